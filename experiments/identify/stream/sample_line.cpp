#include "experiments/identify/stream/sample_line.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>

#include "experiments/text/fields.hpp"

namespace beamid::experiments {

filters::Sample read_sample(const std::string& line, Eigen::Index outputs, const Place& place) {
  std::vector<std::string_view> fields;
  split_fields(std::string_view(line).substr(0, line.find_last_not_of('\r') + 1), ',', fields, true);
  const auto found = static_cast<Eigen::Index>(fields.size());
  if (found != outputs + 1)
    throw InputError(place, fmt::format("{} fields; expected {}: a time and {} output{}, parted by commas",
                                        found, outputs + 1, outputs, outputs == 1 ? "" : "s"));
  filters::Sample sample;
  sample.output.resize(outputs);
  for (Eigen::Index i = 0; i <= outputs; ++i) {
    const std::string_view field = fields[static_cast<std::size_t>(i)];
    const Place here{place.file, place.line, static_cast<std::size_t>(field.data() - line.data()) + 1};
    const ParsedNumber parsed = parse_number(field);
    const bool out_of_range = parsed.number && !parsed.finite && std::isfinite(parsed.value);
    if (!field.empty() && (!parsed.number || out_of_range))
      throw InputError(here,
                       fmt::format("'{}'; expected a number, or nothing where none was measured", field));
    if (i == 0 && !parsed.finite) throw InputError(here, "no time; expected seconds");
    (i == 0 ? sample.time : sample.output[i - 1]) =
        field.empty() ? std::numeric_limits<double>::quiet_NaN() : parsed.value;
  }
  return sample;
}

}  // namespace beamid::experiments
