#include "ros2/parameters.hpp"

#include <cstdio>

#include "posevote/core/error.hpp"

namespace posevote::ros2 {
namespace {

std::string to_text(const rclcpp::Parameter& parameter) {
  switch (parameter.get_type()) {
    case rclcpp::ParameterType::PARAMETER_BOOL:
      return parameter.as_bool() ? "true" : "false";
    case rclcpp::ParameterType::PARAMETER_INTEGER:
      return std::to_string(parameter.as_int());
    case rclcpp::ParameterType::PARAMETER_DOUBLE: {
      char text[64];
      (void)std::snprintf(text, sizeof text, "%.17g", parameter.as_double());
      return text;
    }
    default:
      return parameter.as_string();
  }
}

rclcpp::ParameterValue to_value(const OptionField& field) {
  if (auto* const* flag = std::get_if<bool*>(&field.value)) return rclcpp::ParameterValue(**flag);
  if (auto* const* whole = std::get_if<int*>(&field.value)) return rclcpp::ParameterValue(**whole);
  if (auto* const* real = std::get_if<double*>(&field.value)) return rclcpp::ParameterValue(**real);
  return rclcpp::ParameterValue(*std::get<std::string*>(field.value));
}

rcl_interfaces::msg::ParameterDescriptor describe(const OptionField& field) {
  rcl_interfaces::msg::ParameterDescriptor descriptor;
  descriptor.description = field.help + (field.unit.empty() ? "" : " [" + field.unit + "]");
  if (std::holds_alternative<int*>(field.value)) {
    descriptor.integer_range.resize(1);
    descriptor.integer_range[0].from_value = static_cast<std::int64_t>(field.min);
    descriptor.integer_range[0].to_value = static_cast<std::int64_t>(field.max);
    descriptor.integer_range[0].step = 1;
  } else if (std::holds_alternative<double*>(field.value)) {
    descriptor.floating_point_range.resize(1);
    descriptor.floating_point_range[0].from_value = field.min;
    descriptor.floating_point_range[0].to_value = field.max;
  }
  for (const std::string& choice : field.choices)
    descriptor.additional_constraints +=
        (descriptor.additional_constraints.empty() ? "one of " : ", ") + choice;
  return descriptor;
}

}  // namespace

Parameters::Parameters(rclcpp_lifecycle::LifecycleNode& node) : node_(node) {
  logic::NodeOptions options;
  const OptionList list = list_options(options);
  for (const OptionField& field : list.fields()) declare(field);
  handle_ = node.add_on_set_parameters_callback(
      [this](const std::vector<rclcpp::Parameter>& parameters) { return set(parameters); });
}

void Parameters::declare(const OptionField& field) {
  node_.declare_parameter(field.name, to_value(field), describe(field));
  names_.insert(field.name);
  const auto& overrides = node_.get_node_parameters_interface()->get_parameter_overrides();
  if (overrides.count(field.name)) given_.insert(field.name);
}

logic::Settings Parameters::given() const {
  logic::Settings settings;
  for (const std::string& name : given_) settings[name] = to_text(node_.get_parameter(name));
  return settings;
}

void Parameters::follow(logic::ObjectRecognition* recognition) {
  recognition_ = recognition;
  if (recognition) show(recognition->options());
}

void Parameters::show(logic::NodeOptions options) {
  const OptionList list = list_options(options);
  std::vector<rclcpp::Parameter> changed;
  for (const OptionField& field : list.fields()) {
    const rclcpp::Parameter parameter(field.name, to_value(field));
    if (node_.get_parameter(field.name) != parameter) changed.push_back(parameter);
  }
  showing_ = true;
  (void)node_.set_parameters(changed);
  showing_ = false;
}

rcl_interfaces::msg::SetParametersResult Parameters::set(
    const std::vector<rclcpp::Parameter>& parameters) {
  rcl_interfaces::msg::SetParametersResult result;
  result.successful = true;
  if (showing_) return result;
  logic::Settings settings;
  for (const rclcpp::Parameter& parameter : parameters)
    if (names_.count(parameter.get_name())) settings[parameter.get_name()] = to_text(parameter);
  try {
    if (recognition_ && !settings.empty()) recognition_->set(settings);
    for (const auto& [name, text] : settings) given_.insert(name);
  } catch (const Error& error) {
    result.successful = false;
    result.reason = error.what();
  }
  return result;
}

}  // namespace posevote::ros2
