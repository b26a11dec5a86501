#include "experiments/identify/engine/noise_in_estimates.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "experiments/signal/toolbox.hpp"
#include "filters/sample_walk.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double influence_band = 1.6, fewest_lines = 2;

// Whitened sensitivities of output i at sample k to every direction, in row i N + k (p N x r); zero where
// nothing was read.
MatrixXd sensitivities(filters::DiscreteModel& model, const VectorXd& state, const MatrixXd& directions,
                       const filters::Measurements& record) {
  const Index samples = record.time.size(), p = record.outputs.rows();
  const VectorXd deviation = model.output_noise().diagonal().cwiseSqrt();
  MatrixXd rows = MatrixXd::Zero(p * samples, directions.cols()), moved = directions, sensor;
  filters::walk_samples(model, record, samples, state, moved, [&](Index k, const auto& x, const auto& input) {
    model.output_jacobian(x, input, sensor);
    const MatrixXd read = sensor * moved;
    for (Index i = 0; i < p; ++i)
      if (std::isfinite(record.outputs(i, k))) rows.row(i * samples + k) = read.row(i) / deviation[i];
  });
  return rows;
}

// |X_k|^2 / N of a signal (N), at the lines 0 ... M/2 of the length M that transforms fast, zeros behind it:
// the lines of N themselves take N^2 where it is prime, as 4,001 is.
VectorXd power(const VectorXd& signal) {
  static thread_local Eigen::FFT<double> transform;
  std::vector<double> values(static_cast<std::size_t>(even_fast_length_around(signal.size())), 0.0);
  Eigen::Map<VectorXd>(values.data(), signal.size()) = signal;
  std::vector<std::complex<double>> lines;
  transform.fwd(lines, values);
  VectorXd result(static_cast<Index>(values.size()) / 2 + 1);
  for (Index k = 0; k < result.size(); ++k)
    result[k] = std::norm(lines[static_cast<std::size_t>(k)]) / static_cast<double>(signal.size());
  return result;
}

/// Density of the noise around every line, over that of R, and the lines' weight that it rests on.
struct NoiseDensity {
  VectorXd density, weight;
};

NoiseDensity density_of(const VectorXd& periodogram, const VectorXd& free) {
  const Index lines = periodogram.size();
  VectorXd left(lines + 1), weight(lines + 1);  // running sums
  left[0] = weight[0] = 0.0;
  for (Index k = 0; k < lines; ++k) {
    left[k + 1] = left[k] + periodogram[k];
    weight[k + 1] = weight[k] + free[k];
  }
  NoiseDensity result{VectorXd::Ones(lines), VectorXd::Zero(lines)};
  for (Index k = 0; k < lines; ++k) {
    auto first = static_cast<Index>(std::ceil(static_cast<double>(k) / influence_band)),
         last = static_cast<Index>(static_cast<double>(k) * influence_band);
    first = std::clamp<Index>(first, std::min<Index>(1, lines - 1), lines - 1);
    last = std::clamp<Index>(last, first, lines - 1);
    while (weight[last + 1] - weight[first] < fewest_lines && (first > 1 || last < lines - 1)) {
      if (last < lines - 1) ++last;
      if (first > 1) --first;
    }
    result.weight[k] = weight[last + 1] - weight[first];
    if (result.weight[k] > 0.0) result.density[k] = (left[last + 1] - left[first]) / result.weight[k];
  }
  return result;
}

}  // namespace

std::vector<NoiseInEstimate> noise_in_estimates(filters::DiscreteModel& model, const VectorXd& state,
                                                const StartDirections& directions,
                                                const filters::Measurements& record, const MatrixXd& left) {
  const Index samples = record.time.size(), p = record.outputs.rows(), q = directions.unknowns.cols(),
              starts = directions.motion.cols();
  MatrixXd rows = sensitivities(model, state, directions.all(), record);
  const VectorXd size = rows.colwise().norm().transpose().cwiseMax(1e-300);
  rows *= size.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(1e-10);
  qr.compute(rows);
  const Index rank = qr.rank();
  const MatrixXd basis = qr.householderQ() * MatrixXd::Identity(rows.rows(), rank);
  // Influence of the whitened noise on the columns that were chosen: R^-1 Q^T; others are not determined.
  const MatrixXd upper = qr.matrixR().topLeftCorner(rank, rank);
  const VectorXd deviation = model.output_noise().diagonal().cwiseSqrt();

  std::vector<NoiseDensity> density;
  for (Index i = 0; i < p; ++i) {
    const VectorXd white = left.row(i).transpose() / deviation[i];
    VectorXd free = VectorXd::Constant(even_fast_length_around(samples) / 2 + 1,
                                       white.array().isFinite().cast<double>().mean());
    for (Index c = 0; c < rank; ++c) free -= power(basis.col(c).segment(i * samples, samples));
    density.push_back(density_of(power(white.array().isFinite().select(white, 0.0)), free.cwiseMax(0.0)));
  }

  std::vector<NoiseInEstimate> result(static_cast<std::size_t>(q));
  const auto& places = qr.colsPermutation().indices();
  for (Index c = 0; c < rank; ++c) {
    if (places[c] < starts) continue;
    const VectorXd unit = VectorXd::Unit(rank, c);
    const VectorXd weights = upper.transpose().triangularView<Eigen::Lower>().solve(unit);
    // Row c of R^-1 Q^T is (Q R^-T e_c)^T.
    const VectorXd influence = basis * weights;
    double passed = 0.0, all = 0.0, spread = 0.0;
    for (Index i = 0; i < p; ++i) {
      const VectorXd share = power(influence.segment(i * samples, samples));
      const NoiseDensity& noise = density[static_cast<std::size_t>(i)];
      for (Index k = 0; k < share.size(); ++k) {
        passed += share[k] * noise.density[k];
        all += share[k];
        spread += share[k] * noise.density[k] / std::max(noise.weight[k], 1.0);
      }
    }
    if (!(all > 0.0) || !(passed > 0.0)) continue;
    NoiseInEstimate& one = result[static_cast<std::size_t>(places[c] - starts)];
    one.ratio = std::sqrt(passed / all);
    // Lines within a band share their noise: var(G) = G^2 / weight, all of it common to one mode.
    one.freedom = std::max(1.0, 2.0 * passed / spread);
  }
  return result;
}

}  // namespace beamid::experiments
