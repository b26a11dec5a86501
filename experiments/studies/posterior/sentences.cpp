#include <fmt/format.h>

#include <cmath>

#include "experiments/studies/posterior/report.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

constexpr double hardly_narrower = 0.7, often_at_the_edge = 0.1;

std::string hump_shares(const Posterior& posterior) {
  std::string text;
  constexpr std::size_t most = 6;
  for (std::size_t h = 0; h < std::min(posterior.share.size(), most); ++h)
    text += fmt::format("{}{:.3g}",
                        h == 0                                             ? ""
                        : h + 1 == posterior.share.size() || h + 1 == most ? " and "
                                                                           : ", ",
                        100.0 * posterior.share[h]);
  return text + " %";
}

}  // namespace

std::string posterior_verdict(const PosteriorStudy& study) {
  const Posterior& posterior = study.posterior;
  const std::vector<std::string> complaints = posterior.complaints();
  std::string text = "Not converged: ";
  for (std::size_t i = 0; i < complaints.size(); ++i) text += (i > 0 ? "; " : "") + complaints[i];
  text += ".";
  if (complaints.empty())
    text = fmt::format("Converged: {} draws worth at least {:.0f} independent ones, R-hat at most {:.3f}.",
                       posterior.draws(), posterior.fewest_effective(), posterior.worst_r_hat());
  const std::size_t humps = posterior.humps.size(), notable = posterior.notable_humps();
  if (humps == 1)
    text +=
        posterior.humps_are_uncertain() ? " One hump was found; others may have been missed." : " One hump.";
  else if (notable < 2)
    text +=
        fmt::format(" One hump holds {:.4g} % of the probability; {} more, of next to none, in the table.",
                    100.0 * posterior.share[0], humps - 1);
  else
    text += fmt::format(
        " {} separate humps hold {} of the probability: one estimate with one interval would mislead.", humps,
        hump_shares(posterior));
  const auto [least, most] = study.laplace_ratio();
  return text + fmt::format(" Laplace's standard deviations are {:.2f} to {:.2f} times those sampled{}.",
                            least, most, humps > 1 ? " in the first" : "");
}

std::vector<Objection> prior_objections(const PosteriorStudy& study) {
  std::vector<Objection> objections;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const Unknown& unknown = study.unknowns()[j];
    const PosteriorParameter& one = study.parameters[j];
    if (one.cut_at)
      objections.emplace_back(
          "at_bound",
          fmt::format("{}: the draws pile up at its stated bound of {:.5g}{}{}, which decides its interval "
                      "and moves those of the others.",
                      unknown.name, *one.cut_at, unknown.unit.empty() ? "" : " ", unknown.unit));
    else if (one.in_tail)
      objections.emplace_back(
          "prior_tail",
          fmt::format(
              "{}: most draws lie where its prior has 0.1 % of its probability ({}): prior and measurement "
              "contradict each other, and the interval lies between the two.",
              unknown.name, study.likelihood->priors()[j].text()));
  }
  return objections;
}

std::vector<std::string> posterior_sentences(const PosteriorStudy& study) {
  std::vector<std::string> sentences;
  const Posterior& posterior = study.posterior;
  std::vector<std::string> assumed;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const std::string& name = study.unknowns()[j].name;
    const bool is_assumed = study.likelihood->priors()[j].assumed();
    const PosteriorParameter& one = study.parameters[j];
    if (is_assumed) assumed.push_back(name);
    if (one.share_of_prior > hardly_narrower && posterior.humps.size() == 1)
      sentences.push_back(
          fmt::format("{}: only little narrower than its {} prior, which these numbers repeat.", name,
                      is_assumed ? "assumed" : "stated"));
    else if (is_assumed && one.beyond > often_at_the_edge)
      sentences.push_back(
          fmt::format("{} reaches the edge of its assumed prior in {:.0f} % of the draws: state one.", name,
                      100.0 * one.beyond));
  }
  if (!assumed.empty())
    sentences.push_back(fmt::format(
        "No prior is stated of {}: log-uniform within a factor of {:.0f} of the initial estimate is "
        "assumed. [[parameters]] states one: bounds, or a standard deviation.",
        joined(assumed), PriorLaw::assumed_factor));
  const ImportanceSample& importance = posterior.importance;
  sentences.push_back(
      importance.poor()
          ? fmt::format("Evidence: {:.2f} nat, by tempering.", posterior.tempered.log_evidence)
          : fmt::format("Evidence: {:.3f} +- {:.3f} nat by importance sampling, {:.2f} by tempering.",
                        importance.log_evidence, importance.standard_error, posterior.tempered.log_evidence));
  return sentences;
}

}  // namespace beamid::experiments
