#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/engine/measured_force.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/studies/update/report.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

std::string numbers_text(const Updating& updating) {
  const double chi_square = updating.best().fit.chi_square();
  if (updating.freedom == 0)
    return chi_square < 1e-6
               ? "as many parameters as numbers measured, which are met exactly"
               : fmt::format("chi^2 = {:.3g} with as many parameters as numbers measured", chi_square);
  return fmt::format(
      "chi^2 = {:.3g} for {} numbers measured and {} parameters determined; the 95 % limit is {:.3g}",
      chi_square, updating.independent, updating.independent - updating.freedom, updating.limit);
}

std::vector<std::string> undetermined(const UpdateStudy& study) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j)
    if (!study.updating.parameters[j].determined) names.push_back(study.unknowns()[j].name);
  return names;
}

}  // namespace

std::string sets_text(const Updating& updating) {
  const std::size_t sets = updating.as_well();
  const auto exact = static_cast<std::size_t>(
      std::count_if(updating.sets.begin(), updating.sets.end(),
                    [](const ParameterSet& set) { return set.fit.chi_square() < 1e-6; }));
  if (exact == 0 || exact == sets)
    return fmt::format("{} sets of parameters explain these modes equally well", sets);
  return fmt::format(
      "{} of parameters meet{} these modes exactly and {} more within their standard deviations",
      exact == 1 ? "One set" : fmt::format("{} sets", exact), exact == 1 ? "s" : "", sets - exact);
}

std::pair<std::string, bool> update_verdict(const UpdateStudy& study) {
  const Updating& updating = study.updating;
  const std::string numbers = numbers_text(updating);
  if (updating.refuted)
    return {"No values of these parameters explain the modes: " + numbers +
                ". Something other than the parameters requested is wrong, or the modes are.",
            false};
  if (!updating.open.empty()) {
    const auto names = undetermined(study);
    return {fmt::format("{} of {} parameters {} not determined by these modes: {}.{}", names.size(),
                        study.unknowns().size(), names.size() == 1 ? "is" : "are", joined(names),
                        updating.as_well() > 1 ? " Besides, " + sets_text(updating) + "." : ""),
            false};
  }
  if (updating.as_well() > 1)
    return {sets_text(updating) + ", and the modes cannot show which is true: " + numbers + ".", false};
  if (!updating.explains())
    return {"These parameters explain the modes poorly: " + numbers +
                ", which chance alone exceeds once in 20 times.",
            false};
  if (study.twins.method == TwinSearch::Method::all_solutions && !study.complete())
    return {fmt::format("One set of parameters explains the modes, as far as was found: {}.", numbers), true};
  if (study.twins.method != TwinSearch::Method::all_solutions && starts_say_little(updating))
    return {
        fmt::format("One set of parameters explains the modes, as far as so few starts can show ({}): {}.",
                    updating.starts, numbers),
        true};
  return {fmt::format("One set of parameters explains the modes: {}.{}", numbers,
                      updating.freedom > 0 ? "" : " No number remains to contradict a wrong mode or sensor."),
          true};
}

std::string direction_text(const UpdateStudy& study, const OpenDirection& direction) {
  Index largest = 0;
  const double scale = direction.weights.cwiseAbs().maxCoeff(&largest);
  std::string text;
  int shown = 0, left = 0;
  for (Index j = 0; j < direction.weights.size(); ++j) {
    const double share = direction.weights[j] / scale;
    if (std::abs(share) < 0.05) continue;
    if (++shown > 5) {
      ++left;
      continue;
    }
    text += fmt::format("{}{} {} by {:.2g} %", text.empty() ? "" : ", ",
                        study.unknowns()[static_cast<std::size_t>(j)].name, share > 0 ? "up" : "down",
                        std::abs(share));
  }
  if (left > 0) text += fmt::format(" and {} more", left);
  return text;
}

std::string completeness_text(const UpdateStudy& study) {
  const TwinSearch& twins = study.twins;
  if (twins.method == TwinSearch::Method::all_solutions)
    return twins.complete()
               ? fmt::format(
                     "Proven complete: the equations have {} solutions in complex numbers, all of which were "
                     "found, {} of them with positive values.",
                     twins.complex_solutions, twins.values.size())
               : fmt::format(
                     "Not proven complete: {} of the {} complex solutions were found and distinguished; some "
                     "lie together or too near each other.",
                     twins.found, twins.complex_solutions);
  const std::size_t starts = study.updating.starts;
  const std::string searched =
      fmt::format("Not proven complete, since {}: found by searches from {} start{}.", twins.reason, starts,
                  starts == 1 ? "" : "s");
  if (starts_say_little(study.updating))
    return searched +
           " So few show no other sets: nearly each of them ended at a place of its own. Request more by "
           "--starts.";
  return searched + fmt::format(
                        " The chance that one more start ends elsewhere is about {:.2g} % (sets that "
                        "one start alone found).",
                        100.0 * unseen_probability(study.updating));
}

std::string deciding_text(const DecidingMeasurement& one) {
  const auto [least, most] = std::minmax_element(one.predicted.begin(), one.predicted.end());
  switch (one.kind) {
    case DecidingMeasurement::Kind::shape_ratio:
      return fmt::format("motion at {} over that at {} in mode {}: {:.3g} to {:.3g}", one.place,
                         one.reference, one.mode, *least, *most);
    case DecidingMeasurement::Kind::frequency:
      return fmt::format("frequency of mode {}: {:.4g} to {:.4g} Hz", one.mode, *least, *most);
    case DecidingMeasurement::Kind::added_mass:
      return fmt::format("the frequencies with {:.3g} kg added at {}; mode {}: {:.4g} to {:.4g} Hz", one.mass,
                         one.place, one.mode, *least, *most);
    case DecidingMeasurement::Kind::parameter:
      return fmt::format("{} weighed: {:.4g} to {:.4g} kg", one.parameter, *least, *most);
  }
  return "";
}

std::string twins_warning(const Experiment& experiment) {
  constexpr std::size_t most = 6;  // under a second
  constexpr ModelTrust exactly{0.0005, 0.03};
  constexpr int few_starts = 40;
  const auto asked =
      std::count_if(experiment.parameters.begin(), experiment.parameters.end(),
                    [](const ParameterChoice& choice) { return is_stiffness(choice.quantity); });
  if (asked < 2 || asked > static_cast<std::ptrdiff_t>(most)) return {};
  try {
    if (fem::assemble(experiment.structure, experiment.elements).size() > static_cast<Index>(most)) return {};
    const UpdateStudy study = study_update(experiment, described_modes(experiment), {exactly, few_starts});
    if (study.updating.as_well() < 2) return {};
    return fmt::format(
        "Not unique by frequencies alone: {}, those of the structure as described ('beamid twins --config "
        "FILE' lists them). An estimate near another set has small intervals, too. Sensors that distinguish "
        "the shapes decide, or initial estimates that are near.",
        sets_text(study.updating));
  } catch (const std::exception&) {  // the command itself says what is wrong
    return {};
  }
}

std::string described_text() {
  return "All that is not requested counts as described, exactly. Frequencies and shapes determine only the "
         "ratio of stiffness to mass: " +
         std::string(of_unweighed_masses);
}

std::vector<std::string> update_sentences(const UpdateStudy& study) {
  const Updating& updating = study.updating;
  std::vector<std::string> sentences;
  if (!updating.explains())
    sentences.push_back(
        fmt::format("The residual counts as noise: intervals are widened by {:.3g}.", updating.widening));
  for (const OpenDirection& open : updating.open)
    sentences.push_back(
        std::isinf(open.deviation)
            ? fmt::format("No measured number changes with {}.", direction_text(study, open))
            : fmt::format("Almost no measured number changes with {}: known to a factor of {:.2g} only.",
                          direction_text(study, open),
                          std::exp(quantile_95 * std::min(open.deviation, 100.0))));
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const std::string& name = study.unknowns()[j].name;
    if (updating.parameters[j].on_bound)
      sentences.push_back(name +
                          " lies on its bound: its interval ends there, and those of all hold only if the "
                          "bound does.");
    if (updating.parameters[j].at_search_limit)
      sentences.push_back(
          name + " ran away, beyond a factor of 1e4 from its initial estimate: no measurement holds it.");
  }
  if (std::count(study.model->asked().has_prior.begin(), study.model->asked().has_prior.end(), true) > 0)
    sentences.emplace_back(
        "The standard deviations stated in [[parameters]] count as measurements (priors).");
  if (!study.model->asked().left_out.empty())
    sentences.push_back("Omitted, since frequencies and shapes depend little on damping: " +
                        joined(study.model->asked().left_out) + ".");
  return sentences;
}

}  // namespace beamid::experiments
