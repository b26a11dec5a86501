#include <fmt/format.h>

#include <cmath>

#include "experiments/studies/bounds/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd finite_or_nan(const VectorXd& values) {
  return values.unaryExpr([](double value) { return std::isfinite(value) ? value : std::nan(""); });
}

Panel panel(const Identifiability& found, const BoundSweep& sweep, const std::string& title, Axis varied,
            bool marked) {
  Panel result{title, std::move(varied), {"Cramer-Rao bound [%]", true}, {}};
  constexpr Colour colours[] = {Colour::blue,   Colour::vermillion, Colour::green,
                                Colour::purple, Colour::orange,     Colour::sky};
  for (std::size_t j = 0; j < found.parameters.size(); ++j) {
    const VectorXd percent = finite_or_nan(sweep.percent.col(static_cast<Index>(j)));
    if (percent.array().isNaN().all()) continue;
    const Colour colour = colours[j % std::size(colours)];
    result.curves.push_back({found.parameters[j].name, sweep.at, percent, CurveStyle::line, {}, {}, colour});
    if (marked) result.curves.push_back({"", sweep.at, percent, CurveStyle::points, {}, {}, colour});
  }
  return result;
}

}  // namespace

std::vector<Figure> figures(const Identifiability& found) {
  Figure record{"record",
                {panel(found, found.lengths, "length of the record", {"duration [s]", true}, false),
                 panel(found, found.rates, "sampling rate", {"sampling rate [Hz]", true}, true)},
                1,
                2};
  std::vector<Figure> all{record};
  if (found.places.empty()) return all;
  Figure sensors{
      "sensors",
      {panel(found, found.places, "one sensor alone, moved along the beam", {"place [m]"}, false),
       panel(found, found.numbers, "sensors added, each where it tells most", {"number of sensors"}, true)},
      1,
      2};
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
