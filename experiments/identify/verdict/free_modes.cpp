// Whether a free decay, whose modes a model determines by few parameters, has these modes.
//
// K modes with poles and shapes of their own make 2 K + 2 p K numbers of a record of p channels; a model
// makes 2 K of its start and q of its unknowns. Both are fitted to one record, so that of an exact model the
// free modes gain by chance alone:
//
//     chi^2 = sum_i (|r_i|^2 - |e_i|^2) / s_i^2,    of 2 p K - q degrees of freedom,
//
// r_i the residual of the model in channel i, e_i that of the free modes, s_i^2 the variance of white noise
// as dense as e_i is near the modes. Means are left out: an offset is no mode.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/engine/run_bound.hpp"
#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double hz_of(Complex rate) {
  return std::abs(rate) / (2.0 * std::numbers::pi);
}
double ratio_of(Complex rate) {
  return -rate.real() / std::abs(rate);
}

/// Of the record, by the method of `modal`; absent where it is too short for it.
std::optional<RecordModes> modes_of_record(const Record& even) {
  try {
    return find_modes("", even, true, {});
  } catch (const std::exception&) {
    return {};
  }
}

/// The record's own poles next to those of the model, each once: a fit that starts more than a cycle off ends
/// elsewhere.
std::vector<Complex> poles_of_record(const std::vector<ModeEstimate>& modes, std::vector<Complex> rates) {
  constexpr double near = 0.2;  // of a frequency
  std::vector<bool> taken(modes.size(), false);
  for (Complex& rate : rates) {
    std::size_t nearest = taken.size();
    double least = near;
    for (std::size_t m = 0; m < taken.size(); ++m)
      if (const double apart = std::abs(modes[m].pole.frequency_hz() / hz_of(rate) - 1.0);
          !taken[m] && apart < least)
        least = apart, nearest = m;
    if (nearest == taken.size()) continue;
    taken[nearest] = true;
    rate = modes[nearest].pole.rate;
  }
  return rates;
}

/// Frequency or damping ratio that differs most from the model's, or the channel whose amplitude does.
std::string largest_difference(const JointDecayFit& fit, const std::vector<Complex>& model,
                               const MatrixXd& outputs, double interval,
                               const std::vector<std::string>& channels) {
  constexpr double surely = 5.0;
  std::string text;
  double farthest = surely;
  for (std::size_t m = 0; m < model.size(); ++m) {
    const auto at = static_cast<Index>(2 * m);
    const double w = fit.rates[m].imag(),
                 off = std::abs(model[m].imag() - w) / std::sqrt(fit.covariance(at, at)),
                 damping_off = std::abs(model[m].real() - fit.rates[m].real()) /
                               std::sqrt(fit.covariance(at + 1, at + 1));
    if (std::max(off, damping_off) <= farthest) continue;
    farthest = std::max(off, damping_off);
    text = off >= damping_off
               ? fmt::format("mode {} has {:.6g} +- {:.2g} Hz, and {:.6g} Hz in the model", m + 1,
                             hz_of(fit.rates[m]),
                             std::sqrt(fit.covariance(at, at)) / (2.0 * std::numbers::pi), hz_of(model[m]))
               : fmt::format(
                     "mode {}, at {:.4g} Hz, has a damping ratio of {:.3g} +- {:.2g} %, and {:.3g} % in the "
                     "model",
                     m + 1, hz_of(fit.rates[m]), 100.0 * ratio_of(fit.rates[m]),
                     100.0 * std::sqrt(fit.covariance(at + 1, at + 1)) / std::abs(fit.rates[m]),
                     100.0 * ratio_of(model[m]));
  }
  if (!text.empty()) return text;
  std::vector<Complex> rates = model;
  rates.emplace_back(0.0);
  std::vector<bool> oscillating(rates.size(), true);
  oscillating.back() = false;
  const ShapeFit made = fit_shapes(outputs, interval, rates, oscillating);
  double largest = 0.0;
  for (Index i = 0; i < outputs.rows(); ++i)
    for (Index m = 0; m < fit.shapes.cols(); ++m) {
      const double size = std::abs(fit.shapes(i, m)), expected = std::abs(made.shapes(i, m)),
                   apart =
                       std::abs(fit.shapes(i, m) - made.shapes(i, m)) / fit.residual_standard_deviation[i];
      if (apart <= largest || !(expected > 0.0)) continue;
      largest = apart;
      text = fmt::format("{} moves {:.4g} times as much in mode {}, at {:.4g} Hz, as the model does",
                         channels[static_cast<std::size_t>(i)], size / expected, m + 1,
                         hz_of(fit.rates[static_cast<std::size_t>(m)]));
    }
  return text;
}

/// What the modes of a model that are not strong make of its motion. Free modes in their place would be lost
/// in the noise, and without any the free modes would explain less than the model does.
MatrixXd motion_of_weak_modes(const MatrixXd& outputs, double interval, const std::vector<Complex>& strong,
                              std::vector<Complex> rates) {
  MatrixXd motion = MatrixXd::Zero(outputs.rows(), outputs.cols());
  if (rates.size() == strong.size() ||
      static_cast<Index>(2 * rates.size()) * outputs.cols() > most_sensitivities)
    return motion;
  rates.emplace_back(0.0);
  std::vector<bool> oscillating(rates.size(), true);
  oscillating.back() = false;
  const Eigen::MatrixXcd shapes = fit_shapes(outputs, interval, rates, oscillating).shapes;
  for (Index m = 0; m + 1 < shapes.cols(); ++m) {
    const Complex rate = rates[static_cast<std::size_t>(m)];
    if (std::ranges::find(strong, rate) != strong.end()) continue;
    motion += (shapes.col(m) * decaying_wave(rate, interval, outputs.cols()).transpose()).real();
  }
  return motion;
}

MatrixXd without_means(const MatrixXd& signals) {
  return signals.colwise() - signals.rowwise().mean();
}

FreeModes beside_model(const JointDecayFit& fit, const MatrixXd& record, const MatrixXd& outputs,
                       Index unknowns) {
  const Index p = record.rows(), modes = fit.shapes.cols();
  const MatrixXd of_model = without_means(record - outputs),
                 of_free = without_means(record - fit.reconstruction), moved = without_means(record);
  FreeModes found;
  found.freedom = static_cast<double>(std::max<Index>(2, 2 * p * modes - unknowns));
  const double by_chance = found.freedom / static_cast<double>(p);
  double gained = 0.0, left = 0.0;
  for (Index i = 0; i < p; ++i) {
    const double all = std::max(moved.row(i).squaredNorm(), 1e-300),
                 gain = of_model.row(i).squaredNorm() - of_free.row(i).squaredNorm();
    const double variance = std::max(fit.noise_variance.row(i).maxCoeff(), 1e-24 * all);
    found.chi_square += gain / variance;
    gained += (gain - by_chance * variance) / all;
    left += of_free.row(i).squaredNorm() / all;
  }
  found.share = std::sqrt(std::max(gained, 0.0) / static_cast<double>(p));
  found.left = std::sqrt(left / static_cast<double>(p));
  return found;
}

}  // namespace

bool FreeModes::exclude() const {
  constexpr double size = 1e-4, slight = 1e-3;
  return freedom > 0.0 && chi_square > chi_square_limit(freedom, 1.0 - size) && share > slight;
}

double FreeModes::widening() const {
  return exclude() && std::isfinite(chi_square) ? std::sqrt(chi_square) : 1.0;
}

namespace {

/// Where the modes of the model lie elsewhere, and those of the record explain most of what the model does
/// not.
std::optional<FreeModes> elsewhere(const RecordModes& own, const MatrixXd& record, const MatrixXd& outputs) {
  constexpr double much = 0.1, most = 0.3;
  const MatrixXd left = without_means(record - outputs), moved = without_means(record);
  const double share = left.norm() / moved.norm();
  if (own.modes.empty() || !(share > much) || !(own.left() < most * share)) return {};
  std::string list;
  for (const ModeEstimate& mode : own.modes)
    list += fmt::format("{}{:.4g}", list.empty() ? "" : ", ", mode.pole.frequency_hz());
  return FreeModes{std::numeric_limits<double>::infinity(), 1.0, share, own.left(),
                   "they are at " + list + " Hz"};
}

}  // namespace

void look_at_free_modes(const RunContext& context, const MatrixXd& outputs, const VectorXd& start,
                        ComparedRun& run) {
  constexpr double same = 0.2, same_clock = 0.02;    // of a frequency
  constexpr double highest = 0.8;                    // of half the sampling rate
  constexpr double strong = 0.02, traceable = 1e-6;  // of the strongest mode that the sensors see
  const Record& even = context.analysis.even.record;
  const std::vector<Index> channels = output_channels(even);
  if (context.analysis.forced()) return;
  std::vector<Complex> model = seen_rates(*run.model, start, strong);
  // A fit of modes near half the sampling rate takes up what lies beyond it.
  std::erase_if(model,
                [&](Complex rate) { return std::abs(rate) * even.interval() > highest * std::numbers::pi; });
  const auto numbers = static_cast<Index>(channels.size() * model.size()) * 2 * even.size();
  if (model.empty() || numbers > most_sensitivities || outputs.cols() != even.size()) return;
  const bool is_oscillator = context.experiment.model.name == "sdof";  // which has its own verdict
  if (is_oscillator && channels.size() < 2) return;
  const MatrixXd weak = motion_of_weak_modes(outputs, even.interval(), model,
                                             seen_rates(*run.model, start, traceable)),
                 record = even.samples(channels, Eigen::all) - weak, of_strong = outputs - weak;
  const std::optional<RecordModes> own = is_oscillator ? std::nullopt : modes_of_record(even);
  double farthest = 0.0;
  try {
    const JointDecayFit fit =
        fit_decays_jointly(record, even.interval(), own ? poles_of_record(own->modes, model) : model);
    for (std::size_t m = 0; m < model.size(); ++m)
      farthest = std::max(farthest, std::abs(fit.rates[m].imag() / model[m].imag() - 1.0));
    // A fit that lacks a mode which the model has bends the frequencies of its channels.
    const bool lacks_none = without_means(record - fit.reconstruction).squaredNorm() <
                            1.1 * without_means(record - of_strong).squaredNorm();
    if (channels.size() > 1 && farthest < same_clock && lacks_none) run.clock_scatter = clock_scatter(fit);
    if (run.clock_scatter || is_oscillator) return;
    if (farthest < same) {
      std::vector<std::string> names;
      for (const Index i : channels) names.push_back(even.channels[static_cast<std::size_t>(i)].name);
      run.free_modes = beside_model(fit, record, of_strong, static_cast<Index>(run.unknowns.size()));
      if (run.free_modes->exclude())
        run.free_modes->difference = largest_difference(fit, model, of_strong, even.interval(), names);
    }
  } catch (const std::exception&) {  // decays too short or too few samples for so many modes
  }
  if (!run.free_modes && own) run.free_modes = elsewhere(*own, record, of_strong);
}

void judge_free_modes(ComparedRun& run) {
  constexpr double much = 0.01;
  if (!run.free_modes || !run.free_modes->exclude()) return;
  const FreeModes& free = *run.free_modes;
  const double widened = free.widening();
  for (std::size_t j = 0; j < run.parameters.size(); ++j) widen(run, j, widened);
  const bool contradicts = free.share > much;
  const std::string reason = fmt::format(
      "no parameters of this model make the modes of the record: modes with poles and shapes of their own "
      "have a "
      "residual of {:.2g} %, and explain {:.2g} % of the motion that the model does not{}{}",
      100.0 * free.left, 100.0 * free.share, free.difference.empty() ? "" : "; ", free.difference);
  const Objection objection{
      "free_modes",
      (contradicts ? "CONTRADICTED: " : "APPROXIMATE: ") + reason +
          ". A length, a mass, a support, a place, a gain or the damping of a mode is not as described." +
          (widened > 1.0
               ? fmt::format(" Intervals are widened by {:.3g}, as if all of it were one parameter's{}.",
                             widened, contradicts ? ", and may not hold the truth" : "")
               : ""),
      free.share, much};
  if (contradicts)
    run.contradict(reason, objection);
  else
    run.object(objection);
}

// What in the decay itself speaks against one frequency and damping ratio of it (engine/analysis.hpp).

namespace {

DecayObjection jump_objection(const DecayJump& jump, double from) {
  constexpr double much = 0.05;
  const MotionJump* const motion = jump.motion();
  const bool contradicts =
      !motion || std::abs(motion->amplitude_ratio - 1) > much || std::abs(motion->phase) > much;
  return {
      {"jump",
       fmt::format("{}{} A decay across it has neither this frequency nor this damping ratio within their "
                   "intervals. Expected a --window on one side of it.",
                   contradicts ? "CONTRADICTED: " : "", jump.sentence(from))},
      contradicts};
}

DecayObjection pair_objection(const ClosePair& pair, double frequency_hz) {
  const bool contradicts = pair.contradicts_one();
  return {
      {pair.objection(),
       (contradicts ? "CONTRADICTED: " : "") + pair.sentence(frequency_hz) +
           (pair.wins ? " One mode has neither of their damping ratios. Expected a model of both; `beamid "
                        "modal` lists them."
                      : " Intervals are those of one mode. A longer record or more channels may decide: "
                        "`beamid modal`."),
       pair.over_drift, clearly_two},
      contradicts};
}

/// Absent where the sections of a decay differ by less than amplitude_trend() requires, or by less than half
/// of the half-power width. It contradicts where
/// the frequency moves by more than the half-power width 2 xi f, which a fit of one mode takes for damping,
/// and the damping ratio as identified is that of no part of the decay.
std::optional<DecayObjection> amplitude_objection(const RecordAnalysis& analysis, const FoundMode& mode) {
  constexpr double alike = 1.25, clear = 0.1, surely = 1e-6, least_change = 0.002;
  constexpr double slight = 0.45;  // half-power widths: intervals hold it, and real beams do as much
  std::vector<AmplitudePoint> points;
  for (const DecaySection& one : analysis.sections.sections)
    points.push_back({0.5 * (one.from + one.to), one.amplitude, one.frequency_hz, one.frequency_deviation_hz,
                      one.damping_ratio, one.damping_ratio_deviation});
  auto trend = amplitude_trend(points);
  const SectionTrend& by_law = analysis.sections.frequency;
  if (!trend && by_law.varies() && by_law.probability < surely) {  // the last sections may be poor
    const double first = by_law.values[0], last = by_law.values.tail(1)[0];
    if (std::abs(last / first - 1.0) > least_change)
      trend = AmplitudeTrend{points.front(), points.back(), true};
    if (trend) trend->first.frequency_hz = first, trend->last.frequency_hz = last;
  }
  if (!trend || !trend->frequency) return {};
  const auto is_poor = [](const AmplitudePoint& one) {
    return !(one.damping_ratio_deviation < clear * std::abs(one.damping_ratio));
  };
  if (!std::ranges::all_of(points, is_poor)) std::erase_if(points, is_poor);
  const auto [least, most] = std::ranges::minmax(points, {}, &AmplitudePoint::damping_ratio);
  const double middle = 0.5 * (least.damping_ratio + most.damping_ratio),
               widths = std::abs(trend->last.frequency_hz / trend->first.frequency_hz - 1.0) /
                        (2.0 * std::max(middle, 1e-9)),
               ratio = mode.damping_ratio;
  if (!(widths > slight)) return {};
  const bool contradicts =
      widths > 1.0 && !(ratio < alike * most.damping_ratio && alike * ratio > least.damping_ratio);
  const Channel& channel =
      analysis.record.channels[static_cast<std::size_t>(output_channels(analysis.record)[0])];
  return DecayObjection{
      {"amplitude_dependent",
       fmt::format(
           "{}The frequency follows the amplitude: {} while it falls from {:.3g} to {:.3g} {}, {:.2g} times "
           "the half-power width. {} A second mode that dies out earlier can look the same. Expected a later "
           "--window, or a model of such a spring: [model] name = \"duffing\"; `beamid backbone` shows how "
           "it "
           "depends.",
           contradicts ? "CONTRADICTED: " : "", trend->changes(), trend->first.amplitude,
           trend->last.amplitude, si_unit(channel.quantity), widths,
           contradicts
               ? fmt::format("A model of one frequency takes that for damping: its ratio, {:.3g} %, is "
                             "that of no part of the decay, {:.3g} to {:.3g} %.",
                             100.0 * ratio, 100.0 * least.damping_ratio, 100.0 * most.damping_ratio)
               : std::string("One frequency and damping ratio do not describe it, and intervals hold "
                             "those along the decay.")),
       widths, 1.0},
      contradicts};
}

}  // namespace

std::vector<DecayObjection> decay_objections(const RecordAnalysis& analysis, const FoundMode& mode,
                                             bool alone) {
  std::vector<DecayObjection> objections;
  if (auto amplitude = amplitude_objection(analysis, mode)) objections.push_back(std::move(*amplitude));
  if (analysis.jump) objections.push_back(jump_objection(*analysis.jump, analysis.even.record.time[0]));
  if (const auto& overtone = analysis.overtone; overtone && !analysis.sections.frequency.varies()) {
    constexpr double twice = 2;
    const double half = quantile_95 * mode.damping_ratio_deviation,
                 error = overtone->damping_error() * std::abs(mode.damping_ratio);
    if (std::abs(error) > half)
      objections.push_back(
          {{"overtone",
            fmt::format("{} The damping ratio is wrong by about {:.2g} % through it, more than its interval. "
                        "Expected a later --window, or a sensor of larger range.",
                        overtone->words(), 100 * std::abs(overtone->damping_error())),
            std::abs(error), half},
           std::abs(error) > twice * half});
  }
  if (analysis.pair && alone && analysis.pair->speaks_against_one())
    objections.push_back(pair_objection(*analysis.pair, mode.frequency_hz));
  if (analysis.walk && analysis.walk->is_sure())
    objections.push_back({{"phase_wander", analysis.walk->sentence()}, false});
  return objections;
}

}  // namespace beamid::experiments
