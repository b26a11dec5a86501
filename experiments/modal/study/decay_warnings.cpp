#include "experiments/modal/study/decay_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/modal/decay_jump.hpp"
#include "experiments/modal/third_overtone.hpp"

namespace beamid::experiments {
namespace {

/// The strongest mode as the reference analysis has one, with the others between half and twice its
/// frequency.
ModalEstimate strongest_of(const std::vector<ModeEstimate>& modes, const ModeEstimate& strongest,
                           Eigen::Index channel) {
  const double frequency = strongest.pole.frequency_hz();
  ModalEstimate mode;
  mode.frequency_hz = frequency;
  mode.damping_ratio = strongest.pole.damping_ratio();
  mode.amplitude = strongest.amplitude(channel);
  for (const ModeEstimate& other : modes)
    if (const double hz = other.pole.frequency_hz();
        &other != &strongest && hz > 0.5 * frequency && hz < 2 * frequency)
      mode.companions.push_back({hz, other.pole.damping_ratio(), other.amplitude(channel)});
  return mode;
}

}  // namespace

std::vector<std::string> decay_warnings(const RecordModes& found) {
  if (found.modes.empty()) return {};
  const ModeEstimate& strongest = found.strongest();
  const Record& record = found.record;
  Eigen::Index channel = 0;
  (strongest.pole.shape.cwiseAbs().array() / record.samples.rowwise().norm().array()).maxCoeff(&channel);
  const Eigen::VectorXd signal = record.samples.row(channel).transpose();
  const ModalEstimate mode = strongest_of(found.modes, strongest, channel);
  std::vector<std::string> warnings;
  if (const auto jump = decay_jump(signal, record.interval(), mode))
    warnings.push_back(jump->sentence(record.time[0]) +
                       " Modes across it are wrong by more than their deviations. Expected a --window on one "
                       "side of it.");
  constexpr double many = 2;
  const auto overtone = third_overtone(signal, record.interval(), mode);
  if (overtone && std::abs(overtone->damping_error()) * mode.damping_ratio >
                      many * strongest.pole.damping_ratio_deviation)
    warnings.push_back(
        fmt::format("{} The damping ratio of the mode at {:.4g} Hz is wrong by about {:.2g} % through it, "
                    "more than its deviation. Expected a later --window, or a sensor of larger range.",
                    overtone->words(), mode.frequency_hz, 100 * std::abs(overtone->damping_error())));
  return warnings;
}

}  // namespace beamid::experiments
