
#include "experiments/studies/compare/report.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/forest_plot.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Runs = std::vector<const ComparedRun*>;

constexpr double shown_periods = 10.0;
constexpr std::size_t most_residuals = 8;  // of which each has a panel

Runs reproduced_runs(const Comparison& comparison) {
  Runs runs;
  for (const ComparedRun& run : comparison.runs)
    if (run.reproduced.size() > 0) runs.push_back(&run);
  return runs;
}

// A row for each run: error in per cent where the truth is known, else the estimate.
Panel parameter_panel(const Comparison& comparison, const Runs& runs, std::size_t j) {
  const ComparedParameter& first = runs.front()->parameters[j];
  const std::string unit = first.estimate.unit.empty() ? "" : " [" + first.estimate.unit + "]";
  const bool relative = first.error_percent().has_value();
  std::string title = first.estimate.name;
  std::replace(title.begin(), title.end(), '_', ' ');
  ForestPlot plot{
      title, relative ? "error [%], 95 % intervals" : "estimate" + unit + ", 95 % intervals", {}, {{}}};
  for (const ComparedRun* run : runs) {
    const ComparedParameter& p = run->parameters[j];
    const auto shown = [&](double value) { return relative ? 100.0 * (value / *p.truth - 1.0) : value; };
    const double ends[] = {shown(p.estimate.lower_95), shown(p.estimate.upper_95)};
    plot.names.push_back(name_of(comparison, *run));
    plot.series[0].value.push_back(shown(p.estimate.value));
    plot.series[0].lower.push_back(std::min(ends[0], ends[1]));
    plot.series[0].upper.push_back(std::max(ends[0], ends[1]));
  }
  if (relative) plot.reference = ForestReference{"true value", 0.0};
  return forest_panel(plot);
}

Figure parameter_figure(const Comparison& comparison, const Runs& runs) {
  Figure figure{"parameters", {}, 0, 1, 900};
  for (std::size_t j = 0; j < runs.front()->parameters.size(); ++j)
    figure.panels.push_back(parameter_panel(comparison, runs, j));
  figure.rows = static_cast<int>(figure.panels.size());
  figure.height = forest_height(runs.size(), figure.panels.size());
  figure.caption =
      "Estimates of all runs with their 95 % intervals; an arrow: beyond the axis, the number at the right.";
  return figure;
}

// The estimates of an unknown by each section of a driven record alone, over the size of its motion.
Panel section_panel(const ComparedRun& run, std::size_t j) {
  const SectionScatter& by = *run.sections;
  const Unknown& unknown = run.unknowns[j];
  const auto place = static_cast<Index>(j);
  VectorXd value(by.sections), lower(by.sections), upper(by.sections);
  for (Index i = 0; i < by.sections; ++i) {
    const double at = by.estimates(place, i), half = quantile_95 * by.own_deviation(place, i);
    value[i] = unknown.to_physical(at);
    lower[i] = unknown.to_physical(at - half);
    upper[i] = unknown.to_physical(at + half);
  }
  std::string name = unknown.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  if (!unknown.unit.empty()) name += " [" + unknown.unit + "]";
  Panel panel{"", {"motion of a section over that of the record (rms)", true}, {name}};
  panel.bars("section alone", by.size, value, lower, upper, Colour::blue)
      .level("whole record", run.parameters[j].estimate.value);
  if (const SizeTrend trend = trend_with_size(by, place); trend.exists(run.unknown_state.mean.size())) {
    constexpr Index points = 50;
    const VectorXd doublings =
        VectorXd::LinSpaced(points, std::log2(by.size.minCoeff()), std::log2(by.size.maxCoeff()));
    panel.line(
        "trend", doublings.unaryExpr([](double d) { return std::exp2(d); }),
        doublings.unaryExpr([&](double d) { return unknown.to_physical(trend.at_mean + trend.slope * d); }),
        Colour::vermillion);
  }
  // A section that determines little has bars beyond all others; the frame is of the estimates.
  const double room = 0.25 * std::max(value.maxCoeff() - value.minCoeff(), 1e-3 * std::abs(value.mean()));
  const double lowest = value.minCoeff();
  panel.up(lowest > 0.0 ? std::max(0.0, lowest - room) : lowest - room, value.maxCoeff() + room);
  return panel;
}

std::optional<Figure> section_figure(const ComparedRun& run) {
  constexpr std::size_t most_panels = 8;
  if (!run.sections || !run.sections->estimates.allFinite()) return {};
  Figure figure{"sections", {}, 0, 2, 900};
  for (std::size_t j = 0; j < std::min(most_panels, run.parameters.size()); ++j)
    figure.panels.push_back(section_panel(run, j));
  figure.rows = static_cast<int>((figure.panels.size() + 1) / 2);
  figure.caption = fmt::format(
      "The estimates of each of the {} sections of the record alone, one step from the whole record's "
      "estimate, "
      "with "
      "95 % intervals of its noise alone.",
      run.sections->sections);
  return figure;
}

// Record with the runs nearest to it and farthest from it, then what each run leaves, on one scale.
Figure motion_figure(const Comparison& comparison, const Runs& runs, Index channel) {
  const Record& record = comparison.compared.record;
  const auto row = output_channels(record)[static_cast<std::size_t>(channel)];
  const Channel& shown = record.channels[static_cast<std::size_t>(row)];
  const VectorXd measured = record.samples.row(row);
  const std::string label = axis_label(shown.quantity);
  const auto [best, worst] = std::minmax_element(runs.begin(), runs.end(), [](const auto* a, const auto* b) {
    return a->response_error_percent < b->response_error_percent;
  });
  std::vector<DrawnSignal> drawn{
      {name_of(comparison, **best), (*best)->reproduced.row(channel), Colour::sky}};
  if (*best != *worst)
    drawn.insert(drawn.begin(),
                 {name_of(comparison, **worst), (*worst)->reproduced.row(channel), Colour::vermillion});
  const double begin = record.time[0], end = record.time[record.size() - 1];
  const double frequency = (*best)->frequency_hz.value_or(shown_periods / (end - begin));
  const double last = std::min(end, begin + shown_periods / frequency);
  Figure figure{channel == 0 ? "reproduction" : fmt::format("reproduction_{}", channel + 1), {}, 0, 1, 900};
  figure.panels.push_back(
      reproduction_panel(channel_title(shown) + ", the first ten periods: nearest and farthest run",
                         record.time, measured, drawn, label)
          .across(begin, last));
  const Index inside = (record.time.array() <= last).count();
  std::vector<VectorXd> residuals;
  double largest = 0;
  for (std::size_t i = 0; i < std::min(runs.size(), most_residuals); ++i) {
    residuals.emplace_back(measured - runs[i]->reproduced.row(channel).transpose());
    for (const double value : residuals.back().head(inside))
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    figure.panels.push_back(
        residual_panel(fmt::format("{}: residual {:.3g} {} (rms)", name_of(comparison, *runs[i]),
                                   root_mean_squares(residuals[i].transpose())[0], si_unit(shown.quantity)),
                       record.time, residuals[i], label, largest)
            .across(begin, last));
    figure.panels.back().y_axis.label = std::string("[") + si_unit(shown.quantity) + "]";
    figure.panels.back().x_axis.label = "";
  }
  figure.panels.back().x_axis.label = "time [s]";
  figure.rows = static_cast<int>(figure.panels.size());
  figure.height = 340 + 120 * (figure.rows - 1);
  figure.caption =
      fmt::format("{}: record, its nearest and farthest reproduction, and the residual of each run.",
                  channel_title(shown));
  return figure;
}

}  // namespace

std::string name_of(const Comparison& comparison, const ComparedRun& run) {
  const auto differs = [&](auto part) {
    return std::any_of(comparison.runs.begin(), comparison.runs.end(),
                       [&](const ComparedRun& other) { return other.*part != run.*part; });
  };
  std::string name = run.reduction;
  if (differs(&ComparedRun::filter)) name += ", " + run.filter;
  if (differs(&ComparedRun::discretisation)) name += ", " + run.discretisation;
  return name;
}

std::vector<Figure> figures(const Comparison& comparison) {
  const Runs runs = reproduced_runs(comparison);
  if (runs.empty()) return {};
  std::vector<Figure> all;
  for (Index channel = 0; channel < runs.front()->reproduced.rows(); ++channel)
    all.push_back(motion_figure(comparison, runs, channel));
  Runs alike;  // the models may differ in what they ask about
  for (const ComparedRun* run : runs)
    if (run->parameters.size() == runs.front()->parameters.size() && run->answers()) alike.push_back(run);
  if (!alike.empty() && !alike.front()->parameters.empty())
    all.push_back(parameter_figure(comparison, alike));
  if (runs.size() == 1)
    if (auto sections = section_figure(*runs[0])) all.push_back(std::move(*sections));
  return all;
}

namespace {

// Whether a run says anything of its model.
bool is_sound(const ComparedRun& run) {
  return run.answers() && run.step_cause.empty();
}

// An error many times its own deviation is not noise: the model is at fault.
std::string bias_text(const Comparison& comparison) {
  constexpr double surely = 4.0;
  std::string biased;
  for (const ComparedRun& run : comparison.runs)
    for (const ComparedParameter& p : run.parameters)
      if (is_sound(run) && p.truth && std::abs(p.estimate.value - *p.truth) > surely * p.estimate.deviation)
        biased += fmt::format("{}{} of {} ({:.0f} standard deviations)", biased.empty() ? "" : ", ",
                              p.estimate.name, name_of(comparison, run),
                              std::abs(p.estimate.value - *p.truth) / p.estimate.deviation);
  if (biased.empty()) return {};
  return "Outside their own intervals: " + biased +
         ": an error of the model or of its discretisation, which no interval of a filter shows.";
}

// "modal_truncation" of "modal_truncation:modes=3".
std::string method_of(const ComparedRun& run) {
  return run.reduction.substr(0, run.reduction.find(':'));
}

// Whether a smaller model, otherwise identified alike, leaves less of the record: impossible on the right
// branch where the larger one can move in all the shapes of the smaller, as of the same method, or as the
// mesh.
bool worse_than_smaller(const Comparison& comparison, const ComparedRun& run) {
  constexpr double clearly = 1.25;
  return std::any_of(comparison.runs.begin(), comparison.runs.end(), [&](const ComparedRun& smaller) {
    const bool nested = run.reduction == "none" || method_of(smaller) == method_of(run);
    return nested && smaller.answers() && smaller.coordinates < run.coordinates &&
           smaller.filter == run.filter && smaller.discretisation == run.discretisation &&
           clearly * smaller.response_error_percent < run.response_error_percent;
  });
}

// A model that leaves much of the record is blind to some of its modes, or the filter has settled on a wrong
// branch: both are told from each other by what a larger model leaves.
std::string misfit_text(const Comparison& comparison) {
  constexpr double much = 20.0;
  std::string poor, wrong;
  for (const ComparedRun& run : comparison.runs) {
    if (!is_sound(run)) continue;
    const bool worse = worse_than_smaller(comparison, run);
    if (!worse && (run.misfit_percent <= much || run.status == ComparedRun::Status::approximate)) continue;
    std::string& list = worse ? wrong : poor;
    list += fmt::format("{}{} ({:.3g} %)", list.empty() ? "" : ", ", name_of(comparison, run),
                        run.response_error_percent);
  }
  std::string text;
  if (!poor.empty())
    text = "Large residual: " + poor +
           ". The model lacks modes that the record has, or the filter has settled on a wrong answer. If the "
           "residual of a larger model is as large, start from nearer initial estimates or smaller standard "
           "deviations.";
  if (!wrong.empty())
    text += (text.empty() ? "" : " ") + std::string("Larger residual than a smaller model: ") + wrong +
            ". The filter has settled on a wrong answer. Start from nearer initial estimates or smaller "
            "standard deviations.";
  return text;
}

// Why a deviation is smaller than the record allows.
std::string why_surer(const Comparison& comparison, const ComparedRun& run) {
  constexpr double clearly = 0.8;
  if (run.filter.starts_with("particle"))
    return "its particles have collapsed onto a few values, so that neither estimate nor standard deviation "
           "counts: "
           "use a filter of the Kalman family";
  if (run.last_move > settled_move) return "its estimate has not settled";
  if (comparison.compared.sensor_noise.size() > 0)
    for (Eigen::Index i = 0; i < run.noise.size(); ++i)
      if (run.noise[i] < clearly * run.noise_left[i])
        return fmt::format("[noise] assumes {:.2g} of the residual of the motion",
                           run.noise[i] / run.noise_left[i]);
  return "the filter was linearised too far from its estimate: filter more often ([compare] passes), or "
         "start from nearer initial estimates";
}

// Deviations below the bound, by more than what was known beforehand explains.
std::string surer_text(const Comparison& comparison) {
  std::string text;
  for (const ComparedRun& run : comparison.runs) {
    std::string surer;
    for (const ComparedParameter& p : run.parameters)
      if (p.overconfidence < 1.0)
        surer += fmt::format("{}{} {:.2g}", surer.empty() ? "" : ", ", p.estimate.name, p.overconfidence);
    if (!surer.empty())
      text += fmt::format(
          "{}Overconfident: the filter's standard deviations of {} were, as parts of the Cramer-Rao bound: "
          "{}; {}. They are widened to the bound.",
          text.empty() ? "" : " ", name_of(comparison, run), surer, why_surer(comparison, run));
  }
  return text;
}

// What a discretisation does by itself explains all else that is seen of its run, and what runs say of
// themselves beyond the remarks of their filters.
std::vector<std::string> own_remarks(const ComparedRun& run) {
  std::vector<std::string> texts;
  if (!run.step_cause.empty() && run.status != ComparedRun::Status::contradicted)  // which gives it as reason
    texts.push_back(run.step_cause);
  for (std::size_t i = run.run.remarks.size(); i < run.remarks.size(); ++i) texts.push_back(run.remarks[i]);
  return texts;
}

// By the work of a step: linearised once, several times, or many points moved.
int cost_rank(const ComparedRun& run) {
  const std::string name = run.filter.substr(0, run.filter.find(':'));
  int rank = 6;
  for (const char* const kind : {"particle", "enkf", "ukf", "ckf", "iekf", "ekf"}) {
    if (name.find(kind) != std::string::npos) return rank;
    --rank;
  }
  return rank;
}

/// Largest difference of a parameter, in the deviations of the first run.
double apart(const ComparedRun& one, const ComparedRun& other) {
  double largest = 0.0;
  for (std::size_t j = 0; j < one.parameters.size(); ++j)
    largest =
        std::max(largest, std::abs(one.parameters[j].estimate.value - other.parameters[j].estimate.value) /
                              one.parameters[j].estimate.deviation);
  return largest;
}

// Filters that answer alike on the same model need not all be run.
std::vector<std::string> agreement(const Comparison& comparison, const ComparedRun& run) {
  constexpr double alike = 0.2;
  std::string others;
  double largest = 0.01;
  for (const ComparedRun& other : comparison.runs)
    if (is_sound(run) && is_sound(other) && other.reduction == run.reduction &&
        other.discretisation == run.discretisation && other.parameters.size() == run.parameters.size() &&
        cost_rank(other) > cost_rank(run) && apart(run, other) < alike) {
      others += (others.empty() ? "" : ", ") + other.filter;
      largest = std::max(largest, apart(run, other));
    }
  if (others.empty()) return {};
  return {fmt::format(
      "{} agrees with {} within {:.1g} standard deviations and is the cheaper one: it is enough here.",
      run.filter, others, largest)};
}

// How far the best model is from a sensor's own noise, where that is known.
std::string excess_text(const Comparison& comparison, const ComparedRun& reference) {
  constexpr double far = 2.0;
  const Eigen::VectorXd& sensors = comparison.compared.sensor_noise;
  double excess = 0.0;
  const std::vector<Eigen::Index> channels = output_channels(comparison.compared.record);
  for (std::size_t i = 0; i < channels.size() && sensors.size() > 0; ++i)
    if (const double own = sensors[channels[i]]; own > 0.0)
      excess = std::max(excess, reference.noise[static_cast<Eigen::Index>(i)] / own);
  if (excess < far) return {};
  return fmt::format(
      "Even the residual of the reference is {:.3g} times the noise of a sensor. The record has motion that "
      "no model of this comparison has, or the reference is wrong.",
      excess);
}

}  // namespace

const ComparedRun* reference_run(const Comparison& comparison) {
  const ComparedRun* best = nullptr;
  for (const ComparedRun& run : comparison.runs) {
    if (!run.answers()) continue;
    const bool whole = run.reduction == "none";
    if (!best || (whole && best->reduction != "none") ||
        (whole == (best->reduction == "none") && run.coordinates > best->coordinates))
      best = &run;
  }
  return best;
}

std::vector<std::string> said_once(
    const Comparison& comparison,
    const std::function<std::vector<std::string>(const ComparedRun&)>& texts_of) {
  std::vector<std::pair<std::string, std::string>> said;  // a text, and who says it
  for (const ComparedRun& run : comparison.runs)
    for (const std::string& text : texts_of(run)) {
      const auto same =
          std::find_if(said.begin(), said.end(), [&](const auto& one) { return one.first == text; });
      if (same == said.end())
        said.emplace_back(text, name_of(comparison, run));
      else
        same->second += "; " + name_of(comparison, run);
    }
  std::vector<std::string> paragraphs;
  for (const auto& [text, names] : said)
    paragraphs.push_back(comparison.runs.size() == 1 ? text : names + ": " + text);
  return paragraphs;
}

std::vector<std::string> words(const Comparison& comparison) {
  const ComparedRun* reference = reference_run(comparison);
  const bool alone = comparison.runs.size() == 1;
  std::vector<std::string> paragraphs;
  if (!alone && reference) paragraphs.push_back("The reference: " + name_of(comparison, *reference) + ".");
  for (const ComparedRun& run : comparison.runs)
    if (!alone && !run.answers() && run.objections.empty())  // which say why
      paragraphs.push_back(fmt::format("{}: {}{}{}.", name_of(comparison, run), to_string(run.status),
                                       run.reason.empty() ? "" : ", ", run.reason));
  const auto add = [&](const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      if (!text.empty()) paragraphs.push_back(text);
  };
  if (reference) add({bias_text(comparison), misfit_text(comparison), surer_text(comparison)});
  add(said_once(comparison, own_remarks));
  if (!reference) return paragraphs;
  add({excess_text(comparison, *reference)});
  add(said_once(comparison, [&](const ComparedRun& run) { return agreement(comparison, run); }));
  return paragraphs;
}

}  // namespace beamid::experiments
