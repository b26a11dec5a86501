#include "tests/experiments/sweep/sweep_rows.hpp"

namespace beamid::experiments {

SweepPlan plan_with(const std::vector<std::string>& vary, int samples, int seeds) {
  SweepPlan plan;
  for (const std::string& text : vary) plan.varied.push_back(parse_varied(text));
  plan.samples = samples;
  plan.seeds = seeds;
  check(plan);
  return plan;
}

SweepPlan once(SweepPlan plan) {
  plan.once = true;
  return plan;
}

SweepRow found_row(std::size_t number, double estimate) {
  SweepRow row;
  row.number = number;
  row.values = {"1"};
  row.filter = "ekf";
  row.status = "converged";
  row.parameter = "stiffness";
  row.unit = "N/m";
  row.estimate = estimate;
  row.truth = 10.0;
  row.error = estimate - 10.0;
  row.deviation = 1.0;
  row.lower = estimate - 1.5;
  row.upper = estimate + 1.5;
  row.bound = 1.0;
  return row;
}

SweepRow unfound_row(std::size_t number, const std::string& status) {
  SweepRow row;
  row.number = number;
  row.values = {"1"};
  row.filter = status == "failed" ? "" : "ekf";
  row.status = status;
  row.reason = "a \"reason\", on\ntwo lines";
  return row;
}

}  // namespace beamid::experiments
