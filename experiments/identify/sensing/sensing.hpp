// Forces that nobody measured, and motion where no sensor was.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/sensing/fatigue_damage.hpp"
#include "experiments/identify/sensing/sensing_model.hpp"
#include "filters/diagnostics.hpp"

namespace beamid::experiments {

// What rests on the zero of one sensor.

/// A sensor whose constant offset no other can tell from a constant force: its zero is taken for exact, and
/// no deviation of a history holds what it is off.
struct SoleZero {
  std::string name, unit;
  double off = 0.0;            ///< a power of ten, below what the sensor reads
  std::vector<double> shifts;  ///< mean of every history over the record where the zero is off by that
};

/// @param pass of the record through the filter; @param rows, feed of the histories, as for smoothed_rows
std::vector<SoleZero> sole_zeros(const SensingModel& model, const Eigen::VectorXd& theta,
                                 const filters::LinearGaussian& form, const filters::KalmanPass& pass,
                                 const std::vector<Channel>& channels, const Eigen::MatrixXd& rows,
                                 const Eigen::MatrixXd& feed);

/// A constant that the record was asked for.
struct SensedConstant {
  std::string name, unit;
  double value = 0.0, lower_95 = 0.0, upper_95 = 0.0;  ///< [unit]
};

/// A history that no sensor read, with the deviation of its error.
struct SensedHistory {
  std::string name, unit;
  Eigen::VectorXd mean, deviation;       ///< (N)
  double unread_deviation = 0.0;         ///< that it would have without any sensor
  Eigen::Index first = 0;                ///< sample from which errors count: a filter has to find the start
  std::optional<Eigen::VectorXd> truth;  ///< (N)
  double from_smoother = 0.0;            ///< root mean square of what a filter's differs from the smoother's

  double root_mean_square() const;
  double reported_error() const;  ///< root mean square of the deviation
  double error() const;           ///< of mean - truth, which must be there
  /// Whether the sensors say less of it than what was assumed of the forces.
  bool undetermined() const { return reported_error() > 0.5 * unread_deviation; }
  /// Whether a filter is further from the smoother than its own error allows: it has failed.
  bool contradicts_smoother() const { return !(from_smoother <= 2.0 * reported_error()); }
};

/// A sensor as the others predict it.
struct LeftOutSensor {
  std::string name, unit;
  double root_mean_square = 0.0;  ///< of what it read
  double error = 0.0;             ///< of the prediction
  double expected = 0.0;          ///< error by the prediction's deviation and the sensor's noise
  bool contradicts() const { return error > 2.0 * expected; }
  /// Whether the others say nothing of it, so that nothing is checked.
  bool free() const { return expected > 0.9 * root_mean_square; }
};

/// What of a sensor's reading is left to noise.
struct SensorNoise {
  std::string name, unit;
  double deviation = 0.0, root_mean_square = 0.0;
  bool stated = false;  ///< in the file; else found by the likelihood
  /// Whether noise that nobody stated explains what the structure should: it is not as described.
  bool explains_too_much() const { return !stated && deviation > 0.3 * root_mean_square; }
};

struct SensingStudy {
  Eigen::Index coordinates = 0;
  std::string reduction;
  std::vector<SensedConstant> constants;
  bool converged = true;
  std::string failure;  ///< why the likelihood has no maximum
  std::vector<filters::LatentInput> forces;
  Eigen::VectorXd time;
  std::string filter;  ///< of the histories; empty: the smoother, over all readings
  std::vector<std::string> filter_remarks = {};
  std::vector<SensedHistory> histories;        ///< virtual sensors, then forces
  std::vector<LeftOutSensor> left_out;         ///< none of a single sensor
  std::vector<SensorNoise> noise;              ///< of every sensor that was read
  filters::InnovationConsistency innovations;  ///< of all sensors; its colour is that of the worst
  int unseen_constants = 0;                    ///< SensingModel::unseen_constant_forces
  std::vector<SoleZero> sole_zeros = {};
  struct SensorDamage {
    std::string name;
    FatigueDamage damage;
    double lower_95 = 0.0, upper_95 = 0.0;  ///< of the damage of histories drawn with the error
  };
  std::vector<SensorDamage> damages;

  /// Of the innovations over what they should be; 1 of a right model.
  static constexpr double largest_square = 1.5;
  bool contradicted() const;
  /// Whether the innovations of a sensor are not white, which chance does once in 1,000 records.
  bool coloured() const { return innovations.whiteness_p_value < 1e-3; }
  /// So far from white that intervals are too small.
  bool correlated() const { return coloured() && std::abs(innovations.lag_one_correlation) > 0.3; }
  /// Whether innovations are larger by five of their deviations, and by a twentieth, than they should be.
  bool noisier_than_stated() const {
    constexpr double deviations = 5.0 / 1.96, least = 1.1;
    const double square = innovations.mean_normalised_square;
    return square > least && square - 1.0 > deviations * (innovations.upper_95 - 1.0);
  }
  bool is_to_rely_on() const { return converged && !contradicted() && !correlated(); }
};

/// Constants by the likelihood of the innovations, then all histories at them, by the smoother or a filter;
/// every sensor that was read left out in turn.
/// @param filter for the histories, in place of the smoother
/// @throws std::invalid_argument, std::runtime_error as the parts do.
SensingStudy study_sensing(const Experiment& experiment, const SensingRecord& record, const Choice& reduction,
                           const std::filesystem::path& folder, const Progress& progress,
                           const std::optional<Choice>& filter = {});

/// The same by the smoother at constants that are known otherwise, physical, in the model's order.
SensingStudy study_sensing_at(const Experiment& experiment, const SensingRecord& record,
                              const Choice& reduction, const std::filesystem::path& folder,
                              const Eigen::VectorXd& constants);

/// What the file says; else none of a chain of up to 12 floors, and of other structures the modes below 0.8
/// of the Nyquist frequency, 12 at most, with the static deflection under every force.
Choice sensing_reduction(const Experiment& experiment, double interval);

}  // namespace beamid::experiments
