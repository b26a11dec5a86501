// Named options of filters, reductions and models, checked against what each one declares.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

namespace beamid::filters {

using OptionValue = std::variant<double, std::string, bool, std::vector<double>>;

/// An option a method understands.
struct OptionSpec {
  std::string name;
  OptionValue fallback;     ///< its value when none is given; also fixes its type
  std::string unit;         ///< empty when dimensionless
  std::string description;  ///< one line
};

/// Values by name.
class Options {
 public:
  Options() = default;
  Options(std::initializer_list<std::pair<const std::string, OptionValue>> values) : values_(values) {}

  void set(const std::string& name, OptionValue value) { values_[name] = std::move(value); }
  double number(const std::string& name) const { return std::get<double>(values_.at(name)); }
  bool flag(const std::string& name) const { return std::get<bool>(values_.at(name)); }
  const std::string& text(const std::string& name) const { return std::get<std::string>(values_.at(name)); }
  const std::vector<double>& numbers(const std::string& name) const {
    return std::get<std::vector<double>>(values_.at(name));
  }
  const std::map<std::string, OptionValue>& values() const { return values_; }

  /// These values, completed by the fallbacks of `specs`.
  /// @throws std::invalid_argument on an unknown name or a wrong type; `owner` reads like "filter 'ukf'".
  Options completed(const std::vector<OptionSpec>& specs, const std::string& owner) const;

 private:
  std::map<std::string, OptionValue> values_;
};

}  // namespace beamid::filters
