#include "experiments/signal/missing_samples.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Samples [from, to) that are fitted together, those from `inner` to `outer` being taken from the fit.
struct MissingRun {
  Index from, inner, outer, to;
};

std::vector<MissingRun> missing_runs_of(const VectorXd& signal, double period) {
  const auto margin = std::max<Index>(static_cast<Index>(std::ceil(period)), 16), core = 2 * margin;
  std::vector<MissingRun> blocks;
  for (Index inner = 0; inner < signal.size(); inner += core) {
    const Index outer = std::min(inner + core, signal.size());
    if (signal.segment(inner, outer - inner).allFinite()) continue;
    blocks.push_back(
        {std::max<Index>(0, inner - margin), inner, outer, std::min(outer + margin, signal.size())});
  }
  return blocks;
}

/// Of the samples of a block; frequencies in cycles per sample, the strongest first.
MatrixXd basis(const MissingRun& block, const std::vector<double>& frequencies) {
  const Index count = block.to - block.from;
  MatrixXd columns(count, 4 + 4 * static_cast<Index>(frequencies.size()));
  const Eigen::ArrayXd sample = Eigen::ArrayXd::LinSpaced(count, 0, static_cast<double>(count - 1)),
                       place = Eigen::ArrayXd::LinSpaced(count, -1, 1);
  columns.col(0).setOnes();
  columns.col(1) = place;
  Index next = 2;
  for (const double frequency : frequencies) {
    const Eigen::ArrayXd angle = 2 * std::numbers::pi * frequency * sample;
    const int most = frequency == frequencies.front() ? 2 : 1;
    Eigen::ArrayXd weight = Eigen::ArrayXd::Ones(count);
    for (int power = 0; power <= most; ++power, weight *= place) {
      columns.col(next++) = weight * angle.cos();
      columns.col(next++) = weight * angle.sin();
    }
  }
  return columns;
}

/// The fit to the finite samples of a block, at all of them (between inner and outer).
VectorXd fitted(const VectorXd& signal, const MissingRun& block, std::vector<double> frequencies) {
  std::vector<Index> known;
  for (Index k = block.from; k < block.to; ++k)
    if (std::isfinite(signal[k])) known.push_back(k - block.from);
  constexpr Index samples_per_unknown = 2;
  while (frequencies.size() > 1 &&
         std::ssize(known) < samples_per_unknown * (4 + 4 * std::ssize(frequencies)))
    frequencies.pop_back();
  const MatrixXd columns = basis(block, frequencies);
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  solver.setThreshold(1e-6);
  const VectorXd part = signal.segment(block.from, block.to - block.from);
  const VectorXd weights = solver.compute(columns(known, Eigen::all)).solve(part(known));
  return columns.middleRows(block.inner - block.from, block.outer - block.inner) * weights;
}

}  // namespace

std::vector<std::pair<Index, Index>> gaps_in(const VectorXd& signal) {
  std::vector<std::pair<Index, Index>> gaps;
  for (Index k = 0; k < signal.size(); ++k) {
    if (std::isfinite(signal[k])) continue;
    if (gaps.empty() || gaps.back().first + gaps.back().second < k) gaps.emplace_back(k, 0);
    ++gaps.back().second;
  }
  return gaps;
}

std::vector<double> finite(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values;
}

VectorXd bridged_straight(const VectorXd& signal) {
  VectorXd result = signal;
  for (const auto& [first, count] : gaps_in(signal)) {
    const Index behind = first + count;
    if (first == 0 && behind == signal.size())
      throw std::invalid_argument("signal without a finite sample; expected one at least");
    const double before = first > 0 ? signal[first - 1] : signal[behind],
                 after = behind < signal.size() ? signal[behind] : before;
    for (Index k = 0; k < count; ++k)
      result[first + k] =
          before + (after - before) * static_cast<double>(k + 1) / static_cast<double>(count + 1);
  }
  return result;
}

double largest_measured(const Eigen::MatrixXd& samples) {
  return samples.array().isFinite().select(samples.array().abs(), 0.0).maxCoeff();
}

VectorXd root_mean_squares(const MatrixXd& samples) {
  const auto read = samples.array().isFinite();
  const VectorXd counts = read.cast<double>().rowwise().sum().matrix();
  const MatrixXd finite = read.select(samples, 0.0);
  return finite.rowwise().squaredNorm().cwiseQuotient(counts.cwiseMax(1.0)).cwiseSqrt();
}

VectorXd filled(const VectorXd& signal, double period) {
  constexpr std::size_t most_lines = 4;
  constexpr double above_median = 6;
  const std::vector<MissingRun> blocks = missing_runs_of(signal, period);
  if (blocks.empty()) return signal;
  std::vector<double> frequencies{1 / period};
  for (;;) {
    VectorXd model = VectorXd::Zero(signal.size()), left = VectorXd::Zero(signal.size());
    for (const MissingRun& block : blocks)
      model.segment(block.inner, block.outer - block.inner) = fitted(signal, block, frequencies);
    VectorXd rest = signal - model;
    for (const MissingRun& block : blocks)
      for (Index k = block.inner; k < block.outer; ++k)
        if (std::isfinite(rest[k])) left[k] = rest[k];
    const auto& [frequency, amplitude] = amplitude_spectrum(left, 1.0);
    Index peak = 0;
    const double largest = amplitude.maxCoeff(&peak), usual = median(amplitude);
    const bool line = largest > above_median * usual && frequency[peak] * period > 0.5;
    if (line && frequencies.size() < most_lines) {
      frequencies.push_back(frequency[peak]);
      continue;
    }
    rest = bridged_straight(rest);
    VectorXd result = signal;
    for (const auto& [first, count] : gaps_in(signal))
      result.segment(first, count) = (model + rest).segment(first, count);
    return result;
  }
}

}  // namespace beamid::experiments
