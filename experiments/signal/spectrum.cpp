#include "experiments/signal/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "experiments/signal/amplitude_spectrum.hpp"

namespace beamid::experiments {

double strongest_frequency(const Eigen::VectorXd& signal, double interval) {
  const auto count = static_cast<std::size_t>(signal.size());
  if (count < 16)
    throw std::invalid_argument("signal of " + std::to_string(count) +
                                " samples; expected at least 16 to find its frequency");
  const Eigen::VectorXd magnitude = amplitude_spectrum(signal, interval).amplitude;
  const std::size_t length = 2 * (static_cast<std::size_t>(magnitude.size()) - 1);
  const auto first = magnitude.begin() + static_cast<std::ptrdiff_t>(2 * length / count + 1);
  const auto peak = std::max_element(first, magnitude.end() - 1);
  if (!(*peak > 0)) throw std::invalid_argument("a signal without any variation has no frequency");
  const double left = std::log(*(peak - 1)), centre = std::log(*peak), right = std::log(*(peak + 1));
  const double curvature = left - 2 * centre + right;
  const double shift = curvature < 0 ? 0.5 * (left - right) / curvature : 0;
  return (static_cast<double>(peak - magnitude.begin()) + (std::isfinite(shift) ? shift : 0)) /
         (static_cast<double>(length) * interval);
}

Eigen::MatrixXcd spectrum_lines(const Eigen::MatrixXd& signals, Eigen::Index samples, Eigen::Index lines) {
  Eigen::MatrixXcd found(signals.rows(), lines);
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> spectrum;
  for (Eigen::Index i = 0; i < signals.rows(); ++i) {
    const Eigen::VectorXd signal = signals.row(i).head(samples).transpose();
    transform.fwd(spectrum, std::vector<double>(signal.begin(), signal.end()));
    for (Eigen::Index k = 0; k < lines; ++k)
      found(i, k) = spectrum[static_cast<std::size_t>(k + 1)] / std::sqrt(static_cast<double>(samples));
  }
  return found;
}

Eigen::Index last_strong_line(const Eigen::MatrixXcd& lines) {
  constexpr double all_but = 1e-3;
  Eigen::Index last = 0;
  for (Eigen::Index i = 0; i < lines.rows(); ++i) {
    const Eigen::VectorXd power = lines.row(i).cwiseAbs2().transpose();
    double above = 0.0;
    Eigen::Index k = power.size() - 1;
    for (const double limit = all_but * power.sum(); k > last && (above += power[k]) < limit;) --k;
    last = std::max(last, k);
  }
  return last;
}

Eigen::MatrixXd line_rows(const Eigen::MatrixXcd& lines) {
  Eigen::MatrixXd rows(2 * lines.rows(), lines.cols());
  rows << lines.real(), lines.imag();
  return rows;
}

}  // namespace beamid::experiments
