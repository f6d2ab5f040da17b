#include "ros1/parameters.hpp"

#include <sstream>

#include "posevote/core/error.hpp"

namespace posevote::ros1 {
namespace {

std::string to_text(const std::string& name, XmlRpc::XmlRpcValue& value) {
  std::ostringstream text;
  text.precision(17);
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      text << static_cast<double>(value);
      return text.str();
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpc::XmlRpcValue::TypeStruct:
      for (auto& [key, entry] : value) text << key << '=' << to_text(name, entry) << ';';
      return text.str();
    default:
      throw Error(ErrorCode::invalid_argument,
                  "parameter '" + name + "' is neither a number, a truth value nor a text");
  }
}

std::string config_name(const OptionField& field) {
  return logic::join_name(field.name, "__");
}

/// The part of the name before the first dot; its own group in rqt_reconfigure.
std::string group_of(const OptionField& field) {
  const std::size_t dot = field.name.find('.');
  return dot == std::string::npos ? "Default" : field.name.substr(0, dot);
}

std::string edit_method(const OptionField& field) {
  if (field.choices.empty()) return "";
  std::string entries;
  for (const std::string& choice : field.choices)
    entries += "{'name': '" + choice + "', 'type': 'str', 'value': '" + choice +
               "', 'srcline': 0, 'srcfile': '', 'description': '', 'ctype': 'std::string', "
               "'cconsttype': 'const char * const'},";
  return "{'enum_description': '" + field.help + "', 'enum': [" + entries + "]}";
}

dynamic_reconfigure::ParamDescription describe_field(const OptionField& field) {
  static const char* const types[] = {"bool", "int", "double", "str"};
  dynamic_reconfigure::ParamDescription description;
  description.name = config_name(field);
  description.type = types[field.value.index()];
  description.description = field.help + (field.unit.empty() ? "" : " [" + field.unit + "]");
  description.edit_method = edit_method(field);
  return description;
}

/// The fields' present values, or the lower (-1) or upper (1) ends of their ranges.
dynamic_reconfigure::Config make_config(const OptionList& list, int end = 0) {
  dynamic_reconfigure::Config config;
  const auto add = [](auto& entries, const std::string& name, auto value) {
    entries.emplace_back();
    entries.back().name = name;
    entries.back().value = value;
  };
  const auto number = [&](const OptionField& field, double value) {
    return end < 0 ? field.min : end > 0 ? field.max : value;
  };
  for (const OptionField& field : list.fields()) {
    if (logic::is_read_at_start(field.name)) continue;
    const std::string name = config_name(field);
    if (auto* const* flag = std::get_if<bool*>(&field.value))
      add(config.bools, name, end == 0 ? **flag : end > 0);
    else if (auto* const* whole = std::get_if<int*>(&field.value))
      add(config.ints, name, static_cast<int>(number(field, **whole)));
    else if (auto* const* real = std::get_if<double*>(&field.value))
      add(config.doubles, name, number(field, **real));
    else
      add(config.strs, name, end == 0 ? *std::get<std::string*>(field.value) : "");
  }
  return config;
}

}  // namespace

logic::Settings read_parameters(const ros::NodeHandle& private_nh) {
  logic::NodeOptions options;
  const OptionList list = list_options(options);
  logic::Settings settings;
  for (const OptionField& field : list.fields()) {
    XmlRpc::XmlRpcValue value;
    const std::string name = logic::join_name(field.name, "/");
    if (private_nh.getParam(name, value)) settings[field.name] = to_text(name, value);
  }
  return settings;
}

dynamic_reconfigure::ConfigDescription describe(logic::NodeOptions options) {
  const OptionList list = list_options(options);
  dynamic_reconfigure::ConfigDescription description;
  for (const OptionField& field : list.fields()) {
    if (logic::is_read_at_start(field.name)) continue;
    const std::string name = group_of(field);
    auto& groups = description.groups;
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& known) { return known.name == name; });
    if (group == groups.end()) {
      dynamic_reconfigure::Group fresh;
      fresh.name = name;
      fresh.id = static_cast<int>(groups.size());
      group = groups.insert(groups.end(), fresh);
    }
    group->parameters.push_back(describe_field(field));
  }
  logic::NodeOptions defaults;
  description.dflt = make_config(list_options(defaults));
  description.min = make_config(list, -1);
  description.max = make_config(list, 1);
  return description;
}

dynamic_reconfigure::Config to_config(logic::NodeOptions options) {
  dynamic_reconfigure::Config config = make_config(list_options(options));
  for (const dynamic_reconfigure::Group& group : describe(options).groups) {
    dynamic_reconfigure::GroupState state;
    state.name = group.name;
    state.state = true;
    state.id = group.id;
    config.groups.push_back(state);
  }
  return config;
}

logic::Settings changes(const dynamic_reconfigure::Config& config, logic::NodeOptions options) {
  std::map<std::string, std::string> texts;
  for (const auto& entry : config.bools) texts[entry.name] = entry.value ? "true" : "false";
  for (const auto& entry : config.ints) texts[entry.name] = std::to_string(entry.value);
  for (const auto& entry : config.strs) texts[entry.name] = entry.value;
  for (const auto& entry : config.doubles) {
    XmlRpc::XmlRpcValue value(entry.value);
    texts[entry.name] = to_text(entry.name, value);
  }
  logic::Settings settings;
  const OptionList list = list_options(options);
  for (const OptionField& field : list.fields()) {
    const auto found = texts.find(config_name(field));
    if (found == texts.end()) continue;
    if (found->second != field.text()) settings[field.name] = found->second;
    texts.erase(found);
  }
  if (!texts.empty())
    throw Error(ErrorCode::invalid_argument, "there is no option '" + texts.begin()->first + "'");
  return settings;
}

Reconfiguration::Reconfiguration(ros::NodeHandle private_nh, logic::ObjectRecognition& recognition,
                                 std::function<void()> changed)
    : recognition_(recognition), changed_(std::move(changed)) {
  const bool latched = true;
  descriptions_ = private_nh.advertise<dynamic_reconfigure::ConfigDescription>(
      "parameter_descriptions", 1, latched);
  updates_ = private_nh.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, latched);
  service_ = private_nh.advertiseService("set_parameters", &Reconfiguration::set, this);
  descriptions_.publish(describe(recognition_.options()));
  updates_.publish(to_config(recognition_.options()));
}

bool Reconfiguration::set(dynamic_reconfigure::Reconfigure::Request& request,
                          dynamic_reconfigure::Reconfigure::Response& response) {
  try {
    recognition_.set(changes(request.config, recognition_.options()));
  } catch (const Error& error) {
    ROS_ERROR("not set: %s", error.what());
  }
  response.config = to_config(recognition_.options());
  updates_.publish(response.config);
  changed_();
  return true;
}

}  // namespace posevote::ros1
