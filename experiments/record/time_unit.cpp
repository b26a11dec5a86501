#include "experiments/record/time_unit.hpp"

#include <fmt/format.h>

#include "experiments/record/units.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

std::optional<double> seconds_per(const std::string& unit, const std::string& what, const std::string& file,
                                  const RecordFormat& format) {
  if (unit.empty()) return 1.0;
  std::string small = unit;  // old programs write "SEC"
  for (char& letter : small)
    letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter + 32) : letter;
  for (const std::string& spelling : {unit, small})
    if (const auto stated = stated_unit(spelling); stated && !stated->quantity) return stated->factor;
  if (format.time || format.sampling_rate) return std::nullopt;
  throw InputError({file}, fmt::format("{} is in '{}'; expected times in {}, or record.time or "
                                       "record.sampling_rate_hz in the configuration",
                                       what, unit, joined(symbols(time_units()))));
}

}  // namespace beamid::experiments
