#include "experiments/identify/update/update_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/identify/update/update_study.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

struct LogRatios {
  double mean = 0.0, spread = 0.0;
};

LogRatios mean_and_spread(const VectorXd& logs) {
  const double mean = logs.mean();
  return {mean, std::sqrt((logs.array() - mean).square().mean())};
}

// Measured over described frequencies, the modes being numbered so.
LogRatios frequency_ratios(const UpdateStudy& study, const std::vector<Index>& numbers) {
  VectorXd logs(static_cast<Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    logs[static_cast<Index>(i)] =
        std::log(study.data().modes[i].frequency_hz / study.described.frequency_hz[numbers[i]]);
  return mean_and_spread(logs);
}

void add_units(const UpdateStudy& study, std::vector<std::string>& warnings) {
  const double factor = std::exp(frequency_ratios(study, pair_modes(study.data(), study.described)).mean);
  const double turn = 2.0 * std::numbers::pi;
  if (std::abs(std::log(factor / turn)) < 0.2)
    warnings.push_back(
        fmt::format("The measured frequencies are {:.3g} times those described, about 2 pi: are "
                    "they in rad/s? Expected Hz.",
                    factor));
  else if (std::abs(std::log(factor * turn)) < 0.2)
    warnings.push_back(
        fmt::format("The measured frequencies are {:.3g} times those described, about 1 / (2 "
                    "pi): were they divided by 2 pi twice?",
                    factor));
  else if (std::abs(std::log(factor)) > std::log(2.5))
    warnings.push_back(
        fmt::format("The measured frequencies are {:.3g} times those described: a mass, a unit "
                    "or the numbering of the modes may be wrong.",
                    factor));
}

// One mode left out that makes the ratios alike.
void add_missing(const UpdateStudy& study, std::vector<std::string>& warnings) {
  const auto count = static_cast<Index>(study.data().modes.size());
  const bool numbered = std::any_of(study.data().modes.begin(), study.data().modes.end(),
                                    [](const MeasuredMode& mode) { return mode.number.has_value(); });
  if (study.data().has_shapes() || numbered || count < 2 || study.described.frequency_hz.size() <= count)
    return;
  std::vector<Index> numbers(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) numbers[static_cast<std::size_t>(i)] = i;
  const double in_order = frequency_ratios(study, numbers).spread;
  Index missing = -1;
  double least = in_order;
  for (Index skipped = count - 1; skipped >= 0; --skipped) {
    numbers[static_cast<std::size_t>(skipped)] = skipped + 1;
    if (const double spread = frequency_ratios(study, numbers).spread; spread < least)
      least = spread, missing = skipped;
  }
  if (missing < 0 || in_order < 0.05 || least > 0.4 * in_order) return;
  warnings.push_back(
      fmt::format("The frequencies are taken for modes 1 to {0}. Without mode {1} among them they "
                  "would be nearer to those described: if it was not found, say so by the key "
                  "'mode' of [[modes]].",
                  count, missing + 1));
}

double mean_assurance(const ModalData& data, const PredictedModes& modes) {
  const MatrixXd assurance = modal_assurances(data, modes);
  const std::vector<Index> pairs = pair_modes(data, modes);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (const double mac = assurance(static_cast<Index>(i), pairs[i]); std::isfinite(mac))
      sum += mac, ++count;
  return count > 0 ? sum / count : 1.0;
}

// A sensor whose readings turned round bring shapes and predictions together.
void add_signs(const UpdateStudy& study, std::vector<std::string>& warnings) {
  if (!study.data().has_shapes()) return;
  constexpr double much = 0.15;
  double best_gain = much;
  Index turned = -1;
  for (const PredictedModes* modes : {&study.described, &study.updating.best().fit.value.modes}) {
    const double before = mean_assurance(study.data(), *modes);
    for (Index sensor = 0; sensor < modes->shapes.rows() && modes->shapes.rows() > 2; ++sensor) {
      ModalData data = study.data();
      for (MeasuredMode& mode : data.modes)
        if (mode.shape.size() > 1) mode.shape[sensor] = -mode.shape[sensor];
      const double after = mean_assurance(data, *modes);
      if (after > 0.8 && after - before > best_gain) best_gain = after - before, turned = sensor;
    }
  }
  if (turned >= 0)
    warnings.push_back(
        fmt::format("With the sign of sensor {} turned round the shapes are much nearer to the "
                    "predicted ones (mean MAC {:+.2f}): is it mounted the other way?",
                    turned + 1, best_gain));
}

// All parameters by one factor: what is wrong is elsewhere.
void add_common_factor(const UpdateStudy& study, std::vector<std::string>& warnings) {
  const VectorXd& x = study.updating.best().fit.x;
  if (x.size() < 2 || !study.updating.open.empty()) return;
  for (Index j = 0; j < x.size(); ++j)
    if (!study.space->logarithmic(j)) return;
  const LogRatios factor = mean_and_spread(x);
  if (std::abs(factor.mean) < 0.35 || factor.spread > 0.3 * std::abs(factor.mean)) return;
  warnings.push_back(
      fmt::format("All parameters changed alike, by a factor of {:.3g} in the mean: a mass or a "
                  "unit that is wrong does that, too. Frequencies know only the ratio of "
                  "stiffness to mass.",
                  std::exp(factor.mean)));
}

void add_strange_shapes(const UpdateStudy& study, std::vector<std::string>& warnings) {
  const auto& value = study.updating.best().fit.value;
  const MatrixXd assurance = modal_assurances(study.data(), value.modes);
  for (std::size_t i = 0; i < value.pairs.size(); ++i)
    if (const double mac = assurance(static_cast<Index>(i), value.pairs[i]); mac < 0.8)
      warnings.push_back(fmt::format("The shape at {:.4g} Hz resembles no predicted one: MAC {:.2f} at best.",
                                     study.data().modes[i].frequency_hz, mac));
}

// Where two modes are nearly one frequency a test measures any two shapes of their plane. Within 1 % shapes
// are held against the plane, beyond it one against one: near that border the estimate hangs on where it
// lies.
void add_close_pairs(const UpdateStudy& study, std::vector<std::string>& warnings) {
  constexpr double nearest = 0.005, farthest = 0.02;
  std::vector<double> frequencies;
  for (const MeasuredMode& mode : study.data().modes)
    if (mode.shape.size() > 1) frequencies.push_back(mode.frequency_hz);
  std::sort(frequencies.begin(), frequencies.end());
  for (std::size_t i = 1; i < frequencies.size(); ++i) {
    const double gap = frequencies[i] / frequencies[i - 1] - 1.0;
    if (gap < nearest || gap > farthest) continue;
    warnings.push_back(fmt::format(
        "The modes at {:.5g} and {:.5g} Hz are so close that a test may have mixed their shapes. What rests "
        "on which is which, x and y exchanged for one, may be wrong by more than its interval: do the "
        "estimates "
        "stay without these two shapes?",
        frequencies[i - 1], frequencies[i]));
  }
}

}  // namespace

std::vector<std::string> update_warnings(const UpdateStudy& study) {
  std::vector<std::string> warnings;
  for (const std::string& warning : study.data().warnings)
    warnings.push_back("beamid modal warned of these modes: " + warning);
  for (const Remedy& remedy : study.remedies) warnings.push_back(remedy.sentence);
  add_units(study, warnings);
  add_missing(study, warnings);
  add_signs(study, warnings);
  add_common_factor(study, warnings);
  add_strange_shapes(study, warnings);
  add_close_pairs(study, warnings);
  return warnings;
}

}  // namespace beamid::experiments
