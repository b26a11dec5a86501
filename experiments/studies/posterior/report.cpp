#include "experiments/studies/posterior/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/identify/engine/measured_force.hpp"
#include "experiments/studies/sensing/report.hpp"
#include "experiments/studies/update/report.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

void add_mode_warnings(const PosteriorStudy& study, Results& results) {
  if (!study.explains())
    results.warning(update_verdict(*study.update).first +
                    " The posterior takes their standard deviations as they are: it is too narrow.");
  for (const Objection& one : study.update->objections) results.object(one);
}

nlohmann::ordered_json record_configuration(const Experiment& experiment, const PosteriorStudy& study) {
  nlohmann::ordered_json json = describe(experiment);
  json["reduction"] = study.source->sensing.reduction;
  return json;
}

// Frequencies, and motion that no measured force drives, show stiffness over mass alone.
std::string mass_sentence(const Experiment& experiment, const PosteriorStudy& study) {
  for (const ParameterChoice& one : experiment.parameters)
    if (one.quantity.find("mass") != std::string::npos || one.quantity == "factor") return "";
  if (study.source && measures_force(study.source->record.record)) return "";
  return (study.source ? "No force was measured: "
                       : "Frequencies determine the ratio of stiffness to mass alone: ") +
         std::string(of_unweighed_masses);
}

}  // namespace

Results posterior_report(const Experiment& experiment, const PosteriorStudy& study) {
  Results results;
  results.command = "posterior";
  results.seed = study.settings.seed;
  results.configuration = study.update ? update_configuration(experiment, *study.update)
                                       : record_configuration(experiment, study);
  results.configuration["chains"] = study.settings.chains.chains;
  results.configuration["draws"] = study.settings.chains.draws;
  results.configuration["particles"] = study.settings.particles;
  results.values = posterior_values(study);
  if (study.source) results.paragraph(sensing_sentence(study.source->sensing, "The record"));
  const bool converged = study.posterior.complaints().empty();
  if (converged && study.explains() && study.posterior.notable_humps() == 1)
    results.paragraph(posterior_verdict(study));
  else
    results.warning(posterior_verdict(study), study.posterior.disagrees() || study.contradicted());
  if (study.update)
    add_mode_warnings(study, results);
  else
    add_sensing_verdict(study.source->sensing, results);
  for (const Objection& one : prior_objections(study)) results.object(one);
  if (const std::string text = mass_sentence(experiment, study); !text.empty()) results.paragraph(text);
  results.heading("Parameters");
  results.table(posterior_table(study));
  for (const std::string& sentence : posterior_sentences(study)) results.paragraph(sentence);
  if (study.posterior.humps.size() > 1) {
    results.heading("Humps");
    results.table(hump_table(study));
    if (study.update && !study.update->deciding.empty())
      results.table(deciding_table(study.update->deciding));
  }
  if (study.update) {
    results.heading("Modes");
    results.table(prediction_table(study));
    results.notes(study.update->data().remarks);
  }
  results.figures.push_back(corner_figure(study));
  results.attachments.push_back({{"draws.h5"}, [&study](const std::filesystem::path& folder) {
                                   write_draws(study, folder / "draws.h5");
                                 }});
  results.timing.emplace_back("sampling", study.seconds);
  return results;
}

namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr std::size_t most_in_corner = 4;
constexpr Index most_points = 600, density_bars = 60;

VectorXd thinned(const Eigen::MatrixXd& draws) {
  const Index stride = std::max<Index>(1, draws.size() / most_points), count = draws.size() / stride;
  VectorXd points(count);
  for (Index i = 0; i < count; ++i) points[i] = draws.data()[i * stride];
  return points;
}

// Share of the draws over the width of each of equal bars, as an outline.
std::pair<VectorXd, VectorXd> density_of(const Eigen::MatrixXd& draws) {
  const double low = draws.minCoeff(), high = draws.maxCoeff(), width = (high - low) / density_bars;
  VectorXd x(2 * density_bars), y = VectorXd::Zero(2 * density_bars);
  for (Index i = 0; i < density_bars; ++i) {
    x[2 * i] = low + width * static_cast<double>(i);
    x[2 * i + 1] = low + width * static_cast<double>(i + 1);
  }
  for (Index i = 0; i < draws.size(); ++i) {
    const Index bar = std::min<Index>(density_bars - 1, static_cast<Index>((draws.data()[i] - low) / width));
    y[2 * bar] += 1.0 / (width * static_cast<double>(draws.size()));
    y[2 * bar + 1] = y[2 * bar];
  }
  return {x, y};
}

}  // namespace

Figure corner_figure(const PosteriorStudy& study) {
  const std::size_t count = std::min(study.unknowns().size(), most_in_corner);
  std::vector<Eigen::MatrixXd> draws;
  std::vector<std::string> labels;
  for (std::size_t j = 0; j < count; ++j) {
    const Unknown& unknown = study.unknowns()[j];
    draws.push_back(study.draws(j));
    labels.push_back(unknown.unit.empty() ? unknown.name : unknown.name + " [" + unknown.unit + "]");
  }
  Figure figure{"corner", {}};
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t column = 0; column < count; ++column) {
      Panel panel{"", {labels[column]}, {row == column ? "density" : labels[row]}};
      panel.x_axis.range = {draws[column].minCoeff(), draws[column].maxCoeff()};
      panel.key(Legend::none);
      if (row == column) {
        const auto [x, y] = density_of(draws[row]);
        panel.line("", x, y, Colour::blue);
      } else {
        panel.points("", thinned(draws[column]), thinned(draws[row]), Colour::blue);
      }
      figure.panels.push_back(std::move(panel));
    }
  figure.rows = figure.columns = static_cast<int>(count);
  figure.width = std::max(500, 330 * figure.columns);
  figure.caption = "Draws of the posterior, each parameter against each other; densities on the diagonal.";
  return figure;
}

namespace {

constexpr std::size_t most_humps_shown = 6;

}  // namespace

Table posterior_table(const PosteriorStudy& study) {
  Table table{"posterior", ""};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"mean", "mean", "{:.5g}"})
      .column({"median", "median", "{:.5g}"})
      .column({"+-", "standard_deviation", "{:.3g}"})
      .column({"95 % from", "lower_95", "{:.5g}"})
      .column({"to", "upper_95", "{:.5g}"})
      .column({"Laplace +-", "laplace_standard_deviation", "{:.3g}"})
      .column({"R-hat", "r_hat", "{:.3f}"})
      .column({"worth", "effective_draws", "{:.0f}"})
      .column({"prior", "prior"});
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const PosteriorParameter& one = study.parameters[j];
    table.row({study.unknowns()[j].name, study.unknowns()[j].unit, one.all.mean, one.all.median,
               one.all.deviation, one.all.lower_95, one.all.upper_95, one.laplace.front(),
               one.convergence.r_hat, one.convergence.effective_draws, study.likelihood->priors()[j].text()});
  }
  table.note = study.posterior.humps.size() > 1
                   ? "Over all humps; Laplace +- of the first. worth: independent draws."
                   : "worth: independent draws.";
  return table;
}

Table hump_table(const PosteriorStudy& study) {
  const Posterior& posterior = study.posterior;
  const std::size_t shown = std::min(posterior.humps.size(), most_humps_shown);
  Table table{"humps", "Mean and standard deviation in each hump"};
  table.column({"parameter", "parameter"}).column({"unit", "unit"});
  for (std::size_t h = 0; h < shown; ++h)
    table.column({fmt::format("hump {}", h + 1), fmt::format("hump_{}", h + 1), "{:.5g}"})
        .column({"+-", fmt::format("hump_{}_standard_deviation", h + 1), "{:.3g}"});
  const double nan = std::nan("");
  std::vector<Cell> share{std::string("probability"), std::string("%")};
  for (std::size_t h = 0; h < shown; ++h) {
    share.emplace_back(100.0 * posterior.share[h]);
    share.emplace_back(nan);
  }
  table.row(std::move(share));
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    std::vector<Cell> row{study.unknowns()[j].name, study.unknowns()[j].unit};
    for (std::size_t h = 0; h < shown; ++h) {
      const DrawSummary& hump = study.parameters[j].humps[h];
      const bool drawn = hump.deviation > 0.0;
      row.emplace_back(
          drawn ? hump.mean
                : study.likelihood->physical(posterior.humps[h].top)[static_cast<Eigen::Index>(j)]);
      row.emplace_back(drawn ? hump.deviation : study.parameters[j].laplace[h]);
    }
    table.row(std::move(row));
  }
  if (posterior.humps.size() > shown)
    table.note = fmt::format("{} more in results.json.", posterior.humps.size() - shown);
  return table;
}

Table prediction_table(const PosteriorStudy& study) {
  const ModalData& data = study.update->data();
  Table table{"modes", ""};
  table.column({"measured [Hz]", "measured_hz", "{:.4f}"})
      .column({"+- [Hz]", "standard_deviation_hz", "{:.2g}"})
      .column({"predicted [Hz]", "predicted_hz", "{:.4f}"})
      .column({"95 % from", "lower_95_hz", "{:.4f}"})
      .column({"to [Hz]", "upper_95_hz", "{:.4f}"});
  if (data.has_shapes()) table.column({"MAC", "mac", "{:.4f}"});
  for (std::size_t i = 0; i < data.modes.size(); ++i) {
    const PredictedFrequency& one = study.predicted[i];
    std::vector<Cell> row{data.modes[i].frequency_hz, study.update->residual->frequency_deviation(i),
                          one.drawn.median, one.drawn.lower_95, one.drawn.upper_95};
    if (data.has_shapes()) row.emplace_back(one.mac);
    table.row(std::move(row));
  }
  table.note = "Predicted: the frequency measured once more, with the error of the measurement.";
  return table;
}

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
