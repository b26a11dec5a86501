#include "experiments/studies/identify/diagnostics_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace beamid::experiments {

using Eigen::Index;
using Json = nlohmann::ordered_json;

namespace {

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class Vector>
Json list(const Vector& numbers) {
  Json json = Json::array();
  for (Index i = 0; i < numbers.size(); ++i) json.push_back(finite(numbers[i]));
  return json;
}

}  // namespace

Json values(const filters::Diagnostics& found, const std::vector<std::string>& outputs) {
  Json json{{"log_likelihood", finite(found.log_likelihood)}, {"whiteness", Json::array()}};
  for (std::size_t i = 0; i < outputs.size(); ++i)
    json["whiteness"].push_back({{"output", outputs[i]},
                                 {"ljung_box_p_value", finite(found.whiteness[i].p_value)},
                                 {"autocorrelation", list(found.whiteness[i].autocorrelation)}});
  json["innovation_histogram"] = {{"edges", list(found.histogram.edges)}, {"counts", Json::array()}};
  for (Index i = 0; i < found.histogram.counts.rows(); ++i)
    json["innovation_histogram"]["counts"].push_back(list(found.histogram.counts.row(i)));
  if (!found.information) return json;
  json["information"] = {{"unknowns", found.information->ratios.size()},
                         {"rank", found.information->rank},
                         {"condition", finite(found.information->condition)},
                         {"variance_ratios", list(found.information->ratios)}};
  return json;
}

std::string words(const filters::Diagnostics& found, const std::vector<std::string>& outputs) {
  std::string text =
      fmt::format("Log-likelihood {:.6g}. Ljung-Box p, below 0.05 where innovations are not white:",
                  found.log_likelihood);
  for (std::size_t i = 0; i < outputs.size(); ++i)
    text += fmt::format("{} {} {:.2g}", i ? "," : "", outputs[i], found.whiteness[i].p_value);
  text += ".";
  if (!found.information) return text;
  const auto& told = *found.information;
  text += fmt::format(" Information about {} unknown{}: rank {}", told.ratios.size(),
                      told.ratios.size() == 1 ? "" : "s", told.rank);
  if (std::isfinite(told.condition)) text += fmt::format(", condition {:.3g}", told.condition);
  return text + (told.rank < told.ratios.size() ? "; of the rest the record says less than the prior." : ".");
}

Json values(const std::vector<filters::Failure>& events) {
  Json json = Json::array();
  for (const filters::Failure& event : events)
    json.push_back({{"step", event.step},
                    {"time_s", event.time},
                    {"reason", event.reason},
                    {"smallest_eigenvalue", finite(event.smallest_eigenvalue)}});
  return json;
}

}  // namespace beamid::experiments
