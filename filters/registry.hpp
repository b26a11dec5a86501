// Methods that register themselves by name, so that a new one is one new file.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace beamid::filters {

// Named options of filters, reductions and models, checked against what each one declares.

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

/// The methods of one kind (filters, discretisation schemes, reductions, models), by name.
///
/// A method's file ends with one line that registers it:
///
///     const bool registered = filter_registry().add({"ukf", "unscented Kalman filter", "[julier2004]",
///     ...});
template <class Product, class... Arguments>
class Registry {
 public:
  struct Entry {
    std::string name;
    std::string summary;  ///< one line
    std::string source;   ///< key in docs/references.md
    std::vector<OptionSpec> options;
    std::set<std::string> contracts;  ///< what the conformance tests hold it to
    std::function<std::unique_ptr<Product>(Arguments..., const Options&)> make;
  };

  /// @param kind what an entry is called in messages: "filter".
  explicit Registry(std::string kind) : kind_(std::move(kind)) {}

  bool add(Entry entry) {
    const std::string name = entry.name;
    if (!entries_.emplace(name, std::move(entry)).second)
      throw std::logic_error(kind_ + " '" + name + "' is registered twice");
    return true;
  }

  const std::string& kind() const { return kind_; }
  const std::map<std::string, Entry>& entries() const { return entries_; }

  /// @throws std::invalid_argument "unknown filter 'ufk'; known: ekf, ukf".
  const Entry& find(const std::string& name) const {
    if (const auto it = entries_.find(name); it != entries_.end()) return it->second;
    std::string known;
    for (const auto& [other, entry] : entries_) known += (known.empty() ? "" : ", ") + other;
    throw std::invalid_argument("unknown " + kind_ + " '" + name + "'; known: " + known);
  }

  /// @throws std::invalid_argument when the name or an option is unknown.
  Options completed(const std::string& name, const Options& options) const {
    return options.completed(find(name).options, kind_ + " '" + name + "'");
  }

  std::unique_ptr<Product> make(const std::string& name, const Options& options,
                                Arguments... arguments) const {
    const Options complete = completed(name, options);
    return find(name).make(std::forward<Arguments>(arguments)..., complete);
  }

 private:
  std::string kind_;
  std::map<std::string, Entry> entries_;
};

}  // namespace beamid::filters
