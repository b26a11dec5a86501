// Higher modes as noise: of the five beams, or of a user's own.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/noise/noise_study.hpp"
#include "experiments/studies/paper/monte_carlo.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/text/choice.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

// Higher modes as noise: the report.

using Json = nlohmann::ordered_json;
using Value = double NoiseStatistics::*;
constexpr auto trials_lost = &NoiseStatistics::failed;

const char* name(Blow blow) {
  return blow == Blow::release ? "release" : "hammer";
}

Table leading(const char* table_name, std::string title) {
  Table table{table_name, std::move(title)};
  table.column({"beam", "beam"}).column({"blow", "blow"}).column({"observed", "observed"});
  return table;
}

std::vector<Cell> leading_cells(const NoiseStudy& study, const NoiseCase& c) {
  return {study.settings.beams[c.beam].name, name(c.blow), to_string(c.observed)};
}

// One value of every treatment.
template <class Member>
Table treatment_table(const NoiseStudy& study, const std::vector<NoiseCase>& cases, const char* table_name,
                      std::string title, Member value, const char* suffix, const char* format) {
  Table table = leading(table_name, std::move(title));
  table.column({"modes", "modes", "{:.0f}"});
  for (const Treatment treatment : treatments)
    table.column({to_string(treatment), fmt::format("{}_{}", to_string(treatment), suffix), format});
  for (const NoiseCase& c : cases) {
    std::vector<Cell> row = leading_cells(study, c);
    row.emplace_back(static_cast<double>(c.modes));
    for (const NoiseStatistics& s : c.treatments) row.emplace_back(static_cast<double>(s.*value));
    table.row(std::move(row));
  }
  return table;
}

Table best_table(const NoiseStudy& study) {
  Table table = leading("best_variance", "The best R of white noise, and what it reaches");
  table.column({"higher / first", "higher_modes_over_first", "{:.3g}"})
      .column({"best factor on R", "best_factor", "{:g}"})
      .column({"rms C, R from the residual [%]", "damping_rms_error_percent", "{:.3g}"})
      .column({"rms C, best R [%]", "best_damping_rms_error_percent", "{:.3g}"})
      .column({"error / deviation, best R", "best_damping_error_over_deviation", "{:.3g}"});
  for (const NoiseCase& c : study.cases) {
    std::vector<Cell> row = leading_cells(study, c);
    const NoiseStatistics& best = c.best(study.settings);
    for (const double value : {c.share, c.best_factor, c.by(Treatment::white).damping_rms_percent,
                               best.damping_rms_percent, best.damping_ratio})
      row.emplace_back(value);
    table.row(std::move(row));
  }
  table.note =
      "Factor 1: R is the sensor noise plus the mean square of the higher modes. Higher / first: amplitudes "
      "in what is observed, at the beginning.";
  return table;
}

Figure tip_mass_figure(const NoiseStudy& study, const char* figure_name, Value value, const char* label) {
  Figure figure{figure_name, {}, 2, 3, 1200, 800};
  for (const Blow blow : {Blow::release, Blow::hammer})
    for (const Quantity observed : {Quantity::displacement, Quantity::velocity, Quantity::acceleration}) {
      Panel panel{fmt::format("{}, {}", name(blow), to_string(observed)),
                  {"tip mass [% of the beam]"},
                  {label, true},
                  {}};
      panel.legend = figure.panels.empty() ? Legend::top_right : Legend::none;
      for (const Treatment treatment : treatments) {
        std::vector<double> x, y;
        for (const NoiseCase& c : study.cases)
          if (c.blow == blow && c.observed == observed) {
            x.push_back(study.settings.beams[c.beam].tip_mass_percent);
            y.push_back(c.by(treatment).*value);
          }
        const auto size = static_cast<Eigen::Index>(x.size());
        panel.curves.push_back({to_string(treatment), Eigen::Map<const Eigen::VectorXd>(x.data(), size),
                                Eigen::Map<const Eigen::VectorXd>(y.data(), size)});
      }
      figure.panels.push_back(std::move(panel));
    }
  return figure;
}

// One sentence per sensor: with how many beams taking the modes for noise does no harm.
std::string verdicts(const NoiseStudy& study, Blow blow) {
  std::string text;
  for (const Quantity observed : {Quantity::displacement, Quantity::velocity, Quantity::acceleration}) {
    int all = 0, ignored = 0, white = 0, filtered = 0;
    double worst = 0.0, overconfident = 0.0, worst_filtered = 0.0;
    for (const NoiseCase& c : study.cases) {
      if (c.blow != blow || c.observed != observed) continue;
      ++all;
      ignored += harmless(c.by(Treatment::sensor));
      white += harmless(c.by(Treatment::white));
      filtered += harmless(c.by(Treatment::filtered));
      worst = std::max(worst, c.by(Treatment::white).damping_rms_percent);
      overconfident = std::max(overconfident, c.by(Treatment::sensor).damping_ratio);
      worst_filtered = std::max(worst_filtered, c.by(Treatment::filtered).damping_rms_percent);
    }
    text += fmt::format(
        "- {} observed: harmless on {} of {} beams when R is the sensor's alone (errors up to {:.2g} times "
        "the standard deviation reported), on {} when R takes the modes in as white noise (C up to {:.2g} % "
        "off), on "
        "{} when they are filtered away (up to {:.2g} %).\n",
        to_string(observed), ignored, all, overconfident, white, worst, filtered, worst_filtered);
  }
  return text;
}

Json json_of(const NoiseStatistics& s) {
  return {{"stiffness_mean_error_percent", s.stiffness_mean_percent},
          {"damping_mean_error_percent", s.damping_mean_percent},
          {"stiffness_rms_error_percent", s.stiffness_rms_percent},
          {"damping_rms_error_percent", s.damping_rms_percent},
          {"stiffness_error_over_deviation", s.stiffness_ratio},
          {"damping_error_over_deviation", s.damping_ratio},
          {"normalised_innovation_square", s.normalised_square},
          {"failed", s.failed}};
}

Json json_of(const NoiseStudy& study, const std::vector<NoiseCase>& cases) {
  Json list = Json::array();
  for (const NoiseCase& c : cases) {
    Json json{{"beam", study.settings.beams[c.beam].name},
              {"tip_mass_percent", study.settings.beams[c.beam].tip_mass_percent},
              {"blow", name(c.blow)},
              {"observed", to_string(c.observed)},
              {"modes", c.modes},
              {"higher_modes_over_first", c.share},
              {"best_factor", c.best_factor}};
    for (const Treatment treatment : treatments) json[to_string(treatment)] = json_of(c.by(treatment));
    json["white_best"] = json_of(c.best(study.settings));
    json["white_best"]["harmless"] = harmless(c.best(study.settings));
    for (const Treatment treatment : treatments)
      json[to_string(treatment)]["harmless"] = harmless(c.by(treatment));
    list.push_back(std::move(json));
  }
  return list;
}

Results report(const NoiseStudy& study) {
  const NoiseSettings& s = study.settings;
  Results results;
  results.command = "noise";
  results.seed = s.seed;
  results.configuration = {{"modes", s.modes},          {"trials", s.trials},
                           {"noise_relative", s.noise}, {"deflection_m", s.deflection},
                           {"blow_duration_s", s.blow}, {"interval_s", s.interval},
                           {"duration_s", s.duration},  {"variance_factors", s.factors}};
  results.values["cases"] = json_of(study, study.cases);
  results.values["modes_kept"] = json_of(study, study.kept);
  results.heading("May a filter of one mode take the others for noise?");
  results.paragraph(fmt::format(
      "{} modes of each beam, pulled and released or struck by a half sine of {:g} ms. {:g} s at {:g} Hz, "
      "sensor noise {:g} % of the first mode's amplitude. {} seeded trials that differ in noise and in the "
      "phases of the modes. Harmless: C within 1 % (rms), and not more than three of its standard deviations "
      "off.",
      s.modes, 1e3 * s.blow, s.duration, 1.0 / s.interval, 100.0 * s.noise, s.trials));
  results.paragraph(
      "sensor: R is the sensor's alone. white: R takes in their mean square. coloured: a shaping filter of "
      "known frequency for each. filtered: low-passed and decimated. modelled: stiffness and damping of each "
      "are found too.");
  for (const Blow blow : {Blow::release, Blow::hammer}) {
    results.heading(blow == Blow::release ? "Released" : "Struck by a hammer");
    results.paragraph(verdicts(study, blow));
  }
  results.table(
      treatment_table(study, study.cases, "trials_lost",
                      fmt::format("Trials lost, of {}: K 5 % off or more, C 100 %, or the filter failed; "
                                  "the tables below are of the others",
                                  s.trials),
                      trials_lost, "trials_lost", "{:.0f}"));
  results.table(treatment_table(study, study.cases, "damping_error", "C: rms error [%]",
                                &NoiseStatistics::damping_rms_percent, "damping_rms_error_percent",
                                "{:.3g}"));
  results.table(treatment_table(study, study.cases, "stiffness_error", "K: rms error [%]",
                                &NoiseStatistics::stiffness_rms_percent, "stiffness_rms_error_percent",
                                "{:.3g}"));
  results.table(treatment_table(study, study.cases, "damping_consistency",
                                "C: rms error over the standard deviation reported (1 is honest)",
                                &NoiseStatistics::damping_ratio, "damping_error_over_deviation", "{:.3g}"));
  results.table(treatment_table(
      study, study.cases, "innovations", "Innovations: mean square over their variance (1 is consistent)",
      &NoiseStatistics::normalised_square, "normalised_innovation_square", "{:.3g}"));
  results.table(best_table(study));
  results.table(treatment_table(study, study.kept, "modes_kept", "C: rms error [%] by the number of modes",
                                &NoiseStatistics::damping_rms_percent, "damping_rms_error_percent",
                                "{:.3g}"));
  results.figures = {tip_mass_figure(study, "damping_error_by_tip_mass",
                                     &NoiseStatistics::damping_rms_percent, "rms error of C [%]"),
                     tip_mass_figure(study, "consistency_by_tip_mass", &NoiseStatistics::damping_ratio,
                                     "error of C / deviation")};
  return results;
}

int whole(const filters::Options& options, const char* name, double from, double to) {
  const double value = options.number(name);
  if (!(value >= from && value <= to && value == std::floor(value)))
    throw std::invalid_argument(std::string(name) + " must be a whole number from " +
                                std::to_string(static_cast<int>(from)) + " to " +
                                std::to_string(static_cast<int>(to)));
  return static_cast<int>(value);
}

std::vector<NoiseBeam> five_beams(int modes) {
  std::vector<NoiseBeam> beams;
  for (const paper::TestBeam& test : paper::test_beams) {
    const fem::Cantilever beam = paper::steel_beam(test);
    Eigen::VectorXd ratios = Eigen::VectorXd::Constant(modes, Release().higher_damping_ratio);
    ratios[0] = test.first_damping_ratio;
    beams.push_back({test.name, beam, 100.0 * test.tip_mass / beam.mass(), ratios});
  }
  return beams;
}

/// The file's beam and damping; 0.5 % where it states none.
NoiseBeam described(const std::string& file, int modes) {
  const Experiment experiment = read_experiment(file);
  require_linear_storeys(experiment, "noise");
  const fem::Beam beam = at_place({file}, [&] { return experiment.structure.beam(); });
  const Eigen::VectorXd frequencies =
      fem::modes(fem::assemble(beam, experiment.elements), modes).angular_frequency;
  Eigen::VectorXd ratios = Eigen::VectorXd::Constant(modes, 0.005);
  if (!std::holds_alternative<fem::Undamped>(experiment.damping))
    ratios = fem::damping_ratios(experiment.damping, frequencies);
  return {experiment.title.empty() ? file : experiment.title, beam, 100.0 * beam.tip_mass() / beam.mass(),
          ratios};
}

class HigherModeStudy final : public Study {
 public:
  explicit HigherModeStudy(const filters::Options& options) {
    settings_.modes = whole(options, "modes", 1, 6);
    settings_.trials = whole(options, "trials", 2, 10000);
    const double seed = options.number("seed");
    if (!(seed >= 0.0 && seed == std::floor(seed) && seed < 0x1p53))
      throw std::invalid_argument("seed must be a whole number from 0");
    settings_.seed = static_cast<std::uint64_t>(seed);
    settings_.noise = options.number("noise");
    settings_.blow = options.number("blow");
    settings_.interval = options.number("interval");
    settings_.duration = options.number("duration");
    config_ = options.text("config");
    settings_.beams = config_.empty() ? five_beams(settings_.modes)
                                      : std::vector<NoiseBeam>{described(config_, settings_.modes)};
  }

  Results run(const Progress& progress) const override {
    Results results = report(study_higher_modes(settings_, progress));
    warn_of_file(results, config_);
    return results;
  }

 private:
  NoiseSettings settings_;
  std::string config_;
};

const bool noise_registered = study_registry().add(
    {"noise",
     "whether a filter of one mode may treat the others as noise, and the remedy if not",
     "[inverse2009]",
     {{"modes", 3.0, "", "of the continuum in the records"},
      {"trials", 6.0, "", "seeded, per beam, blow and sensor"},
      {"seed", 2009.0, "", "of noise and phases; the same seed gives the same bytes"},
      {"noise", 0.001, "", "of the sensor, relative to the first mode's amplitude"},
      {"blow", 0.005, "s", "duration of the hammer's half sine"},
      {"interval", 0.004, "s", "between samples"},
      {"duration", 8.0, "s", "of a record"},
      {"config", std::string(), "", "experiment file of another beam; by default the study's five"}},
     {},
     [](const filters::Options& options) { return std::make_unique<HigherModeStudy>(options); }});

}  // namespace

}  // namespace beamid::experiments
