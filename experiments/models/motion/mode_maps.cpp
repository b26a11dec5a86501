#include "experiments/models/motion/mode_maps.hpp"

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t most_maps = 4096;  // a filter visits tens; particles may visit many

}  // namespace

ModeMaps::ModeMaps(Equations equations, VectorXd reference, VectorXd spacing, MatrixXd reading)
    : equations_(std::move(equations)),
      reference_(std::move(reference)),
      spacing_(std::move(spacing)),
      reading_(std::move(reading)) {}

const std::vector<fem::ModeCurve>& ModeMaps::map_of(const Cell& cell) {
  const auto known = maps_.find(cell);
  if (known != maps_.end()) return known->second;
  VectorXd values = reference_;
  for (Index j = 0; j < values.size(); ++j)
    values[j] += spacing_[j] * static_cast<double>(cell[static_cast<std::size_t>(j)]);
  std::vector<fem::ModeCurve> curves;
  try {
    const fem::ParametricSystem equations = equations_(values);
    curves = fem::mode_curves(equations, fem::modes(equations.system, reading_.cols()));
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(std::string("impossible values of the unknowns: ") + error.what());
  }
  // An eigensolver's signs are anybody's guess: those of the modes at p_0 are kept.
  for (std::size_t i = 0; i < curves.size(); ++i) {
    fem::ModeCurve& curve = curves[i];
    if (curve.reading.dot(reading_.col(static_cast<Index>(i))) >= 0.0) continue;
    curve.reading *= -1.0;
    curve.reading_slope *= -1.0;
    for (MatrixXd& curvature : curve.reading_curvature) curvature *= -1.0;
  }
  if (maps_.size() >= most_maps) maps_.clear();
  return maps_.emplace(cell, std::move(curves)).first->second;
}

ModesThere ModeMaps::at(const VectorXd& change) {
  const std::lock_guard lock(mutex_);
  const Index a = change.size(), p = reading_.rows(), r = reading_.cols();
  if (!change.allFinite()) throw std::runtime_error("unknowns that are not finite");
  Cell cell;
  VectorXd x = change;
  for (Index j = 0; j < a; ++j) {
    cell.push_back(std::lround(change[j] / spacing_[j]));
    x[j] -= spacing_[j] * static_cast<double>(cell.back());
  }
  const std::vector<fem::ModeCurve>& curves = map_of(cell);
  ModesThere there{VectorXd(r), MatrixXd(r, a), MatrixXd(p, r),
                   std::vector<MatrixXd>(static_cast<std::size_t>(a), MatrixXd(p, r))};
  for (Index i = 0; i < r; ++i) {
    const fem::ModeCurve& curve = curves[static_cast<std::size_t>(i)];
    const VectorXd bend = curve.square_curvature * x;
    there.square[i] = curve.square + x.dot(curve.square_slope + 0.5 * bend);
    there.square_slopes.row(i) = (curve.square_slope + bend).transpose();
    for (Index k = 0; k < p; ++k) {
      const VectorXd turn = curve.reading_curvature[static_cast<std::size_t>(k)] * x;
      const VectorXd slope = curve.reading_slope.row(k).transpose();
      there.reading(k, i) = curve.reading[k] + x.dot(slope + 0.5 * turn);
      for (Index j = 0; j < a; ++j)
        there.reading_slopes[static_cast<std::size_t>(j)](k, i) = slope[j] + turn[j];
    }
    if (!(there.square[i] > 0.0))
      throw std::runtime_error("the beam does not oscillate at these values of its unknowns");
  }
  return there;
}

}  // namespace beamid::experiments
