#include <algorithm>

#include "experiments/results/key_label.hpp"
#include "experiments/studies/sweep/report.hpp"
#include "experiments/text/choice_text.hpp"

namespace beamid::experiments {
namespace {

using Eigen::VectorXd;

constexpr std::size_t most_sweep_curves = 6;  // more cannot be told apart
constexpr std::size_t most_parameters = 3;

/// A key whose values are numbers to draw against; plan.varied.size() without one.
std::size_t abscissa(const SweepPlan& plan, bool drawn) {
  for (std::size_t j = 0; j < plan.varied.size(); ++j) {
    const VariedKey& key = plan.varied[j];
    const bool numbers =
        std::all_of(key.values.begin(), key.values.end(),
                    [](const filters::OptionValue& value) { return std::holds_alternative<double>(value); });
    const bool is_drawn = key.law != VariedKey::Law::grid;
    if (is_drawn == drawn && (drawn || (numbers && key.values.size() > 1))) return j;
  }
  return plan.varied.size();
}

bool logarithmic(const VectorXd& x) {
  return x.size() > 1 && x.minCoeff() > 0.0 && x.maxCoeff() > 20.0 * x.minCoeff();
}

VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<std::string> parameters_of(const std::vector<PointStatistics>& all) {
  std::vector<std::string> names;
  for (const PointStatistics& one : all)
    if (!one.parameter.empty() && std::isfinite(one.rms_percent) && names.size() < most_parameters &&
        std::find(names.begin(), names.end(), one.parameter) == names.end())
      names.push_back(one.parameter);
  return names;
}

/// Entries of one parameter that differ in the abscissa only.
struct Series {
  std::string name;
  std::vector<double> x, rms, bound, coverage, lower, upper;
};

std::vector<Series> series_of(const SweepPlan& plan, const std::vector<PointStatistics>& all,
                              const std::string& parameter, std::size_t key) {
  std::vector<Series> found;
  for (const PointStatistics& one : all) {
    if (one.parameter != parameter) continue;
    const std::string name = name_of(plan, all, one, key);
    auto at =
        std::find_if(found.begin(), found.end(), [&](const Series& other) { return other.name == name; });
    if (at == found.end() && found.size() == most_sweep_curves) continue;
    if (at == found.end()) at = found.insert(at, Series{name, {}, {}, {}, {}, {}, {}});
    at->x.push_back(std::get<double>(values_of_point(plan, one.point)[key]));
    at->rms.push_back(one.rms_percent);
    at->bound.push_back(one.bound_percent);
    const bool known = one.coverage.runs > 0;
    at->coverage.push_back(known ? 100.0 * one.coverage.value() : std::nan(""));
    at->lower.push_back(known ? 100.0 * one.coverage.lower_95 : std::nan(""));
    at->upper.push_back(known ? 100.0 * one.coverage.upper_95 : std::nan(""));
  }
  return found;
}

constexpr Colour sweep_colours[most_sweep_curves] = {Colour::blue,   Colour::vermillion, Colour::green,
                                                     Colour::purple, Colour::orange,     Colour::sky};

void add_panels(Figure& figure, const std::string& key, const std::string& parameter,
                const std::vector<Series>& all) {
  const bool log_x = logarithmic(vector_of(all[0].x));
  std::string title = parameter;
  std::replace(title.begin(), title.end(), '_', ' ');
  Panel errors{title, {key_label(key), log_x}, {"rms error [%]", true}};
  Panel coverage{title, {key_label(key), log_x}, {"truth in the 95 % interval [%]"}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Series& one = all[i];
    const VectorXd x = vector_of(one.x);
    const std::string label = one.name.empty() ? "filter" : one.name;
    errors.points(label, x, vector_of(one.rms), sweep_colours[i])
        .dashed(i == 0 ? "Cramér-Rao bound" : "", x, vector_of(one.bound), sweep_colours[i]);
    coverage.bars(label, x, vector_of(one.coverage), vector_of(one.lower), vector_of(one.upper),
                  sweep_colours[i]);
  }
  coverage.level("95 %", 95.0, Colour::grey);
  for (Panel& earlier : figure.panels) earlier.legend = Legend::none;  // said once, below the last parameter
  figure.panels.push_back(errors);
  figure.panels.push_back(coverage);
}

Figure scattered(const SweepPlan& plan, const std::vector<SweepRow>& rows,
                 const std::vector<std::string>& parameters, std::size_t key) {
  Figure figure{"sweep", {}, static_cast<int>(parameters.size()), 1};
  for (const std::string& parameter : parameters) {
    std::vector<double> x, error;
    for (const SweepRow& row : rows) {
      if (row.parameter != parameter || row.status != "converged") continue;
      x.push_back(number(row.values[key]).value_or(std::nan("")));
      error.push_back(100.0 * row.error / std::abs(row.truth));
    }
    figure.panels.push_back(
        Panel{parameter, {key_label(plan.varied[key].key), logarithmic(vector_of(x))}, {"error [%]"}}
            .points("", vector_of(x), vector_of(error))
            .key(Legend::none));
  }
  return figure;
}

}  // namespace

std::vector<Figure> figures(const SweepPlan& plan, const std::vector<SweepRow>& rows,
                            const std::vector<PointStatistics>& statistics) {
  const std::vector<std::string> parameters = parameters_of(statistics);
  const std::size_t key = abscissa(plan, false), drawn = abscissa(plan, true);
  if (parameters.empty()) return {};
  if (key == plan.varied.size())
    return drawn == plan.varied.size() ? std::vector<Figure>{}
                                       : std::vector<Figure>{scattered(plan, rows, parameters, drawn)};
  Figure figure{"sweep", {}, static_cast<int>(parameters.size()), 2};
  figure.width = 1000;
  figure.caption =
      "Root mean square error with the Cramér-Rao bound, and how often the 95 % interval holds the truth.";
  for (const std::string& parameter : parameters)
    add_panels(figure, plan.varied[key].key, parameter, series_of(plan, statistics, parameter, key));
  return {figure};
}

}  // namespace beamid::experiments
