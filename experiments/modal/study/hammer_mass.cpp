#include "experiments/modal/study/hammer_mass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/hit_sampling.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;

bool is_motion(Quantity quantity) {
  return quantity == Quantity::displacement || quantity == Quantity::velocity ||
         quantity == Quantity::acceleration;
}

}  // namespace

std::optional<HammerMass> hammer_mass(const Record& record, const Pole& pole,
                                      const std::vector<Complex>& others, std::string& reason) {
  Index force = -1, motion = -1;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    if (record.channels[i].quantity == Quantity::force && force < 0) force = i;
    if (is_motion(record.channels[i].quantity) && motion < 0) motion = i;
  }
  reason = "the record holds no force beside a motion";
  if (force < 0 || motion < 0) return std::nullopt;
  reason = "a reading is missing or clipped";
  if (!record.samples.allFinite()) return std::nullopt;
  try {
    const double interval = record.interval();
    const std::vector<Hit> hits = find_hits(record.samples.row(force).transpose(), interval);
    const Hit& hit = hits.front();
    std::vector<HitSampling> sampling;
    for (const Hit& one : hits) sampling.push_back(hit_sampling(record.samples.row(force).transpose(), one));
    const double unresolved = unresolved_at_once(sampling);
    reason =
        fmt::format("its hit has {:.0f} samples above half of the largest force, too few for its momentum",
                    sampling.front().above_half);
    if (unresolved > lost_momentum) return std::nullopt;
    const Index end = hits.size() > 1 ? hits[1].onset : record.size();
    const VectorXd decay = record.samples.row(motion).segment(hit.end, end - hit.end).transpose();
    const std::vector<AmplitudePoint> points = amplitude_dependence(decay, interval, pole.rate, others);
    reason = "its decay is too short or too uncertain for two windows";
    if (points.size() < 2) return std::nullopt;
    const auto damping = [](const AmplitudePoint& p) {
      return 2 * std::numbers::pi * p.frequency_hz * p.damping_ratio;
    };
    const AmplitudePoint &first = points[0], &second = points[1];
    const double back = first.time + interval * static_cast<double>(hit.end - hit.onset);
    const double part = 0.5 * back * back / (second.time - first.time);
    const double logarithm =
        std::log(first.amplitude) + damping(first) * back + (damping(first) - damping(second)) * part;
    const double w = 2 * std::numbers::pi * first.frequency_hz, ratio = first.damping_ratio;
    const Complex s = w * Complex(-ratio, std::sqrt(1 - ratio * ratio));
    Complex transformed = 0;
    for (Index i = 0; i < hit.end; ++i)
      transformed += interval * hit.force[i] * std::exp(-s * interval * static_cast<double>(i - hit.onset));
    HammerMass found;
    const int power = times_differentiated(record.channels[motion].quantity);
    found.mass = std::pow(w, power) * std::abs(transformed) / (s.imag() * std::exp(logarithm));
    found.deviation = found.mass * std::hypot(w * (back + part) * first.damping_ratio_deviation,
                                              w * part * second.damping_ratio_deviation, unresolved);
    found.coarse = coarse_hits(sampling, interval);
    found.impulse = hit.impulse;
    found.velocity_step = hit.impulse / found.mass;
    found.pulses_s = hit.pulses_s;
    return found;
  } catch (const std::invalid_argument& error) {
    reason = error.what();
    return std::nullopt;
  }
}

}  // namespace beamid::experiments
