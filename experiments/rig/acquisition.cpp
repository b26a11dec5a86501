#include "experiments/rig/acquisition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <stdexcept>

#include "experiments/signal/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

// Of a seed, far from the streams of the sensors' noise, which count from 0.
constexpr std::uint64_t stamps_stream = 1u << 20, repeats_stream = stamps_stream + 1,
                        gaps_stream = stamps_stream + 2;

/// (mean - median) / standard deviation of a gamma distribution of this shape.
double relative_shortfall(double shape) {
  return (shape - boost::math::gamma_p_inv(shape, 0.5)) / std::sqrt(shape);
}

/// The shape with a given relative shortfall, which falls from 0.41 at 0.25 to 1/3 shape^(-1/2).
double shape_of(double shortfall) {
  double least = 0.25, most = 1e4;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(least * most);
    (relative_shortfall(middle) > shortfall ? least : most) = middle;
  }
  return std::sqrt(least * most);
}

/// Mean one, standard deviation and shortfall as asked for (n).
VectorXd relative_intervals(const Acquisition& acquisition, Index n, std::uint64_t seed) {
  constexpr double shortest = 0.05, hardly = 1e-3;
  const double shortfall = acquisition.median_shortfall / acquisition.jitter;
  if (shortfall > largest_shortfall)
    throw std::invalid_argument(
        fmt::format("median_shortfall is {:g} at a jitter of {:g}; expected {:g} of it at most",
                    acquisition.median_shortfall, acquisition.jitter, largest_shortfall));
  filters::RandomStream random(seed, stamps_stream);
  VectorXd interval(n);
  if (shortfall < hardly) {
    interval = 1 + acquisition.jitter * random.normal(n, 1).col(0).array();
  } else {
    const double shape = shape_of(shortfall), scale = acquisition.jitter / std::sqrt(shape);
    for (Index k = 0; k < n; ++k)
      interval[k] = 1 + scale * (boost::math::gamma_p_inv(shape, random.uniform()) - shape);
  }
  interval = interval.cwiseMax(shortest);
  return interval / interval.mean();
}

double largest_size(const VectorXd& readings) {
  return readings.size() > 0 ? readings.cwiseAbs().maxCoeff() : 0.0;
}

}  // namespace

VectorXd sample_instants(const Acquisition& acquisition, Index count, double rate, std::uint64_t seed) {
  VectorXd time = VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1)) / rate;
  if (!(acquisition.jitter > 0) || count < 2) return time;
  const VectorXd interval = relative_intervals(acquisition, count - 1, seed) / rate;
  for (Index k = 1; k < count; ++k) time[k] = time[k - 1] + interval[k - 1];
  return time;
}

VectorXd shown_readings(const SensorDefects& sensor, const VectorXd& time, const VectorXd& readings,
                        const VectorXd& noise, std::uint64_t seed, std::uint64_t stream) {
  const Index count = time.size();
  const double largest = largest_size(readings), length = count > 1 ? time[count - 1] - time[0] : 1.0;
  if (sensor.dead) return VectorXd::Constant(count, sensor.offset * largest);
  VectorXd shown = readings + noise;
  if (sensor.rattle > 0) {
    const VectorXd rattle = sensor.rattle * largest * standard_normal(count, seed, stream);
    shown += (readings.cwiseAbs().array() > sensor.rattle_above * largest).select(rattle, 0.0);
  }
  const Eigen::ArrayXd since = time.array() - time[0];
  shown.array() += largest * (sensor.offset + sensor.drift * since / length +
                              sensor.startup * (-since / sensor.startup_time).exp());
  if (sensor.clipping > 0)
    shown = shown.cwiseMax(-sensor.clipping * largest).cwiseMin(sensor.clipping * largest);
  if (const double step = sensor.resolution * largest; step > 0)
    shown = (shown / step).array().round() * step;
  return shown;
}

void lose_samples(const Acquisition& acquisition, Record& record, std::uint64_t seed) {
  const Index count = record.size();
  if (acquisition.repeated > 0) {
    filters::RandomStream random(seed, repeats_stream);
    for (Index k = 1; k < count; ++k)
      if (random.uniform() < acquisition.repeated) record.samples.col(k) = record.samples.col(k - 1);
  }
  if (acquisition.gaps == 0) return;
  filters::RandomStream random(seed, gaps_stream);
  const double part = (record.time[count - 1] - record.time[0]) / acquisition.gaps;
  const auto [least, most] = acquisition.gap;
  std::vector<bool> kept(static_cast<std::size_t>(count), true);
  for (int g = 0; g < acquisition.gaps; ++g) {
    const double length = least * std::pow(most / least, random.uniform()),
                 from = record.time[0] + part * (g + random.uniform() * std::max(0.0, 1 - length / part));
    const double* const begin = record.time.data();
    const Index last = std::min<Index>(std::lower_bound(begin, begin + count, from) - begin, count - 1);
    for (Index k = last + 1; k < count && record.time[k] < record.time[last] + length; ++k)
      kept[static_cast<std::size_t>(k)] = false;
  }
  Index left = 0;
  for (Index k = 0; k < count; ++k) {
    if (!kept[static_cast<std::size_t>(k)]) continue;
    record.time[left] = record.time[k];
    record.samples.col(left++) = record.samples.col(k);
  }
  record.time.conservativeResize(left);
  record.samples.conservativeResize(Eigen::NoChange, left);
}

}  // namespace beamid::experiments
