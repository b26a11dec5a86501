#include "filters/measurements.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

std::string shape(Index rows, Index columns) {
  return std::to_string(rows) + " x " + std::to_string(columns);
}

void check_deviations(const Measurements& measurements) {
  for (Index k = 0; k < measurements.size(); ++k)
    for (Index i = 0; i < measurements.outputs.rows(); ++i)
      if (const double deviation = measurements.output_deviations(i, k);
          !std::isnan(measurements.outputs(i, k)) && !(deviation >= 0.0 && std::isfinite(deviation)))
        throw std::invalid_argument("standard deviation of output " + std::to_string(i) + " at sample " +
                                    std::to_string(k) + " is " + std::to_string(deviation) +
                                    "; expected at least 0");
}

}  // namespace

void check_measurements(const Measurements& measurements, Index outputs) {
  const Index samples = measurements.size();
  const MatrixXd &y = measurements.outputs, &u = measurements.inputs, &s = measurements.output_deviations;
  if (y.rows() != outputs || y.cols() != samples)
    throw std::invalid_argument("outputs are " + shape(y.rows(), y.cols()) + "; expected " +
                                shape(outputs, samples));
  if (u.size() > 0 && u.cols() != samples)
    throw std::invalid_argument("inputs have " + std::to_string(u.cols()) + " columns; expected " +
                                std::to_string(samples));
  if (s.size() > 0 && (s.rows() != outputs || s.cols() != samples))
    throw std::invalid_argument("output standard deviations are " + shape(s.rows(), s.cols()) +
                                "; expected " + shape(outputs, samples));
  for (Index k = 0; k < samples; ++k)
    if (!std::isfinite(measurements.time[k]) || (k > 0 && !(measurements.time[k] > measurements.time[k - 1])))
      throw std::invalid_argument("time stamp " + std::to_string(k) + " is " +
                                  std::to_string(measurements.time[k]) +
                                  " s; expected numbers that increase");
  if (s.size() > 0) check_deviations(measurements);
}

MatrixXd step_noise(const VectorXd& deviations) {
  return deviations.array().isFinite().select(deviations, 0.0).cwiseAbs2().asDiagonal();
}

}  // namespace beamid::filters
