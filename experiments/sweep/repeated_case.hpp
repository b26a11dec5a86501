// What the records of one case have in common that differ by their noise alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/models/joint_model.hpp"
#include "experiments/sweep/repeats.hpp"
#include "filters/batch.hpp"

namespace beamid::experiments {

struct Repeats::Common {
  Experiment experiment;
  Record clean;  ///< without noise
  std::string reduction;
  std::vector<Observation> observations;
  JointModel model, true_model;         ///< of the beam assumed, and of the one simulated
  bool one_place = true;                ///< all channels read the same displacement
  Eigen::VectorXd sensor_noise, noise;  ///< put into the records, and assumed by the filter (p)
  std::vector<std::optional<double>> truth, bound;
  double frequency_hz = 0.0;  ///< of the beam simulated

  /// A record, and what is assumed before it, in the memory of an earlier one.
  void make_trial(std::uint64_t seed, filters::LaneTrial& made) const;
  ComparedRun judged(const filters::Gaussian& last) const;
  /// By one filter and one discretisation, a run for every record.
  std::vector<ComparedRun> identify(const Choice& filter, const std::string& scheme,
                                    const std::vector<filters::LaneTrial>& trials) const;

 private:
  std::optional<filters::OscillatorTrials> lanes(const Choice& filter, const std::string& scheme) const;
  ComparedRun alone(const Choice& filter, const std::string& scheme, const filters::LaneTrial& trial) const;
};

}  // namespace beamid::experiments
