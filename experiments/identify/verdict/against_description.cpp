#include "experiments/identify/verdict/run_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "experiments/identify/engine/measured_force.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

constexpr double far_from_prior = 4.0;  // of its standard deviations

bool states_a_prior(const Estimate& e) {
  const bool damping = e.name.find("damping") != std::string::npos;
  return std::isfinite(e.value) && e.prior_deviation > 0.0 &&
         !(damping && e.prior_deviation >= std::abs(e.prior_value));
}

// Whether a force's unit multiplies it: kg, N/m, N s/m, N m2, ...
bool weighs(const Estimate& e) {
  return e.unit.starts_with("kg");
}
bool has_force(const Estimate& e) {
  return weighs(e) || e.unit.starts_with("N");
}

struct CommonFactor {
  double factor = 1.0;     // negative where all signs are turned
  double deviation = 0.0;  // of its logarithm
  double log_apart = 0.0;  // largest |r_j - g|
  bool common = false;     // within the intervals
  std::vector<std::string> names;

  double size() const { return std::abs(std::log(std::abs(factor))); }
};

CommonFactor common_factor(const std::vector<ComparedParameter>& parameters) {
  constexpr double point = 0.999;
  CommonFactor found;
  std::vector<double> logs, weights;
  int turned = 0, masses = 0;
  for (const ComparedParameter& p : parameters) {
    const Estimate& e = p.estimate;
    if (!has_force(e) || !states_a_prior(e) || e.prior_value == 0.0 || e.value == 0.0) continue;
    const double ratio = e.value / e.prior_value;
    logs.push_back(std::log(std::abs(ratio)));
    weights.push_back(1.0 /
                      (std::pow(e.prior_deviation / e.prior_value, 2) + std::pow(e.deviation / e.value, 2)));
    found.names.push_back(e.name);
    turned += ratio < 0.0 ? 1 : 0;
    masses += weighs(e) ? 1 : 0;
  }
  const auto count = static_cast<int>(logs.size());
  if (masses == 0 || masses == count || (turned != 0 && turned != count)) return found;
  const double whole = std::accumulate(weights.begin(), weights.end(), 0.0),
               g = std::inner_product(logs.begin(), logs.end(), weights.begin(), 0.0) / whole;
  double squares = 0.0;
  for (std::size_t j = 0; j < logs.size(); ++j) {
    squares += weights[j] * (logs[j] - g) * (logs[j] - g);
    found.log_apart = std::max(found.log_apart, std::abs(logs[j] - g));
  }
  found.common = squares < chi_square_limit(count - 1, point);
  found.factor = (turned > 0 ? -1.0 : 1.0) * std::exp(g);
  found.deviation = 1.0 / std::sqrt(whole);
  return found;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

// Whether all are further from the description together than from each other, by far.
bool is_no_coincidence(const CommonFactor& found, const std::vector<ComparedParameter>& parameters) {
  constexpr double noteworthy = 1.5, together = 0.1;
  const bool known = std::all_of(parameters.begin(), parameters.end(), [&](const ComparedParameter& p) {
    const Estimate& e = p.estimate;
    return !has_force(e) || !states_a_prior(e) || e.deviation < together * found.size() * std::abs(e.value);
  });
  return known && found.size() > noteworthy * found.deviation && found.log_apart < together * found.size();
}

std::string scale_text(const CommonFactor& found, bool contradicts) {
  return fmt::format(
      "{} come out {:.4g} times as large as described{}{}: the measured force's unit, gain or sign is the "
      "likely cause, or the motion's. A force read {:.4g} times too large does this, and the record itself "
      "cannot show it; {} are wrong by that factor then, while frequency and damping ratio are not. Check "
      "[record], or {}",
      listed(found.names), found.factor,
      found.factor < 0.0 ? ", the force or the motion with its sign turned"
                         : usual_scale(found.factor, std::min(3.0 * found.deviation, 0.1), true),
      contradicts ? fmt::format(", {:.2g} prior standard deviations", found.size() / found.deviation) : "",
      found.factor, found.names.size() == 2 ? "both" : "all",
      contradicts ? "describe the structure with the masses that it has" : "weigh the structure");
}

std::string prior_text(const Estimate& e, double deviations) {
  const double ratio = e.value / e.prior_value;
  return fmt::format(
      "{} comes out as {:.5g}{}{}, {:.2g} standard deviations from the prior, {:.5g} +- {:.2g}{}: prior and "
      "record exclude each other. A wrong unit, gain, place or description does this to estimates; check "
      "them, or state a larger standard deviation.",
      e.name, e.value, e.unit.empty() ? "" : " ", e.unit, deviations, e.prior_value, e.prior_deviation,
      std::isfinite(ratio) && e.prior_value != 0.0 ? fmt::format(" ({:.3g} times)", ratio) : "");
}

// In the coordinate that a filter's state carries.
double deviations_from_prior(const Unknown& unknown, const Estimate& e) {
  const double prior = unknown.to_state(e.prior_value);
  return std::abs(unknown.to_state(e.value) - prior) * std::abs(unknown.slope(prior)) / e.prior_deviation;
}

}  // namespace

std::string usual_scale(double factor, double near, bool by_force) {
  struct Usual {
    double factor;
    const char* number;
    const char* of_force;
    const char* of_motion;  // empty: of a force alone
  };
  for (const auto& [usual, number, of_force, of_motion] :
       {Usual{9.80665, "9.80665", "a force in N taken for kgf", "an acceleration in g taken for m/s2"},
        Usual{1.0 / 9.80665, "1 / 9.80665", "a force in kgf taken for N",
              "an acceleration in m/s2 taken for g"},
        Usual{4.44822, "4.448", "a force in N taken for pounds-force", ""},
        Usual{1.0 / 4.44822, "1 / 4.448", "a force in pounds-force taken for N", ""},
        Usual{1000.0, "1000", "a force in N taken for kN", "a motion in m taken for mm"},
        Usual{0.001, "0.001", "a force in kN taken for N", "a motion in mm taken for m"}}) {
    if (std::abs(std::log(factor / usual)) >= near) continue;
    if (!by_force) return *of_motion ? fmt::format(", as with {}, {}", number, of_motion) : "";
    return fmt::format(", as with {}, {}{}{}", number, of_force, *of_motion ? " or " : "", of_motion);
  }
  return {};
}

AgainstDescription against_description(const std::vector<ComparedParameter>& parameters, bool by_force,
                                       const std::vector<Unknown>& unknowns) {
  AgainstDescription found;
  const CommonFactor scale = by_force ? common_factor(parameters) : CommonFactor{};
  found.contradicts = scale.common && (scale.factor < 0.0 || scale.size() > far_from_prior * scale.deviation);
  if (found.contradicts || (scale.common && is_no_coincidence(scale, parameters)))
    found.scale = scale_text(scale, found.contradicts);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const Estimate& e = parameters[j].estimate;
    const double deviations = unknowns.empty() ? std::abs(e.value - e.prior_value) / e.prior_deviation
                                               : deviations_from_prior(unknowns[j], e);
    if (states_a_prior(e) && deviations > far_from_prior && !(found.contradicts && has_force(e)))
      found.differences.push_back(prior_text(e, deviations));
  }
  return found;
}

void judge_description(const RunContext& context, ComparedRun& run) {
  const AgainstDescription found =
      against_description(run.parameters, measures_force(context.analysis.record), run.unknowns);
  for (const std::string& text : found.differences) run.objections.emplace_back("prior", text);
  if (found.scale.empty()) return;
  if (!found.contradicts) {
    run.objections.emplace_back("prior", found.scale + ".");
    return;
  }
  run.object({"prior", "CONTRADICTED: " + found.scale + "."});
  if (!run.answers()) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = found.scale;
}

}  // namespace beamid::experiments
