#include "experiments/studies/paper/specificity.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "experiments/studies/paper/data_generator.hpp"
#include "experiments/studies/paper/errors.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "experiments/studies/paper/test_beams.hpp"

namespace beamid::experiments::paper {
namespace {

struct ObservedChoice {
  const char* name;
  std::vector<Quantity> quantities;
};

const std::vector<ObservedChoice>& observed_choices() {
  static const std::vector<ObservedChoice> choices{{"x and v", {Quantity::displacement, Quantity::velocity}},
                                                   {"x", {Quantity::displacement}},
                                                   {"v", {Quantity::velocity}}};
  return choices;
}

double hundredths(double percent_value) {
  return std::round(100.0 * std::abs(percent_value));
}

}  // namespace

bool DigitCase::prints_the_published_digits() const {
  return hundredths(stiffness_error_percent) == hundredths(published_stiffness_error_percent) &&
         hundredths(damping_error_percent) == hundredths(published_damping_error_percent);
}

std::vector<DigitCase> examine_digits() {
  std::vector<DigitCase> cases;
  for (const ObservedChoice& observed : observed_choices())
    for (const std::string& data : data_generators())
      for (const std::string& scheme : compared_schemes()) cases.push_back({data, scheme, observed.name});
  const std::size_t per_choice = cases.size() / observed_choices().size();
  tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
    ValidationSettings settings;
    settings.release = release_of(test_beams[0]).tip_deflection;
    settings.data = cases[i].data;
    settings.observed = observed_choices()[i / per_choice].quantities;
    const Identification found = validate("ekf", cases[i].scheme, settings);
    cases[i].stiffness_error_percent = stiffness_error(found.found, settings.truth);
    cases[i].damping_error_percent = damping_error(found.found, settings.truth);
  });
  return cases;
}

Table digit_matrix(const std::vector<DigitCase>& cases) {
  Table table{"generator_and_filter",
              "Error of C by what made the data, what the filter is and what it reads [%]"};
  table.column({"observed", "observed"}).column({"data", "data"});
  for (const std::string& scheme : compared_schemes())
    table.column({scheme + " [%]", scheme + "_damping_error_percent", "{:+.4f}"});
  std::vector<Cell> row;
  for (const DigitCase& one : cases) {
    if (row.empty()) row = {one.observed, one.data};
    row.emplace_back(one.damping_error_percent);
    if (row.size() < table.columns.size()) continue;
    table.row(row);
    row.clear();
  }
  table.note =
      "The oscillator of table 2, released from 12 mm; rows: what made the data, columns: the filter's own "
      "discretisation. Average acceleration moves a linear system as the implicit midpoint rule does.";
  return table;
}

Table digit_matches(const std::vector<DigitCase>& cases) {
  Table table{"published_digits", "The combinations that print the published 0.13 and 6.41 %"};
  table.column({"data", "data"})
      .column({"filter", "filter"})
      .column({"observed", "observed"})
      .column({"error K [%]", "stiffness_error_percent", "{:+.4f}"})
      .column({"error C [%]", "damping_error_percent", "{:+.4f}"});
  for (const DigitCase& one : cases)
    if (one.prints_the_published_digits())
      table.row({one.data, one.scheme, one.observed, one.stiffness_error_percent, one.damping_error_percent});
  table.note = fmt::format("{} of {} combinations. The article prints magnitudes, so signs do not decide.",
                           table.rows(), cases.size());
  return table;
}

Figure digit_figure(const std::vector<DigitCase>& cases) {
  const auto& generators = data_generators();
  Panel panel{"", {"error of C [%]"}, {""}};
  panel.y_axis.names = generators;
  for (const std::string& scheme : compared_schemes()) {
    Eigen::VectorXd error(static_cast<Eigen::Index>(generators.size())), place(error.size());
    Eigen::Index i = 0;
    for (const DigitCase& one : cases)
      if (one.scheme == scheme && one.observed == observed_choices()[0].name) {
        error[i] = one.damping_error_percent;
        place[i] = static_cast<double>(i + 1);
        ++i;
      }
    panel.points(scheme, error, place);
  }
  panel.across(-15.0, 15.0)
      .up(0.5, static_cast<double>(generators.size()) + 0.5)
      .upright("published, with its sign as forward Euler has it", published_damping_error_percent);
  Figure figure{"generator_matrix", {panel}, 1, 1, 900};
  figure.caption =
      "Error of C on the paper's oscillator, displacement and velocity observed: rows, what made the data; "
      "colours, the filter.";
  return figure;
}

}  // namespace beamid::experiments::paper
