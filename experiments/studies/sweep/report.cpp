#include "experiments/studies/sweep/report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/text.hpp"
#include "experiments/sweep/hdf5_table.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

/// How the ways to identify differ at one point: what differs between points is a key of theirs.
std::vector<std::pair<const char*, std::string PointStatistics::*>> differing(
    const std::vector<PointStatistics>& all) {
  std::vector<std::pair<const char*, std::string PointStatistics::*>> kept;
  for (const auto& one :
       {std::pair("reduction", &PointStatistics::reduction), std::pair("filter", &PointStatistics::filter),
        std::pair("discretisation", &PointStatistics::discretisation)})
    if (std::adjacent_find(all.begin(), all.end(), [&](const auto& entry, const auto& next) {
          return entry.point == next.point && entry.*one.second != next.*one.second;
        }) != all.end())
      kept.push_back(one);
  return kept;
}

/// An end of its interval; that of none or of all is exact, not to rounding.
Cell sweep_percent(const filters::Proportion& proportion, double filters::Proportion::*bound) {
  if (proportion.runs == 0) return std::nan("");
  if (proportion.count == 0 && bound == &filters::Proportion::lower_95) return 0.0;
  if (proportion.count == proportion.runs && bound == &filters::Proportion::upper_95) return 100.0;
  return 100.0 * proportion.*bound;
}

Cell sweep_percent(const filters::Proportion& proportion) {
  return proportion.runs > 0 ? 100.0 * proportion.value() : std::nan("");
}

Table table_of(const SweepPlan& plan, const std::vector<PointStatistics>& all, const std::string& parameter) {
  Table table{"summary", "Runs without an estimate"};
  if (!parameter.empty()) table = {"summary_" + parameter, parameter};
  for (const VariedKey& key : plan.varied)
    if (!key.is_drawn()) table.column({key.key.substr(key.key.rfind('.') + 1), key.key, "{:.6g}"});
  const auto ways = differing(all);
  for (const auto& [name, member] : ways) table.column({name, name});
  const bool truth = std::any_of(all.begin(), all.end(), [&](const PointStatistics& one) {
    return one.parameter == parameter && one.coverage.runs > 0;
  });
  table.column({"runs", "runs", "{:g}"});
  if (!truth) table.column({"mean", "mean_estimate", "{:.6g}"});
  if (truth)
    table.column({"bias [%]", "bias_percent", "{:+.3g}"})
        .column({"+-", "bias_standard_error_percent", "{:.2g}"})
        .column({"rms [%]", "rms_error_percent", "{:.3g}"})
        .column({"rms / bound", "rms_over_bound", "{:.3f}"})
        .column({"in the 95 % interval [%]", "coverage_percent", "{:.1f}"})
        .column({"from", "coverage_lower_95_percent", "{:.1f}"})
        .column({"to", "coverage_upper_95_percent", "{:.1f}"});
  table.column({"diverged [%]", "divergence_percent", "{:.1f}"})
      .column({"from", "divergence_lower_95_percent", "{:.1f}"})
      .column({"to", "divergence_upper_95_percent", "{:.1f}"})
      .column({"not run", "refused_or_failed", "{:g}"});
  for (const PointStatistics& one : all) {
    if (one.parameter != parameter) continue;
    std::vector<Cell> row;
    const auto values = values_of_point(plan, one.point);
    for (std::size_t j = 0; j < values.size(); ++j) {
      if (plan.varied[j].is_drawn()) continue;
      const double* const number = std::get_if<double>(&values[j]);
      row.push_back(number ? Cell(*number) : Cell(word_of(values[j])));
    }
    for (const auto& [name, member] : ways) row.emplace_back(one.*member);
    using P = filters::Proportion;
    row.emplace_back(static_cast<double>(one.converged + one.diverged));
    if (!truth) row.emplace_back(one.mean);
    if (truth)
      row.insert(row.end(), {one.bias_percent, one.bias_percent_error, one.rms_percent, one.rms_over_bound,
                             sweep_percent(one.coverage), sweep_percent(one.coverage, &P::lower_95),
                             sweep_percent(one.coverage, &P::upper_95)});
    row.insert(row.end(), {sweep_percent(one.divergence), sweep_percent(one.divergence, &P::lower_95),
                           sweep_percent(one.divergence, &P::upper_95), static_cast<double>(one.unusable)});
    table.row(row);
  }
  return table;
}

Json json_of(const filters::Proportion& proportion) {
  if (proportion.runs == 0) return nullptr;
  return {{"count", proportion.count},
          {"runs", proportion.runs},
          {"share", proportion.value()},
          {"lower_95", proportion.lower_95},
          {"upper_95", proportion.upper_95}};
}

Json json_of(const SweepPlan& plan, const PointStatistics& one) {
  Json json{{"point", one.point}};
  const auto values = values_of_point(plan, one.point);
  for (std::size_t j = 0; j < values.size(); ++j) {
    const double* const number = std::get_if<double>(&values[j]);
    json[plan.varied[j].key] = number ? Json(*number) : Json(word_of(values[j]));
  }
  json.update({{"reduction", one.reduction},
               {"filter", one.filter},
               {"discretisation", one.discretisation},
               {"parameter", one.parameter},
               {"unit", one.unit},
               {"converged", one.converged},
               {"diverged", one.diverged},
               {"refused_or_failed", one.unusable}});
  for (const auto& [key, value] :
       {std::pair("mean", one.mean), std::pair("bias", one.bias), std::pair("rms_error", one.rms),
        std::pair("bias_percent", one.bias_percent),
        std::pair("bias_standard_error_percent", one.bias_percent_error),
        std::pair("rms_error_percent", one.rms_percent), std::pair("bound_percent", one.bound_percent),
        std::pair("rms_over_bound", one.rms_over_bound)})
    json[key] = number_or_null(value);
  json["coverage"] = json_of(one.coverage);
  json["divergence"] = json_of(one.divergence);
  return json;
}

/// The first reason of each kind of trouble.
std::vector<std::string> troubles(const std::vector<SweepRow>& rows) {
  std::vector<std::string> found;
  for (const std::string kind : {"failed", "refused", "diverged"}) {
    std::set<std::size_t> cases;
    const SweepRow* first = nullptr;
    for (const SweepRow& row : rows)
      if (row.status == kind) {
        if (!first) first = &row;
        cases.insert(row.number);
      }
    if (first)
      found.push_back(fmt::format("{} {} {}; the first, case {}: {}", cases.size(),
                                  cases.size() == 1 ? "case" : "cases", kind, first->number, first->reason));
  }
  return found;
}

/// What a ratio below 1 means: chance, as far as that goes, or information that the bound does not count.
std::string below_bound_text(const SweepPlan& plan, const std::vector<PointStatistics>& all) {
  constexpr std::size_t shown = 4;
  constexpr double surely = 3.0;  // standard deviations: one row of hundreds by chance
  std::string chance, beyond;
  std::size_t count = 0;
  for (const PointStatistics& one : all) {
    if (!(one.rms_over_bound < 1.0)) continue;
    const double least = 1.0 - surely / std::sqrt(2.0 * one.converged);
    if (one.rms_over_bound >= least && chance.empty())
      chance = fmt::format("rms / bound is 1 at best; with {} runs values down to {:.3f} are chance.",
                           one.converged, std::max(0.0, least));
    if (one.rms_over_bound >= least || ++count > shown) continue;
    const std::string name = name_of(plan, all, one, plan.varied.size());
    beyond += fmt::format("{}{} {:.3g}{}", beyond.empty() ? "" : ", ", one.parameter, one.rms_over_bound,
                          name.empty() ? "" : " at " + name);
  }
  if (beyond.empty()) return chance;
  if (count > shown) beyond += fmt::format(" and {} more", count - shown);
  return fmt::format(
      "{}{}Errors below the Cramer-Rao bound, rms / bound: {}. No unbiased estimate from the records alone "
      "can do that: the initial estimates, which are information that the bound omits, are at or near the "
      "truth. Such rows do not show how good the filter is.",
      chance, chance.empty() ? "" : " ", beyond);
}

std::string plan_text(const SweepPlan& plan) {
  std::string keys;
  for (const VariedKey& key : plan.varied) keys += (keys.empty() ? "" : "; ") + key.text;
  return fmt::format("{} {}: {} {}{} x {} {} from {} on. {}", plan.cases(),
                     plan.cases() == 1 ? "case" : "cases", plan.points(),
                     plan.points() == 1 ? "point" : "points",
                     plan.samples > 1 ? fmt::format(" x {} samples", plan.samples) : "", plan.seeds,
                     plan.seeds == 1 ? "seed" : "seeds", plan.seed,
                     keys.empty() ? "Only the noise varies." : "Varied: " + keys);
}

}  // namespace

std::string name_of(const SweepPlan& plan, const std::vector<PointStatistics>& all,
                    const PointStatistics& one, std::size_t but) {
  std::string name;
  const auto add = [&](const std::string& part) { name += (name.empty() ? "" : ", ") + part; };
  const auto values = values_of_point(plan, one.point);
  for (std::size_t j = 0; j < values.size(); ++j)
    if (j != but && !plan.varied[j].is_drawn())
      add(plan.varied[j].key.substr(plan.varied[j].key.rfind('.') + 1) + " = " + word_of(values[j]));
  for (const auto& [key, member] : differing(all)) add(one.*member);
  return name;
}

Results report(const Json& manifest, const SweepPlan& plan, std::vector<SweepRow> rows,
               const std::string& command) {
  const auto kept = std::make_shared<const std::vector<SweepRow>>(std::move(rows));
  const std::vector<PointStatistics> all = statistics(plan, *kept);
  Results results;
  results.command = "sweep";
  results.seed = plan.seed;
  for (const auto& [key, value] : manifest.items())
    if (key != "program" && key != "version" && key != "shard") results.configuration[key] = value;
  results.heading("Sweep");
  results.paragraph(plan_text(plan));
  if (const Json& shard = manifest["shard"]; shard["count"] != 1)
    results.paragraph(
        fmt::format("Shard {} of {}: `beamid sweep --merge` joins them; below is this one alone.",
                    shard["index"].dump(), shard["count"].dump()));
  std::vector<std::string> parameters;
  for (const PointStatistics& one : all)
    if (std::find(parameters.begin(), parameters.end(), one.parameter) == parameters.end())
      parameters.push_back(one.parameter);
  for (const std::string& parameter : parameters) results.table(table_of(plan, all, parameter));
  results.paragraph(
      "Errors are estimate - truth, relative to the truth, of the runs that converged. Bound: Cramer-Rao. "
      "Intervals of the shares: Wilson, 95 %.");
  if (const std::string text = below_bound_text(plan, all); !text.empty()) results.paragraph(text);
  for (const std::string& trouble : troubles(*kept)) results.paragraph(trouble);
  results.values["cases"] = plan.cases();
  results.values["points"] = Json::array();
  for (const PointStatistics& one : all) results.values["points"].push_back(json_of(plan, one));
  results.figures = figures(plan, *kept, all, command);
  results.attachments.push_back({{"cases.csv", "cases.h5", "manifest.json"},
                                 [kept, plan, manifest](const std::filesystem::path& folder) {
                                   std::string text = header_line(plan);
                                   for (const SweepRow& row : *kept) text += to_line(row);
                                   write_file(folder / "cases.csv", text);
                                   write_hdf5(plan, *kept, folder / "cases.h5");
                                   write_file(
                                       folder / "manifest.json",
                                       manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
                                 }});
  return results;
}

namespace {

using Eigen::VectorXd;

constexpr std::size_t most_sweep_curves = 6;  // more cannot be told apart
constexpr std::size_t most_parameters = 3;

/// A key whose values are numbers to draw against; plan.varied.size() without one.
std::size_t abscissa(const SweepPlan& plan, bool drawn) {
  for (std::size_t j = 0; j < plan.varied.size(); ++j) {
    const VariedKey& key = plan.varied[j];
    const bool numbers =
        std::all_of(key.values.begin(), key.values.end(),
                    [](const filters::OptionValue& value) { return std::holds_alternative<double>(value); });
    if (key.is_drawn() == drawn && (drawn || (numbers && key.values.size() > 1))) return j;
  }
  return plan.varied.size();
}

bool logarithmic(const VectorXd& x) {
  return x.size() > 1 && x.minCoeff() > 0.0 && x.maxCoeff() > 20.0 * x.minCoeff();
}

VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<std::string> parameters_of(const std::vector<PointStatistics>& all) {
  std::vector<std::string> names;
  for (const PointStatistics& one : all)
    if (!one.parameter.empty() && std::isfinite(one.rms_percent) && names.size() < most_parameters &&
        std::find(names.begin(), names.end(), one.parameter) == names.end())
      names.push_back(one.parameter);
  return names;
}

/// What repeats a case, and those of the following seeds, with the values of its row.
std::string repeating_command(std::string command, const SweepPlan& plan, const SweepRow& first, int seeds) {
  for (std::size_t j = 0; j < plan.varied.size(); ++j)
    command += " --vary " + shell_word(plan.varied[j].key + "=" + first.values[j]);
  if (plan.samples > 1) command += " --random 1";
  if (plan.once) command += " --once";
  return command + fmt::format(" --seeds {} --seed {}", seeds, first.seed);
}

/// What a click on a point of the figure shows.
PointDetail runs_of(const SweepPlan& plan, const std::vector<const SweepRow*>& of_point,
                    const PointStatistics& one, const std::string& title, const std::string& command,
                    std::size_t most) {
  std::vector<const SweepRow*> runs;
  for (const SweepRow* row : of_point)
    if (one.same_run(*row) && (row->parameter == one.parameter || row->parameter.empty()))
      runs.push_back(row);
  PointDetail detail{title, run_table(plan, runs, one.unit, most)};
  if (runs.empty()) return detail;
  const bool drawn = std::any_of(plan.varied.begin(), plan.varied.end(), std::mem_fn(&VariedKey::is_drawn));
  detail.command = repeating_command(command, plan, *runs.front(), drawn ? 1 : plan.seeds);
  if (runs.size() > most)
    detail.note =
        fmt::format("{} of {} runs, the largest errors first; cases.csv has all. ", most, runs.size());
  if (drawn) detail.note += fmt::format("The command repeats case {}.", runs.front()->number);
  return detail;
}

/// Rows by the point of the grid that they belong to.
std::vector<std::vector<const SweepRow*>> by_point(const SweepPlan& plan, const std::vector<SweepRow>& rows) {
  std::vector<std::vector<const SweepRow*>> found(plan.points());
  for (const SweepRow& row : rows) found[plan.point_of(row.number)].push_back(&row);
  return found;
}

/// Entries of one parameter that differ in the abscissa only.
struct Series {
  std::string name;
  std::vector<double> x, rms, bound, coverage, lower, upper;
  std::vector<PointDetail> details;
};

using CellDetail = std::function<PointDetail(const PointStatistics& one, const std::string& title)>;

std::vector<Series> series_of(const SweepPlan& plan, const std::vector<PointStatistics>& all,
                              const std::string& parameter, std::size_t key, const CellDetail& detail_of) {
  std::vector<Series> found;
  for (const PointStatistics& one : all) {
    if (one.parameter != parameter) continue;
    const std::string name = name_of(plan, all, one, key);
    auto at =
        std::find_if(found.begin(), found.end(), [&](const Series& other) { return other.name == name; });
    if (at == found.end() && found.size() == most_sweep_curves) continue;
    if (at == found.end()) at = found.insert(at, Series{name, {}, {}, {}, {}, {}, {}, {}});
    at->x.push_back(std::get<double>(values_of_point(plan, one.point)[key]));
    at->rms.push_back(one.rms_percent);
    const std::string title = name_of(plan, all, one, plan.varied.size());
    at->details.push_back(detail_of(one, parameter + (title.empty() ? "" : ": ") + title));
    at->bound.push_back(one.bound_percent);
    const bool known = one.coverage.runs > 0;
    at->coverage.push_back(known ? 100.0 * one.coverage.value() : std::nan(""));
    at->lower.push_back(known ? 100.0 * one.coverage.lower_95 : std::nan(""));
    at->upper.push_back(known ? 100.0 * one.coverage.upper_95 : std::nan(""));
  }
  return found;
}

constexpr Colour sweep_colours[most_sweep_curves] = {Colour::blue,   Colour::vermillion, Colour::green,
                                                     Colour::purple, Colour::orange,     Colour::sky};

void add_panels(Figure& figure, const std::string& key, const std::string& parameter,
                const std::vector<Series>& all) {
  const bool log_x = logarithmic(vector_of(all[0].x));
  std::string title = parameter;
  std::replace(title.begin(), title.end(), '_', ' ');
  Panel errors{title, {key_label(key), log_x}, {"rms error [%]", true}};
  Panel coverage{title, {key_label(key), log_x}, {"truth in the 95 % interval [%]"}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Series& one = all[i];
    const VectorXd x = vector_of(one.x);
    const std::string label = one.name.empty() ? "filter" : one.name;
    errors.points(label, x, vector_of(one.rms), sweep_colours[i]);
    errors.curves.back().details = one.details;
    errors.dashed(i == 0 ? "Cramér-Rao bound" : "", x, vector_of(one.bound), sweep_colours[i]);
    coverage.bars(label, x, vector_of(one.coverage), vector_of(one.lower), vector_of(one.upper),
                  sweep_colours[i]);
    coverage.curves.back().details = one.details;
  }
  coverage.level("95 %", 95.0, Colour::grey);
  for (Panel& earlier : figure.panels) earlier.legend = Legend::none;  // said once, below the last parameter
  figure.panels.push_back(errors);
  figure.panels.push_back(coverage);
}

Figure scattered(const SweepPlan& plan, const std::vector<SweepRow>& rows,
                 const std::vector<std::string>& parameters, std::size_t key, const std::string& command) {
  constexpr std::size_t most_details = 1000;
  Figure figure{"sweep", {}, static_cast<int>(parameters.size()), 1};
  for (const std::string& parameter : parameters) {
    std::vector<double> x, error;
    std::vector<PointDetail> details;
    for (const SweepRow& row : rows) {
      if (row.parameter != parameter || row.status != "converged") continue;
      x.push_back(number(row.values[key]).value_or(std::nan("")));
      error.push_back(100.0 * row.error / std::abs(row.truth));
      if (rows.size() <= most_details)
        details.push_back({fmt::format("{}, case {}", parameter, row.number),
                           run_table(plan, {&row}, row.unit, 1), "",
                           repeating_command(command, plan, row, 1)});
    }
    figure.panels.push_back(
        Panel{parameter, {key_label(plan.varied[key].key), logarithmic(vector_of(x))}, {"error [%]"}}
            .points("", vector_of(x), vector_of(error))
            .key(Legend::none));
    figure.panels.back().curves.back().details = std::move(details);
  }
  return figure;
}

}  // namespace

std::vector<Figure> figures(const SweepPlan& plan, const std::vector<SweepRow>& rows,
                            const std::vector<PointStatistics>& statistics, const std::string& command) {
  constexpr std::size_t most_listed = 20, listed_in_all = 2000;
  const std::vector<std::string> parameters = parameters_of(statistics);
  const std::size_t key = abscissa(plan, false), drawn = abscissa(plan, true);
  if (parameters.empty()) return {};
  if (key == plan.varied.size())
    return drawn == plan.varied.size()
               ? std::vector<Figure>{}
               : std::vector<Figure>{scattered(plan, rows, parameters, drawn, command)};
  Figure figure{"sweep", {}, static_cast<int>(parameters.size()), 2};
  figure.width = 1000;
  figure.caption =
      "Root mean square error with the Cramér-Rao bound, and how often the 95 % interval holds the truth.";
  const auto cells = by_point(plan, rows);
  const std::size_t most = std::clamp<std::size_t>(listed_in_all / statistics.size(), 3, most_listed);
  const CellDetail detail_of = [&](const PointStatistics& one, const std::string& title) {
    return runs_of(plan, cells[one.point], one, title, command, most);
  };
  for (const std::string& parameter : parameters)
    add_panels(figure, plan.varied[key].key, parameter,
               series_of(plan, statistics, parameter, key, detail_of));
  return {figure};
}

}  // namespace beamid::experiments
