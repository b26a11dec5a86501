#include "experiments/identify/bounds/sweeps.hpp"

#include <algorithm>
#include <cmath>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

std::vector<Index> record_lengths(double samples_per_period, Index described, Index most) {
  constexpr double few_periods = 3.0, same = 0.05;
  constexpr int count = 16;
  const double least =
      std::max(8.0, std::min(few_periods * samples_per_period, static_cast<double>(described) / 4.0));
  std::vector<Index> lengths{described};
  for (int i = 0; i <= count; ++i) {
    const double length = least * std::pow(static_cast<double>(most) / least, static_cast<double>(i) / count);
    if (std::abs(length / static_cast<double>(described) - 1.0) > same)
      lengths.push_back(static_cast<Index>(std::llround(length)));
  }
  std::sort(lengths.begin(), lengths.end());
  lengths.erase(std::unique(lengths.begin(), lengths.end()), lengths.end());
  return lengths;
}

std::vector<Index> strides(double samples_per_period, Index samples) {
  constexpr double fewest_per_period = 2.1;  // at 2 all samples may fall on zeros
  constexpr Index fewest_samples = 16;
  std::vector<Index> found{1};
  for (Index decade = 1;; decade *= 10)
    for (const Index step : {2 * decade, 5 * decade, 10 * decade}) {
      if (samples_per_period < fewest_per_period * static_cast<double>(step) ||
          samples < fewest_samples * step)
        return found;
      found.push_back(step);
    }
}

MatrixXd bounds_percent(const ObservedMotion& motion, const std::vector<ChannelInformation>& records,
                        const std::vector<NoisyChannel>& channels) {
  MatrixXd percent(static_cast<Index>(records.size()), static_cast<Index>(motion.model.unknowns.size()));
  for (std::size_t i = 0; i < records.size(); ++i)
    percent.row(static_cast<Index>(i)) =
        100.0 * relative_bounds(information_about_unknowns(motion, records[i], channels)).transpose();
  return percent;
}

MatrixXd bounds_percent_alone(const ObservedMotion& motion, const ChannelInformation& record,
                              const std::vector<NoisyChannel>& channels) {
  MatrixXd percent(static_cast<Index>(channels.size()), static_cast<Index>(motion.model.unknowns.size()));
  for (std::size_t i = 0; i < channels.size(); ++i)
    percent.row(static_cast<Index>(i)) =
        100.0 * relative_bounds(information_about_unknowns(motion, record, {channels[i]})).transpose();
  return percent;
}

std::vector<AddedChannel> add_best(const ObservedMotion& motion, const ChannelInformation& record,
                                   std::vector<NoisyChannel> channels,
                                   const std::vector<NoisyChannel>& candidates, int count) {
  const auto q = static_cast<Index>(motion.model.unknowns.size());
  std::vector<AddedChannel> added;
  for (int i = 0; i < count; ++i) {
    std::optional<AddedChannel> best;
    Index most_determined = -1;
    double largest = 0.0;
    for (std::size_t candidate = 0; candidate < candidates.size(); ++candidate) {
      if (std::any_of(added.begin(), added.end(),
                      [&](const AddedChannel& other) { return other.candidate == candidate; }))
        continue;
      channels.push_back(candidates[candidate]);
      const auto report = filters::determined_combinations(
          information_about_unknowns(motion, record, channels), VectorXd::Ones(q));
      channels.pop_back();
      const double logarithm = report.eigenvalues.head(report.rank).array().log().sum();
      if (report.rank < most_determined || (report.rank == most_determined && !(logarithm > largest)))
        continue;
      most_determined = report.rank;
      largest = logarithm;
      best = AddedChannel{candidate, 100.0 * report.bounds};
    }
    if (!best) break;
    channels.push_back(candidates[best->candidate]);
    added.push_back(std::move(*best));
  }
  return added;
}

}  // namespace beamid::experiments
