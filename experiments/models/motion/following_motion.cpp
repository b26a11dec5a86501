#include "experiments/models/motion/following_motion.hpp"

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

namespace {

constexpr double guess_spacing =
    0.01;  // of the guesses: half of it, to the third power, is what the maps err by

// A guess of zero (an inertia, a load) is stepped by its uncertainty.
VectorXd spacing_of(const MotionDescription& description) {
  VectorXd spacing(description.properties());
  for (std::size_t j = 0; j < description.unknowns.size(); ++j)
    if (const Drive& drive = description.drives[j]; drive.kind == Drive::Kind::property) {
      const double guess = std::abs(description.reference[drive.index]);
      spacing[drive.index] = guess_spacing * (guess > 0.0 ? guess : description.unknowns[j].deviation);
    }
  return spacing;
}

}  // namespace

FollowingMotion::FollowingMotion(Equations equations, MotionDescription description, VectorXd frequencies,
                                 const MatrixXd& reading, VectorXd scale)
    : SecondOrderMotion(
          description,
          reading.topRows(static_cast<Index>(description.observations.size())) * scale.asDiagonal(), "mode"),
      frequencies_(std::move(frequencies)),
      scale_(std::move(scale)) {
  maps_ = std::make_shared<ModeMaps>(std::move(equations), this->description().reference,
                                     spacing_of(this->description()), reading);
}

void FollowingMotion::evaluate(const VectorXd& state, SecondOrderForm& form,
                               std::vector<SecondOrderForm>* slopes) const {
  const MotionDescription& given = description();
  const Index r = frequencies_.size(), p = rows().rows(), m = input_size();
  const VectorXd inverse = scale_.cwiseInverse();
  const PhysicalValues at = physical_values(given, layout(), state);
  const ModesThere modes = maps_->at(at.change);
  const VectorXd omega = modes.square.cwiseSqrt();
  VectorXd ratios = VectorXd::Zero(r);
  for (std::size_t i = 0; i < given.damped_modes.size(); ++i)
    ratios[given.damped_modes[i].number] = at.ratios[static_cast<Index>(i)];

  form.stiffness = modes.square.asDiagonal();
  form.damping = (2.0 * ratios.cwiseProduct(omega) + at.stiffness_damping * modes.square).asDiagonal();
  form.damping.diagonal().array() += at.mass_damping;
  form.inputs = inverse.asDiagonal() * modes.reading.bottomRows(m).transpose();
  form.rows = modes.reading.topRows(p) * scale_.asDiagonal();
  if (!slopes) return;

  slopes->resize(given.unknowns.size());
  for (std::size_t j = 0; j < given.unknowns.size(); ++j) {
    const Drive& drive = given.drives[j];
    VectorXd stiffness = VectorXd::Zero(r), damping = VectorXd::Zero(r);
    MatrixXd reading = MatrixXd::Zero(p + m, r);
    switch (drive.kind) {
      case Drive::Kind::property:
        stiffness = modes.square_slopes.col(drive.index);
        damping = (ratios.cwiseQuotient(omega).array() + at.stiffness_damping) * stiffness.array();
        reading = modes.reading_slopes[static_cast<std::size_t>(drive.index)];
        break;
      case Drive::Kind::damping_ratio:
        for (const DampedMode& mode : given.damped_modes)
          if (mode.unknown == static_cast<Index>(j)) damping[mode.number] = 2.0 * omega[mode.number];
        break;
      case Drive::Kind::mass_damping:
        damping.setOnes();
        break;
      case Drive::Kind::stiffness_damping:
        damping = modes.square;
        break;
    }
    const double chain = at.slopes[static_cast<Index>(j)];
    SecondOrderForm& slope = (*slopes)[j];
    slope.stiffness = (chain * stiffness).asDiagonal();
    slope.damping = (chain * damping).asDiagonal();
    slope.inputs = chain * inverse.asDiagonal() * reading.bottomRows(m).transpose();
    slope.rows = chain * reading.topRows(p) * scale_.asDiagonal();
  }
}

}  // namespace beamid::experiments
