#include "experiments/identify/backbone/whole_record_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>

#include "experiments/identify/backbone/loop_motion.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/models/one_coordinate.hpp"
#include "experiments/signal/decimation.hpp"
#include "filters/batch_estimator.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

constexpr double record_steps_per_period = 48, start_cycles = 3;  // from which the fit grows over the record

/// Samples as they are, and at the fine steps that the registered models take, NaN between.
struct DecaySamples {
  filters::Measurements plain, fine;
  double lost = 0;       ///< before the first of them [s]
  double whiteness = 1;  ///< what the low-pass takes from the variance of white noise
  int steps = 1, factor = 1;
  double frequency_hz = 0;
  Quantity quantity = Quantity::acceleration;

  double interval() const { return plain.time[1] - plain.time[0]; }
  Index size() const { return plain.time.size(); }
};

DecaySamples decay_samples(const VectorXd& signal, double interval, double frequency_hz,
                           double samples_per_period) {
  DecaySamples result;
  const int factor = static_cast<int>(1 / (samples_per_period * frequency_hz * interval));
  result.factor = factor >= 4 ? factor : 1;  // a low-pass costs the first samples, the largest
  const DecimatedSignal kept = decimate(signal, interval, result.factor);
  if (result.factor > 1) result.whiteness = result.factor * kept.kernel.squaredNorm();
  result.lost = kept.start;
  result.frequency_hz = frequency_hz;
  result.steps =
      std::max(1, static_cast<int>(std::ceil(record_steps_per_period * frequency_hz * kept.interval)));
  const Index count = kept.samples.size(), n = (count - 1) * result.steps + 1;
  result.plain.time = kept.interval * VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  result.plain.outputs = kept.samples.transpose();
  result.fine.time = kept.interval / result.steps * VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1));
  result.fine.outputs.setConstant(1, n, std::numeric_limits<double>::quiet_NaN());
  for (Index k = 0; k < count; ++k) result.fine.outputs(0, k * result.steps) = kept.samples[k];
  return result;
}

filters::BatchSettings batch_settings(const DecaySamples& samples, int steps, bool grow, int most) {
  filters::BatchSettings settings;
  settings.tolerance = 1e-2;
  settings.max_iterations = most;  // for each length
  if (grow)
    settings.first_samples =
        static_cast<Index>(start_cycles / (samples.frequency_hz * samples.interval()) * steps);
  return settings;
}

filters::BatchEstimate fine_estimate(const std::shared_ptr<const filters::ContinuousModel>& motion,
                                     const DecaySamples& samples, const VectorXd& state,
                                     const MatrixXd& directions, double noise) {
  const auto discrete = filters::discretise(motion, samples.interval() / samples.steps, "runge_kutta_4",
                                            {{}, MatrixXd::Constant(1, 1, noise * noise)});
  return filters::estimate_batch(*discrete, state, directions, samples.fine,
                                 batch_settings(samples, samples.steps, true, 12));
}

RecordFit record_fit(const std::string& name, const filters::BatchEstimate& found,
                     const DecaySamples& samples, int steps) {
  RecordFit fit;
  fit.name = name;
  fit.reason = found.reason;
  fit.converged = found.status == filters::BatchStatus::converged;
  if (found.status == filters::BatchStatus::failed) return fit;
  fit.residuals.resize(samples.size());
  for (Index k = 0; k < samples.size(); ++k) fit.residuals[k] = found.residuals(0, k * steps);
  fit.left = fit.residuals.norm() / samples.plain.outputs.norm();
  return fit;
}

RecordFit fine_fit(const std::string& name, const filters::BatchEstimate& found,
                   const DecaySamples& samples) {
  return record_fit(name, found, samples, samples.steps);
}

/// Coefficients of a curve that runs as a function does, by least squares on a grid.
template <typename Function>
VectorXd run_as(const SecantCurve& curve, const Function& value) {
  constexpr Index points = 80;
  MatrixXd rows(points, curve.terms());
  VectorXd values(points);
  for (Index i = 0; i < points; ++i) {
    const double x = curve.range() * std::pow(static_cast<double>(i) / (points - 1), 2);
    rows.row(i) = curve.shape(x).transpose();
    values[i] = value(x);
  }
  return rows.colPivHouseholderQr().solve(values);
}

/// From what a fit of a spring begins.
struct LawStart {
  std::function<double(double)> secant, damping;
  double masing = 0;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();
  double offset = 0;
};

LawStart after(const RecordFit& fit) {
  return {[fit](double x) { return fit.spring.secant(x); },
          [fit](double x) { return fit.damping_curve.shape(x).dot(fit.damping); }, fit.masing, fit.motion,
          fit.offset};
}

class LawFitter {
 public:
  LawFitter(const DecaySamples& samples, double mass, double noise, double omega)
      : samples_(samples), mass_(mass), noise_(noise), omega_(omega) {}

  RecordFit fit(const std::string& name, Index terms, Index damping_terms, double range,
                const LawStart& start, bool grow) const {
    LoopMotionSetting setting{SecantCurve(range, terms),
                              SecantCurve(range, damping_terms),
                              mass_,
                              omega_,
                              samples_.quantity,
                              samples_.interval(),
                              samples_.steps,
                              noise_,
                              name == "masing" || name == "between"};
    LoopMotion motion(setting);
    const Index q = terms, d = damping_terms, unknowns = 3 + q + d + (name == "between");
    VectorXd state = VectorXd::Zero(motion.states());
    state.head<2>() = start.motion;
    state.segment(LoopMotion::spring, q) = run_as(setting.spring, start.secant);
    state.segment(motion.damping(), d) = run_as(setting.damping, start.damping);
    state[motion.masing()] = start.masing;
    state[motion.offset()] = start.offset;
    const double k = std::abs(start.secant(0.3 * range)),
                 size = range * (samples_.quantity == Quantity::acceleration ? omega_ * omega_
                                 : samples_.quantity == Quantity::velocity   ? omega_
                                                                             : 1);
    MatrixXd directions = MatrixXd::Zero(state.size(), unknowns);
    Index at = 0;
    const auto seek = [&](Index place, double scale) { directions(place, at++) = scale; };
    seek(LoopMotion::displacement, range), seek(LoopMotion::velocity, range * omega_);
    for (Index j = 0; j < q; ++j) seek(LoopMotion::spring + j, k);
    for (Index j = 0; j < d; ++j) seek(motion.damping() + j, 0.02 * std::sqrt(k * mass_));
    if (name == "between") seek(motion.masing(), 0.1);
    seek(motion.offset(), size);
    const filters::BatchEstimate found =
        filters::estimate_batch(motion, state, directions, samples_.plain,
                                batch_settings(samples_, 1, grow, grow && name == "masing" ? 12 : 25));
    RecordFit fit = record_fit(name, found, samples_, 1);
    fit.unknowns = unknowns;
    if (fit.residuals.size() == 0 || found.covariance.size() == 0) {
      fit.converged = false;
      return fit;
    }
    const MatrixXd covariance = directions * found.covariance * directions.transpose();
    fit.spring = {setting.spring, found.state.segment(LoopMotion::spring, q),
                  covariance.block(LoopMotion::spring, LoopMotion::spring, q, q)};
    fit.damping_curve = setting.damping;
    fit.damping = found.state.segment(motion.damping(), d);
    fit.masing = found.state[motion.masing()];
    fit.masing_deviation = std::sqrt(std::max(0.0, covariance(motion.masing(), motion.masing())));
    fit.motion = found.state.head<2>();
    fit.offset = found.state[motion.offset()];
    fit.largest = largest(motion, found.state, name == "masing");
    return fit;
  }

 private:
  const DecaySamples& samples_;
  double mass_, noise_, omega_;

  double largest(LoopMotion& motion, const VectorXd& start, bool half_swings) const {
    VectorXd state = start, next;
    double most = 0;
    for (Index k = 1; k < samples_.size(); ++k) {
      if (!half_swings) most = std::max(most, std::abs(state[LoopMotion::displacement]));
      motion.transition(state, {}, next);
      state.swap(next);
      if (half_swings)
        most = std::max(most, 0.5 * std::abs(state[LoopMotion::displacement] - state[LoopMotion::reversal]));
    }
    return most;
  }
};

/// A registered model, from several starts of its unknowns; the best of them.
RecordFit registered_fit(const std::string& name, const DecaySamples& samples, double mass, double noise,
                         const Eigen::Vector2d& motion, double offset,
                         const std::vector<std::vector<std::pair<std::string, double>>>& starts) {
  RecordFit best;
  best.name = name;
  for (const auto& start : starts) {
    const Oscillator oscillator{mass, start[0].second, start[1].second};
    const auto model =
        model_registry().make(name, {}, at_one_point(one_coordinate(oscillator), {samples.quantity}));
    VectorXd state = VectorXd::Zero(static_cast<Index>(model->motion->state_labels().size()));
    VectorXd scale = VectorXd::Zero(state.size());
    state.head<2>() = motion;
    const double omega = oscillator.angular_frequency(),
                 size = motion.norm() > 0 ? std::hypot(motion[0], motion[1] / omega) : 1;
    scale.head<2>() << size, size * omega;
    for (const Index slip : model->slips) scale[slip] = size;
    for (std::size_t j = 0; j < model->unknowns.size(); ++j)
      for (const auto& [quantity, value] : start)
        if (model->unknowns[j].quantity == quantity) {
          state[model->unknown_places[j]] = model->unknowns[j].to_state(value);
          scale[model->unknown_places[j]] = std::max(std::abs(value), 1e-3 * model->unknowns[j].deviation);
        }
    for (const JointModel::Offset& one : model->offsets) {
      state[one.place] = offset;
      scale[one.place] = size * omega * omega;
    }
    try {
      const filters::BatchEstimate found =
          fine_estimate(model->motion, samples, state, scale.asDiagonal(), noise);
      RecordFit fit = fine_fit(name, found, samples);
      fit.unknowns = state.size();
      if (fit.residuals.size() == 0) {
        if (best.residuals.size() == 0) best.reason = fit.reason;
        continue;
      }
      if (best.residuals.size() == 0 || fit.left < best.left) best = fit;
    } catch (const std::exception& error) {
      if (best.residuals.size() == 0) best.reason = error.what();
    }
  }
  return best;
}

/// The same model with ever more B-splines; given up where the fewest do not lead anywhere. Fewer than six
/// are steps on the way: if BIC might take them, the band would hold 92 instead of 95 of a hundred
/// hyperbolas.
void refine(const LawFitter& fitter, const std::string& name,
            const std::vector<std::pair<Index, Index>>& terms, double range, const LawStart& start,
            std::vector<RecordFit>& to) {
  RecordFit last;
  for (const auto& [q, d] : terms) {
    const bool first = last.residuals.size() == 0 || !last.converged;
    constexpr double room = 1.02;
    double reach = first ? range : room * last.largest;
    RecordFit fit = fitter.fit(name, q, d, reach, first ? start : after(last), first);
    for (int round = 0; round < 4 && fit.converged; ++round) {  // until the curve ends where the motion does
      if (fit.largest <= reach && fit.largest > reach / (room * room)) break;
      reach = room * fit.largest;
      fit = fitter.fit(name, q, d, reach, after(fit), false);
    }
    if (!fit.converged) {
      if (to.empty() || to.back().name != name || !to.back().converged) to.push_back(fit);
      if (first) return;
      continue;
    }
    last = fit;
    constexpr Index least_terms = 6;
    if (q >= least_terms) to.push_back(std::move(fit));
  }
}

}  // namespace

const RecordFit* RecordFits::find(const std::string& name) const {
  for (const RecordFit& fit : fits)
    if (fit.name == name && fit.converged) return &fit;
  return nullptr;
}

RecordFits fit_whole_record(const Record& record, const AmplitudeWindows& windows,
                            const RecordFitStart& start, double samples_per_period) {
  const Index row = output_channels(record)[0];
  double fastest = 0, damping = 0;
  for (const AmplitudeWindow& window : windows.windows) {
    fastest = std::max(fastest, window.frequency_hz);
    damping += window.damping / static_cast<double>(windows.windows.size());
  }
  DecaySamples samples =
      decay_samples(record.samples.row(row).transpose(), record.interval(), fastest, samples_per_period);
  samples.quantity = record.channels[static_cast<std::size_t>(row)].quantity;
  const double signal_size = samples.plain.outputs.cwiseAbs().maxCoeff();
  RecordFits result;
  result.decimation = samples.factor;
  const double omega = 2 * pi * windows.windows.front().frequency_hz, mass = start.mass,
               range = 1.03 * std::max(std::abs(windows.start), windows.first_amplitude);
  const std::complex<double> phasor = windows.start * std::exp(std::complex<double>(0, omega * samples.lost));
  const LawFitter fitter(samples, mass, windows.noise, omega);
  const auto constant = [](double value) { return [value](double) { return value; }; };
  LawStart from{constant(start.elastic.secant(0.5 * windows.first_amplitude)),
                constant(damping),
                0,
                {phasor.real(), (phasor * std::complex<double>(0, omega)).real()},
                0};
  std::vector<RecordFit> all;
  all.push_back(fitter.fit("linear", 1, 1, range, from, true));
  from.secant = [&](double x) { return start.elastic.secant(x); };
  refine(fitter, "elastic", {{4, 1}, {6, 1}, {8, 1}, {6, 2}, {6, 4}}, range, from, all);
  LawStart loop = from;
  loop.secant = [&](double x) { return start.masing.secant(x); };
  loop.damping = constant(std::max(0.1 * damping, windows.windows.back().damping));
  loop.masing = 1;
  refine(fitter, "masing", {{4, 1}, {6, 1}, {8, 1}}, 0.95 * range, loop, all);

  const auto count = static_cast<double>(samples.size());
  const auto squares = [&](const RecordFit& fit) {
    return fit.residuals.squaredNorm() / (count - static_cast<double>(fit.unknowns));
  };
  const auto least_noise = [&] {
    double least = std::numeric_limits<double>::infinity();
    for (const RecordFit& fit : all)
      if (fit.residuals.size() > 0) least = std::min(least, squares(fit));
    const double smallest = 1e-7 * signal_size;
    return std::max(std::sqrt(least), smallest);
  };
  const auto bic = [&](const RecordFit& fit, double noise) {
    return std::log(count) * static_cast<double>(fit.unknowns) +
           fit.residuals.squaredNorm() / (noise * noise);
  };
  const auto best_of = [&](const std::string& name, double noise) {
    const RecordFit* best = nullptr;
    for (const RecordFit& fit : all)
      if (fit.name == name &&
          (!best || (fit.converged && (!best->converged || bic(fit, noise) < bic(*best, noise)))))
        best = &fit;
    return best;
  };
  double noise = least_noise();
  if (!std::isfinite(noise)) return result;
  const RecordFit *elastic = best_of("elastic", noise), *masing = best_of("masing", noise);
  const RecordFit* better = elastic && elastic->converged ? elastic : nullptr;
  if (masing && masing->converged && (!better || bic(*masing, noise) < bic(*better, noise))) better = masing;
  if (better) {
    const RecordFit near = *better;
    all.push_back(fitter.fit("between", near.spring.curve.terms(), near.damping.size(),
                             near.spring.curve.range(), after(near), false));
    from.motion = near.motion, from.offset = near.offset;
  }
  const double k0 = start.elastic.secant(0), size = windows.first_amplitude,
               middle = start.elastic.secant(0.5 * size),
               cubic = (start.elastic.secant(size) - k0) / (size * size);
  all.push_back(
      registered_fit("duffing", samples, mass, windows.noise, from.motion, from.offset,
                     {{{"stiffness", k0}, {"damping", damping}, {"cubic_stiffness", cubic}},
                      {{"stiffness", middle}, {"damping", damping}, {"cubic_stiffness", 0.3 * cubic}}}));
  std::vector<std::vector<std::pair<std::string, double>>> hysteretic;
  for (const double yield : {0.3, 1.5})
    hysteretic.push_back({{"stiffness", std::max(k0, 0.1 * middle)},
                          {"damping", std::max(0.3 * damping, 0.0)},
                          {"post_yield_ratio", 0.3},
                          {"hysteresis_beta", 0.5 / (yield * size)},
                          {"hysteresis_gamma", 0.5 / (yield * size)}});
  all.push_back(
      registered_fit("bouc_wen", samples, mass, windows.noise, from.motion, from.offset, hysteretic));

  result.noise = noise = least_noise();
  const double variance = noise * noise,
               scale = variance / samples.whiteness / (windows.noise * windows.noise);
  for (const char* const name : {"linear", "elastic", "masing", "between", "duffing", "bouc_wen"}) {
    const RecordFit* const best = best_of(name, noise);
    if (!best) continue;
    RecordFit fit = *best;
    if (fit.residuals.size() > 0) {
      fit.log_likelihood =
          -0.5 * count * std::log(2 * pi * variance) - 0.5 * fit.residuals.squaredNorm() / variance;
      fit.bic = bic(fit, noise) + count * std::log(2 * pi * variance);
      fit.spring.covariance *= scale;
      fit.masing_deviation *= std::sqrt(scale);
    }
    result.fits.push_back(std::move(fit));
  }
  for (std::size_t i = 0; i < result.fits.size(); ++i) {
    const RecordFit& fit = result.fits[i];
    if (!fit.converged) continue;
    const auto place = static_cast<int>(i);
    if (result.best < 0 || fit.bic < result.fits[static_cast<std::size_t>(result.best)].bic)
      result.best = place;
    if (fit.damping.size() > 0 &&
        (result.law < 0 || fit.bic < result.fits[static_cast<std::size_t>(result.law)].bic))
      result.law = place;
  }
  if (result.law < 0) return result;
  const RecordFit& law = result.fits[static_cast<std::size_t>(result.law)];
  const int more = std::max(1, windows.decimation / result.decimation);
  if (law.residuals.size() < 20 * more + 24) return result;
  const DecimatedSignal left = decimate(law.residuals, samples.interval(), more);
  double sum = 0;
  for (const AmplitudeWindow& window : windows.windows) {
    const double before = record.time[0] + samples.lost + left.start;
    const Index from = std::max<Index>(0, std::lround((window.from - before) / left.interval)),
                to = std::min<Index>(left.samples.size(), std::lround((window.to - before) / left.interval));
    if (to - from < 2) continue;
    sum += left.samples.segment(from, to - from).squaredNorm() / static_cast<double>(to - from) /
           std::pow(std::max(window.left, 1e-7 * signal_size), 2);
  }
  result.lack = sum / static_cast<double>(windows.windows.size());
  return result;
}

}  // namespace beamid::experiments
