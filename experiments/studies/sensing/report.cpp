#include "experiments/studies/sensing/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/results/result_directory.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

// "name [unit]" as the key of a column: "tip_force_n".
std::string suffix_of_unit(const std::string& unit) {
  if (unit == "m/s2") return "_m_per_s2";
  if (unit == "m/s") return "_m_per_s";
  if (unit == "N m") return "_n_m";
  if (unit == "N") return "_n";
  if (unit == "m") return "_m";
  return "";  // strain
}

Table history_table(const SensingStudy& study) {
  Table table{"sensed", "What no sensor read"};
  const bool truth = std::any_of(study.histories.begin(), study.histories.end(),
                                 [](const auto& one) { return one.truth.has_value(); });
  table.column({"what", "name"})
      .column({"unit", "unit"})
      .column({"rms", "root_mean_square", "{:.4g}"})
      .column({"largest", "largest", "{:.4g}"})
      .column({"error reported", "reported_error", "{:.3g}"})
      .column({"without sensors", "unread_deviation", "{:.3g}"});
  if (truth)
    table.column({"true error", "true_error", "{:.3g}"}).column({"true/reported", "error_ratio", "{:.2f}"});
  for (const SensedHistory& one : study.histories) {
    std::vector<Cell> row{one.name,
                          one.unit,
                          one.root_mean_square(),
                          one.mean.cwiseAbs().maxCoeff(),
                          one.reported_error(),
                          one.unread_deviation};
    if (truth) {
      row.emplace_back(one.truth ? one.error() : std::nan(""));
      row.emplace_back(one.truth ? one.error() / one.reported_error() : std::nan(""));
    }
    table.row(row);
  }
  table.note = "Errors: root mean square over the record of the standard deviation at each sample.";
  if (!study.filter.empty())
    table.note += fmt::format(
        " By {}, of the readings up to each sample; its first tenth, in which it finds the start, is not "
        "counted.",
        study.filter);
  for (const std::string& remark : study.filter_remarks)
    table.note += fmt::format(" {}: {}.", study.filter, remark);
  return table;
}

Table left_out_table(const SensingStudy& study) {
  Table table{"left_out", "Each sensor predicted from the others"};
  table.column({"sensor", "name"})
      .column({"unit", "unit"})
      .column({"rms", "root_mean_square", "{:.4g}"})
      .column({"error", "error", "{:.3g}"})
      .column({"expected", "expected_error", "{:.3g}"})
      .column({"error/expected", "ratio", "{:.2f}"})
      .column({"", "verdict"});
  for (const LeftOutSensor& one : study.left_out)
    table.row({one.name, one.unit, one.root_mean_square, one.error, one.expected, one.error / one.expected,
               one.contradicts() ? "contradicted"
               : one.free()      ? "not predictable"
                                 : "agrees"});
  return table;
}

Table constant_table(const SensingStudy& study) {
  Table table{"constants", "Found by the likelihood of the record"};
  table.column({"constant", "name"})
      .column({"unit", "unit"})
      .column({"value", "value", "{:.5g}"})
      .column({"from", "lower_95", "{:.5g}"})
      .column({"to", "upper_95", "{:.5g}"});
  for (const SensedConstant& one : study.constants)
    table.row({one.name, one.unit, one.value, one.lower_95, one.upper_95});
  return table;
}

Table damage_table(const SensingStudy& study) {
  Table table{"fatigue", "Fatigue damage over the record"};
  table.column({"strain", "name"})
      .column({"damage", "damage", "{:.3g}"})
      .column({"from", "lower_95", "{:.3g}"})
      .column({"to", "upper_95", "{:.3g}"})
      .column({"cycles", "cycles", "{:.0f}"})
      .column({"range", "equivalent_range", "{:.3g}"})
      .column({"narrow band", "narrow_band_damage", "{:.3g}"});
  for (const auto& one : study.damages)
    table.row({one.name, one.damage.damage, one.lower_95, one.upper_95, one.damage.cycles,
               one.damage.equivalent_range, one.damage.narrow_band});
  table.note =
      "Rainflow cycles of histories drawn with their error; narrow band: the closed formula for a "
      "Gaussian history of one frequency, which broader bands stay below.";
  return table;
}

Table history_columns(const SensingStudy& study) {
  Table table{"histories", ""};
  const auto add = [&](const std::string& key, const VectorXd& values) {
    Column column{key, key};
    column.cells.assign(values.begin(), values.end());
    table.column(std::move(column));
  };
  add("time_s", study.time);
  for (const SensedHistory& one : study.histories) {
    add(one.name + suffix_of_unit(one.unit), one.mean);
    add(one.name + "_deviation" + suffix_of_unit(one.unit), one.deviation);
  }
  return table;
}

// 600 samples about the largest force, at most four histories.
Figure history_figure(const SensingStudy& study) {
  constexpr std::size_t most = 4;
  Figure figure{"sensed_histories", {}};
  const Index samples = study.time.size(), shown = std::min<Index>(samples, 600);
  Index at = 0;
  study.histories.back().mean.cwiseAbs().maxCoeff(&at);
  const Index from = std::clamp<Index>(at - shown / 2, 0, samples - shown);
  for (const SensedHistory& one : study.histories) {
    if (figure.panels.size() == most) break;
    const VectorXd t = study.time.segment(from, shown), mean = one.mean.segment(from, shown),
                   wide = quantile_95 * one.deviation.segment(from, shown);
    Panel panel{"", {"time [s]"}, {one.unit.empty() ? one.name : one.name + " [" + one.unit + "]"}};
    panel.band("95 %", t, mean - wide, mean + wide, Colour::sky);
    if (one.truth) panel.line("true", t, one.truth->segment(from, shown), Colour::black);
    panel.line("sensed", t, mean, Colour::blue);
    figure.panels.push_back(std::move(panel));
  }
  figure.rows = static_cast<int>(figure.panels.size());
  figure.caption = "Histories that no sensor read, where the force is largest.";
  return figure;
}

// A force that is not known takes in whatever inertia its place has.
void add_what_is_unchecked(const Experiment& experiment, Results& results) {
  for (const ParameterChoice& parameter : experiment.parameters)
    if (parameter.quantity.find("mass") != std::string::npos) return;
  std::string places;
  for (const UnknownForce& force : experiment.unknown_forces)
    if (force.quantity == Quantity::force) places += (places.empty() ? "" : ", ") + force.name;
  if (!places.empty())
    results.paragraph("No sensor checks the mass where " + places +
                      " acts: what it is off becomes part of the force, and all sensors agree.");
}

}  // namespace

std::string sensing_sentence(const SensingStudy& study, const std::string& record) {
  std::string text = fmt::format("{}: {} samples, {} coordinates ({})", record, study.time.size(),
                                 study.coordinates, study.reduction);
  if (!study.forces.empty())
    text += fmt::format(", {} unknown force{}", study.forces.size(), study.forces.size() == 1 ? "" : "s");
  return text + ".";
}

Results sensing_report(const Experiment& experiment, const SensingStudy& study, const std::string& record) {
  Results results;
  results.command = "sense";
  results.configuration = describe(experiment);
  results.configuration["reduction"] = study.reduction;
  results.paragraph(sensing_sentence(study, record));
  add_sensing_verdict(study, results);
  add_what_is_unchecked(experiment, results);
  if (experiment.fatigue && study.damages.empty())
    results.warning(
        "[fatigue] requests the damage of strains, and no [[virtual_sensors]] has quantity = \"strain\": no "
        "damage is worked out.");
  results.table(history_table(study));
  if (!study.left_out.empty()) results.table(left_out_table(study));
  if (!study.constants.empty()) results.table(constant_table(study));
  if (!study.damages.empty()) results.table(damage_table(study));
  results.values["converged"] = study.converged;
  results.values["contradicted"] = study.contradicted();
  results.values["status"] = !study.converged       ? "not converged"
                             : study.contradicted() ? "contradicted"
                             : study.correlated()   ? "correlated"
                                                    : "converged";
  if (!study.filter.empty()) results.values["filter"] = study.filter;
  results.values["unseen_constant_forces"] = study.unseen_constants;
  results.values["mean_normalised_square"] = study.innovations.mean_normalised_square;
  results.values["lag_one_correlation"] = study.innovations.lag_one_correlation;
  const Table histories = history_columns(study);
  results.attachments.push_back({{"histories.csv"}, [histories](const std::filesystem::path& folder) {
                                   write_file(folder / "histories.csv", to_csv(histories));
                                 }});
  results.figures.push_back(history_figure(study));
  return results;
}

// Whether what was sensed may be relied on, and what contradicts it.

namespace {

// A part of a whole that may be next to nothing.
std::string share(double part, double whole) {
  constexpr double most = 10.0;
  return part <= most * whole ? fmt::format("{:.0f} %", 100.0 * part / whole) : "more than 1000 %";
}

}  // namespace

void add_sensing_verdict(const SensingStudy& study, Results& results) {
  if (!study.converged)
    results.warning(
        "The constants were not found: " + study.failure + ". All below is where the search ended.", true);
  for (const SensorNoise& one : study.noise)
    if (one.explains_too_much())
      results.warning(
          fmt::format("{}: {} of its signal is treated as noise, which was not specified: {:.3g} {}. The "
                      "structure, a sensor's place or unit, or the places of the unknown forces are not "
                      "as described.",
                      one.name, share(one.deviation, one.root_mean_square), one.deviation, one.unit),
          true);
  std::size_t free = 0;
  for (const LeftOutSensor& one : study.left_out) {
    if (one.contradicts())
      results.warning(fmt::format("{}: the other sensors predict it with an error of {:.3g} {}, {:.2g} times "
                                  "what they report. The structure, a sensor's place or unit, or the places "
                                  "of the unknown forces are not as described.",
                                  one.name, one.error, one.unit, one.error / one.expected),
                      true);
    free += one.free() ? 1 : 0;
  }
  if (study.left_out.empty())
    results.warning(
        study.forces.empty()
            ? "One sensor alone: no other checks it, its place or its unit."
            : "One sensor alone: no other checks the structure as described, and its errors become "
              "force.");
  else if (free == study.left_out.size())
    results.warning(
        "No sensor can be predicted from the others: any record would fit, and no sensor checks the "
        "structure "
        "as described. A sensor more would.");
  else if (study.is_to_rely_on())
    results.paragraph(fmt::format(
        "{} of {} sensors are predicted by the others as well as their standard deviations state.",
        study.left_out.size() - free, study.left_out.size()));
  if (study.unseen_constants > 0)
    results.warning(fmt::format(
        "{} cannot be seen: these sensors read the same of {} as of rest. Means of forces, "
        "displacements and strains are not known, and no error below holds them; what changes "
        "slowly is known from the correlation time only. One displacement or strain would determine them.",
        study.forces.size() == 1 ? "A constant force"
        : study.unseen_constants == 1
            ? "One combination of constant forces"
            : std::to_string(study.unseen_constants) + " combinations of constant forces",
        study.unseen_constants == 1 ? "it" : "them"));
  for (const SoleZero& zero : study.sole_zeros) {
    std::string moved;
    for (std::size_t j = 0; j < zero.shifts.size() && j < study.histories.size(); ++j)
      if (std::abs(zero.shifts[j]) > 1e-3 * study.histories[j].reported_error())
        moved += fmt::format("{}{} by {:.3g} {}", moved.empty() ? "" : ", ", study.histories[j].name,
                             zero.shifts[j], study.histories[j].unit);
    results.warning(fmt::format(
        "Means rest on the zero of {} alone, which is taken for exact: no other sensor distinguishes an "
        "offset of it from a constant force. Off by {:g} {} it shifts {}. The errors below do not "
        "hold it.",
        zero.name, zero.off, zero.unit, moved));
  }
  for (const SensedHistory& one : study.histories)
    if (one.undetermined())
      results.warning(
          fmt::format("{}: not determined by these sensors; its error is {} of what it would be without "
                      "any.",
                      one.name, share(one.reported_error(), one.unread_deviation)));
  for (const SensedHistory& one : study.histories)
    if (one.contradicts_smoother())
      results.warning(
          fmt::format("{} has failed: its {} is {:.2g} {} from the smoother's, which sees the same "
                      "readings; it reports an error of {:.2g}.",
                      study.filter, one.name, one.from_smoother, one.unit, one.reported_error()),
          true);
  const double square = study.innovations.mean_normalised_square,
               correlation = study.innovations.lag_one_correlation;
  if (square > SensingStudy::largest_square)
    results.warning(
        fmt::format(
            "One-step prediction errors are {:.2g} times as large as specified: structure, sensors or forces "
            "are not as described.",
            std::sqrt(square)),
        true);
  else if (study.coloured())
    results.warning(
        fmt::format(
            "Innovations are correlated from sample to sample, {:.2f}: the force is not such a process, "
            "or the structure not quite as described. {}.",
            correlation,
            study.correlated() ? "Standard deviations, and intervals of parameters above all, are too small"
                               : "Standard deviations may be too small"),
        study.correlated());
  if (square <= SensingStudy::largest_square && study.noisier_than_stated())
    results.warning(
        fmt::format("One-step prediction errors are {:.2f} times as large as specified. The noise is larger "
                    "than stated, or forces are. Standard deviations and intervals are too small by as much.",
                    std::sqrt(square)));
}

}  // namespace beamid::experiments
