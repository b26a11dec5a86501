#include "experiments/identify/update/update_study.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/identify/update/updating.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t most_remedies = 3, remedy_starts = 3, most_exchanged_sensors = 12;

/// The measurement as it would be without one error.
struct Remedied {
  std::string sentence;  ///< "Without the mode at 3 Hz"
  ModalData data;
  std::vector<fem::Point> points;  ///< of the shapes
  std::string question;
};

std::string sensor_name(const Experiment& experiment, std::size_t sensor) {
  const std::string& name = experiment.sensors[sensor].name;
  return name.empty() ? fmt::format("{}", sensor + 1) : fmt::format("'{}'", name);
}

void without_modes(const RemedyRequest& request, std::vector<Remedied>& all) {
  for (std::size_t i = 0; i < request.data.modes.size() && request.data.modes.size() > 1; ++i) {
    all.push_back({fmt::format("Without the mode at {:.4g} Hz", request.data.modes[i].frequency_hz),
                   request.data, request.model.points(),
                   "is it one of the structure's, and measured as described?"});
    all.back().data.modes.erase(all.back().data.modes.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void with_a_mode_missing(const RemedyRequest& request, std::vector<Remedied>& all) {
  const auto count = static_cast<Index>(request.data.modes.size());
  for (const MeasuredMode& mode : request.data.modes)
    if (mode.number || request.model.modes() <= count) return;
  for (Index missing = 0; missing < count; ++missing) {
    all.push_back({fmt::format("Were mode {} missing in the file, then", missing + 1), request.data,
                   request.model.points(), "if it was not found, state so by the key 'mode' of [[modes]]."});
    for (Index i = 0; i < count; ++i)
      all.back().data.modes[static_cast<std::size_t>(i)].number =
          static_cast<int>(i < missing ? i + 1 : i + 2);
  }
}

void without_a_sensor(const RemedyRequest& request, std::vector<Remedied>& all) {
  const std::size_t sensors = request.model.points().size();
  for (std::size_t s = 0; s < sensors && sensors > 2; ++s) {
    all.push_back({fmt::format("Without sensor {}", sensor_name(request.experiment, s)), request.data,
                   request.model.points(), "are its gain, place and direction as described?"});
    all.back().points.erase(all.back().points.begin() + static_cast<std::ptrdiff_t>(s));
    for (MeasuredMode& mode : all.back().data.modes) {
      if (mode.shape.size() < 2) continue;
      const VectorXd whole = mode.shape;
      mode.shape.resize(whole.size() - 1);
      for (Index i = 0; i < mode.shape.size(); ++i)
        mode.shape[i] = whole[i < static_cast<Index>(s) ? i : i + 1];
    }
  }
}

void with_sensors_exchanged(const RemedyRequest& request, std::vector<Remedied>& all) {
  const std::size_t sensors = std::min(request.model.points().size(), most_exchanged_sensors);
  for (std::size_t a = 0; a < sensors; ++a)
    for (std::size_t b = a + 1; b < sensors; ++b) {
      all.push_back({fmt::format("With sensors {} and {} exchanged", sensor_name(request.experiment, a),
                                 sensor_name(request.experiment, b)),
                     request.data, request.model.points(), "does each sit where the file states?"});
      for (MeasuredMode& mode : all.back().data.modes)
        if (mode.shape.size() > 1)
          std::swap(mode.shape[static_cast<Index>(a)], mode.shape[static_cast<Index>(b)]);
    }
}

std::optional<Remedy> fitted(const RemedyRequest& request, const Remedied& one) {
  const ModalModel model(request.experiment.structure, request.experiment.elements, one.points,
                         request.model.asked(), request.model.modes());
  const ModalResidual residual(model, request.space, one.data, request.trust);
  std::optional<Fit> best = least_squares(residual, request.updating.best().fit.x);
  for (std::size_t start = 0; start < remedy_starts; ++start)
    if (auto fit = least_squares(residual, request.space.start(start));
        fit && (!best || fit->chi_square() < best->chi_square()))
      best = std::move(fit);
  if (!best) return std::nullopt;
  const Index determined = request.updating.independent - request.updating.freedom,
              freedom = residual.independent(best->value) - determined;
  if (freedom < 1) return std::nullopt;
  const double limit = chi_square_limit(static_cast<double>(freedom));
  if (best->chi_square() > limit) return std::nullopt;
  return Remedy{fmt::format("{} these parameters explain the modes (chi^2 = {:.3g}, limit {:.3g}): {}",
                            one.sentence, best->chi_square(), limit, one.question),
                best->chi_square()};
}

}  // namespace

std::vector<Remedy> remedies(const RemedyRequest& request) {
  std::vector<Remedied> all;
  without_modes(request, all);
  if (request.data.has_shapes()) {
    without_a_sensor(request, all);
    with_sensors_exchanged(request, all);
  } else {
    with_a_mode_missing(request, all);
  }
  std::vector<Remedy> found;
  for (const Remedied& one : all)
    if (auto remedy = fitted(request, one)) found.push_back(std::move(*remedy));
  std::stable_sort(found.begin(), found.end(),
                   [](const Remedy& a, const Remedy& b) { return a.chi_square < b.chi_square; });
  std::erase_if(found, [best = found.empty() ? 0.0 : found.front().chi_square](const Remedy& one) {
    return one.chi_square > best + as_well_chi_square;
  });
  if (found.size() > most_remedies) found.resize(most_remedies);
  return found;
}

namespace {

// What suggests that measured modes are not what they are taken for.

struct LogRatios {
  double mean = 0.0, spread = 0.0;
};

LogRatios mean_and_spread(const VectorXd& logs) {
  const double mean = logs.mean();
  return {mean, std::sqrt((logs.array() - mean).square().mean())};
}

// Measured over described frequencies, the modes being numbered so.
LogRatios frequency_ratios(const UpdateStudy& study, const std::vector<Index>& numbers) {
  VectorXd logs(static_cast<Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    logs[static_cast<Index>(i)] =
        std::log(study.data().modes[i].frequency_hz / study.described.frequency_hz[numbers[i]]);
  return mean_and_spread(logs);
}

void add_units(const UpdateStudy& study, std::vector<Objection>& objections) {
  const double factor = std::exp(frequency_ratios(study, pair_modes(study.data(), study.described)).mean);
  const double turn = 2.0 * std::numbers::pi;
  if (std::abs(std::log(factor / turn)) < 0.2)
    objections.emplace_back(
        "unit_of_frequency",
        fmt::format("The measured frequencies are {:.3g} times those described, about 2 pi: are "
                    "they in rad/s? Expected Hz.",
                    factor));
  else if (std::abs(std::log(factor * turn)) < 0.2)
    objections.emplace_back(
        "unit_of_frequency",
        fmt::format("The measured frequencies are {:.3g} times those described, about 1 / (2 "
                    "pi): were they divided by 2 pi twice?",
                    factor));
  else if (std::abs(std::log(factor)) > std::log(2.5))
    objections.emplace_back(
        "unit_of_frequency",
        fmt::format("The measured frequencies are {:.3g} times those described: a mass, a unit "
                    "or the numbering of the modes may be wrong.",
                    factor));
}

// One mode left out that makes the ratios alike.
void add_missing(const UpdateStudy& study, std::vector<Objection>& objections) {
  const auto count = static_cast<Index>(study.data().modes.size());
  const bool numbered = std::any_of(study.data().modes.begin(), study.data().modes.end(),
                                    [](const MeasuredMode& mode) { return mode.number.has_value(); });
  if (study.data().has_shapes() || numbered || count < 2 || study.described.frequency_hz.size() <= count)
    return;
  std::vector<Index> numbers(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) numbers[static_cast<std::size_t>(i)] = i;
  const double in_order = frequency_ratios(study, numbers).spread;
  Index missing = -1;
  double least = in_order;
  for (Index skipped = count - 1; skipped >= 0; --skipped) {
    numbers[static_cast<std::size_t>(skipped)] = skipped + 1;
    if (const double spread = frequency_ratios(study, numbers).spread; spread < least)
      least = spread, missing = skipped;
  }
  if (missing < 0 || in_order < 0.05 || least > 0.4 * in_order) return;
  objections.emplace_back(
      "missing_mode",
      fmt::format(
          "The frequencies are taken for modes 1 to {0}. Without mode {1} among them they "
          "would be nearer to those described: if it was not found, state so by the key 'mode' of [[modes]].",
          count, missing + 1));
}

double mean_assurance(const ModalData& data, const PredictedModes& modes) {
  const MatrixXd assurance = modal_assurances(data, modes);
  const std::vector<Index> pairs = pair_modes(data, modes);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (const double mac = assurance(static_cast<Index>(i), pairs[i]); std::isfinite(mac))
      sum += mac, ++count;
  return count > 0 ? sum / count : 1.0;
}

// A sensor whose readings turned round bring shapes and predictions together.
void add_signs(const UpdateStudy& study, std::vector<Objection>& objections) {
  if (!study.data().has_shapes()) return;
  constexpr double much = 0.15;
  double best_gain = much;
  Index turned = -1;
  for (const PredictedModes* modes : {&study.described, &study.updating.best().fit.value.modes}) {
    const double before = mean_assurance(study.data(), *modes);
    for (Index sensor = 0; sensor < modes->shapes.rows() && modes->shapes.rows() > 2; ++sensor) {
      ModalData data = study.data();
      for (MeasuredMode& mode : data.modes)
        if (mode.shape.size() > 1) mode.shape[sensor] = -mode.shape[sensor];
      const double after = mean_assurance(data, *modes);
      if (after > 0.8 && after - before > best_gain) best_gain = after - before, turned = sensor;
    }
  }
  if (turned >= 0)
    objections.emplace_back(
        "sign", fmt::format("With the sign of sensor {} turned round the shapes are much nearer to the "
                            "predicted ones (mean MAC {:+.2f}): is it mounted the other way?",
                            turned + 1, best_gain));
}

// All parameters by one factor: what is wrong is elsewhere.
void add_common_factor(const UpdateStudy& study, std::vector<Objection>& objections) {
  const VectorXd& x = study.updating.best().fit.x;
  if (x.size() < 2 || !study.updating.open.empty()) return;
  for (Index j = 0; j < x.size(); ++j)
    if (!study.space->logarithmic(j)) return;
  const LogRatios factor = mean_and_spread(x);
  if (std::abs(factor.mean) < 0.35 || factor.spread > 0.3 * std::abs(factor.mean)) return;
  objections.emplace_back(
      "common_factor",
      fmt::format("All parameters changed alike, by a factor of {:.3g} in the mean: a mass or a unit that is "
                  "wrong does that, too. Frequencies determine only the ratio of stiffness to mass.",
                  std::exp(factor.mean)));
}

void add_strange_shapes(const UpdateStudy& study, std::vector<Objection>& objections) {
  const auto& value = study.updating.best().fit.value;
  const MatrixXd assurance = modal_assurances(study.data(), value.modes);
  for (std::size_t i = 0; i < value.pairs.size(); ++i)
    if (const double mac = assurance(static_cast<Index>(i), value.pairs[i]); mac < 0.8)
      objections.emplace_back(
          "strange_shape",
          fmt::format("The shape at {:.4g} Hz resembles no predicted one: MAC {:.2f} at best.",
                      study.data().modes[i].frequency_hz, mac));
}

// Where two modes are nearly one frequency a test measures any two shapes of their plane. Within 1 % shapes
// are held against the plane, beyond it one against one: near that border the estimate hangs on where it
// lies.
void add_close_pairs(const UpdateStudy& study, std::vector<Objection>& objections) {
  constexpr double nearest = 0.005, farthest = 0.02;
  std::vector<double> frequencies;
  for (const MeasuredMode& mode : study.data().modes)
    if (mode.shape.size() > 1) frequencies.push_back(mode.frequency_hz);
  std::sort(frequencies.begin(), frequencies.end());
  for (std::size_t i = 1; i < frequencies.size(); ++i) {
    const double gap = frequencies[i] / frequencies[i - 1] - 1.0;
    if (gap < nearest || gap > farthest) continue;
    objections.emplace_back(
        "close_pair",
        fmt::format(
            "The modes at {:.5g} and {:.5g} Hz are so close that a test may have mixed their shapes. What "
            "rests "
            "on which is which, x and y exchanged for one, may be wrong by more than its interval: do the "
            "estimates "
            "stay without these two shapes?",
            frequencies[i - 1], frequencies[i]));
  }
}

/// Sentences: frequencies in rad/s, a mode missing in between, a sensor with the wrong sign, a mass or unit
/// that is wrong by a factor, modes that no predicted one resembles.
std::vector<Objection> update_objections(const UpdateStudy& study) {
  std::vector<Objection> objections;
  for (const std::string& warning : study.data().objections)
    objections.emplace_back("measured_modes", "beamid modal warned of these modes: " + warning);
  for (const Remedy& remedy : study.remedies) objections.emplace_back("remedy", remedy.sentence);
  add_units(study, objections);
  add_missing(study, objections);
  add_signs(study, objections);
  add_common_factor(study, objections);
  add_strange_shapes(study, objections);
  add_close_pairs(study, objections);
  return objections;
}

constexpr Index spare_modes = 4;  // beyond those measured, for pairing

// Of the shapes; without any, the natural point.
std::vector<fem::Point> sensor_points(const Experiment& experiment, bool shapes) {
  std::vector<fem::Point> points;
  for (const Sensor& sensor : experiment.sensors) {
    if (!shapes) break;
    if (sensor.quantity == Quantity::strain || is_angular(sensor.quantity))
      throw std::invalid_argument("sensor '" + sensor.name + "' reads " + to_string(sensor.quantity) +
                                  "; expected displacement, velocity or acceleration where "
                                  "shapes are compared");
    points.push_back({fmt::format("sensor{}", points.size() + 1),
                      sensor.position ? *sensor.position : fem::natural_point(experiment.structure).position,
                      sensor.place});
  }
  if (points.empty()) points.push_back(fem::natural_point(experiment.structure));
  return points;
}

Index modes_needed(const ModalData& data) {
  const auto count = static_cast<Index>(data.modes.size());
  Index last = count;
  for (const MeasuredMode& mode : data.modes) last = std::max<Index>(last, mode.number.value_or(0));
  return data.has_shapes() ? std::max(last, count + spare_modes) : last + 1;
}

}  // namespace

UpdateStudy study_update(const Experiment& experiment, const ModalData& data, const UpdateSettings& settings,
                         const Progress& progress) {
  UpdateStudy study;
  study.settings = settings;
  study.model = std::make_unique<const ModalModel>(experiment.structure, experiment.elements,
                                                   sensor_points(experiment, data.has_shapes()),
                                                   asked_parameters(experiment), modes_needed(data));
  study.space = std::make_unique<const SearchSpace>(study.model->asked());
  study.residual = std::make_unique<const ModalResidual>(*study.model, *study.space, data, settings.trust);
  study.described = study.model->at(study.space->physical(VectorXd::Zero(study.space->size())), false);
  study.twins = exact_twins(*study.model, data, progress);
  study.updating = update(*study.residual, settings, study.twins.values, progress);
  std::vector<VectorXd> as_well;
  for (const ParameterSet& set : study.updating.sets)
    if (set.as_well) as_well.push_back(set.values);
  study.deciding = deciding_measurements(*study.model, data, as_well, settings.trust);
  if (study.updating.refuted && study.model->dense())
    study.remedies = remedies({experiment, *study.model, *study.space, data, settings.trust, study.updating});
  study.objections = update_objections(study);
  return study;
}

ModalData described_modes(const Experiment& experiment) {
  const AskedParameters asked = asked_parameters(experiment);
  const auto q = static_cast<Index>(asked.unknowns.size());
  const ModalModel model(experiment.structure, experiment.elements,
                         {fem::natural_point(experiment.structure)}, asked, q);
  VectorXd guess(q);
  for (Index j = 0; j < q; ++j) guess[j] = asked.unknowns[static_cast<std::size_t>(j)].guess;
  const PredictedModes modes = model.at(guess, false);
  ModalData data{"the structure as described", {}};
  for (Index i = 0; i < modes.frequency_hz.size(); ++i) data.modes.push_back({modes.frequency_hz[i]});
  return data;
}

}  // namespace beamid::experiments
