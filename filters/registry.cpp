#include "filters/registry.hpp"

#include <algorithm>
#include <stdexcept>

namespace beamid::filters {
namespace {
constexpr const char* type_names[] = {"a number", "a text", "true or false",
                                      "a list of numbers"};  // in the order of OptionValue
}

Options Options::completed(const std::vector<OptionSpec>& specs, const std::string& owner) const {
  Options result;
  std::string known;
  for (const OptionSpec& spec : specs) {
    result.set(spec.name, spec.fallback);
    known += (known.empty() ? "" : ", ") + spec.name;
  }
  for (const auto& [name, value] : values_) {
    const auto spec = std::find_if(specs.begin(), specs.end(),
                                   [&wanted = name](const OptionSpec& s) { return s.name == wanted; });
    if (spec == specs.end())
      throw std::invalid_argument("unknown option '" + name + "' of " + owner +
                                  (known.empty() ? "; it has none" : "; known: " + known));
    if (spec->fallback.index() != value.index())
      throw std::invalid_argument("option '" + name + "' of " + owner + " expects " +
                                  type_names[spec->fallback.index()] + "; found " +
                                  type_names[value.index()]);
    result.set(name, value);
  }
  return result;
}

}  // namespace beamid::filters
