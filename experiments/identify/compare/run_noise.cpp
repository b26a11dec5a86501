#include "experiments/identify/compare/run_noise.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

KnownNoise known_noise(const Experiment& experiment, const RecordAnalysis& analysis,
                       const ComparedRecord& compared) {
  const std::vector<Index> channels = output_channels(analysis.record);
  const MatrixXd outputs = analysis.record.samples(channels, Eigen::all);
  KnownNoise known{VectorXd::Zero(outputs.rows()), smallest_relative_noise * root_mean_squares(outputs), {}};
  for (Index i = 0; i < outputs.rows(); ++i) {
    const Channel& channel = analysis.record.channels[static_cast<std::size_t>(channels[i])];
    const double stated = stated_noise(experiment, channel);
    known.is_stated.push_back(stated > 0.0);
    if (compared.quiet_noise.size() > 0)
      known.configured[i] =
          std::max(compared.quiet_noise[i], smallest_relative_noise * largest_measured(outputs.row(i)));
    if (known.is_stated.back()) known.configured[i] = stated;
    if (compared.sensor_noise.size() > 0)
      known.least[i] = std::max(known.least[i], compared.sensor_noise[channels[i]]);
  }
  return known;
}

double stated_noise(const Experiment& experiment, const Channel& channel) {
  if (channel.noise > 0.0) return channel.noise;
  const auto given = experiment.noise.find(channel.quantity);
  return given != experiment.noise.end() ? given->second : 0.0;
}

VectorXd input_noise(const Experiment& experiment, const Record& record) {
  const std::vector<Index> inputs = input_channels(record);
  VectorXd noise(static_cast<Index>(inputs.size()));
  for (Index i = 0; i < noise.size(); ++i)
    noise[i] = stated_noise(experiment, record.channels[static_cast<std::size_t>(inputs[i])]);
  return noise;
}

VectorXd assumed_noise(const KnownNoise& known, const VectorXd& left) {
  return (known.configured.array() > 0.0).select(known.configured, left.cwiseMax(known.least));
}

VectorXd noise_of_bound(const ComparedRecord& compared, const KnownNoise& known, const VectorXd& left,
                        const VectorXd& assumed) {
  constexpr double surely = 3.0;  // standard deviations of a root mean square
  if (compared.sensor_noise.size() == 0) return assumed;
  const double scatter = 1.0 / std::sqrt(2.0 * static_cast<double>(compared.record.size()));
  return (left.array() > (1.0 + surely * scatter) * known.least.array()).select(left, known.least);
}

MatrixXd unit_noise(const MatrixXd& outputs) {
  return root_mean_squares(outputs).cwiseMax(1e-150).cwiseAbs2().asDiagonal();
}

}  // namespace beamid::experiments
