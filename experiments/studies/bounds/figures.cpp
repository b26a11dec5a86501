#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/studies/bounds/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd finite_or_nan(const VectorXd& values) {
  return values.unaryExpr([](double value) { return std::isfinite(value) ? value : std::nan(""); });
}

Panel panel(const Identifiability& found, const BoundSweep& sweep, const std::string& title, Axis varied) {
  Panel result{title, std::move(varied), {"Cramér-Rao bound [%]", true}};
  constexpr Colour colours[] = {Colour::blue,   Colour::vermillion, Colour::green,
                                Colour::purple, Colour::orange,     Colour::sky};
  for (std::size_t j = 0; j < found.parameters.size(); ++j) {
    const VectorXd percent = finite_or_nan(sweep.percent.col(static_cast<Index>(j)));
    if (percent.array().isNaN().all()) continue;
    const Colour colour = colours[j % std::size(colours)];
    std::string name = found.parameters[j].name;
    std::replace(name.begin(), name.end(), '_', ' ');
    result.line(name, sweep.at, percent, colour);
  }
  return result;
}

}  // namespace

std::vector<Figure> figures(const Identifiability& found) {
  Figure record{"record",
                {panel(found, found.lengths, "length of the record", {"duration [s]", true}),
                 panel(found, found.rates, "sampling rate", {"sampling rate [Hz]", true})},
                1,
                2};
  record.caption = "Cramér-Rao bounds against the length of the record and the sampling rate.";
  std::vector<Figure> all{record};
  if (found.places.empty()) return all;
  Figure sensors{
      "sensors",
      {panel(found, found.places, "one sensor alone, moved along the beam", {"place [m]"}),
       panel(found, found.numbers, "sensors added, each at its best place", {"number of sensors"})},
      1,
      2};
  sensors.caption = "Cramér-Rao bounds against the place of a sensor, and against the number of sensors.";
  all.push_back(sensors);
  std::vector<Figure> drawn;
  for (Figure& figure : all) {
    std::erase_if(figure.panels, [](const Panel& one) { return one.curves.empty(); });
    figure.columns = static_cast<int>(figure.panels.size());
    if (!figure.panels.empty()) drawn.push_back(std::move(figure));
  }
  return drawn;
}

}  // namespace beamid::experiments
