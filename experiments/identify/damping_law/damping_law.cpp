#include "experiments/identify/damping_law/damping_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/spelling.hpp"
#include "fem/modes.hpp"
#include "filters/batch_estimator.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double slow_samples_per_period = 8.0, steps_per_period = 48.0;
constexpr Index fewest_slow_samples = 64;  // samples that must be left

}  // namespace

MatrixXd SlowRecord::measured(const MatrixXd& fine_columns) const {
  MatrixXd kept(fine_columns.rows(), samples.cols());
  for (Index k = 0; k < kept.cols(); ++k) kept.col(k) = fine_columns.col(k * steps);
  return kept;
}

SlowRecord slow_record(const filters::Measurements& record, Index inputs, double frequency_hz) {
  const Index all = record.size();
  const double dt = record.interval();
  SlowRecord slow;
  slow.factor = decimation_factor(1.0 / (slow_samples_per_period * frequency_hz * dt),
                                  all / (fewest_slow_samples + 10));
  slow.interval = slow.factor * dt;
  slow.samples = decimate_channels(record.outputs, slow.factor);
  const double start = slow.factor == 1 ? 0.0 : 5 * slow.interval;
  const Index m = slow.samples.cols();
  slow.time = record.time[0] + start +
              slow.interval * VectorXd::LinSpaced(m, 0.0, static_cast<double>(m - 1)).array();
  slow.steps = std::max(1, static_cast<int>(std::ceil(steps_per_period * frequency_hz * slow.interval)));
  const Index n = (m - 1) * slow.steps + 1;
  slow.fine.time =
      slow.interval / slow.steps * VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)).array();
  slow.fine.outputs.setConstant(slow.samples.rows(), n, std::numeric_limits<double>::quiet_NaN());
  for (Index k = 0; k < m; ++k) slow.fine.outputs.col(k * slow.steps) = slow.samples.col(k);
  if (record.inputs.size() == 0) return slow;
  slow.fine.inputs =
      filters::in_parts(decimated_inputs(record, inputs, slow.factor, slow.time), slow.steps).columns;
  return slow;
}

VectorXd noise_near(const MatrixXd& left, double interval, double frequency_hz, double fitted) {
  const Index m = left.cols();
  const double resolution = 1.0 / (interval * static_cast<double>(m));
  const auto from = std::max<Index>(1, static_cast<Index>(0.5 * frequency_hz / resolution)),
             to = std::min<Index>(m / 2 - 1, static_cast<Index>(std::ceil(1.5 * frequency_hz / resolution)));
  const auto lines = static_cast<double>(to - from + 1);
  VectorXd noise(left.rows());
  const Eigen::MatrixXcd found = lines_between(left.transpose(), from, std::max<Index>(0, to - from + 1));
  for (Index i = 0; i < left.rows(); ++i) {
    const double power = found.row(i).squaredNorm() / static_cast<double>(m);
    // Two numbers a line; a fit makes as many of them vanish as it has unknowns.
    const double dense = power / std::max(0.25 * lines, lines - 0.5 * fitted);
    const double whole = left.row(i).squaredNorm() / std::max(1.0, static_cast<double>(m) - fitted);
    noise[i] = std::sqrt(std::max(dense, whole));
  }
  return noise;
}

namespace {

using std::numbers::pi;

bool rubs(const std::string& law) {
  return law == "coulomb" || law == "both";
}
bool drags(const std::string& law) {
  return law == "quadratic" || law == "both";
}

// Amplitudes of the first channel's mode as displacement [m], at the ends of the record, as if its damping
// did not change.
void take_amplitudes(const Record& record, DampingLawStudy& study) {
  const double omega = 2.0 * pi * study.modal.frequency_hz;
  const Quantity quantity = record.channels[output_channels(record)[0]].quantity;
  const double span = record.time[record.size() - 1] - record.time[0];
  study.first_amplitude =
      study.modal.amplitude * displacement_per_reading(quantity, study.modal.frequency_hz);
  study.last_amplitude = study.first_amplitude * std::exp(-study.modal.damping_ratio * omega * span);
}

JointModel model_of(const std::string& law, ModelSetting setting, double friction_velocity) {
  const auto ask = [&](const char* quantity) {
    ParameterChoice choice;
    choice.quantity = quantity;
    setting.parameters.push_back(choice);
  };
  setting.parameters.clear();
  for (const char* quantity : {"stiffness", "damping", "cubic_stiffness"}) ask(quantity);
  if (rubs(law)) ask("coulomb_friction");
  if (drags(law)) ask("quadratic_damping");
  return std::move(
      *model_registry().make("damped", {{"friction_velocity_m_per_s", friction_velocity}}, setting));
}

// The law against sections of the decay, and the amplitudes that the record shows: it says nothing of smaller
// ones.
void test_by_sections(const Record& record, DampingLawStudy& study) {
  const FittedLaw& law = study.supported();
  const DecaySections found = decay_sections(record, study.modal);
  study.sections = found.sections;
  if (study.sections.empty() || law.state.size() == 0) return;
  study.first_amplitude = std::hypot(law.state[0], law.state[1] / (2.0 * pi * study.modal.frequency_hz));
  study.last_amplitude = found.last_amplitude;
  study.misfit = misfit_of(law, study.sections, static_cast<Index>(law.model.unknowns.size()));
}

// Motion, offsets and the terms that both have; the others begin at zero.
VectorXd carried_over(const FittedLaw& from, const JointModel& to) {
  VectorXd state = VectorXd::Zero(static_cast<Index>(to.motion->state_labels().size()));
  state.head<2>() = from.state.head<2>();
  for (std::size_t j = 0; j < to.unknowns.size(); ++j)
    for (std::size_t i = 0; i < from.model.unknowns.size(); ++i)
      if (from.model.unknowns[i].quantity == to.unknowns[j].quantity)
        state[to.unknown_places[j]] = from.state[from.model.unknown_places[i]];
  for (std::size_t i = 0; i < to.offsets.size(); ++i)
    state[to.offsets[i].place] = from.state[from.model.offsets[i].place];
  return state;
}

class DampingLawFitter {
 public:
  DampingLawFitter(const ModelSetting& setting, const SlowRecord& slow, const ModalEstimate& modal)
      : setting_(setting), slow_(slow), modal_(modal) {}

  // @param start another law's, or null: from the modal analysis
  FittedLaw fit(const std::string& name, double friction_velocity, const VectorXd& noise,
                const FittedLaw* start) const {
    FittedLaw law;
    law.name = name;
    law.model = model_of(name, setting_, friction_velocity);
    const filters::Measurements& record = slow_.fine;
    const double interval = record.time[1] - record.time[0];
    const StartScale scale = start_scale(law.model, setting_.observations, slow_.samples,
                                         record.time[record.size() - 1] - record.time[0]);
    const StartDirections directions = start_directions(law.model, setting_.observations, scale);
    const MatrixXd covariance = noise.cwiseAbs2().asDiagonal();
    const auto discrete = filters::discretise(law.model.motion, interval, "runge_kutta_4", {{}, covariance});
    filters::BatchSettings settings;
    settings.tolerance = 1e-3;
    VectorXd state;
    if (start) {
      state = carried_over(*start, law.model);
    } else {
      settings.first_samples = samples_in(law.model, record, 2.0);
      state = from_modal(law.model);
      state = nearest_phase(*discrete, state, directions, record, settings.first_samples);
    }
    const MatrixXd all = directions.all();
    const filters::BatchEstimate found = filters::estimate_batch(*discrete, state, all, record, settings);
    law.reason = found.reason;
    if (found.status == filters::BatchStatus::failed) return law;
    law.state = found.state;
    law.left = slow_.measured(found.residuals);
    law.log_likelihood = found.log_likelihood;
    law.unknowns = all.cols();
    law.aic = 2.0 * static_cast<double>(law.unknowns) - 2.0 * law.log_likelihood;
    law.bic = std::log(static_cast<double>(found.measured)) * static_cast<double>(law.unknowns) -
              2.0 * law.log_likelihood;
    if (found.covariance.size() == 0) return law;
    law.estimates = estimates(law.model, {found.state, all * found.covariance * all.transpose()});
    law.possible = true;
    for (const Estimate& estimate : law.estimates)
      if (estimate.value < 0.0 && estimate.name != "cubic_stiffness") {
        law.possible = false;
        law.reason =
            fmt::format("{} {:.3g} {} would feed energy in", estimate.name, estimate.value, estimate.unit);
      }
    return law;
  }

 private:
  const ModelSetting& setting_;
  const SlowRecord& slow_;
  const ModalEstimate& modal_;

  VectorXd from_modal(const JointModel& model) const {
    VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
    const double omega = 2.0 * pi * modal_.frequency_hz, mass = model.equivalent_mass;
    for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
      const std::string& quantity = model.unknowns[j].quantity;
      state[model.unknown_places[j]] = quantity == "stiffness" ? mass * omega * omega
                                       : quantity == "damping" ? 2.0 * modal_.damping_ratio * omega * mass
                                       : quantity == "mass"    ? mass
                                                               : 0.0;
    }
    return state;
  }
};

}  // namespace

const std::vector<std::string>& damping_laws() {
  static const std::vector<std::string> laws{"viscous", "coulomb", "quadratic", "both"};
  return laws;
}

double FittedLaw::value(const std::string& quantity) const {
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    if (model.unknowns[j].quantity == quantity && state.size() > 0)
      return model.unknowns[j].to_physical(state[model.unknown_places[j]]);
  return quantity == "mass" ? model.equivalent_mass : 0.0;
}

double FittedLaw::frequency_hz(double a) const {
  return std::sqrt((value("stiffness") + 0.75 * value("cubic_stiffness") * a * a) / value("mass")) /
         (2.0 * pi);
}

double FittedLaw::damping_ratio(double a) const {
  const double omega = 2.0 * pi * frequency_hz(a);
  const double equivalent = value("damping") + 4.0 * value("coulomb_friction") / (pi * a * omega) +
                            8.0 * value("quadratic_damping") * a * omega / (3.0 * pi);
  return equivalent / (2.0 * value("mass") * omega);
}

DampingLawStudy study_damping_law(const Experiment& experiment, const Record& whole, const std::string& law,
                                  const std::filesystem::path& folder) {
  constexpr double smoothing = 0.05;  // of the last velocity: 0.2 % of what friction dissipates there
  constexpr double least = 0.002;     // of the first velocity, which steps of a 48th of a period still follow
  const auto& all = damping_laws();
  if (law != "auto" && std::find(all.begin(), all.end(), law) == all.end())
    throw std::invalid_argument("unknown damping law '" + law + "'; known: auto, " + joined(all));
  DampingLawStudy study;
  study.objections = whole.objections;
  AnalysableRecord ready = analysable(whole);
  if (!ready.remark.empty()) study.remarks.push_back(std::move(ready.remark));
  const Record& record = ready.record;
  const ModelSetting setting = model_setting(experiment, record, experiment.reduction, folder);
  ModalAnalysisSettings modal;
  modal.expected_frequency_hz =
      fem::lowest_frequency_hz(fem::assemble(experiment.structure, experiment.elements));
  study.modal =
      dominant_mode(record.samples.row(output_channels(record)[0]).transpose(), record.interval(), modal);
  take_amplitudes(record, study);
  const SlowRecord slow = slow_record(measurements(record), static_cast<Index>(input_channels(record).size()),
                                      study.modal.frequency_hz);
  study.decimation = slow.factor;
  study.samples = slow.samples;
  study.time = slow.time;
  const double omega = 2.0 * pi * study.modal.frequency_hz;
  study.friction_velocity = omega * std::max(smoothing * study.last_amplitude, least * study.first_amplitude);

  const DampingLawFitter fitter(setting, slow, study.modal);
  const VectorXd size = slow.samples.rowwise().norm() / std::sqrt(static_cast<double>(slow.samples.cols()));
  const FittedLaw first = fitter.fit("viscous", study.friction_velocity, 0.05 * size, nullptr);
  if (first.state.size() == 0) throw std::invalid_argument("no motion fits the record: " + first.reason);
  const FittedLaw richest = fitter.fit("both", study.friction_velocity, 0.05 * size, &first);
  const FittedLaw& reference = richest.state.size() > 0 ? richest : first;
  study.noise = noise_near(reference.left, slow.interval, study.modal.frequency_hz,
                           static_cast<double>(reference.unknowns))
                    .cwiseMax(1e-6 * size);
  study.named = law != "auto";
  for (const std::string& name : all) {
    if (study.named && name != "viscous" && name != law) continue;
    study.laws.push_back(
        fitter.fit(name, study.friction_velocity, study.noise, name == "both" ? &reference : &first));
    if (study.named && name == law) study.chosen = study.laws.size() - 1;
  }
  const auto better = [](const FittedLaw& a, const FittedLaw& b) {
    return a.possible != b.possible ? a.possible : a.bic < b.bic;
  };
  if (!study.named)
    study.chosen = static_cast<std::size_t>(std::min_element(study.laws.begin(), study.laws.end(), better) -
                                            study.laws.begin());
  test_by_sections(record, study);
  return study;
}

double displacement_per_reading(Quantity quantity, double frequency_hz) {
  const double omega = 2.0 * std::numbers::pi * frequency_hz;
  return quantity == Quantity::acceleration ? 1.0 / (omega * omega)
         : quantity == Quantity::velocity   ? 1.0 / omega
                                            : 1.0;
}

DecaySections decay_sections(const Record& record, const ModalEstimate& modal) {
  const Index row = output_channels(record)[0];
  std::vector<std::complex<double>> others;
  for (const CompanionMode& mode : modal.companions)
    others.push_back(std::polar(2.0 * std::numbers::pi * mode.frequency_hz,
                                std::acos(std::clamp(-mode.damping_ratio, -1.0, 1.0))));
  // Sections as short as a mode can be isolated in, a sixteenth of the record at least: more of them tell a
  // law from its neighbours.
  AmplitudeSettings settings;
  const double span = record.time[record.size() - 1] - record.time[0];
  settings.window = std::max(span / 16.0, 6.0 / modal.frequency_hz);
  settings.largest_deviation = 0.5;
  std::vector<AmplitudePoint> points;
  try {
    points = amplitude_dependence(record.samples.row(row).transpose(), record.interval(), modal.rate(),
                                  others, settings);
  } catch (const std::invalid_argument&) {  // shorter than the mode's isolation asks for
    return {};
  }
  DecaySections found;
  std::vector<double> frequency, damping;  // deviation times amplitude
  for (std::size_t i = 0; i < points.size(); i += 2) {
    AmplitudePoint section = points[i];
    section.amplitude *= displacement_per_reading(record.channels[row].quantity, section.frequency_hz);
    frequency.push_back(section.frequency_deviation_hz * section.amplitude);
    damping.push_back(section.damping_ratio_deviation * section.amplitude);
    found.sections.push_back(section);
  }
  for (AmplitudePoint& section : found.sections) {
    section.frequency_deviation_hz = median(frequency) / section.amplitude;
    section.damping_ratio_deviation = median(damping) / section.amplitude;
  }
  if (points.empty()) return found;
  const AmplitudePoint& last = points.back();
  const double rate = 2.0 * std::numbers::pi * last.frequency_hz * last.damping_ratio;
  found.last_amplitude = last.amplitude * std::exp(-0.5 * rate * settings.window) *
                         displacement_per_reading(record.channels[row].quantity, last.frequency_hz);
  return found;
}

LawMisfit misfit_of(const FittedLaw& law, const std::vector<AmplitudePoint>& sections, Index fitted) {
  LawMisfit misfit;
  misfit.sections = static_cast<Index>(sections.size());
  misfit.freedom = 2 * misfit.sections - fitted;
  for (const AmplitudePoint& section : sections) {
    const double ratio = law.damping_ratio(section.amplitude), off = section.damping_ratio - ratio;
    misfit.chi_square +=
        std::pow(off / section.damping_ratio_deviation, 2) +
        std::pow(
            (section.frequency_hz - law.frequency_hz(section.amplitude)) / section.frequency_deviation_hz, 2);
    if (std::abs(off) > std::abs(misfit.largest * ratio)) {
      misfit.largest = off / ratio;
      misfit.at_amplitude = section.amplitude;
    }
  }
  misfit.tested = misfit.freedom > 0;
  misfit.lacks = misfit.tested && misfit.chi_square > chi_square_limit(static_cast<double>(misfit.freedom));
  return misfit;
}

}  // namespace beamid::experiments
