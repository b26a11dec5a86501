#include <fmt/format.h>

#include <limits>

#include "experiments/config/readers.hpp"
#include "experiments/record/delimited_text.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

reduction::Training read_shape(const std::filesystem::path& file, double length) {
  constexpr const char* expected = "two columns, position_m and deflection";
  const std::string text = read_text(file, fmt::format("a shape in {}", expected));
  DelimitedText rows(file.string(), text, '\0', 0);
  if (rows.width() != 2)
    throw InputError(rows.row_place(),
                     fmt::format("{}; expected {}", count_of_columns(rows.width()), expected));
  if (const auto& names = rows.names();
      !names.empty() && (names[0] != "position_m" || names[1] != "deflection"))
    throw InputError({file.string(), rows.header_line()},
                     fmt::format("columns '{}' and '{}'; expected {}", names[0], names[1], expected));
  std::vector<double> positions, deflections;
  double largest = 0.0;
  while (rows.next()) {
    const double position = rows.number(0);
    if (!(position >= 0.0 && position <= length))
      throw InputError(rows.place(0),
                       fmt::format("position {} m; expected one on the beam, 0 to {} m", position, length));
    if (!positions.empty() && position <= positions.back())
      throw InputError(rows.place(0), fmt::format("position {} m after {} m; expected increasing positions",
                                                  position, positions.back()));
    positions.push_back(position);
    deflections.push_back(rows.number(1));
    largest = std::max(largest, std::abs(deflections.back()));
  }
  if (!(largest > std::numeric_limits<double>::min()))
    throw InputError({file.string()}, "every deflection is zero; expected a shape");
  const auto count = static_cast<Eigen::Index>(positions.size());
  return {Eigen::Map<const Eigen::VectorXd>(positions.data(), count),
          Eigen::Map<const Eigen::VectorXd>(deflections.data(), count)};
}

}  // namespace beamid::experiments
