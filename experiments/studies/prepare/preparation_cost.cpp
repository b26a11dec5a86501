#include "experiments/studies/prepare/preparation_report.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "experiments/modal/classic_estimators.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/record/prepare/preparation_step.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Steps = std::vector<std::unique_ptr<PreparationStep>>;
constexpr double no_cost_value = std::numeric_limits<double>::quiet_NaN();

/// The mode, and when it starts [s].
struct Decay {
  Complex rate;
  double onset;

  /// Re e^(s (t - onset)) from the onset on, zero before.
  Eigen::VectorXd at(const Eigen::VectorXd& time) const {
    return time.unaryExpr([this](double t) { return t < onset ? 0.0 : std::exp(rate * (t - onset)).real(); });
  }
};

/// Between two instants, what a fit finds of the decay.
struct Found {
  ModalChange change;
  Complex factor{no_cost_value, no_cost_value};
  double decrement_damping = no_cost_value;
};

Found fitted(const Record& record, Eigen::Index row, double from, double to, const Decay& decay) {
  constexpr Eigen::Index fewest = 16;
  Found found;
  const double *begin = record.time.data(), *end = begin + record.size();
  const double slack = 1e-6 * record.interval();
  const Eigen::Index first = std::lower_bound(begin, end, from - slack) - begin;
  const Eigen::Index count = std::upper_bound(begin, end, to + slack) - begin - first;
  if (count < fewest) return found;
  const Eigen::VectorXd signal = record.samples.row(row).segment(first, count).transpose();
  const double span = record.time[first + count - 1] - record.time[first];
  if (span * decay.rate.imag() < 2 * std::numbers::pi || !(signal.cwiseAbs().maxCoeff() > 0)) return found;
  const auto ratio = [](Complex rate) { return -rate.real() / std::abs(rate); };
  try {
    const DampedSine sine = fit_damped_sines(signal, record.interval(), {decay.rate}).sines[0];
    found.change = {std::abs(sine.rate) / std::abs(decay.rate) - 1, ratio(sine.rate) / ratio(decay.rate) - 1};
    found.factor = sine.amplitude / std::exp(decay.rate * (record.time[first] - decay.onset));
    const double change =
        logarithmic_decrement(signal, record.interval()).damping_ratio / ratio(decay.rate) - 1;
    if (std::abs(change) < 1) found.decrement_damping = change;  // beyond, drift hides the decay from it
  } catch (const std::exception&) {                              // NaN says that it found nothing
  }
  return found;
}

/// Fills in what the fits find in one channel of what is left, from `settled_from` to `settled_to` at best.
void fit(StepCost& cost, const Record& left, Eigen::Index row, double settled_from, double settled_to,
         const Decay& decay) {
  const double last = left.time[left.size() - 1];
  const Found whole = fitted(left, row, std::max(left.time[0], decay.onset), last, decay);
  const Found settled =
      fitted(left, row, std::max(settled_from, decay.onset), std::min(settled_to, last), decay);
  cost.whole = whole.change;
  cost.decrement_damping = whole.decrement_damping;
  cost.settled = settled.change;
  cost.fitted_factor = settled.factor;
}

/// The stamps before every step and behind the last, and the onset, of the record itself.
struct Course {
  std::vector<Record> stages;
  std::optional<double> onset;
  std::vector<bool> cuts;  ///< whether the step looks for an event
};

Course run(const Steps& steps, const Record& record) {
  Course course{{record}, {}, {}};
  for (const auto& step : steps) {
    Record now = course.stages.back();
    const std::optional<double> onset = step->onset(now);
    if (onset && !course.onset) course.onset = onset;
    course.cuts.push_back(onset.has_value());
    apply(*step, now);
    course.stages.push_back(std::move(now));
  }
  return course;
}

/// The step on a clean record; a cut is the one made in the record.
void apply_step(const PreparationStep& step, bool cuts, const Record& after, Record& clean) {
  if (cuts)
    clean = clean.window(after.time[0], after.time[after.size() - 1]);
  else
    apply(step, clean);
}

std::string step_name_of(const Channel& channel) {
  return to_string(channel.quantity) + (channel.name.empty() ? "" : " " + channel.name);
}

}  // namespace

PreparationCost preparation_cost(const std::vector<Choice>& choices, const Record& record,
                                 double frequency_hz, double damping_ratio,
                                 const std::optional<std::pair<double, double>>& window) {
  if (!(frequency_hz > 0 && damping_ratio > 0 && damping_ratio < 1))
    throw std::invalid_argument("mode at " + std::to_string(frequency_hz) + " Hz with damping ratio " +
                                std::to_string(damping_ratio) +
                                "; expected a positive frequency and a ratio between 0 and 1");
  Steps steps;
  for (const Choice& choice : choices) steps.push_back(step_registry().make(choice.name, choice.options));
  const Course course = run(steps, analysable(record, window).record);
  const Decay decay{2 * std::numbers::pi * frequency_hz *
                        Complex(-damping_ratio, std::sqrt(1 - damping_ratio * damping_ratio)),
                    course.onset.value_or(record.time[0])};
  const auto motion = std::find_if(record.channels.begin(), record.channels.end(),
                                   [](const Channel& channel) { return !is_input(channel.quantity); });
  const Channel& first = motion == record.channels.end() ? record.channels.front() : *motion;

  PreparationCost cost{frequency_hz, damping_ratio, {}, {}};
  Record chain;
  chain.time = record.time;
  chain.time_resolution = record.time_resolution;
  chain.samples = decay.at(record.time).transpose();
  chain.channels = {first};
  std::vector<FollowedChannel> followed{{first}};
  double settled_from = decay.onset, settled_to = record.time[record.size() - 1];
  bool exact = true;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Record& after = course.stages[i + 1];
    const double interval = chain.interval();
    const Transient transient = steps[i]->transient(interval);
    std::vector<FollowedChannel> alone{followed.front()};
    alone[0].factor = 1;
    Record one = chain;
    const Decay own{decay.rate, std::max(decay.onset, chain.time[0])};
    one.samples = own.at(chain.time).transpose();
    one.channels = {followed.front().channel};
    StepCost step;
    step.step = choices[i].name;
    step.transient_begin = transient.begin;
    step.transient_end = transient.end;
    step.exact = steps[i]->exact();
    try {
      apply_step(*steps[i], course.cuts[i], after, one);
      steps[i]->follow(alone, decay.rate, interval);
      step.factor = alone.back().factor;
      fit(step, one, one.samples.rows() - 1, std::max(own.onset, one.time[0]) + transient.begin,
          one.time[one.size() - 1] - transient.end, own);
    } catch (const std::invalid_argument&) {  // it acts on other channels only
      step.acts = false;
    }
    cost.steps.push_back(step);
    try {
      apply_step(*steps[i], course.cuts[i], after, chain);
    } catch (const std::invalid_argument&) {
      continue;
    }
    steps[i]->follow(followed, decay.rate, interval);
    exact = exact && step.exact;
    settled_from = std::max(settled_from, chain.time[0]) + transient.begin;
    settled_to = std::min(settled_to, chain.time[chain.size() - 1]) - transient.end;
  }
  if (window) chain = chain.window(window->first, window->second);
  for (std::size_t row = 0; row < followed.size(); ++row) {
    StepCost together;
    together.step = step_name_of(followed[row].channel);
    together.exact = exact;
    together.factor = followed[row].factor;
    together.transient_begin = std::max(0.0, settled_from - std::max(decay.onset, chain.time[0]));
    together.transient_end = std::max(0.0, chain.time[chain.size() - 1] - settled_to);
    fit(together, chain, static_cast<Eigen::Index>(row), std::max(settled_from, chain.time[0]), settled_to,
        decay);
    cost.together.push_back(together);
  }
  return cost;
}

}  // namespace beamid::experiments
