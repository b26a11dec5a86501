#include "experiments/studies/efficiency/report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "experiments/models/estimates.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/progress.hpp"
#include "filters/filter_run.hpp"
#include "filters/fisher_information.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

void check_lengthening_passes(const LengtheningSettings& settings) {
  const auto require = [](bool good, const std::string& what) {
    if (!good) throw std::invalid_argument("lengthening passes: " + what);
  };
  require(settings.first_samples >= 1,
          "first_samples is " + std::to_string(settings.first_samples) + "; expected at least 1");
  require(settings.passes >= 1 && settings.last_passes >= 1,
          "passes are " + std::to_string(settings.passes) + " and " + std::to_string(settings.last_passes) +
              "; expected at least 1");
  require(settings.widening > 1.0,
          "widening is " + std::to_string(settings.widening) + "; expected a number above 1");
}

filters::Measurements first_samples(const filters::Measurements& record, Index samples) {
  filters::Measurements part = record;
  part.time = record.time.head(samples);
  part.outputs = record.outputs.leftCols(samples);
  if (record.inputs.size() > 0) part.inputs = record.inputs.leftCols(samples);
  if (record.output_deviations.size() > 0)
    part.output_deviations = record.output_deviations.leftCols(samples);
  return part;
}

// The motion as unknown as at first; the constants where the last pass left them.
filters::Gaussian next(const filters::Gaussian& initial, const filters::Gaussian& last,
                       const std::vector<Index>& constants, double widening) {
  filters::Gaussian start = initial;
  const Eigen::VectorXd first = initial.deviations(), told = last.deviations();
  for (const Index c : constants) {
    start.mean[c] = last.mean[c];
    const double share = std::min(1.0, widening * told[c] / first[c]);
    start.covariance.row(c) *= share;
    start.covariance.col(c) *= share;
  }
  return start;
}

}  // namespace

std::optional<filters::Gaussian> lengthening_passes(filters::Filter& filter, const filters::Gaussian& initial,
                                                    const filters::Measurements& record,
                                                    const std::vector<Index>& constants,
                                                    const LengtheningSettings& settings) {
  check_lengthening_passes(settings);
  filters::Gaussian start = initial;
  for (Index samples = std::min(settings.first_samples, record.size());;
       samples = std::min(2 * samples, record.size())) {
    const bool whole = samples == record.size();
    const filters::Measurements part = first_samples(record, samples);
    for (int pass = 1; pass <= (whole ? settings.last_passes : settings.passes); ++pass) {
      filters::FilterRun run = filters::run(filter, start, part);
      if (run.failure) return std::nullopt;
      start = next(initial, run.last, constants, settings.widening);
      if (whole && pass == settings.last_passes) return run.last;
    }
  }
}

namespace {

constexpr std::uint64_t noise_stream = 0, guess_stream = 1;

void check_free_decays(const DecaySettings& settings) {
  if (!(settings.damping_ratio > 0.0 && settings.damping_ratio < 1.0))
    throw std::invalid_argument("damping ratio: " + std::to_string(settings.damping_ratio) +
                                "; expected a number between 0 and 1");
  require_positive(settings.mass, "mass");
  require_positive(settings.frequency_hz, "frequency");
  require_positive(settings.amplitude, "amplitude");
  require_positive(settings.noise, "noise");
  require_positive(settings.samples_per_cycle, "samples per cycle");
  require_positive(settings.cycles, "cycles");
  require_positive(settings.time_constants, "time constants");
}

double cycles_seen(const DecaySettings& settings) {
  return std::min(settings.cycles,
                  settings.time_constants / (2.0 * std::numbers::pi * settings.damping_ratio));
}

}  // namespace

FreeDecays::FreeDecays(const DecaySettings& settings) : settings_(settings) {
  check_free_decays(settings);
  truth_ = Oscillator::from_frequency(settings.mass, 2.0 * std::numbers::pi * settings.frequency_hz,
                                      settings.damping_ratio);
  interval_ = 1.0 / (settings.frequency_hz * settings.samples_per_cycle);
  const double samples = std::round(cycles_seen(settings) * settings.samples_per_cycle);
  if (!(samples >= 16.0 && samples <= 1e7))
    throw std::invalid_argument("the record would have " + std::to_string(samples) +
                                " samples; expected 16 to 10000000");
  samples_ = static_cast<Index>(samples);
  motion_ = model_registry()
                .make("sdof", {}, at_one_point(one_coordinate(truth_), {Quantity::displacement}))
                ->motion;
  const std::complex<double> lambda = truth_.eigenvalue(), a = std::polar(settings.amplitude, settings.phase);
  decay_ = VectorXd::NullaryExpr(samples_, [&](Index k) {
    return (a * std::exp(lambda * (interval_ * static_cast<double>(k)))).real();
  });
  const Eigen::Vector4d start(a.real(), (a * lambda).real(), truth_.stiffness, truth_.damping);
  bound_ = filters::cramer_rao_bound(filters::fisher_information(*model(), start, samples_)).tail<2>();
}

std::unique_ptr<filters::DiscreteModel> FreeDecays::model() const {
  const double deviation = settings_.noise * settings_.amplitude;
  return filters::discretise(motion_, interval_, "exponential",
                             {{}, MatrixXd::Constant(1, 1, deviation * deviation)});
}

Eigen::Vector2d FreeDecays::guess_factors(std::uint64_t seed) const {
  if (settings_.guess == Guess::ends) return {seed & 1 ? 0.5 : 2.0, seed & 2 ? 0.5 : 2.0};
  // a normal number's own probability is uniform
  const VectorXd normal = standard_normal(2, seed, guess_stream);
  const auto factor = [](double z) { return std::exp2(std::erf(z / std::numbers::sqrt2)); };
  return {factor(normal[0]), factor(normal[1])};
}

filters::Trial FreeDecays::trial(std::uint64_t seed) const {
  filters::Trial trial;
  trial.truth = Eigen::Vector2d(truth_.stiffness, truth_.damping);
  trial.record.time = VectorXd::LinSpaced(samples_, 0.0, static_cast<double>(samples_ - 1)) * interval_;
  trial.record.outputs =
      (decay_ + settings_.noise * settings_.amplitude * standard_normal(samples_, seed, noise_stream))
          .transpose();
  const double largest = trial.record.outputs.cwiseAbs().maxCoeff();
  const Eigen::Vector2d guess = guess_factors(seed).cwiseProduct(trial.truth);
  trial.initial.mean = Eigen::Vector4d(0.0, 0.0, guess[0], guess[1]);
  const Eigen::Vector4d deviations(2.0 * largest, 2.0 * largest * std::sqrt(guess[0] / truth_.mass),
                                   0.75 * guess[0], guess[1]);
  trial.initial.covariance = deviations.cwiseAbs2().asDiagonal();
  return trial;
}

namespace {

const std::vector<Index> constants{2, 3};  // K and C in [x, v, K, C]

bool has(const Choice& filter, const char* contract) {
  return filters::filter_registry().find(filter.name).contracts.contains(contract);
}

int runs_with(const EfficiencySettings& settings, const Choice& filter) {
  return has(filter, filters::contract::sampled_on_linear_gaussian) ? settings.sampled_runs : settings.runs;
}

std::size_t all_runs(const EfficiencySettings& settings) {
  std::size_t runs = 0;
  for (const Choice& filter : settings.filters) runs += static_cast<std::size_t>(runs_with(settings, filter));
  return runs * settings.damping_ratios.size() * settings.passes.size();
}

std::optional<filters::Gaussian> estimate(const Choice& choice, Passes passes, const FreeDecays& decays,
                                          std::uint64_t seed) {
  const filters::Trial trial = decays.trial(seed);
  const auto filter = filters::filter_registry().make(choice.name, choice.options, decays.model());
  std::optional<filters::Gaussian> last;
  if (passes == Passes::lengthening) {
    LengtheningSettings settings;
    settings.first_samples = static_cast<Index>(std::lround(decays.settings().samples_per_cycle));
    last = lengthening_passes(*filter, trial.initial, trial.record, constants, settings);
  } else if (filters::FilterRun run = filters::run(*filter, trial.initial, trial.record); !run.failure) {
    last = run.last;
  }
  if (!last) return std::nullopt;
  return filters::Gaussian{last->mean.segment<2>(2), last->marginal(2, 2)};
}

EfficiencyCase measure(const EfficiencySettings& settings, const Choice& filter, Passes passes,
                       const FreeDecays& decays, Countdown& countdown) {
  const Oscillator& truth = decays.truth();
  const Eigen::Vector2d constant(truth.stiffness, truth.damping);
  EfficiencyCase one{filter, passes, decays.settings().damping_ratio, truth, decays.bound(), {}, {}};
  one.largest = (10.0 * decays.bound()).cwiseMax(Eigen::Vector2d(0.05, 0.5).cwiseProduct(constant));
  const int runs = runs_with(settings, filter);
  std::vector<std::optional<filters::Gaussian>> found(static_cast<std::size_t>(runs));
  tbb::parallel_for(0, runs, [&](int run) {
    found[static_cast<std::size_t>(run)] =
        estimate(filter, passes, decays, settings.seed + static_cast<std::uint64_t>(run));
    countdown.count();
  });
  // what the runs found, told in their order
  std::size_t next = 0;
  one.result = filters::monte_carlo(
      [&](std::uint64_t) {
        return filters::Trial{{}, {}, constant};
      },
      [&](const filters::Trial&) { return found[next++]; }, {runs, settings.seed, one.bound, one.largest});
  return one;
}

void check_efficiency(const EfficiencySettings& settings) {
  if (settings.filters.empty() || settings.damping_ratios.empty() || settings.passes.empty())
    throw std::invalid_argument("efficiency: found no filter, no damping ratio or no way to pass");
  if (settings.runs < 2 || settings.sampled_runs < 2)
    throw std::invalid_argument(
        fmt::format("efficiency: {} and {} runs; expected at least 2", settings.runs, settings.sampled_runs));
  for (const Choice& filter : settings.filters)
    if (has(filter, filters::contract::linear_models_only))
      throw std::invalid_argument(fmt::format(
          "filter '{}' takes linear models only; the oscillator with unknown K and C is none", filter.name));
}

}  // namespace

const char* to_string(Passes passes) {
  return passes == Passes::lengthening ? "lengthening" : "single";
}

std::vector<Choice> applicable_filters() {
  std::vector<Choice> choices;
  for (const auto& [name, entry] : filters::filter_registry().entries())
    if (!entry.contracts.contains(filters::contract::linear_models_only))
      choices.push_back({name, filters::filter_registry().completed(name, {}), {}});
  return choices;
}

Efficiency find_efficiency(const EfficiencySettings& settings, const Progress& progress) {
  check_efficiency(settings);
  Efficiency all{settings, {}};
  Countdown countdown(progress, all_runs(settings), "runs");
  for (const double damping_ratio : settings.damping_ratios) {
    DecaySettings decay = settings.decay;
    decay.damping_ratio = damping_ratio;
    const FreeDecays decays(decay);
    for (const Passes passes : settings.passes)
      for (const Choice& filter : settings.filters) {
        countdown.begin(fmt::format("{}, {} passes, damping ratio {:g} %", filter.name, to_string(passes),
                                    100.0 * damping_ratio));
        all.cases.push_back(measure(settings, filter, passes, decays, countdown));
      }
  }
  return all;
}

namespace {

std::string label_of(const Choice& filter) {
  return choice_text(filter, filters::filter_registry().find(filter.name).options);
}

// One constant after one way to pass: a point with its 95 % interval per filter and damping ratio.
Panel panel(const Efficiency& all, Passes passes, Index constant) {
  const EfficiencySettings& settings = all.settings;
  Panel panel{fmt::format("{}, passes: {}", constant == 0 ? "stiffness K" : "damping C", to_string(passes)),
              {"damping ratio [%]", true},
              {"rms error / Cramér-Rao bound", true},
              {}};
  const auto [least, most] =
      std::minmax_element(settings.damping_ratios.begin(), settings.damping_ratios.end());
  const Eigen::Vector2d ends(50.0 * *least, 200.0 * *most);
  panel.curves.push_back({"0.95 to 1.05", ends, Eigen::Vector2d::Ones(), CurveStyle::band,
                          Eigen::Vector2d::Constant(0.95), Eigen::Vector2d::Constant(1.05), Colour::grey});
  const auto count = static_cast<double>(settings.filters.size());
  for (std::size_t f = 0; f < settings.filters.size(); ++f) {
    std::vector<const EfficiencyCase*> shown;
    for (std::size_t i = f; i < all.cases.size(); i += settings.filters.size())
      if (all.cases[i].passes == passes && all.cases[i].result.rms_over_bound.size() > 0)
        shown.push_back(&all.cases[i]);
    VectorXd x(shown.size()), y(shown.size()), half(shown.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const auto k = static_cast<Index>(i);
      const double aside = (static_cast<double>(f) + 0.5) / count - 0.5;  // side by side
      x[k] = 100.0 * shown[i]->damping_ratio * std::exp2(1.2 * aside);
      y[k] = shown[i]->result.rms_over_bound[constant];
      half[k] = std::min(quantile_95 * shown[i]->result.relative_rms_deviation, 0.95) * y[k];
    }
    if (shown.empty()) continue;
    panel.curves.push_back({label_of(settings.filters[f]), x, y,
                            f % 2 == 0 ? CurveStyle::points : CurveStyle::open_points, y - half, y + half});
  }
  return panel;
}

nlohmann::ordered_json interval(const filters::Proportion& share) {
  return {{"count", share.count},
          {"runs", share.runs},
          {"lower_95", share.lower_95},
          {"upper_95", share.upper_95}};
}

nlohmann::ordered_json efficiency_values_of(const EfficiencyCase& one) {
  const filters::MonteCarloResult& result = one.result;
  nlohmann::ordered_json json{{"filter", label_of(one.filter)},     {"passes", to_string(one.passes)},
                              {"damping_ratio", one.damping_ratio}, {"runs", result.runs},
                              {"lost", interval(result.diverged)},  {"lost_seeds", result.diverged_seeds}};
  const char *names[] = {"stiffness", "damping"}, *units[] = {"_n_per_m", "_n_s_per_m"};
  for (Index i = 0; i < 2; ++i) {
    nlohmann::ordered_json& constant = json[names[i]];
    const auto with_unit = [&](const char* name) { return std::string(name) + units[i]; };
    constant[with_unit("truth")] = i == 0 ? one.truth.stiffness : one.truth.damping;
    constant[with_unit("bound")] = one.bound[i];
    constant[with_unit("lost_beyond")] = one.largest[i];
    if (result.coverage.empty()) continue;
    constant[with_unit("bias")] = result.bias[i];
    constant[with_unit("bias_standard_error")] = result.bias_deviation[i];
    constant[with_unit("rms")] = result.rms[i];
    constant["rms_over_bound"] = result.rms_over_bound[i];
    constant["rms_over_deviation"] = result.rms_over_deviation[i];
    constant["coverage"] = interval(result.coverage[static_cast<std::size_t>(i)]);
  }
  if (result.coverage.empty()) return json;
  json["rms_relative_standard_error"] = result.relative_rms_deviation;
  json["nees"] = {{"mean", result.nees},
                  {"lower_999", result.nees_lower_999},
                  {"upper_999", result.nees_upper_999},
                  {"consistent", result.consistent()}};
  return json;
}

nlohmann::ordered_json efficiency_configuration(const EfficiencySettings& settings) {
  const DecaySettings& decay = settings.decay;
  nlohmann::ordered_json json;
  for (const Choice& filter : settings.filters) json["filters"].push_back(label_of(filter));
  json["damping_ratios"] = settings.damping_ratios;
  for (const Passes passes : settings.passes) json["passes"].push_back(to_string(passes));
  json["guess"] = decay.guess == Guess::drawn ? "drawn" : "ends";
  json["runs"] = settings.runs;
  json["sampled_runs"] = settings.sampled_runs;
  json["mass_kg"] = decay.mass;
  json["frequency_hz"] = decay.frequency_hz;
  json["amplitude_m"] = decay.amplitude;
  json["phase_rad"] = decay.phase;
  json["noise_over_amplitude"] = decay.noise;
  json["samples_per_cycle"] = decay.samples_per_cycle;
  json["cycles"] = decay.cycles;
  json["time_constants"] = decay.time_constants;
  return json;
}

}  // namespace

Figure efficiency_figure(const Efficiency& all) {
  Figure figure{"efficiency_plot", {}, static_cast<int>(all.settings.passes.size()), 2, 1100};
  for (const Passes passes : all.settings.passes)
    for (const Index constant : {0, 1}) figure.panels.push_back(panel(all, passes, constant));
  return figure;
}

Results report(const Efficiency& all) {
  const DecaySettings& decay = all.settings.decay;
  Results results;
  results.command = "efficiency";
  results.seed = all.settings.seed;
  results.configuration = efficiency_configuration(all.settings);
  results.values["cases"] = nlohmann::ordered_json::array();
  for (const EfficiencyCase& one : all.cases) results.values["cases"].push_back(efficiency_values_of(one));
  results.heading("Filters against the Cramer-Rao bound");
  results.paragraph(fmt::format(
      "Free decays of an oscillator of {:g} Hz, displacement read {:g} times a cycle over {:g} cycles or "
      "{:g} time constants with white noise of {:g} % of the amplitude. Initial state unknown; K and C "
      "guessed at {} half {} twice the truth.",
      decay.frequency_hz, decay.samples_per_cycle, decay.cycles, decay.time_constants, 100.0 * decay.noise,
      decay.guess == Guess::drawn ? "between" : "either", decay.guess == Guess::drawn ? "and" : "or"));
  results.table(efficiency_table(all));
  results.table(consistency_table(all));
  results.figures = {efficiency_figure(all)};
  return results;
}

}  // namespace beamid::experiments
