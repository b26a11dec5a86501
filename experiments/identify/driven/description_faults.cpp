#include "experiments/identify/driven/description_faults.hpp"
#include "experiments/identify/engine/measured_force.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "experiments/identify/driven/driven_part.hpp"
#include "experiments/identify/driven/other_models.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/model_check/candidates.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/units.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double worth_following = 0.1, mostly = 0.5;  // of what is left
constexpr double hopeless = 2.5;                       // times what is left, after a few steps
constexpr double tangent = 2e-5;  // of a change that counts: a resonance moves by far less than its width

/// Of a long record every so many lines: each costs all trials alike. @returns one of how many
Index keep_few_lines(DrivenProblem& problem) {
  constexpr Index most_numbers = 2000;
  RecordLines& lines = problem.parts.front();
  const Index stride = lines.outputs.size() / most_numbers + 1;
  lines = thinned(lines, stride);
  return stride;
}

/// The unknowns fitted anew, if a few steps get anywhere. @param most of what is left after these
std::optional<DrivenFit> promising_fit(const DrivenProblem& problem, const VectorXd& from, double most) {
  constexpr int few_steps = 8, more_steps = 6;
  const DrivenFit first = fit_driven_from(problem, from, few_steps);
  if (!(first.cost < most)) return {};
  return first.converged ? first : fit_driven_from(problem, first.theta, more_steps);
}

/// Share of a residual that the inputs move, whatever the model: in bands of eight lines r_k = (a + b k) u_k
/// of each channel, which takes 2 m of the eight of noise. 0 where that is chance.
double share_of_inputs(const RecordLines& part, const VectorXd& rest) {
  constexpr Index band = 8;
  constexpr double surely = 5.0;  // deviations of the mean share
  const Index p = part.outputs.rows(), m = part.inputs.rows(), lines = part.omega.size(), half = p * lines;
  if (rest.size() != 2 * half || 2 * m >= band) return 0.0;
  Eigen::MatrixXcd left(p, lines);
  left.reshaped() = rest.head(half) + std::complex<double>(0.0, 1.0) * rest.tail(half);
  const double by_chance = static_cast<double>(2 * m) / static_cast<double>(band);
  double taken = 0.0, all = 0.0, shares = 0.0, count = 0.0;
  for (Index from = 0; from + band <= lines; from += band) {
    Eigen::MatrixXcd columns(band, 2 * m);
    for (Index k = 0; k < band; ++k)
      for (Index j = 0; j < m; ++j) {
        columns(k, j) = part.inputs(j, from + k);
        columns(k, m + j) = (static_cast<double>(k) - 0.5 * (band - 1)) * part.inputs(j, from + k);
      }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> qr(columns);
    const Eigen::MatrixXcd axes = qr.householderQ() * Eigen::MatrixXcd::Identity(band, 2 * m);
    for (Index i = 0; i < p; ++i) {
      const Eigen::VectorXcd lines_of_band = left.row(i).segment(from, band).transpose();
      const double squares = lines_of_band.squaredNorm(),
                   of_inputs = (axes.adjoint() * lines_of_band).squaredNorm();
      taken += of_inputs, all += squares;
      shares += of_inputs / std::max(squares, 1e-300), count += 1.0;
    }
  }
  // Of noise each share is one of a beta distribution of 2 m and 8 - 2 m.
  const double spread = std::sqrt(by_chance * (1.0 - by_chance) / (static_cast<double>(band + 1) * count));
  if (!(count > 0.0) || !(shares / count - by_chance > surely * spread)) return 0.0;
  return std::clamp((taken / all - by_chance) / (1.0 - by_chance), 0.0, 1.0);
}

/// Behind the sentence of a change: what is left with it, where that is no noise.
std::string rest_text(const RecordLines& part, const VectorXd& rest) {
  constexpr double much = 0.2;
  const double share = share_of_inputs(part, rest);
  if (!(share > much)) return {};
  return fmt::format(", beside which {:.0f} % of the rest still follows the input, as of another cause",
                     100.0 * share);
}

struct FollowedChange {
  double change = 0.0, deviation = 0.0, left = 0.0;  // of x; squares of what remains
  VectorXd theta, rest = {};
};

/// A change of the structure to where it explains most, the unknowns with it.
/// @param whole J without it
FollowedChange followed(const DrivenProblem& problem, const OtherModels& models, const Experiment& experiment,
                        const Candidate& candidate, const VectorXd& theta, double first,
                        const VectorXd& moved_per_change, double whole) {
  constexpr int rounds = 8;
  FollowedChange best;
  best.left = std::numeric_limits<double>::infinity();
  double x = first;
  VectorXd from = theta + first * moved_per_change;
  for (int round = 0; round < rounds; ++round) {
    x = std::clamp(x, candidate.lower, candidate.upper);
    const JointModel model = models.of(candidate.changed(experiment.structure, x));
    DrivenProblem there = problem;
    there.model = &model;
    const auto fit = promising_fit(there, from, round == 0 ? hopeless * whole : best.left);
    if (!fit) break;
    const LineScores left(there, fit->theta);
    const double step = tangent * candidate.scale();
    const JointModel moved = models.of(candidate.changed(experiment.structure, x + step));
    const auto score = left.score(left.change_of(model, moved) / step);
    if (!(left.left().squaredNorm() < best.left) || !score) break;
    best = {x, score->deviation, left.left().squaredNorm(), fit->theta, left.left()};
    x += score->change;
    from = fit->theta + score->moved;
  }
  return best;
}

std::string value_text(const Candidate& candidate, const fem::Structure& structure, double x,
                       double deviation) {
  if (!candidate.value)
    return fmt::format("{} by the record {:+.3g} +- {:.2g} % of that described", candidate.label, 100.0 * x,
                       100.0 * quantile_95 * deviation);
  const double step = 1e-3 * candidate.scale(),
               slope = (candidate.value(structure, x + step) - candidate.value(structure, x)) / step;
  if (candidate.value_unit == of_described)
    return fmt::format("{} by the record {:.4g} +- {:.2g} times as large as described", candidate.label,
                       candidate.value(structure, x), quantile_95 * std::abs(slope) * deviation);
  return fmt::format("{} described as {:.4g} {}, by the record {:.4g} +- {:.2g} {}", candidate.label,
                     candidate.value(structure, 0.0), candidate.value_unit, candidate.value(structure, x),
                     quantile_95 * std::abs(slope) * deviation, candidate.value_unit);
}

/// Whether the unknowns hold it already.
bool is_asked(const Experiment& experiment, const Candidate& candidate) {
  return std::ranges::any_of(experiment.parameters, [&](const ParameterChoice& asked) {
    return candidate.name.starts_with(asked.quantity) || candidate.name == asked.name;
  });
}

void add_structure_changes(const DrivenProblem& problem, const OtherModels& models,
                           const Experiment& experiment, const LineScores& left, const VectorXd& theta,
                           bool much_is_left, bool weighed, std::vector<DescriptionFault>& faults) {
  const double whole = left.left().squaredNorm(), cost = evaluate_driven(problem, theta).cost;
  constexpr std::size_t few = 24;
  const JointModel described = models.of(experiment.structure);
  const std::vector<Candidate> candidates = candidates_of({experiment.structure});
  for (const Candidate& candidate : candidates) {
    if (candidate.of_clock || is_asked(experiment, candidate)) continue;
    if (!weighed && candidate.weighs_all) continue;
    try {
      const double step = tangent * candidate.scale();
      const JointModel model = models.of(candidate.changed(experiment.structure, step));
      const auto score = left.score(left.change_of(described, model) / step);
      if (!score) continue;
      DescriptionFault fault{value_text(candidate, experiment.structure, score->change, score->deviation),
                             score->score, score->explained, score->moved};
      // Where the unknowns have moved by many widths of a resonance, what is left is not linear in x.
      const VectorXd along = score->moved / score->change, unmoved = VectorXd::Zero(theta.size());
      std::vector<std::pair<double, VectorXd>> firsts;  // of x, and how the unknowns move with it at first
      if (candidates.size() <= few || score->explained > worth_following)
        firsts.emplace_back(score->change, along);
      if (much_is_left && !(score->explained > mostly))
        for (const double sign : {1.0, -1.0}) {
          firsts.emplace_back(0.5 * sign * candidate.scale(), along);
          firsts.emplace_back(sign * candidate.scale(), unmoved);
        }
      for (const auto& [first, moving] : firsts) {
        const FollowedChange end =
            followed(problem, models, experiment, candidate, theta, first, moving, cost);
        if (!std::isfinite(end.left) || !(1.0 - end.left / whole > fault.explained)) continue;
        fault = {value_text(candidate, experiment.structure, end.change, end.deviation) +
                     rest_text(problem.parts.front(), end.rest),
                 std::max(score->score, std::abs(end.change) / end.deviation), 1.0 - end.left / whole,
                 end.theta - theta};
      }
      if (fault.score > sure_score) faults.push_back(std::move(fault));
    } catch (const std::exception&) {  // there is no such structure, or it does not move so
    }
  }
}

/// Gains, each with the unknowns fitted anew beside it, by the noise that is left then.
void add_gains(const DrivenProblem& problem, const Record& record, const LineScores& left,
               const VectorXd& theta, std::vector<DescriptionFault>& faults) {
  using Reading = std::function<void(RecordLines & lines, double gain)>;
  // A gain is reading over truth: the model's inputs times 1 + c are the truth.
  const auto add = [&](const std::string& name, const VectorXd& direction, bool is_input,
                       const Reading& with_gain) {
    constexpr double least = 0.02;  // a gain is next to the masses and stiffnesses that are asked
    const auto score = left.score(direction, least);
    constexpr double largest = 0.6, turned = 0.2;  // a sign is a gain of -1
    if (!score || !(score->score > sure_score)) return;
    if (std::abs(score->change) > largest && std::abs(score->change + 2.0) > turned) return;
    DrivenProblem there = problem;
    with_gain(there.parts.front(), 1.0 + score->change);
    VectorXd found = theta + score->moved;
    try {
      weigh_by_residual(there, found);
      if (const auto fit = promising_fit(there, found, std::numeric_limits<double>::infinity()))
        found = fit->theta;
    } catch (const std::runtime_error&) {  // no motion there
    }
    const double factor = 1.0 + score->change, gain = is_input ? 1.0 / factor : factor,
                 deviation = score->deviation * (is_input ? gain * gain : 1.0);
    faults.push_back(
        {fmt::format("gain of {} {:.4g} +- {:.2g} by the record", name, gain, quantile_95 * deviation),
         score->score, score->explained, found - theta});
  };
  const std::vector<Index> outputs = output_channels(record), inputs = input_channels(record);
  for (Index i = 0; i < std::ssize(outputs) && outputs.size() > 1; ++i)
    add(record.channels[static_cast<std::size_t>(outputs[static_cast<std::size_t>(i)])].name, left.gain_of(i),
        false, [i](RecordLines& lines, double gain) { lines.outputs.row(i) /= gain; });
  const std::string driver = inputs.size() == 1 ? record.channels[static_cast<std::size_t>(inputs[0])].name
                                                : "the inputs, beside that of the outputs,";
  add(driver, left.gain_of_inputs(), true, [](RecordLines& lines, double gain) { lines.inputs *= gain; });
}

/// Of records whose inputs hold noise, which clocks/likeliest_clock.hpp takes for exact.
void add_lags(const Record& record, const LineScores& left, std::vector<DescriptionFault>& faults) {
  constexpr double largest = 2.0;  // sampling intervals: a linear step holds for no more
  const auto add = [&](const std::string& name, std::optional<Index> channel) {
    const auto score = left.score(left.lag_of(channel));
    if (!score || !(score->score > sure_score) || std::abs(score->change) > largest) return;
    const double lag = record.interval() * score->change;
    faults.push_back(
        {fmt::format("{} {:.3g} +- {:.2g} ms {} by the record", name, 1e3 * std::abs(lag),
                     1e3 * quantile_95 * record.interval() * score->deviation, lag > 0.0 ? "late" : "early"),
         score->score, score->explained, score->moved});
  };
  const std::vector<Index> outputs = output_channels(record);
  for (std::size_t i = 0; i < outputs.size() && outputs.size() > 1; ++i)
    add(record.channels[static_cast<std::size_t>(outputs[i])].name, static_cast<Index>(i));
  add("the inputs are", {});
}

/// Inputs that run by lines between their samples, as simulations make them, where they are taken for
/// band-limited.
void add_path(const DrivenProblem& problem, const Record& record, const LineScores& left,
              const VectorXd& theta, std::vector<DescriptionFault>& faults) {
  if (problem.path != InputPath::band_limited) return;
  DrivenProblem other = problem;
  other.path = InputPath::linear;
  const auto fit = promising_fit(other, theta, evaluate_driven(problem, theta).cost);
  if (!fit) return;
  const double whole = std::max(left.left().squaredNorm(), 1e-300),
               share = std::max(LineScores(other, fit->theta).left().squaredNorm() / whole, 1e-300),
               score = std::sqrt(static_cast<double>(left.left().size()) * -std::log(std::min(share, 1.0)));
  // Where less of the residual goes, a sensor's low-pass looks alike.
  if (!(share < 1.0 - mostly) || !(score > sure_score)) return;
  const std::vector<Index> inputs = input_channels(record);
  const std::string who = inputs.size() == 1 ? record.channels[static_cast<std::size_t>(inputs[0])].name +
                                                   " runs linearly between its"
                                             : "the inputs run linearly between their";
  faults.push_back({who + " samples by the record: input = \"linear\" in [record]", score, 1.0 - share,
                    fit->theta - theta});
}

/// Every sensor of a chain at every other floor, and every two of one quantity exchanged.
void add_places(const DrivenProblem& problem, const OtherModels& models, const Experiment& experiment,
                const Record& record, const LineScores& left, const VectorXd& theta,
                std::vector<DescriptionFault>& faults) {
  constexpr std::size_t most_floors = 12;
  std::vector<double> floors;
  if (experiment.structure.is_chain())
    for (const fem::Body& body : experiment.structure.beam().bodies) floors.push_back(body.position);
  if (floors.empty() || floors.size() > most_floors) return;
  Record other = record;
  const auto add = [&, whole = left.left().squaredNorm()](const std::string& sentence) {
    try {
      const JointModel model = models.of(other);
      DrivenProblem there = problem;
      there.model = &model;
      // The start came from sensors where they are not: what was known before is as described again.
      for (std::size_t j = 0; j < model.unknowns.size(); ++j)
        there.prior.mean[static_cast<Index>(j)] = model.unknowns[j].to_state(model.unknowns[j].guess);
      auto [best, moved] = std::pair(whole, theta);
      DrivenProblem anew = there;  // its weights become those of its own residual
      if (const auto fit = fit_driven(anew))
        if (const double cost = evaluate_driven(there, fit->theta).cost; cost < best)
          best = cost, moved = fit->theta;
      if (1.0 - best / whole > worth_following)
        faults.push_back(
            {sentence, std::numeric_limits<double>::infinity(), 1.0 - best / whole, moved - theta});
    } catch (const std::exception&) {  // no motion there
    }
  };
  const std::vector<Index> outputs = output_channels(record);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    Channel& one = other.channels[static_cast<std::size_t>(outputs[i])];
    const std::optional<double> described = one.position;
    if (!described) continue;
    for (const double floor : floors) {
      if (std::abs(floor - *described) < 1e-6 * floors.back()) continue;
      one.position = floor;
      add(fmt::format("{} sits at {:g} m by the record, not at {:g} m", one.name, floor, *described));
    }
    one.position = described;
    for (std::size_t j = i + 1; j < outputs.size(); ++j) {
      Channel& two = other.channels[static_cast<std::size_t>(outputs[j])];
      if (two.quantity != one.quantity || !two.position || two.position == one.position) continue;
      std::swap(one.position, two.position);
      add(fmt::format("{} and {} are exchanged: by the record the first sits at {:g} m, the second at {:g} m",
                      one.name, two.name, *one.position, *two.position));
      std::swap(one.position, two.position);
    }
  }
}

/// With the estimates as guesses: a model takes the modes of its damping, for one, from there.
Experiment at_estimates(Experiment experiment, const JointModel& model, const VectorXd& theta) {
  const std::size_t count = std::min(experiment.parameters.size(), model.unknowns.size());
  for (std::size_t j = 0; j < count; ++j)
    if (experiment.parameters[j].quantity == model.unknowns[j].quantity)
      experiment.parameters[j].guess = model.unknowns[j].to_physical(theta[static_cast<Index>(j)]);
  return experiment;
}

}  // namespace

DescriptionTests description_tests(const Experiment& experiment, const Record& record,
                                   const Choice& reduction, const std::filesystem::path& folder,
                                   const JointModel& model, const filters::Gaussian& prior,
                                   const VectorXd& theta, const VectorXd& input_noise) {
  DescriptionTests tests;
  std::vector<DescriptionFault>& faults = tests.faults;
  auto problem = driven_problem(model, measurements(record), prior);
  if (!problem) return tests;
  const Index stride = keep_few_lines(*problem);
  try {
    if (has_noise(input_noise)) problem->input_noise = input_noise;
    const DrivenFit fit = weigh_by_residual(*problem, theta);
    const LineScores left(*problem, theta);
    if (problem->path == InputPath::band_limited)  // lines of other inputs have images beside them
      tests.deviations = left.deviations() / std::sqrt(static_cast<double>(stride));
    const Experiment there = at_estimates(experiment, model, theta);
    const OtherModels models(there, record, reduction, folder),
        as_described(experiment, record, reduction, folder);
    constexpr double much = 0.03, misplaced = 0.15;  // a sensor one floor off: a residual of 20 % and more
    add_structure_changes(*problem, models, experiment, left, theta, fit.left_share > much,
                          measures_force(record), faults);
    add_gains(*problem, record, left, theta, faults);
    add_path(*problem, record, left, theta, faults);
    if (problem->input_noise.size() > 0) add_lags(record, left, faults);
    if (fit.left_share > misplaced)
      add_places(*problem, as_described, experiment, record, left, theta, faults);
    add_other_damping(*problem, models, there, left, theta, faults);
  } catch (const std::runtime_error&) {  // no motion at these unknowns
  }
  for (DescriptionFault& fault : faults)
    fault.gain = 0.5 * static_cast<double>(stride) * fault.score * fault.score;
  std::ranges::stable_sort(faults, std::greater<>(), &DescriptionFault::explained);
  return tests;
}

std::string wrong_reading(const JointModel& model, const Record& record, const filters::Gaussian& known) {
  constexpr double poor = 0.5, good = 0.3;  // of the lines' size, what the best fit leaves
  auto problem = driven_problem(model, measurements(record), known);
  if (!problem) return {};
  keep_few_lines(*problem);
  const auto left_with = [&](const std::function<void(RecordLines&)>& change) {
    DrivenProblem other = *problem;
    change(other.parts.front());
    const auto fit = fit_driven(other);
    return fit ? fit->left_share : 1.0;
  };
  const double described = left_with([](RecordLines&) {});
  if (!(described > poor)) return {};
  const std::vector<Index> outputs = output_channels(record), inputs = input_channels(record);
  const auto name = [&](Index channel) { return record.channels[static_cast<std::size_t>(channel)].name; };
  struct Reading {
    double factor;
    const char* text;
  };
  for (const auto& [factor, text] :
       {Reading{-1.0, "has the other sign"},
        Reading{1.0 / standard_gravity, "is 9.80665 times too large, as g read as m/s2"},
        Reading{standard_gravity, "is 9.80665 times too small, as m/s2 read as g"}}) {
    const auto sentence = [&](const std::string& who, double left) {
      return fmt::format("{} {}: otherwise the model explains {:.0f} % of the motion, as described {:.0f} %",
                         who, text, 100.0 * (1.0 - left), 100.0 * std::max(0.0, 1.0 - described));
    };
    if (const double left = left_with([&](RecordLines& other) { other.inputs *= factor; }); left < good)
      return sentence(inputs.size() == 1 ? name(inputs[0]) : "the input", left);
    for (std::size_t i = 0; i < outputs.size() && outputs.size() > 1; ++i)
      if (const double left =
              left_with([&](RecordLines& other) { other.outputs.row(static_cast<Index>(i)) *= factor; });
          left < good)
        return sentence(name(outputs[i]), left);
  }
  return {};
}

}  // namespace beamid::experiments
