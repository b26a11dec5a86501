#include "experiments/identify/decay_objections.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

DecayObjection jump_objection(const DecayJump& jump, double from) {
  constexpr double much = 0.05;
  const MotionJump* const motion = jump.motion();
  const bool contradicts =
      !motion || std::abs(motion->amplitude_ratio - 1) > much || std::abs(motion->phase) > much;
  return {fmt::format("{}{} A decay across it has neither this frequency nor this damping ratio within their "
                      "intervals. Expected a --window on one side of it.",
                      contradicts ? "CONTRADICTED: " : "", jump.sentence(from)),
          contradicts};
}

}  // namespace

std::vector<DecayObjection> decay_objections(const RecordAnalysis& analysis, const FoundMode& mode) {
  std::vector<DecayObjection> objections;
  if (analysis.jump) objections.push_back(jump_objection(*analysis.jump, analysis.even.record.time[0]));
  if (const auto& overtone = analysis.overtone; overtone && !analysis.sections.frequency.varies()) {
    constexpr double twice = 2;
    const double half = quantile_95 * mode.damping_ratio_deviation,
                 error = overtone->damping_error() * std::abs(mode.damping_ratio);
    if (std::abs(error) > half)
      objections.push_back(
          {fmt::format("{} The damping ratio is wrong by about {:.2g} % through it, more than its interval. "
                       "Expected a later --window, or a sensor of larger range.",
                       overtone->words(), 100 * std::abs(overtone->damping_error())),
           std::abs(error) > twice * half});
  }
  return objections;
}

}  // namespace beamid::experiments
