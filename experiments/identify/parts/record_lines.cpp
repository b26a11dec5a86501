#include "experiments/identify/parts/record_lines.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiments/signal/fast_length.hpp"
#include "experiments/signal/spectrum.hpp"
#include "filters/linear_gaussian.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double usual_band = 0.6;  // of half the sampling rate
constexpr Index fewest_lined_samples = 64, fewest_used_lines = 8;

Complex sum_of_powers(Complex pole, double omega, const RecordLines& record) {
  const double dt = record.interval;
  const Complex whole = std::exp(pole * (dt * static_cast<double>(record.samples)));
  return (1.0 - whole) / (1.0 - std::exp((pole - Complex(0.0, omega)) * dt));
}

}  // namespace

RecordLines record_lines(const filters::Measurements& record, const MatrixXd& inputs,
                         const std::optional<double>& highest_hz) {
  filters::require_even_stamps(record, record.interval());
  if (!record.outputs.allFinite() || !inputs.allFinite())
    throw std::invalid_argument("readings are missing; expected every sample of every channel of the part");
  if (record.size() < fewest_lined_samples)
    throw std::invalid_argument(
        fmt::format("{} samples; expected {} at least", record.size(), fewest_lined_samples));
  RecordLines found;
  found.samples = fast_length_within(record.size(), 5);
  found.interval = record.interval();
  const double half_rate = 0.5 / found.interval, highest = highest_hz.value_or(usual_band * half_rate),
               length = static_cast<double>(found.samples) * found.interval;
  const auto lines = static_cast<Index>(highest * length * (1.0 + 1e-9));
  if (!(highest < half_rate) || lines < fewest_used_lines)
    throw std::invalid_argument(fmt::format(
        "highest_hz is {:g}; expected it between {:.3g}, {} lines, and half the sampling rate, {:g} Hz",
        highest, static_cast<double>(fewest_used_lines) / length, fewest_used_lines, half_rate));
  const double first = 2.0 * pi / length;
  found.omega = first * VectorXd::LinSpaced(lines, 1.0, static_cast<double>(lines));
  found.outputs = spectrum_lines(record.outputs, found.samples, lines);
  found.inputs = spectrum_lines(inputs, found.samples, lines);
  return found;
}

MatrixXcd free_lines(const SupportedResponse::FreeMotion& motion, const RecordLines& record) {
  const Index p = motion.shapes.rows(), lines = record.omega.size();
  std::vector<VectorXcd> columns;
  for (Index j = 0; j < motion.poles.size(); ++j) {
    const Complex pole = motion.poles[j];
    const VectorXcd shape = motion.shapes.col(j);
    VectorXcd real(p * lines), imaginary(p * lines);
    for (Index k = 0; k < lines; ++k) {
      const VectorXcd forth = shape * sum_of_powers(pole, record.omega[k], record),
                      back = shape.conjugate() * sum_of_powers(std::conj(pole), record.omega[k], record);
      real.segment(k * p, p) = 0.5 * (forth + back);
      imaginary.segment(k * p, p) = Complex(0.0, -0.5) * (forth - back);
    }
    columns.push_back(real.normalized());
    if (pole.imag() > 0.0) columns.push_back(imaginary.normalized());
  }
  MatrixXcd found(p * lines, static_cast<Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) found.col(static_cast<Index>(j)) = columns[j];
  return found;
}

}  // namespace beamid::experiments
