#include "experiments/identify/twins/deciding_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "experiments/identify/update/modal_model.hpp"

namespace beamid::experiments {
namespace {

// What a set of parameters predicts where nothing was measured.

/// Modes with their deflections at places where a sensor could sit.
struct SetModes {
  Eigen::VectorXd frequency_hz;           ///< (k)
  std::vector<std::string> places;        ///< "1.2 m", "ridge.x" (p), about ten of them, evenly spread
  std::vector<Eigen::Index> coordinates;  ///< of the system, deflections there (p)
  Eigen::MatrixXd shapes;                 ///< (p x k) [m]
};

/// @param model small; @param count of the lowest modes; fewer where there are fewer
SetModes set_modes(const ModalModel& model, const Eigen::VectorXd& values, std::size_t count);

/// The mass that moves when everything is displaced alike [kg].
double translated_mass(const ModalModel& model, const Eigen::VectorXd& values);

/// All frequencies [Hz] with a mass [kg] added to one coordinate.
Eigen::VectorXd frequencies_with_mass(const ModalModel& model, const Eigen::VectorXd& values,
                                      Eigen::Index coordinate, double mass);

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t most_sensor_places = 10;

// Coordinates that are deflections, and what multiplies a displacement there.
std::vector<std::pair<Index, double>> deflections_in(const ModalModel& model) {
  std::vector<std::pair<Index, double>> found;
  using Kind = fem::Coordinate::Kind;
  const auto& coordinates = model.described().system.coordinates;
  const bool spatial = model.structure().space_frame() != nullptr;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (const Kind kind = coordinates[i].kind;
        kind == Kind::deflection || (spatial && (kind == Kind::axial || kind == Kind::lateral)))
      found.emplace_back(static_cast<Index>(i), coordinates[i].scale);
  return found;
}

// A joint of a frame by its name, a place between joints by where it is.
std::string place_text(const ModalModel& model, Index coordinate) {
  const fem::StructuralSystem& system = model.described().system;
  const fem::Coordinate& there = system.coordinates[static_cast<std::size_t>(coordinate)];
  if (const fem::MatrixSystem* const matrices = model.structure().matrices())
    return matrices->labels[static_cast<std::size_t>(coordinate)];
  if (const fem::Frame* const frame = model.structure().frame()) {
    const auto node = static_cast<std::size_t>(there.node);
    if (node < frame->joints.size())
      return (frame->joints[node].name.empty() ? fmt::format("{}", node + 1) : frame->joints[node].name) +
             ".y";
    return fmt::format("({:.3g} m, {:.3g} m).y", system.mesh.nodes[node].x, system.mesh.nodes[node].y);
  }
  if (const fem::SpaceFrame* const frame = model.structure().space_frame()) {
    using Kind = fem::Coordinate::Kind;
    const char axis = there.kind == Kind::axial ? 'x' : there.kind == Kind::deflection ? 'y' : 'z';
    const auto node = static_cast<std::size_t>(there.node);
    const fem::Mesh::Node& at = system.mesh.nodes[node];
    if (node >= frame->joints.size())
      return fmt::format("({:.3g} m, {:.3g} m, {:.3g} m).{}", at.x, at.y, at.z, axis);
    const std::string& name = frame->joints[node].name;
    return fmt::format("{}.{}", name.empty() ? fmt::format("{}", node + 1) : name, axis);
  }
  return fmt::format("{:.4g} m", there.position);
}

VectorXd frequencies_of(const VectorXd& eigenvalues) {
  return eigenvalues.cwiseMax(0.0).cwiseSqrt() / (2.0 * std::numbers::pi);
}

SetModes set_modes(const ModalModel& model, const VectorXd& values, std::size_t count) {
  const auto [mass, stiffness] = model.matrices(values);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, mass);
  const Index kept = std::min(model.size(), static_cast<Index>(count));
  SetModes modes;
  modes.frequency_hz = frequencies_of(solver.eigenvalues().head(kept));
  const auto deflections = deflections_in(model);
  const std::size_t step =
      std::max<std::size_t>(1, (deflections.size() + most_sensor_places - 1) / most_sensor_places);
  std::vector<double> scales;
  for (std::size_t i = deflections.size(); i > 0; i -= std::min(i, step)) {  // the last one first: the tip
    const auto& [coordinate, scale] = deflections[i - 1];
    modes.coordinates.insert(modes.coordinates.begin(), coordinate);
    scales.insert(scales.begin(), scale);
    modes.places.insert(modes.places.begin(), place_text(model, coordinate));
  }
  modes.shapes.resize(static_cast<Index>(scales.size()), kept);
  for (Index a = 0; a < modes.shapes.rows(); ++a)
    modes.shapes.row(a) =
        solver.eigenvectors().row(modes.coordinates[static_cast<std::size_t>(a)]).head(kept) /
        scales[static_cast<std::size_t>(a)];
  return modes;
}

double translated_mass(const ModalModel& model, const VectorXd& values) {
  VectorXd motion = VectorXd::Zero(model.size());
  for (const auto& [coordinate, scale] : deflections_in(model)) motion[coordinate] = scale;
  return motion.dot(model.matrices(values).first * motion);
}

VectorXd frequencies_with_mass(const ModalModel& model, const VectorXd& values, Index coordinate,
                               double mass) {
  auto [matrix, stiffness] = model.matrices(values);
  const double scale = model.described().system.coordinates[static_cast<std::size_t>(coordinate)].scale;
  matrix(coordinate, coordinate) += mass / (scale * scale);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, matrix, Eigen::EigenvaluesOnly);
  return frequencies_of(solver.eigenvalues());
}

using MeasurementKind = DecidingMeasurement::Kind;

constexpr double mass_share = 0.05;      // of an added mass, of all that moves
constexpr double weighing_share = 0.01;  // standard deviation of a weighing

// The smallest distance of any two, each prediction with its own standard deviation.
double least_distance(const std::vector<double>& values, const std::vector<double>& deviations) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < values.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      least = std::min(least, std::abs(values[a] - values[b]) / std::hypot(deviations[a], deviations[b]));
  return least;
}

void keep_better(std::optional<DecidingMeasurement>& best, DecidingMeasurement one) {
  if (std::isfinite(one.separation) && (!best || one.separation > best->separation)) best = std::move(one);
}

// phi at a over phi at b: the ratio of whichever is larger below, as an angle, which stays finite at a node;
// its standard deviation is that of a component of the unit pair.
std::optional<DecidingMeasurement> best_ratio(const std::vector<SetModes>& sets, double trust) {
  std::optional<DecidingMeasurement> best;
  const auto places = static_cast<Index>(sets[0].places.size());
  for (Index mode = 0; mode < sets[0].frequency_hz.size(); ++mode)
    for (Index b = 0; b < places; ++b)
      for (Index a = 0; a < b; ++a) {
        DecidingMeasurement one{MeasurementKind::shape_ratio, static_cast<int>(mode) + 1,
                                sets[0].places[static_cast<std::size_t>(a)],
                                sets[0].places[static_cast<std::size_t>(b)]};
        one.separation = std::numeric_limits<double>::infinity();
        for (const SetModes& set : sets) one.predicted.push_back(set.shapes(a, mode) / set.shapes(b, mode));
        for (std::size_t s = 0; s < sets.size(); ++s)
          for (std::size_t t = 0; t < s; ++t) {
            const VectorXd u{{sets[s].shapes(a, mode), sets[s].shapes(b, mode)}},
                v{{sets[t].shapes(a, mode), sets[t].shapes(b, mode)}};
            const double noise_u = trust * sets[s].shapes.col(mode).cwiseAbs().maxCoeff() / u.norm(),
                         noise_v = trust * sets[t].shapes.col(mode).cwiseAbs().maxCoeff() / v.norm();
            const double angle =
                std::asin(std::min(1.0, std::abs(u[0] * v[1] - u[1] * v[0]) / (u.norm() * v.norm())));
            one.separation = std::min(one.separation, angle / std::hypot(noise_u, noise_v));
          }
        keep_better(best, std::move(one));
      }
  return best;
}

std::optional<DecidingMeasurement> best_frequency(const std::vector<SetModes>& sets, Index measured,
                                                  double trust) {
  std::optional<DecidingMeasurement> best;
  for (Index mode = measured; mode < sets[0].frequency_hz.size(); ++mode) {
    DecidingMeasurement one{MeasurementKind::frequency, static_cast<int>(mode) + 1};
    std::vector<double> deviations;
    for (const SetModes& set : sets) {
      one.predicted.push_back(set.frequency_hz[mode]);
      deviations.push_back(trust * set.frequency_hz[mode]);
    }
    one.separation = least_distance(one.predicted, deviations);
    keep_better(best, std::move(one));
  }
  return best;
}

// All frequencies measured again: what separates two sets is the root of the sum of squares.
std::optional<DecidingMeasurement> best_mass(const ModalModel& model, const std::vector<VectorXd>& values,
                                             const std::vector<SetModes>& sets, Index measured,
                                             double trust) {
  std::optional<DecidingMeasurement> best;
  if (!model.dense()) return best;
  const double mass = mass_share * translated_mass(model, values[0]);
  for (std::size_t place = 0; place < sets[0].places.size(); ++place) {
    std::vector<VectorXd> frequencies;
    for (const VectorXd& value : values)
      frequencies.push_back(frequencies_with_mass(model, value, sets[0].coordinates[place], mass));
    DecidingMeasurement one{MeasurementKind::added_mass};
    one.place = sets[0].places[place];
    one.mass = mass;
    one.separation = std::numeric_limits<double>::infinity();
    const Index kept = std::min(measured, frequencies[0].size());
    VectorXd apart = VectorXd::Zero(kept);
    for (std::size_t s = 0; s < sets.size(); ++s)
      for (std::size_t t = 0; t < s; ++t) {
        const VectorXd difference =
            (frequencies[s].head(kept).array() / frequencies[t].head(kept).array()).log() /
            (std::numbers::sqrt2 * trust);
        apart += difference.cwiseAbs();
        one.separation = std::min(one.separation, difference.norm());
      }
    Index mode = 0;
    apart.maxCoeff(&mode);
    one.mode = static_cast<int>(mode) + 1;
    for (const VectorXd& f : frequencies) one.predicted.push_back(f[mode]);
    keep_better(best, std::move(one));
  }
  return best;
}

std::optional<DecidingMeasurement> best_weighing(const ModalModel& model,
                                                 const std::vector<VectorXd>& values) {
  std::optional<DecidingMeasurement> best;
  for (Index j = 0; j < model.parameters(); ++j) {
    const Unknown& unknown = model.asked().unknowns[static_cast<std::size_t>(j)];
    if (unknown.unit != "kg") continue;
    DecidingMeasurement one{MeasurementKind::parameter};
    one.parameter = unknown.name;
    std::vector<double> deviations;
    for (const VectorXd& value : values) {
      one.predicted.push_back(value[j]);
      deviations.push_back(weighing_share * std::abs(value[j]));
    }
    one.separation = least_distance(one.predicted, deviations);
    keep_better(best, std::move(one));
  }
  return best;
}

}  // namespace

const char* to_string(DecidingMeasurement::Kind kind) {
  switch (kind) {
    case MeasurementKind::shape_ratio:
      return "shape ratio";
    case MeasurementKind::frequency:
      return "frequency";
    case MeasurementKind::added_mass:
      return "added mass";
    case MeasurementKind::parameter:
      return "weighing";
  }
  return "";
}

std::vector<DecidingMeasurement> deciding_measurements(const ModalModel& model, const ModalData& data,
                                                       const std::vector<VectorXd>& values,
                                                       const ModelTrust& trust) {
  std::vector<DecidingMeasurement> all;
  if (values.size() < 2 || !model.dense()) return all;
  std::vector<SetModes> sets;
  for (const VectorXd& value : values) sets.push_back(set_modes(model, value, data.modes.size() + 2));
  const auto measured = static_cast<Index>(data.modes.size());
  for (auto& one : {best_ratio(sets, trust.shape), best_frequency(sets, measured, trust.frequency),
                    best_mass(model, values, sets, measured, trust.frequency), best_weighing(model, values)})
    if (one) all.push_back(*one);
  std::stable_sort(all.begin(), all.end(), [](const DecidingMeasurement& a, const DecidingMeasurement& b) {
    return a.separation > b.separation;
  });
  return all;
}

}  // namespace beamid::experiments
