#include "fem/space_frame.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "fem/assembly.hpp"
#include "fem/frame.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem {
namespace {

using Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;

constexpr double nearly_upright = 0.01;  // sine of a member's angle to z, below which its section has no up
constexpr double parallel = 1e-6;        // sine of the angle to the member

const char* const axis_names[] = {"x", "y", "z"};

void check_vector(const std::string& what, const Vector3d& value, const std::string& unit) {
  for (const int i : {0, 1, 2}) check_in_frame(what + " along " + axis_names[i], value[i], false, unit);
}

void check_coefficients(const std::string& what, const Vector3d& values, const std::string& unit) {
  for (const int i : {0, 1, 2}) check_in_frame(what + axis_names[i], values[i], true, unit);
}

void check_space_section(const SpaceSection& section, const std::string& member) {
  const auto positive = [&](const char* what, double value, const char* unit) {
    if (!(value > 0.0 && std::isfinite(value)))
      refuse_in_frame(member + ": " + what, value, std::string("a positive number of ") + unit);
  };
  positive("axial stiffness", section.axial_stiffness, "N");
  positive("bending stiffness about y", section.bending_stiffness_y, "N m2");
  positive("bending stiffness about z", section.bending_stiffness_z, "N m2");
  positive("torsional stiffness", section.torsional_stiffness, "N m2");
  positive("mass per length", section.mass_per_length, "kg/m");
  positive("torsional inertia", section.torsional_inertia, "kg m");
  if (section.shear_stiffness_y) positive("shear stiffness along y", *section.shear_stiffness_y, "N");
  if (section.shear_stiffness_z) positive("shear stiffness along z", *section.shear_stiffness_z, "N");
  check_in_frame(member + ": rotary inertia about y", section.rotary_inertia_y, true, "kg m");
  check_in_frame(member + ": rotary inertia about z", section.rotary_inertia_z, true, "kg m");
}

void check_space_member(const SpaceFrame& frame, std::size_t i) {
  const SpaceFrame::Member& member = frame.members[i];
  const std::string name = "member " + std::to_string(i);
  for (const SpaceFrame::End* const end : {&member.at_first, &member.at_second})
    check_vector("offset of " + name, end->offset, "metres");
  if (!(frame.length(i) > 0.0))
    throw std::invalid_argument(name + " has no length; expected ends at different places");
  if (!(member.stiffness_factor > 0.0 && std::isfinite(member.stiffness_factor)))
    refuse_in_frame("stiffness factor of " + name, member.stiffness_factor, "a positive number");
  check_in_frame("roll of " + name, member.roll, false, "rad");
  check_in_frame("axial load of " + name, member.axial_load, false, "N");
  check_space_section(member.section, name);
  const double twisting = member.stiffness_factor * member.section.torsional_stiffness *
                          member.section.mass_per_length / member.section.torsional_inertia;
  if (!(member.axial_load < twisting)) {
    std::ostringstream expected;
    expected << "less than G J A / (I_y + I_z) = " << twisting << " N, at which it buckles by twisting";
    refuse_in_frame("axial load of " + name, member.axial_load, expected.str());
  }
  try {
    frame.axes(i);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(name + ": " + error.what());
  }
}

}  // namespace

Section SpaceSection::bending(char axis) const {
  const bool along_y = axis == 'y';
  Section section;
  section.bending_stiffness = along_y ? bending_stiffness_z : bending_stiffness_y;
  section.mass_per_length = mass_per_length;
  section.rotary_inertia = along_y ? rotary_inertia_z : rotary_inertia_y;
  if (const std::optional<double>& shear = along_y ? shear_stiffness_y : shear_stiffness_z)
    section.shear_stiffness = *shear;
  section.axial_stiffness = axial_stiffness;
  return section;
}

Vector3d SpaceFrame::begin(std::size_t member) const {
  return joints[static_cast<std::size_t>(members[member].first)].place + members[member].at_first.offset;
}

Vector3d SpaceFrame::end(std::size_t member) const {
  return joints[static_cast<std::size_t>(members[member].second)].place + members[member].at_second.offset;
}

double SpaceFrame::length(std::size_t member) const {
  return (end(member) - begin(member)).norm();
}

Matrix3d SpaceFrame::axes(std::size_t member) const {
  const Member& of = members[member];
  const Vector3d along = (end(member) - begin(member)).normalized();
  const bool upright = along.cross(Vector3d::UnitZ()).norm() < nearly_upright;
  const Vector3d up = of.section_z.value_or(upright ? Vector3d::UnitX() : Vector3d::UnitZ());
  const Vector3d across = up.cross(along);
  if (!(across.norm() > parallel * up.norm()) || !up.allFinite())
    throw std::invalid_argument(
        "the direction of its section's z is along the member; expected one across it");
  Matrix3d axes;
  axes.col(0) = along;
  axes.col(1) = across.normalized();
  axes.col(2) = along.cross(axes.col(1));
  if (of.roll != 0.0) axes = (Eigen::AngleAxisd(of.roll, along).toRotationMatrix() * axes).eval();
  return axes;
}

void validate(const SpaceFrame& frame) {
  const auto count = static_cast<int>(frame.joints.size());
  for (int joint = 0; joint < count; ++joint)
    check_vector("place of joint " + std::to_string(joint),
                 frame.joints[static_cast<std::size_t>(joint)].place, "metres");
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    for (const int joint : {frame.members[i].first, frame.members[i].second})
      check_joint_in_frame("member " + std::to_string(i), joint, count);
    check_space_member(frame, i);
  }
  check_frame_graph(count, member_ends(frame));
  for (const SpaceFrame::Support& support : frame.supports)
    check_joint_in_frame("a support", support.joint, count);
  for (const SpaceFrame::Body& body : frame.bodies) {
    check_joint_in_frame("a body", body.joint, count);
    check_in_frame("body mass", body.mass, true, "kg");
    check_coefficients("body inertia about ", body.inertia, "kg m2");
    check_vector("body offset", body.offset, "metres");
  }
  for (const SpaceFrame::Spring& spring : frame.springs) {
    check_joint_in_frame("a spring", spring.joint, count);
    check_coefficients("spring stiffness along ", spring.translational, "N/m");
    check_coefficients("rotational spring stiffness about ", spring.rotational, "N m/rad");
  }
  for (const SpaceFrame::Dashpot& dashpot : frame.dashpots) {
    check_joint_in_frame("a dashpot", dashpot.joint, count);
    check_coefficients("damping along ", dashpot.translational, "N s/m");
    check_coefficients("rotational damping about ", dashpot.rotational, "N m s/rad");
  }
  if (!(frame.base_direction.norm() > 0.0) || !frame.base_direction.allFinite())
    throw std::invalid_argument(
        "the direction of the base's motion has no length; expected three numbers, "
        "not all zero");
}

namespace {

constexpr double rounding = 1e-11;  // of what a load softens, relative to what it stiffens

// Coordinates that K couples with others or that lose stiffness: those inside elements mostly do neither.
std::vector<Eigen::Index> concerned(const SparseMatrix& full, const SparseMatrix& softened) {
  std::vector<Eigen::Index> found;
  for (Eigen::Index column = 0; column < full.cols(); ++column) {
    bool any = full.coeff(column, column) != softened.coeff(column, column);
    for (const SparseMatrix* const stiffness : {&full, &softened})
      for (SparseMatrix::InnerIterator it(*stiffness, column); it && !any; ++it)
        any = it.row() != column && it.value() != 0.0;
    if (any) found.push_back(column);
  }
  return found;
}

// The least positive x with det(K + x G) = 0; G is how K changes.
std::optional<double> first_loss(const StrainFactors& unloaded, const StrainFactors& loaded) {
  if (StiffnessSolver(unloaded).rigid_motions().cols() > 0) return std::nullopt;
  const SparseMatrix whole = unloaded.assembled(), softened = loaded.assembled();
  const std::vector<Eigen::Index> kept = concerned(whole, softened);
  if (kept.empty()) return std::nullopt;
  const MatrixXd full = MatrixXd(whole)(kept, kept), softening = full - MatrixXd(softened)(kept, kept);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(softening, full, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return std::nullopt;
  const double largest = solver.eigenvalues().tail(1)[0], stiffening = -solver.eigenvalues()[0];
  if (!(largest > rounding * stiffening)) return std::nullopt;
  return 1.0 / largest;
}

template <class AnyFrame>
std::optional<double> factor_of_loads(const AnyFrame& frame, int elements_per_member) {
  AnyFrame unloaded = frame;
  for (auto& member : unloaded.members) member.axial_load = 0.0;
  return first_loss(assemble(unloaded, elements_per_member).stiffness,
                    assemble(frame, elements_per_member).stiffness);
}

}  // namespace

std::optional<double> buckling_load(const Beam& beam, int elements) {
  const auto stiffness = [&](double load) {
    Beam loaded = beam;
    loaded.axial_load = load;
    return assemble(loaded, elements).stiffness;
  };
  // K is linear in P: any load of the size that matters will do.
  const double length = beam.length(),
               load = beam.segments.front().section.bending_stiffness(0.5) / (length * length);
  const auto factor = first_loss(stiffness(0.0), stiffness(load));
  return factor ? std::optional(*factor * load) : std::nullopt;
}

std::optional<double> buckling_factor(const Frame& frame, int elements_per_member) {
  return factor_of_loads(frame, elements_per_member);
}

std::optional<double> buckling_factor(const SpaceFrame& frame, int elements_per_member) {
  return factor_of_loads(frame, elements_per_member);
}

}  // namespace beamid::fem
