#include "api_description.hpp"

#include <algorithm>
#include <sstream>

namespace posevote {

using Json = nlohmann::ordered_json;

namespace {

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

bool has_type(const std::string& type, const Json& value) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  return type == "number" && value.is_number();
}

}  // namespace

std::vector<int> Operation::statuses() const {
  std::vector<int> all;
  for (const auto& response : node["responses"])
    if (response.first.as<std::string>() != "default") all.push_back(response.first.as<int>());
  return all;
}

ApiDescription::ApiDescription(const std::string& yaml) : root_(YAML::Load(yaml)) {
  for (const auto& path : root_["paths"])
    for (const auto& method : path.second) {
      const YAML::Node security = method.second["security"];
      operations_.push_back({upper(method.first.as<std::string>()), path.first.as<std::string>(),
                             security.IsDefined() && security.size() == 0, method.second});
    }
}

YAML::Node ApiDescription::resolve(YAML::Node node) const {
  while (node["$ref"].IsDefined()) {
    std::istringstream path(node["$ref"].as<std::string>().substr(2));
    YAML::Node at;
    at.reset(root_);
    for (std::string step; std::getline(path, step, '/');) at.reset(YAML::Node(at[step]));
    node.reset(at);
  }
  return node;
}

std::string ApiDescription::check(const Operation& operation, int status, const std::string& type,
                                  const std::string& body) const {
  const bool failed = status == 500 || status == 501;
  const YAML::Node found = operation.node["responses"][failed ? "default" : std::to_string(status)];
  if (!found.IsDefined()) return "status " + std::to_string(status) + " is not described";
  const YAML::Node content = resolve(found)["content"];
  const std::string plain = type.substr(0, type.find(';'));
  if (!content.IsDefined()) return body.empty() ? "" : "a body is not described";
  const YAML::Node described = content[plain];
  if (!described.IsDefined()) return "content type '" + type + "' is not described";
  if (plain != "application/json") return body.empty() ? "the body is empty" : "";
  const Json json = Json::parse(body, nullptr, false);
  if (json.is_discarded()) return "the body is not JSON: " + body;
  return check_value(described["schema"], json, "$");
}

std::string ApiDescription::check_value(YAML::Node schema, const Json& value,
                                        const std::string& at) const {
  schema.reset(resolve(schema));
  if (value.is_null() && schema["nullable"].IsDefined()) return "";
  if (schema["allOf"].IsDefined()) return check_object(schema, value, at);
  const YAML::Node type = schema["type"];
  if (!type.IsDefined()) return "";  // anything
  if (!has_type(type.as<std::string>(), value))
    return at + " is no " + type.as<std::string>() + ": " + value.dump();
  if (const YAML::Node choices = schema["enum"]; choices.IsDefined()) {
    const bool known = std::any_of(choices.begin(), choices.end(), [&](const YAML::Node& choice) {
      return choice.as<std::string>() == value.get<std::string>();
    });
    if (!known) return at + " is none of its choices: " + value.dump();
  }
  if (value.is_number() && schema["minimum"].IsDefined() &&
      value.get<double>() < schema["minimum"].as<double>())
    return at + " is too small: " + value.dump();
  if (value.is_number() && schema["maximum"].IsDefined() &&
      value.get<double>() > schema["maximum"].as<double>())
    return at + " is too large: " + value.dump();
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      std::string wrong =
          check_value(schema["items"], value[i], at + "[" + std::to_string(i) + "]");
      if (!wrong.empty()) return wrong;
    }
    if (schema["minItems"].IsDefined() && value.size() < schema["minItems"].as<std::size_t>())
      return at + " is too short";
  }
  return value.is_object() ? check_object(schema, value, at) : "";
}

void ApiDescription::collect(YAML::Node schema, std::vector<YAML::Node>& parts) const {
  schema.reset(resolve(schema));
  if (schema["allOf"].IsDefined())
    for (const YAML::Node& part : schema["allOf"]) collect(part, parts);
  if (schema["properties"].IsDefined()) parts.push_back(schema);
}

std::string ApiDescription::check_object(const YAML::Node& schema, const Json& value,
                                         const std::string& at) const {
  std::vector<YAML::Node> parts;
  collect(schema, parts);
  if (!value.is_object()) return at + " is no object";
  for (const YAML::Node& part : parts)
    for (const YAML::Node& name : part["required"])
      if (!value.contains(name.as<std::string>())) return at + " has no " + name.as<std::string>();
  const std::string within = at + ".";
  for (const auto& [name, inner] : value.items()) {
    const std::string place = within + name;
    std::string wrong = place + " is not described";
    for (const YAML::Node& part : parts)
      if (const YAML::Node property = part["properties"][name]; property.IsDefined())
        wrong = check_value(property, inner, place);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace posevote
