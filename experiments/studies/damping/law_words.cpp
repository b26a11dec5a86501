
#include "experiments/studies/damping/report.hpp"

#include <fmt/format.h>

#include <cmath>

namespace beamid::experiments {
namespace {

// How large a difference of BIC is, in the words of [kass1995].
const char* strength(double difference) {
  return difference > 10.0  ? "very strong"
         : difference > 6.0 ? "strong"
         : difference > 2.0 ? "positive"
                            : "almost no";
}

}  // namespace

const char* law_title(const std::string& law) {
  return law == "viscous"     ? "viscous"
         : law == "coulomb"   ? "viscous and Coulomb"
         : law == "quadratic" ? "viscous and quadratic"
                              : "viscous, Coulomb and quadratic";
}

std::string law_verdict(const DampingLawStudy& study) {
  const FittedLaw& best = study.supported();
  if (study.named)
    return fmt::format("As specified: {} damping{}.", law_title(best.name),
                       best.possible ? "" : ", which this record does not support: " + best.reason);
  if (!best.possible) return "The record determines none of the laws: " + best.reason + ".";
  double second = std::nan("");
  std::string other;
  for (const FittedLaw& law : study.laws)
    if (&law != &best && law.possible && !(law.bic - best.bic > second)) {
      second = law.bic - best.bic;
      other = law_title(law.name);
    }
  constexpr double hardly = 2.0;  // of BIC
  std::string text = fmt::format("The record {} {} damping", second < hardly ? "leans to" : "supports",
                                 law_title(best.name));
  if (std::isfinite(second))
    text +=
        fmt::format(": {} evidence against {}, whose BIC is {:.1f} higher", strength(second), other, second);
  text += ".";
  for (const FittedLaw& law : study.laws) {
    if (law.possible || law.state.size() == 0 || law.bic > best.bic - hardly) continue;
    text += fmt::format(
        " Likelier, but impossible, is {} damping (BIC {:.1f} lower; {}): the true law is none of these, and "
        "the estimates are those of the nearest.",
        law_title(law.name), best.bic - law.bic, law.reason);
    break;
  }
  if (best.name == "viscous")
    text += " Neither friction nor quadratic damping makes the record likely enough to pay for itself.";
  text += fmt::format(
      " From {:.3g} to {:.3g} mm the damping ratio goes from {:.5f} to {:.5f} and the frequency from {:.4f} "
      "to {:.4f} Hz.",
      1e3 * study.first_amplitude, 1e3 * study.last_amplitude, best.damping_ratio(study.first_amplitude),
      best.damping_ratio(study.last_amplitude), best.frequency_hz(study.first_amplitude),
      best.frequency_hz(study.last_amplitude));
  return text;
}

// Whether the best of the laws is good enough.
std::string law_fit_words(const DampingLawStudy& study) {
  const LawMisfit& misfit = study.misfit;
  if (!misfit.tested)
    return fmt::format(
        "Whether any of these laws fits cannot be tested: {} section{} of the decay that share no sample, "
        "too few for a law of {} unknowns.",
        misfit.sections, misfit.sections == 1 ? "" : "s", study.supported().model.unknowns.size());
  const std::string size = fmt::format(
      "chi^2 {:.3g} of {} degrees of freedom in {} sections of the decay, the damping ratio {:+.2g} % off at "
      "{:.3g} mm",
      misfit.chi_square, misfit.freedom, misfit.sections, 100.0 * misfit.largest, 1e3 * misfit.at_amplitude);
  if (!misfit.lacks) return "The law fits sections of the decay: " + size + " at most.";
  return fmt::format(
      "Lack of fit: {} damping does not describe this decay ({}). It is the nearest of these laws. Its "
      "intervals are {:.2g} times too narrow for the residual. No conclusion follows from it beyond {:.3g} "
      "to {:.3g} mm.",
      law_title(study.supported().name), size,
      std::sqrt(misfit.chi_square / static_cast<double>(misfit.freedom)), 1e3 * study.last_amplitude,
      1e3 * study.first_amplitude);
}

std::string law_words(const DampingLawStudy& study) {
  return study.misfit.lacks ? law_fit_words(study) + " " + law_verdict(study)
                            : law_verdict(study) + " " + law_fit_words(study);
}

}  // namespace beamid::experiments
