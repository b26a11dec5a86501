#include "experiments/modal/input_responses.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiments/signal/fast_length.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;

InputResponses input_responses(const MatrixXd& outputs, const MatrixXd& inputs, double interval) {
  constexpr Index blocks_per_input = 6, fewest_samples = 64, overlapping = 4;
  constexpr double tiny = 1e-12;  // of the largest power of the inputs
  const Index p = outputs.rows(), m = inputs.rows();
  const Index longest = 2 * outputs.cols() / (blocks_per_input * m + 1);
  if (longest < fewest_samples)
    throw std::invalid_argument(
        fmt::format("{} samples; frequency responses to {} input{} expect {} at least", outputs.cols(), m,
                    m > 1 ? "s" : "", fewest_samples * (blocks_per_input * m + 1) / 2));
  const Index length = fast_length_within(longest), lines = (length - 1) / 2;
  const VectorXd phase = VectorXd::LinSpaced(
      length, 0.0, 2.0 * std::numbers::pi * static_cast<double>(length - 1) / static_cast<double>(length));
  const VectorXd window = 0.5 * (1.0 - phase.array().cos());
  const auto block = [&](const MatrixXd& signals, Index begin) {
    const MatrixXd part = signals.middleCols(begin, length);
    return spectrum_lines((part.colwise() - part.rowwise().mean()) * window.asDiagonal(), length, lines);
  };
  std::vector<MatrixXcd> uu(static_cast<std::size_t>(lines), MatrixXcd::Zero(m, m)),
      yu(static_cast<std::size_t>(lines), MatrixXcd::Zero(p, m));
  InputResponses found;
  MatrixXd yy = MatrixXd::Zero(p, lines);
  double largest = 0.0;  // power of an input
  for (Index begin = 0; begin + length <= outputs.cols(); begin += std::max<Index>(1, length / overlapping)) {
    const MatrixXcd y = block(outputs, begin), u = block(inputs, begin);
    for (Index k = 0; k < lines; ++k) {
      uu[static_cast<std::size_t>(k)] += u.col(k) * u.col(k).adjoint();
      yu[static_cast<std::size_t>(k)] += y.col(k) * u.col(k).adjoint();
    }
    yy += y.cwiseAbs2();
    ++found.averages;
  }
  for (const MatrixXcd& power : uu) largest = std::max(largest, power.diagonal().real().maxCoeff());
  found.duration = interval * static_cast<double>(length);
  found.frequency_hz = VectorXd::LinSpaced(lines, 1.0, static_cast<double>(lines)) / found.duration;
  found.h1.resize(p * m, lines);
  found.coherence.resize(p, lines);
  const double least = tiny * largest;
  for (Index k = 0; k < lines; ++k) {
    MatrixXcd power = uu[static_cast<std::size_t>(k)];
    power.diagonal().array() += least;
    const MatrixXcd cross = yu[static_cast<std::size_t>(k)],
                    h = power.ldlt().solve(cross.adjoint()).adjoint();
    found.h1.col(k) = h.reshaped();
    for (Index i = 0; i < p; ++i)
      found.coherence(i, k) = std::clamp(
          (h.row(i) * cross.row(i).adjoint()).value().real() / std::max(yy(i, k), 1e-300), 0.0, 1.0);
  }
  return found;
}

}  // namespace beamid::experiments
