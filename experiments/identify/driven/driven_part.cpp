#include "experiments/identify/driven/driven_part.hpp"

#include <cmath>
#include <complex>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;

// What a converter that holds or joins samples by lines does to a frequency.
Complex path_gain(InputPath path, double omega, double interval) {
  if (path == InputPath::band_limited) return 1.0;
  const double half = 0.5 * omega * interval, sinc = std::sin(half) / half;
  return path == InputPath::linear ? Complex(sinc * sinc) : sinc * std::exp(Complex(0.0, -half));
}

}  // namespace

MatrixXd line_rows(const MatrixXcd& lines) {
  MatrixXd rows(2 * lines.rows(), lines.cols());
  rows << lines.real(), lines.imag();
  return rows;
}

PartLines part_lines(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part) {
  const Index p = part.outputs.rows(), lines = part.omega.size(), l = response.motion_size();
  PartLines found{MatrixXcd(p * lines, 1), MatrixXcd::Zero(p * lines, l + 2 * p)};
  MatrixXcd transfer, free;
  for (Index k = 0; k < lines; ++k) {
    const double omega = part.omega[k];
    response.line(omega, part.interval, transfer, free);
    found.driven.col(0).segment(k * p, p) = path_gain(problem.path, omega, part.interval) *
                                            (problem.weights.asDiagonal() * (transfer * part.inputs.col(k)));
    found.added.block(k * p, 0, p, l) = problem.weights.asDiagonal() * free;
    for (Index i = 0; i < p; ++i) {
      found.added(k * p + i, l + i) = 1.0;
      found.added(k * p + i, l + p + i) = Complex(0.0, std::sin(omega * part.interval));
    }
  }
  return found;
}

PartAt::PartAt(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part)
    : lines(part_lines(problem, response, part)) {
  MatrixXcd read = part.outputs;
  read = problem.weights.asDiagonal() * read;
  const VectorXd all = line_rows(Eigen::Map<VectorXcd>(read.data(), read.size()) - lines.driven.col(0));
  MatrixXd columns = line_rows(lines.added);
  scale = columns.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  columns = columns * scale.asDiagonal();
  ends.setThreshold(1e-10);
  ends.compute(columns);
  const VectorXd scaled = ends.solve(all);
  left = all - columns * scaled;
  coefficients = scale.asDiagonal() * scaled;
}

void PartAt::project(VectorXd& rows) const {
  rows.applyOnTheLeft(ends.householderQ().transpose());
  rows.head(ends.rank()).setZero();
  rows.applyOnTheLeft(ends.householderQ());
}

}  // namespace beamid::experiments
