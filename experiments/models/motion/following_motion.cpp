#include "experiments/models/motion/following_motion.hpp"

#include <cmath>

#include "experiments/models/motion/mode_maps.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
