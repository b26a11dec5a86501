#include "experiments/modal/study/decay_polish.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/modal/study/mode_objections.hpp"
#include "experiments/modal/study/phase_wander.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

// Two modes of a free decay where a search over orders shows one.

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

using std::numbers::pi;

/// The record without all modes but m.
MatrixXd without_others(const RecordModes& found, const JointDecayFit& fit, std::size_t m) {
  MatrixXd rest = found.target.colwise() - fit.offsets;
  for (std::size_t other = 0; other < fit.rates.size(); ++other) {
    if (other == m) continue;
    const Eigen::VectorXcd wave = decaying_wave(fit.rates[other], found.interval, rest.cols());
    rest -= (fit.shapes.col(static_cast<Index>(other)) * wave.transpose()).real();
  }
  return rest;
}

/// About eight samples a period: Hankel rows then reach over many periods.
std::vector<std::pair<Complex, Complex>> starts(const RecordModes& found, const JointDecayFit& fit,
                                                std::size_t m) {
  constexpr double samples_per_period = 8.0, near = 0.1;
  std::vector<std::pair<Complex, Complex>> pairs;
  const double w = std::abs(fit.rates[m]),
               duration = found.interval * static_cast<double>(found.target.cols());
  const MatrixXd rest = without_others(found, fit, m);
  const auto stride =
      std::max<Index>(1, static_cast<Index>(2.0 * pi / (w * found.interval * samples_per_period)));
  try {
    const MatrixXd coarse = rest(Eigen::all, Eigen::seq(0, rest.cols() - 1, stride));
    EigensystemSettings settings;
    settings.order = 4;
    settings.rows = std::min<Index>(coarse.cols() / 2, 200);
    std::vector<Complex> close;
    for (const IdentifiedMode& mode :
         eigensystem_realisation(coarse, found.interval * static_cast<double>(stride), settings).modes)
      if (mode.frequency_hz > 0.0 && mode.rate.real() < 0.0 && std::abs(std::abs(mode.rate) - w) < near * w)
        close.push_back(mode.rate);
    if (close.size() == 2) pairs.emplace_back(close[0], close[1]);
  } catch (const std::invalid_argument&) {  // too short
  }
  for (const double cycles : {0.5, 1.0}) {
    const Complex apart(0.0, pi * cycles / duration);
    pairs.emplace_back(fit.rates[m] - apart, fit.rates[m] + apart);
  }
  return pairs;
}

/// Noise around modes a and b over that a few of its lines farther away, the largest of all channels.
double density_near(const JointDecayFit& fit, const RecordModes& found, std::size_t a) {
  constexpr int nearest = 10, first = 25, last = 80;  // lines of the record
  const MatrixXd left = found.target - fit.reconstruction;
  const double line = 2.0 * pi / (found.interval * static_cast<double>(left.cols())), w = fit.rates[a].imag();
  const auto power = [&](Index channel, double omega) {
    Complex sum = 0.0, phase = 1.0;
    const Complex step = std::polar(1.0, -omega * found.interval);
    for (Index k = 0; k < left.cols(); ++k, phase *= step) sum += left(channel, k) * phase;
    return std::norm(sum);
  };
  double largest = 0.0;
  for (Index c = 0; c < left.rows(); ++c) {
    double near = 0.0;
    std::vector<double> far;
    for (int k = -nearest; k <= nearest; ++k) near += power(c, w + k * line) / (2 * nearest + 1);
    for (int k = first; k <= last; ++k)
      for (const double omega : {w - k * line, w + k * line})
        if (omega > line) far.push_back(power(c, omega));
    // Of noise the median power is ln 2 of the mean; overtones and other modes do not move it.
    const double mean = far.empty() ? 0.0 : median(far) / std::numbers::ln2;
    largest = std::max(largest, near / std::max(mean, 1e-300));
  }
  return largest;
}

/// Cycles by which the modes differ over the record.
double cycles_apart(const JointDecayFit& pair, std::size_t a, std::size_t b, const RecordModes& found) {
  return std::abs(pair.rates[a].imag() - pair.rates[b].imag()) / (2.0 * pi) * found.interval *
         static_cast<double>(found.target.cols());
}

/// Two modes that are nearer than this over the record [cycles], and a chi^2 by which they must win.
constexpr double least_apart = 0.25, clearly_two = 25.0;

/// Whether modes a and b may be one mode in channels whose clocks differ: they are too near, or each channel
/// has one of them only.
bool may_be_clocks(const JointDecayFit& pair, Index a, Index b, double cycles) {
  constexpr double weak = 0.05;
  const Eigen::ArrayXd first = pair.shapes.col(a).cwiseAbs(), second = pair.shapes.col(b).cwiseAbs();
  return first.size() > 1 && (cycles < least_apart || (first.min(second) < weak * first.max(second)).all());
}

enum class OneOrTwo { one, undecided, two };

/// Whether the record is that of modes a and b of `pair`, where `single` has one, and by how much one that
/// drifts has the larger squares, in units of the noise.
std::pair<OneOrTwo, double> compete(const RecordModes& found, const JointDecayFit& single,
                                    const JointDecayFit& pair, std::size_t a, std::size_t b) {
  constexpr double by_chance = 1e-5, surely = 1e-6, close = 1.5, clearly_one = -10.0, denser = 2.0,
                   weakest = 0.02;
  const double w = single.rates[a].imag();
  bool surely_damped = true;
  for (const std::size_t m : {a, b}) {
    const Pole pole = fitted_pole(pair, m);
    const double ratio = pole.damping_ratio(), deviation = pole.damping_ratio_deviation;
    if (!(ratio > -2.0 * deviation) || !(std::abs(pair.rates[m].imag() - w) < 0.1 * w))
      return {OneOrTwo::one, 0.0};
    surely_damped = surely_damped && ratio > 2.0 * deviation;
  }
  const auto at_a = static_cast<Index>(a), at_b = static_cast<Index>(b);
  const double size_a = pair.shapes.col(at_a).norm(), size_b = pair.shapes.col(at_b).norm();
  if (std::min(size_a, size_b) < weakest * std::max(size_a, size_b)) return {OneOrTwo::one, 0.0};
  std::vector<Index> channels(static_cast<std::size_t>(found.target.rows()));
  std::iota(channels.begin(), channels.end(), 0);
  const PairAgainstDrift both = pair_against_drift(pair, a, b, found.target, found.interval, channels);
  const VectorXd by_one = (found.target - single.reconstruction).rowwise().squaredNorm();
  const double gained =
      by_one.cwiseQuotient(pair.noise_variance.col(at_a).cwiseMax(1e-300)).sum() - both.left_by_pair;
  const double over_drift = both.left_by_drift - both.left_by_pair;
  const double freedom = 2.0 + 2.0 * static_cast<double>(found.target.rows());
  if (!(gained > chi_square_limit(freedom, 1.0 - by_chance)) || over_drift < clearly_one ||
      density_near(pair, found, a) > denser)
    return {OneOrTwo::one, over_drift};
  const double cycles = cycles_apart(pair, a, b, found);
  if (over_drift > clearly_two && may_be_clocks(pair, at_a, at_b, cycles)) return {OneOrTwo::one, over_drift};
  if (surely_damped && over_drift > clearly_two && gained > chi_square_limit(freedom, 1.0 - surely))
    return {OneOrTwo::two, over_drift};
  return {cycles < close ? OneOrTwo::undecided : OneOrTwo::one, over_drift};
}

/// What explains the record as well as mode m does: two modes in its place, the last of them behind all
/// others.
struct OpenPair {
  std::size_t m = 0;
  JointDecayFit pair;
  double over_drift = 0.0;  ///< chi^2 of the drifting mode over theirs
};

/// Mode m may be the two of the pair: its intervals grow by their distances, each by its share of the larger.
/// What follows the amplitude looks like a second mode of another damping, as the n-th power of an amplitude
/// decays n times as fast, or of nearly the same rate. Only where both are damped alike and a quarter of a
/// cycle apart has the record no result.
void object_to_one(const OpenPair& open, RecordModes& found) {
  constexpr double alike = 1.5;
  ModeEstimate& one = found.modes[open.m];
  const std::size_t last = open.pair.rates.size() - 1;
  Pole low = fitted_pole(open.pair, open.m), high = fitted_pole(open.pair, last);
  if (low.frequency_hz() > high.frequency_hz()) std::swap(low, high);
  const double larger = std::max(low.shape.norm(), high.shape.norm());
  const auto farthest = [&](auto of) {
    return std::max(std::abs(of(low) - of(one.pole)) * low.shape.norm(),
                    std::abs(of(high) - of(one.pole)) * high.shape.norm()) /
           larger;
  };
  one.frequency_spread_hz = farthest([](const Pole& pole) { return pole.frequency_hz(); });
  one.damping_ratio_spread = farthest([](const Pole& pole) { return pole.damping_ratio(); });
  const bool damped_alike = std::max(low.damping_ratio(), high.damping_ratio()) <
                            alike * std::min(low.damping_ratio(), high.damping_ratio());
  const bool undecided = damped_alike && cycles_apart(open.pair, open.m, last, found) > least_apart;
  const std::string two = fmt::format("two of {:.5g} and {:.5g} Hz with {:.3g} and {:.3g} %",
                                      low.frequency_hz(), high.frequency_hz(), 100.0 * low.damping_ratio(),
                                      100.0 * high.damping_ratio()),
                    differs = fmt::format("(chi^2 differs by {:.2g})", open.over_drift);
  found.objections.emplace_back(
      undecided ? "close_modes" : "drift_or_pair",
      undecided
          ? fmt::format(
                "One or two modes at {:.5g} Hz: {} explain the record as well as one that drifts {}. The "
                "damping ratio is not determined; intervals are widened. A longer record or more channels "
                "may separate them.",
                one.pole.frequency_hz(), two, differs)
          : fmt::format(
                "The mode at {:.5g} Hz follows its amplitude, or there are {}: both explain the record "
                "{}. Intervals are widened; --amplitude shows the damping ratio against the amplitude.",
                one.pole.frequency_hz(), two, differs),
      open.over_drift, clearly_two);
}

std::optional<JointDecayFit> with_pair(const RecordModes& found, const JointDecayFit& fit, std::size_t m,
                                       const std::pair<Complex, Complex>& start) {
  std::vector<Complex> rates = fit.rates;
  rates[m] = start.first;
  rates.push_back(start.second);
  try {
    return fit_decays_jointly(found.target, found.interval, rates);
  } catch (const std::exception&) {  // it does not converge, or too few samples
    return {};
  }
}

/// Poles less than a line apart are one pole to a search over orders, and a line that is wider than its mode.
/// For each mode that is found a pair is tried in its place: the realisation of order 4 [juang1985] of the
/// record without the other modes, then least squares of all. The pair stays where
///
/// - it reduces the squares by more than chance does: chi-square of 2 + 2 p degrees of freedom at 1e-6, by
///   the density of its residual near it;
/// - one mode whose frequency and damping drift (phase_wander.hpp), alike in all channels, has squares larger
///   by 25 times that density;
/// - its residual is as dense near it as farther away: a frequency that follows the amplitude is no pair.
///
/// Where squares of the drifting mode are not larger by 25 and not smaller by 10, neither wins.
/// @param fit of found's modes, before and after
/// @return those of which neither won
std::vector<OpenPair> split_close_pairs(RecordModes& found, JointDecayFit& fit) {
  constexpr double worth = 0.02;  // of the strongest
  double strongest = 0.0;
  for (const ModeEstimate& mode : found.modes) strongest = std::max(strongest, mode.strength);
  const std::size_t modes = found.modes.size();  // a mode of a pair is not parted again
  std::vector<OpenPair> open;
  for (std::size_t m = 0; m < modes; ++m) {
    if (found.modes[m].strength < worth * strongest) continue;
    std::optional<OpenPair> undecided;
    for (const auto& start : starts(found, fit, m)) {
      const auto pair = with_pair(found, fit, m, start);
      if (!pair) continue;
      const auto [verdict, over_drift] = compete(found, fit, *pair, m, found.modes.size());
      if (verdict == OneOrTwo::undecided) undecided = OpenPair{m, *pair, over_drift};
      if (verdict != OneOrTwo::two) continue;
      found.modes.push_back(found.modes[m]);
      for (std::size_t k = 0; k < found.modes.size(); ++k) found.modes[k].pole = fitted_pole(*pair, k);
      fit = *pair;
      undecided.reset();
      break;
    }
    if (undecided) open.push_back(*std::move(undecided));
  }
  return open;
}

// Whether all channels of a free decay ring at the same frequencies.

/// Where they do not (joint_decay_fit.hpp), the deviations of the joint frequencies are widened by how far
/// the farthest of the mode's channels is, for any of them may be right, and a warning says by how much the
/// clocks differ.
/// @param fit of found's modes, in their order
void compare_clocks(const JointDecayFit& fit, RecordModes& found) {
  const auto scatter = clock_scatter(fit);
  if (!scatter) return;
  for (std::size_t m = 0; m < found.modes.size(); ++m) {
    double& deviation = found.modes[m].pole.frequency_deviation_hz;
    deviation =
        std::hypot(deviation, scatter->farthest[static_cast<Eigen::Index>(m)] / (2.0 * std::numbers::pi));
  }
  found.objections.emplace_back(
      "channel_clocks",
      scatter->sentence(found.record.channel_names()) +
          " A frequency cannot show which is right; its standard deviations are widened by how far "
          "its channels are from it.");
}

using Modes = std::vector<ModeEstimate>;

void reject(std::size_t m, const std::string& why, RecordModes& found) {
  found.stabilisation.rejected.push_back({found.modes[m].pole, found.modes[m].orders, why});
  found.modes.erase(found.modes.begin() + static_cast<std::ptrdiff_t>(m));
}

/// Of two poles that are one mode, the one that is stable at fewer orders.
bool reject_twin(const std::vector<Pole>& poles, RecordModes& found) {
  const double duration = found.interval * static_cast<double>(found.target.cols());
  for (std::size_t a = 0; a < poles.size(); ++a)
    for (std::size_t b = a + 1; b < poles.size(); ++b) {
      if (!indistinguishable(poles[a], poles[b], duration)) continue;
      const auto weight = [&](std::size_t m) {
        return std::pair(found.modes[m].orders.size(), found.modes[m].strength);
      };
      const std::size_t kept = weight(a) < weight(b) ? b : a, lost = kept == a ? b : a;
      reject(lost,
             fmt::format("one mode with {:.4g} Hz: they cannot be separated in this record",
                         poles[kept].frequency_hz()),
             found);
      return true;
    }
  return false;
}

/// Of two fitted poles that are one drifting mode, the weaker.
bool reject_drifting(const JointDecayFit& fit, RecordModes& found) {
  for (std::size_t a = 0; a < found.modes.size(); ++a)
    for (std::size_t b = a + 1; b < found.modes.size(); ++b) {
      if (!is_one_drifting_mode(fit, a, b, found.target, found.interval)) continue;
      const bool first = fit.shapes.col(static_cast<Eigen::Index>(a)).norm() <
                         fit.shapes.col(static_cast<Eigen::Index>(b)).norm();
      reject(first ? a : b,
             fmt::format("one mode with {:.4g} Hz, whose frequency or damping follows the amplitude",
                         fitted_pole(fit, first ? b : a).frequency_hz()),
             found);
      return true;
    }
  return false;
}

/// Nothing where it does not converge: then the weakest mode is rejected.
std::optional<JointDecayFit> fit_or_reject(RecordModes& found) {
  std::vector<std::complex<double>> start;
  for (const ModeEstimate& mode : found.modes) start.push_back(mode.pole.rate);
  std::string why;
  try {
    return fit_decays_jointly(found.target, found.interval, start);
  } catch (const std::runtime_error&) {
    why = "least squares of all modes do not converge with it";
  } catch (const std::invalid_argument&) {
    why = "too few samples to fit it";
  }
  const auto weakest =
      std::min_element(found.modes.begin(), found.modes.end(),
                       [](const ModeEstimate& a, const ModeEstimate& b) { return a.strength < b.strength; });
  reject(static_cast<std::size_t>(weakest - found.modes.begin()), why, found);
  return std::nullopt;
}

std::vector<Pole> poles_of(const Modes& modes) {
  std::vector<Pole> poles;
  for (const ModeEstimate& mode : modes) poles.push_back(mode.pole);
  return poles;
}

std::vector<Pole> poles_of(const JointDecayFit& fit) {
  std::vector<Pole> poles;
  for (std::size_t m = 0; m < fit.rates.size(); ++m) poles.push_back(fitted_pole(fit, m));
  return poles;
}

bool strongest_is_uncertain(const JointDecayFit& fit, const StabilisationSettings& settings,
                            const RecordModes& found) {
  const auto m = static_cast<std::size_t>(&found.strongest() - found.modes.data());
  return !objection_to(found.modes[m].pole, fit, m, found, settings).empty();
}

/// Only the least certain goes: without it, others may stay.
bool reject_least_certain(const JointDecayFit& fit, const StabilisationSettings& settings,
                          RecordModes& found) {
  std::optional<std::size_t> worst;
  double largest = -1;
  std::string why;
  for (std::size_t m = 0; m < found.modes.size(); ++m) {
    const Pole pole = fitted_pole(fit, m);
    std::string objection = objection_to(found.modes[m].pole, fit, m, found, settings);
    const double uncertainty = pole.frequency_deviation_hz / pole.frequency_hz();
    if (objection.empty() || uncertainty <= largest) continue;
    worst = m, largest = uncertainty, why = std::move(objection);
  }
  if (worst) reject(*worst, why, found);
  return worst.has_value();
}

/// What was rejected for the company it was in, the strongest first, is tried once more with those that
/// stayed: all of them have to. @param last the fit of found's modes, before and after
void try_again(Modes lost, const StabilisationSettings& settings, RecordModes& found, JointDecayFit& last) {
  std::sort(lost.begin(), lost.end(),
            [](const ModeEstimate& a, const ModeEstimate& b) { return a.strength > b.strength; });
  for (const ModeEstimate& one : lost) {
    RecordModes tried = found;
    tried.modes.push_back(one);
    std::erase_if(tried.stabilisation.rejected, [&](const PoleCluster& cluster) {
      return cluster.pole.rate == one.pole.rate && cluster.orders == one.orders;
    });
    const std::size_t rejected = tried.stabilisation.rejected.size();
    if (reject_twin(poles_of(tried.modes), tried)) continue;
    auto fit = fit_or_reject(tried);
    if (!fit || reject_least_certain(*fit, settings, tried) || reject_twin(poles_of(*fit), tried) ||
        reject_drifting(*fit, tried) || tried.stabilisation.rejected.size() != rejected)
      continue;
    for (std::size_t m = 0; m < tried.modes.size(); ++m) tried.modes[m].pole = fitted_pole(*fit, m);
    found = std::move(tried);
    last = std::move(*fit);
  }
}

}  // namespace

void polish(RecordModes& found, const StabilisationSettings& settings) {
  const bool any = !found.modes.empty();
  while (reject_twin(poles_of(found.modes), found)) {
  }
  const Modes all = found.modes;
  while (!found.modes.empty()) {
    auto fit = fit_or_reject(found);
    if (!fit) continue;
    bool split = false;
    std::vector<OpenPair> open;
    if (found.free_decay && strongest_is_uncertain(*fit, settings, found)) {
      const std::size_t before =
          found.modes.size();  // a pair that is fitted as one mode makes that uncertain
      open = split_close_pairs(found, *fit);
      split = found.modes.size() > before;
    }
    if (reject_least_certain(*fit, settings, found)) continue;
    const std::vector<Pole> poles = poles_of(*fit);
    if (!split && (reject_twin(poles, found) || reject_drifting(*fit, found))) continue;
    Modes lost;
    for (const ModeEstimate& mode : all)
      if (std::none_of(found.modes.begin(), found.modes.end(),
                       [&](const ModeEstimate& one) { return one.pole.rate == mode.pole.rate; }))
        lost.push_back(mode);
    for (std::size_t m = 0; m < poles.size(); ++m) found.modes[m].pole = poles[m];
    try_again(lost, settings, found, *fit);
    if (found.free_decay) {
      if (!split) open = split_close_pairs(found, *fit);
      for (const OpenPair& one : open) object_to_one(one, found);
      compare_clocks(*fit, found);
      follow_phases(*fit, found);
    }
    std::sort(found.modes.begin(), found.modes.end(),
              [](const auto& a, const auto& b) { return a.pole.frequency_hz() < b.pole.frequency_hz(); });
    found.polished = true;
    return;
  }
  if (any)
    found.objections.emplace_back(
        "no_deviations",
        "No pole was confirmed by least squares; --no-polish lists them as the method finds them.");
}

}  // namespace beamid::experiments
