#include "experiments/modal/study/close_pair.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "experiments/modal/eigensystem_realisation.hpp"
#include "experiments/modal/study/drifting_mode.hpp"
#include "experiments/modal/study/mode_objections.hpp"
#include "experiments/signal/chi_square_limit.hpp"
#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

using std::numbers::pi;

/// The record without all modes but m.
MatrixXd without_others(const RecordModes& found, const JointDecayFit& fit, std::size_t m) {
  MatrixXd rest = found.target.colwise() - fit.offsets;
  for (std::size_t other = 0; other < fit.rates.size(); ++other) {
    if (other == m) continue;
    for (Index k = 0; k < rest.cols(); ++k) {
      const Complex wave = std::exp(fit.rates[other] * (found.interval * static_cast<double>(k)));
      rest.col(k) -= (fit.shapes.col(static_cast<Index>(other)) * wave).real();
    }
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

/// Whether modes a and b of `pair` stand, where `single` has one.
bool stands(const RecordModes& found, const JointDecayFit& single, const JointDecayFit& pair, std::size_t a,
            std::size_t b) {
  constexpr double by_chance = 1e-6, clearly = 25.0, denser = 2.0, weakest = 0.02;
  const double w = single.rates[a].imag();
  for (const std::size_t m : {a, b}) {
    const Pole pole = fitted_pole(pair, m);
    if (!(pole.damping_ratio() > 2.0 * pole.damping_ratio_deviation) ||
        !(std::abs(pair.rates[m].imag() - w) < 0.1 * w))
      return false;
  }
  const auto at_a = static_cast<Index>(a), at_b = static_cast<Index>(b);
  const double size_a = pair.shapes.col(at_a).norm(), size_b = pair.shapes.col(at_b).norm();
  if (std::min(size_a, size_b) < weakest * std::max(size_a, size_b)) return false;
  double gained = 0.0, over_drift = 0.0;
  for (Index c = 0; c < found.target.rows(); ++c) {
    const double noise = std::max(pair.noise_variance(c, at_a), 1e-300);
    const double one = (found.target.row(c) - single.reconstruction.row(c)).squaredNorm();
    const PairAgainstDrift both = pair_against_drift(pair, a, b, found.target, found.interval, c);
    gained += (one - both.left_by_pair) / noise;
    over_drift += (both.left_by_drift - both.left_by_pair) / noise;
  }
  const double freedom = 2.0 + 2.0 * static_cast<double>(found.target.rows());
  return gained > chi_square_limit(freedom, 1.0 - by_chance) && over_drift > clearly &&
         density_near(pair, found, a) < denser;
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

}  // namespace

void split_close_pairs(RecordModes& found, JointDecayFit& fit) {
  constexpr double worth = 0.02;  // of the strongest
  double strongest = 0.0;
  for (const ModeEstimate& mode : found.modes) strongest = std::max(strongest, mode.strength);
  const std::size_t modes = found.modes.size();  // a mode of a pair is not parted again
  for (std::size_t m = 0; m < modes; ++m) {
    if (found.modes[m].strength < worth * strongest) continue;
    for (const auto& start : starts(found, fit, m)) {
      const auto pair = with_pair(found, fit, m, start);
      if (!pair || !stands(found, fit, *pair, m, found.modes.size())) continue;
      found.modes.push_back(found.modes[m]);
      for (std::size_t k = 0; k < found.modes.size(); ++k) found.modes[k].pole = fitted_pole(*pair, k);
      fit = *pair;
      break;
    }
  }
}

}  // namespace beamid::experiments
