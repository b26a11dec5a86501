#include "experiments/identify/model_check/contradictions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/model_check/explanation.hpp"
#include "experiments/signal/chi_square_limit.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

double apart(double a, double b) {
  return std::abs(std::log(a / b));
}

/// The matched mode that a stray stands in the place of: nearest, within a factor of 2, in none of the
/// stray's own records.
const CheckedMode* in_place_of(const ObservedMode& stray, const std::vector<CheckedMode>& matched) {
  const CheckedMode* best = nullptr;
  for (const CheckedMode& mode : matched)
    if (!best || apart(stray.frequency_hz, mode.predicted_hz) < apart(stray.frequency_hz, best->predicted_hz))
      best = &mode;
  if (!best || apart(stray.frequency_hz, best->identified.frequency_hz) > std::log(2.0)) return nullptr;
  const auto& own = stray.records;
  const auto& others = best->identified.records;
  const bool shared = std::any_of(own.begin(), own.end(), [&](const std::string& record) {
    return std::find(others.begin(), others.end(), record) != others.end();
  });
  return shared || own.empty() || others.empty() ? nullptr : best;
}

bool explains(const Explanation& e) {
  return e.verdict == Explanation::Verdict::explains;
}

/// Whose prediction a frequency meets within 3 %; empty: nobody's.
std::string predicted_by(double frequency_hz, const ModelCheck& check, std::size_t self) {
  constexpr double near = 0.03;
  for (const CheckedMode& mode : check.modes)
    if (mode.structure != self && apart(frequency_hz, mode.predicted_hz) < near)
      return fmt::format("; {} predicts {:.4g} Hz, so the records may have been exchanged",
                         check.structures[mode.structure].name, mode.predicted_hz);
  return "";
}

}  // namespace

std::vector<std::string> contradictions_of(const std::vector<CheckedMode>& matched,
                                           std::vector<ObservedMode>& strays) {
  std::vector<std::string> sentences;
  std::erase_if(strays, [&](const ObservedMode& stray) {
    const CheckedMode* mode = in_place_of(stray, matched);
    if (!mode) return false;
    const ObservedMode *few = &stray, *many = &mode->identified;
    if (few->records.size() > many->records.size()) std::swap(few, many);
    sentences.push_back(fmt::format(
        "{} contradict{} {}: mode {} at {:.4g} Hz against {:.4g} Hz. One structure has it at one of them: "
        "another one, another mass or another clamping was recorded.",
        joined(few->records), few->records.size() > 1 ? "" : "s", joined(many->records), mode->number,
        few->frequency_hz, many->frequency_hz));
    return true;
  });
  return sentences;
}

void set_far_structures_aside(ModelCheck& check) {
  std::vector<std::size_t> far, near;
  for (std::size_t s = 0; s < check.structures.size(); ++s) {
    const auto off = [&](const CheckedMode& mode) { return mode.structure == s && mode.far; };
    const auto own = [&](const CheckedMode& mode) { return mode.structure == s; };
    if (std::any_of(check.modes.begin(), check.modes.end(), off))
      far.push_back(s);
    else if (std::any_of(check.modes.begin(), check.modes.end(), own))
      near.push_back(s);
  }
  if (far.empty() || far.size() >= near.size()) return;
  for (const CheckedMode& mode : check.modes)
    if (mode.far)
      check.contradictions.push_back(fmt::format(
          "{} contradicts the others and is left out: mode {} predicted at {:.4g} Hz and found at {:.4g} "
          "Hz{}.",
          check.structures[mode.structure].name, mode.number, mode.predicted_hz, mode.identified.frequency_hz,
          predicted_by(mode.identified.frequency_hz, check, mode.structure)));
  std::erase_if(check.modes, [&](const CheckedMode& mode) {
    return std::find(far.begin(), far.end(), mode.structure) != far.end();
  });
}

std::optional<Outlier> outlier_of(const ModelCheck& check) {
  if (check.right || check.structures.size() < 3 ||
      std::any_of(check.single.begin(), check.single.end(), explains))
    return std::nullopt;
  std::optional<Outlier> only;
  for (std::size_t s = 0; s < check.structures.size(); ++s) {
    ModelCheck others = check;
    std::erase_if(others.modes, [&](const CheckedMode& mode) { return mode.structure == s; });
    if (others.modes.size() == check.modes.size() || others.modes.size() < 2) continue;
    const auto [chi_square, numbers] = described_fit(others);
    const bool right = chi_square <= chi_square_limit(static_cast<double>(numbers));
    std::optional<Explanation> best;
    for (std::size_t c = 0; !right && c < check.candidates.size(); ++c) {
      const Explanation one = explain(others, {c});
      if (explains(one) && (!best || one.chi_square < best->chi_square)) best = one;
    }
    if (!right && !best) continue;
    if (only) return std::nullopt;
    only = Outlier{s, best};
  }
  return only;
}

}  // namespace beamid::experiments
