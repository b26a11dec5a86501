#include <fmt/format.h>

#include <cmath>

#include "experiments/studies/posterior/report.hpp"

namespace beamid::experiments {
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

}  // namespace beamid::experiments
