#include "experiments/identify/bounds/channel_information.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "filters/discrete_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::InformationFactor;

/// The information of all channels, every `stride`-th sample read. A channel's own offsets stand in its first
/// columns.
class ChannelReader {
 public:
  ChannelReader(const JointModel& model, Index channels, Index columns, double duration, Index stride)
      : stride_(stride), duration_(duration), drifts_(static_cast<std::size_t>(channels)) {
    for (const JointModel::Offset& offset : model.offsets)
      drifts_[static_cast<std::size_t>(offset.channel)].push_back(offset.drift);
    for (const auto& own : drifts_) factors_.emplace_back(static_cast<Index>(own.size()) + columns);
  }

  Index stride() const { return stride_; }

  /// @param rows sensitivities to start and unknowns at this sample (p x (2k + q)).
  void add(Index sample, double time, const MatrixXd& rows) {
    if (sample % stride_ != 0) return;
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      const auto own = static_cast<Index>(drifts_[i].size());
      MatrixXd row(1, own + rows.cols());
      for (Index j = 0; j < own; ++j)
        row(0, j) = drifts_[i][static_cast<std::size_t>(j)] ? time / duration_ : 1.0;
      row.rightCols(rows.cols()) = rows.row(static_cast<Index>(i));
      factors_[i].add(row);
    }
  }

  ChannelInformation so_far(Index start) const {
    ChannelInformation result{start, {}};
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      std::vector<Index> own;
      for (std::size_t j = 0; j < drifts_[i].size(); ++j) own.push_back(static_cast<Index>(j));
      result.channels.push_back(factors_[i].without(own));
    }
    return result;
  }

 private:
  Index stride_;
  double duration_;
  std::vector<std::vector<bool>> drifts_;  // a channel's offsets: whether they grow with time
  std::vector<InformationFactor> factors_;
};

Index longest_memory(const ObservedMotion& motion, const std::vector<Reading>& readings) {
  Index samples = 0;
  for (const Reading& reading : readings) {
    if (reading.samples < 1 || reading.stride < 1)
      throw std::invalid_argument(fmt::format("a reading of {} samples, every {}th; expected at least 1",
                                              reading.samples, reading.stride));
    samples = std::max(samples, reading.samples);
  }
  if (motion.inputs.size() > 0 && motion.inputs.cols() < samples)
    throw std::invalid_argument(
        fmt::format("inputs at {} samples; expected {}", motion.inputs.cols(), samples));
  return samples;
}

}  // namespace

std::vector<ChannelInformation> channel_information(const ObservedMotion& motion,
                                                    const std::vector<Reading>& readings) {
  const JointModel& model = motion.model;
  const Index samples = longest_memory(motion, readings), start = 2 * model.mode_shapes.cols();
  const auto channels = static_cast<Index>(model.motion->output_labels().size());
  const auto discrete = filters::discretise(model.motion, motion.interval, motion.discretisation,
                                            {{}, MatrixXd::Identity(channels, channels)});

  MatrixXd moved(motion.initial_state.size(), start + motion.directions.unknowns.cols());
  moved << motion.directions.motion.leftCols(start), motion.directions.unknowns;
  const double duration = static_cast<double>(samples) * motion.interval;
  std::vector<ChannelReader> readers;
  for (const Reading& reading : readings)
    if (std::none_of(readers.begin(), readers.end(),
                     [&](const ChannelReader& reader) { return reader.stride() == reading.stride; }))
      readers.emplace_back(model, channels, moved.cols(), duration, reading.stride);

  std::vector<ChannelInformation> result(readings.size());
  VectorXd state = motion.initial_state, next, input = VectorXd::Zero(model.motion->input_size());
  MatrixXd sensor, rows;
  for (Index step = 0; step < samples; ++step) {
    if (motion.inputs.size() > 0) input = motion.inputs.col(step);
    const double time = static_cast<double>(step) * motion.interval;
    discrete->output_jacobian(state, input, sensor);
    rows.noalias() = sensor * moved;
    if (!rows.allFinite())
      throw std::runtime_error(fmt::format("the motion grows beyond all bounds at {:g} s", time));
    for (ChannelReader& reader : readers) reader.add(step, time, rows);
    for (std::size_t i = 0; i < readings.size(); ++i)
      if (readings[i].samples == step + 1)
        for (const ChannelReader& reader : readers)
          if (reader.stride() == readings[i].stride) result[i] = reader.so_far(start);
    if (step + 1 == samples) break;
    discrete->move(state, input, next, moved);
    state.swap(next);
  }
  return result;
}

}  // namespace beamid::experiments
