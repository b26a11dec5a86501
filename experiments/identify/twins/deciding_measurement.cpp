#include "experiments/identify/twins/deciding_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "experiments/identify/twins/set_modes.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
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
