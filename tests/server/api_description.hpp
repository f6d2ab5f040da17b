// openapi.yaml as data, and JSON held against its schemas.
#pragma once

#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace posevote {

struct Operation {
  std::string method;  ///< "GET"
  std::string path;    ///< "/api/objects/{object}"
  bool open = false;   ///< needs no token
  YAML::Node node;

  [[nodiscard]] std::string name() const { return method + " " + path; }
  [[nodiscard]] std::vector<int> statuses() const;  ///< but "default"
};

class ApiDescription {
 public:
  explicit ApiDescription(const std::string& yaml);

  [[nodiscard]] const std::vector<Operation>& operations() const { return operations_; }

  /// What is wrong with this response, as it is described; "": nothing. "default" describes 500 and
  /// 501 only: all others are to be listed.
  [[nodiscard]] std::string check(const Operation& operation, int status, const std::string& type,
                                  const std::string& body) const;

 private:
  [[nodiscard]] YAML::Node resolve(YAML::Node node) const;
  [[nodiscard]] std::string check_value(YAML::Node schema, const nlohmann::ordered_json& value,
                                        const std::string& at) const;
  [[nodiscard]] std::string check_object(const YAML::Node& schema,
                                         const nlohmann::ordered_json& value,
                                         const std::string& at) const;
  void collect(YAML::Node schema, std::vector<YAML::Node>& parts) const;

  YAML::Node root_;
  std::vector<Operation> operations_;
};

}  // namespace posevote
