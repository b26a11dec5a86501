#include "experiments/identify/model_check/matching.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/identify/model_check/contradictions.hpp"
#include "experiments/identify/model_check/shared_residual.hpp"
#include "experiments/identify/update/mode_pairing.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double farthest = std::numbers::ln2;  // of the lowest mode, where nothing is nearer: a factor of 2
constexpr double least_alike = 0.5;             // MAC
constexpr double impossible = -1e3, certainly = 1e3;
constexpr Index most_checked_modes = 15;

double ln_apart(double identified, double predicted) {
  return std::abs(std::log(identified / predicted));
}

Index first_vibrating(const VectorXd& frequency) {
  Index rigid = 0;
  while (rigid < frequency.size() && frequency[rigid] == 0.0) ++rigid;
  return rigid;
}

/// Taken for the lowest mode although it is beyond 30 %.
bool is_far_match(const ObservedMode& mode, const VectorXd& predicted, Index k) {
  const double apart = ln_apart(mode.frequency_hz, predicted[k]);
  return k == first_vibrating(predicted) && apart >= most_apart && apart < farthest &&
         (k + 1 >= predicted.size() || ln_apart(mode.frequency_hz, predicted[k + 1]) > 2 * apart);
}

/// Scores of update as far as modes are near enough, then one column for each mode that stays alone.
MatrixXd matching_scores(const CheckedStructure& structure, const PredictedModes& predicted,
                         const ModalData& data, const MatrixXd& assurances) {
  const auto count = static_cast<Index>(structure.modes.size()), known = predicted.frequency_hz.size();
  MatrixXd scores = MatrixXd::Constant(count, known + count, -most_apart);
  scores.leftCols(known) = pairing_scores(data, predicted, assurances);
  for (Index i = 0; i < count; ++i)
    for (Index k = 0; k < known; ++k) {
      const ObservedMode& mode = structure.modes[static_cast<std::size_t>(i)];
      const bool near = ln_apart(mode.frequency_hz, predicted.frequency_hz[k]) < most_apart,
                 far = is_far_match(mode, predicted.frequency_hz, k);
      if (mode.number)
        scores(i, k) = *mode.number == k + 1 ? certainly : impossible;
      else if (predicted.frequency_hz[k] == 0.0 || !(near || far) || assurances(i, k) < least_alike)
        scores(i, k) = impossible;
      else if (far)
        scores(i, k) = -0.99 * most_apart;
    }
  return scores;
}

}  // namespace

void match_modes(const CheckedStructure& structure, std::size_t number, ModelCheck& check) {
  const std::vector<fem::Point> points = points_of_shapes(structure);
  Index last = most_checked_modes;
  ModalData data{structure.name, {}};
  for (const ObservedMode& mode : structure.modes) {
    data.modes.push_back(as_measured(mode, points.size(), mode.number));
    last = std::max<Index>(last, mode.number.value_or(0));
  }
  const CauseModel model(structure.structure, structure.elements, points, {}, last);
  for (const ObservedMode& mode : structure.modes)
    if (mode.number && *mode.number > model.modes())
      throw std::invalid_argument("mode " + std::to_string(*mode.number) + " of a structure that has " +
                                  std::to_string(model.modes()) + "; expected no more than it has");
  const PredictedModes predicted = model.at(VectorXd(), false);
  const VectorXd& frequency = predicted.frequency_hz;
  const VectorXd damping = std::holds_alternative<fem::Undamped>(structure.damping)
                               ? VectorXd::Constant(frequency.size(), CheckedMode::unknown)
                               : fem::damping_ratios(structure.damping, 2.0 * std::numbers::pi * frequency);
  const MatrixXd assurances = modal_assurances(data, predicted);
  const std::vector<Index> pairs = best_assignment(matching_scores(structure, predicted, data, assurances));
  std::vector<CheckedMode> found;
  std::vector<ObservedMode> strays;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Index k = pairs[i];
    const ObservedMode& mode = structure.modes[i];
    if (k < frequency.size())
      found.push_back({number, static_cast<int>(k) + 1, frequency[k], damping[k], mode,
                       assurances(static_cast<Index>(i), k), is_far_match(mode, frequency, k)});
    else
      strays.push_back(mode);
  }
  std::sort(found.begin(), found.end(),
            [](const CheckedMode& a, const CheckedMode& b) { return a.number < b.number; });
  check.modes.insert(check.modes.end(), found.begin(), found.end());
  std::vector<std::string> sentences = contradictions_of(found, strays);
  check.contradictions.insert(check.contradictions.end(), sentences.begin(), sentences.end());
  for (ObservedMode& stray : strays) check.strays.emplace_back(number, std::move(stray));
}

}  // namespace beamid::experiments
