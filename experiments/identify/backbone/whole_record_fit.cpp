#include "experiments/identify/backbone/whole_record_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/QR>

#include "experiments/identify/backbone/loop_motion.hpp"
#include "experiments/identify/backbone/record_fit.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

// Models fitted to one record, ranked by one noise level.

/// The fits of all models and numbers of terms, BIC = k ln M + sum (y - h)^2 / s^2 [schwarz1978] but for a
/// constant.
class ModelRanking {
 public:
  explicit ModelRanking(const DecaySamples& samples)
      : count_(static_cast<double>(samples.size())), peak_(samples.peak()) {}

  std::vector<RecordFit> fits;

  /// s: the least that a fit leaves, no less than 1e-7 of the largest sample; infinite without a fit.
  double noise() const;
  double bic(const RecordFit& fit, double noise) const;
  /// Of a model's fits that of least BIC, of those converged if there are any; nullptr without one.
  const RecordFit* best_of(const std::string& name, double noise) const;
  /// The better of the elastic spring and Masing's loop; nullptr where neither converged.
  const RecordFit* best_spring() const;
  /// Each model's best fit with likelihood and BIC.
  /// @param scale s^2 over the variance that the fits' covariances assumed
  std::vector<RecordFit> best_of_each(double noise, double scale) const;

 private:
  double count_, peak_;
};

double ModelRanking::noise() const {
  double least = std::numeric_limits<double>::infinity();
  for (const RecordFit& fit : fits)
    if (fit.residuals.size() > 0)
      least = std::min(least, fit.residuals.squaredNorm() / (count_ - static_cast<double>(fit.unknowns)));
  const double smallest = 1e-7 * peak_;
  return std::max(std::sqrt(least), smallest);
}

double ModelRanking::bic(const RecordFit& fit, double noise) const {
  return std::log(count_) * static_cast<double>(fit.unknowns) + fit.residuals.squaredNorm() / (noise * noise);
}

const RecordFit* ModelRanking::best_of(const std::string& name, double noise) const {
  const RecordFit* best = nullptr;
  for (const RecordFit& fit : fits)
    if (fit.name == name &&
        (!best || (fit.converged && (!best->converged || bic(fit, noise) < bic(*best, noise)))))
      best = &fit;
  return best;
}

const RecordFit* ModelRanking::best_spring() const {
  const double s = noise();
  const RecordFit *elastic = best_of("elastic", s), *masing = best_of("masing", s);
  const RecordFit* better = elastic && elastic->converged ? elastic : nullptr;
  if (masing && masing->converged && (!better || bic(*masing, s) < bic(*better, s))) better = masing;
  return better;
}

std::vector<RecordFit> ModelRanking::best_of_each(double noise, double scale) const {
  const double variance = noise * noise, normalised = std::log(2 * std::numbers::pi * variance);
  std::vector<RecordFit> each;
  for (const char* const name : {"linear", "elastic", "masing", "between", "duffing", "bouc_wen"}) {
    const RecordFit* const best = best_of(name, noise);
    if (!best) continue;
    RecordFit fit = *best;
    if (fit.residuals.size() > 0) {
      fit.log_likelihood = -0.5 * count_ * normalised - 0.5 * fit.residuals.squaredNorm() / variance;
      fit.bic = bic(fit, noise) + count_ * normalised;
      fit.spring.covariance *= scale;
      fit.masing_deviation *= std::sqrt(scale);
    }
    each.push_back(std::move(fit));
  }
  return each;
}

// One force law, elastic or with Masing's loop, fitted to all samples of a decay.

/// From what a fit of a law begins.
struct LoopStart {
  std::function<double(double)> secant, damping;  ///< s(x) [N/m] and c(x) [N s/m]
  double masing = 0;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< [x, x'] at the first sample
  double offset = 0;
};

/// Fits LoopMotion, whose spring and damping are B-splines, by filters::estimate_batch.
class LoopFitter {
 public:
  /// @param noise standard deviation of a sample
  /// @param omega of the motion's beginning [rad/s]
  LoopFitter(const DecaySamples& samples, double mass, double noise, double omega)
      : samples_(samples), mass_(mass), noise_(noise), omega_(omega) {}

  /// @param name "linear", "elastic"; "masing" and "between" have a loop, the last a share of it sought
  /// @param range up to which the splines reach [m]
  /// @param grow whether the fit begins with the first cycles
  RecordFit fit(const std::string& name, Eigen::Index terms, Eigen::Index damping_terms, double range,
                const LoopStart& start, bool grow) const;

  /// The same law with ever more B-splines (of spring and damping), added to `to`; given up where the fewest
  /// do not lead anywhere. Fewer than six are steps on the way: if BIC might take them, the band would hold
  /// 92 instead of 95 of a hundred hyperbolas.
  void refine(const std::string& name, const std::vector<std::pair<Eigen::Index, Eigen::Index>>& terms,
              double range, const LoopStart& start, std::vector<RecordFit>& to) const;

 private:
  const DecaySamples& samples_;
  double mass_, noise_, omega_;

  LoopMotionSetting setting(const std::string& name, Eigen::Index terms, Eigen::Index damping_terms,
                            double range) const;
  Eigen::MatrixXd directions(const LoopMotion& motion, const LoopMotionSetting& setting, double stiffness,
                             bool masing_sought) const;
  double largest_argument(LoopMotion& motion, const Eigen::VectorXd& start, bool half_swings) const;
};

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Coefficients of a curve that runs as a function does, by least squares on a grid.
VectorXd coefficients_like(const SecantCurve& curve, const std::function<double(double)>& value) {
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

VectorXd loop_state(const LoopMotion& motion, const LoopMotionSetting& setting, const LoopStart& start) {
  VectorXd state = VectorXd::Zero(motion.states());
  state.head<2>() = start.motion;
  state.segment(LoopMotion::spring, setting.spring.terms()) = coefficients_like(setting.spring, start.secant);
  state.segment(motion.damping(), setting.damping.terms()) =
      coefficients_like(setting.damping, start.damping);
  state[motion.masing()] = start.masing;
  state[motion.offset()] = start.offset;
  return state;
}

/// Where a fit has ended.
LoopStart start_after(const RecordFit& fit) {
  return {[fit](double x) { return fit.spring.secant(x); },
          [fit](double x) { return fit.damping_curve.shape(x).dot(fit.damping); }, fit.masing, fit.motion,
          fit.offset};
}

LoopMotionSetting LoopFitter::setting(const std::string& name, Index terms, Index damping_terms,
                                      double range) const {
  return {SecantCurve(range, terms),
          SecantCurve(range, damping_terms),
          mass_,
          omega_,
          samples_.quantity,
          samples_.interval(),
          samples_.steps,
          noise_,
          name == "masing" || name == "between"};
}

MatrixXd LoopFitter::directions(const LoopMotion& motion, const LoopMotionSetting& setting, double stiffness,
                                bool masing_sought) const {
  const double range = setting.spring.range();
  const double size = range * (samples_.quantity == Quantity::acceleration ? omega_ * omega_
                               : samples_.quantity == Quantity::velocity   ? omega_
                                                                           : 1);
  const Index q = setting.spring.terms(), d = setting.damping.terms();
  MatrixXd result = MatrixXd::Zero(motion.states(), 3 + q + d + masing_sought);
  Index at = 0;
  const auto seek = [&](Index place, double scale) { result(place, at++) = scale; };
  seek(LoopMotion::displacement, range), seek(LoopMotion::velocity, range * omega_);
  for (Index j = 0; j < q; ++j) seek(LoopMotion::spring + j, stiffness);
  for (Index j = 0; j < d; ++j) seek(motion.damping() + j, 0.02 * std::sqrt(stiffness * mass_));
  if (masing_sought) seek(motion.masing(), 0.1);
  seek(motion.offset(), size);
  return result;
}

RecordFit LoopFitter::fit(const std::string& name, Index terms, Index damping_terms, double range,
                          const LoopStart& start, bool grow) const {
  const LoopMotionSetting law = setting(name, terms, damping_terms, range);
  LoopMotion motion(law);
  const MatrixXd sought = directions(motion, law, std::abs(start.secant(0.3 * range)), name == "between");
  const filters::BatchEstimate found =
      filters::estimate_batch(motion, loop_state(motion, law, start), sought, samples_.plain,
                              samples_.batch_settings(1, grow, grow && name == "masing" ? 12 : 25));
  RecordFit fit = record_fit(name, found, samples_, 1);
  fit.unknowns = sought.cols();
  if (fit.residuals.size() == 0 || found.covariance.size() == 0) {
    fit.converged = false;
    return fit;
  }
  const MatrixXd covariance = sought * found.covariance * sought.transpose();
  fit.spring = {law.spring, found.state.segment(LoopMotion::spring, terms),
                covariance.block(LoopMotion::spring, LoopMotion::spring, terms, terms)};
  fit.damping_curve = law.damping;
  fit.damping = found.state.segment(motion.damping(), damping_terms);
  fit.masing = found.state[motion.masing()];
  fit.masing_deviation = std::sqrt(std::max(0.0, covariance(motion.masing(), motion.masing())));
  fit.motion = found.state.head<2>();
  fit.offset = found.state[motion.offset()];
  fit.largest = largest_argument(motion, found.state, name == "masing");
  return fit;
}

double LoopFitter::largest_argument(LoopMotion& motion, const VectorXd& start, bool half_swings) const {
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

void LoopFitter::refine(const std::string& name, const std::vector<std::pair<Index, Index>>& terms,
                        double range, const LoopStart& start, std::vector<RecordFit>& to) const {
  constexpr Index least_terms = 6;
  constexpr double room = 1.02;
  RecordFit last;
  for (const auto& [q, d] : terms) {
    const bool first = last.residuals.size() == 0 || !last.converged;
    double reach = first ? range : room * last.largest;
    RecordFit found = fit(name, q, d, reach, first ? start : start_after(last), first);
    for (int round = 0; round < 4 && found.converged;
         ++round) {  // until the curve ends where the motion does
      if (found.largest <= reach && found.largest > reach / (room * room)) break;
      reach = room * found.largest;
      found = fit(name, q, d, reach, start_after(found), false);
    }
    if (!found.converged) {
      if (to.empty() || to.back().name != name || !to.back().converged) to.push_back(found);
      if (first) return;
      continue;
    }
    last = found;
    if (q >= least_terms) to.push_back(std::move(found));
  }
}

using Complex = std::complex<double>;

/// What all steps of the fit are given.
struct WholeRecord {
  const AmplitudeWindows& windows;
  const RecordFitStart& start;
  DecaySamples samples;
  double damping = 0;  ///< mean of the windows [N s/m]
};

WholeRecord whole_record(const Record& record, const AmplitudeWindows& windows, const RecordFitStart& start,
                         double samples_per_period) {
  const Index row = output_channels(record)[0];
  double fastest = 0, damping = 0;
  for (const AmplitudeWindow& window : windows.windows) {
    fastest = std::max(fastest, window.frequency_hz);
    damping += window.damping / static_cast<double>(windows.windows.size());
  }
  return {windows, start,
          decay_samples(record.samples.row(row).transpose(), record.interval(),
                        record.channels[static_cast<std::size_t>(row)].quantity, fastest, samples_per_period),
          damping};
}

/// Springs, elastic, with Masing's loop and between them.
/// @return where the models registered begin: motion and offset count
LoopStart fit_springs(const WholeRecord& on, ModelRanking& to) {
  const AmplitudeWindows& windows = on.windows;
  const double omega = 2 * std::numbers::pi * windows.windows.front().frequency_hz,
               range = 1.03 * std::max(std::abs(windows.start), windows.first_amplitude);
  const Complex phasor = windows.start * std::exp(Complex(0, omega * on.samples.lost));
  const LoopFitter fitter(on.samples, on.start.mass, windows.noise, omega);
  const auto constant = [](double value) { return [value](double) { return value; }; };
  LoopStart from{constant(on.start.elastic.secant(0.5 * windows.first_amplitude)),
                 constant(on.damping),
                 0,
                 {phasor.real(), (phasor * Complex(0, omega)).real()},
                 0};
  to.fits.push_back(fitter.fit("linear", 1, 1, range, from, true));

  from.secant = [&](double x) { return on.start.elastic.secant(x); };
  fitter.refine("elastic", {{4, 1}, {6, 1}, {8, 1}, {6, 2}, {6, 4}}, range, from, to.fits);

  LoopStart loop = from;
  loop.secant = [&](double x) { return on.start.masing.secant(x); };
  loop.damping = constant(std::max(0.1 * on.damping, windows.windows.back().damping));
  loop.masing = 1;
  fitter.refine("masing", {{4, 1}, {6, 1}, {8, 1}}, 0.95 * range, loop, to.fits);

  const RecordFit* const better = std::isfinite(to.noise()) ? to.best_spring() : nullptr;
  if (!better) return from;
  const RecordFit near = *better;
  to.fits.push_back(fitter.fit("between", near.spring.curve.terms(), near.damping.size(),
                               near.spring.curve.range(), start_after(near), false));
  from.motion = near.motion, from.offset = near.offset;
  return from;
}

void fit_registered(const WholeRecord& on, const LoopStart& from, ModelRanking& to) {
  const ForceLaw& elastic = on.start.elastic;
  const double k0 = elastic.secant(0), size = on.windows.first_amplitude, middle = elastic.secant(0.5 * size),
               cubic = (elastic.secant(size) - k0) / (size * size), damping = on.damping;
  const auto add = [&](const char* name, const std::vector<ModelStart>& starts) {
    to.fits.push_back(
        registered_fit(name, on.samples, on.start.mass, on.windows.noise, from.motion, from.offset, starts));
  };
  add("duffing", {{{"stiffness", k0}, {"damping", damping}, {"cubic_stiffness", cubic}},
                  {{"stiffness", middle}, {"damping", damping}, {"cubic_stiffness", 0.3 * cubic}}});
  std::vector<ModelStart> hysteretic;
  for (const double yield : {0.3, 1.5})
    hysteretic.push_back({{"stiffness", std::max(k0, 0.1 * middle)},
                          {"damping", std::max(0.3 * damping, 0.0)},
                          {"post_yield_ratio", 0.3},
                          {"hysteresis_beta", 0.5 / (yield * size)},
                          {"hysteresis_gamma", 0.5 / (yield * size)}});
  add("bouc_wen", hysteretic);
}

/// Places of the least BIC, of all that converged and of those with a spline.
void choose_best(RecordFits& result) {
  const auto better = [&](const RecordFit& fit, int than) {
    return than < 0 || fit.bic < result.fits[static_cast<std::size_t>(than)].bic;
  };
  for (std::size_t i = 0; i < result.fits.size(); ++i) {
    const RecordFit& fit = result.fits[i];
    if (!fit.converged) continue;
    const auto place = static_cast<int>(i);
    if (better(fit, result.best)) result.best = place;
    if (fit.damping.size() > 0 && better(fit, result.law)) result.law = place;
  }
}

/// RecordFits::lack
double lack_of(const RecordFit& law, const WholeRecord& on, double record_start, int decimation) {
  const AmplitudeWindows& windows = on.windows;
  const int more = std::max(1, windows.decimation / decimation);
  if (law.residuals.size() < 20 * more + 24) return 0;
  const DecimatedSignal left = decimate(law.residuals, on.samples.interval(), more);
  const double before = record_start + on.samples.lost + left.start, smallest = 1e-7 * on.samples.peak();
  double sum = 0;
  for (const AmplitudeWindow& window : windows.windows) {
    const Index from = std::max<Index>(0, std::lround((window.from - before) / left.interval)),
                to = std::min<Index>(left.samples.size(), std::lround((window.to - before) / left.interval));
    if (to - from < 2) continue;
    sum += left.samples.segment(from, to - from).squaredNorm() / static_cast<double>(to - from) /
           std::pow(std::max(window.left, smallest), 2);
  }
  return sum / static_cast<double>(windows.windows.size());
}

}  // namespace

const RecordFit* RecordFits::find(const std::string& name) const {
  for (const RecordFit& fit : fits)
    if (fit.name == name && fit.converged) return &fit;
  return nullptr;
}

RecordFits fit_whole_record(const Record& record, const AmplitudeWindows& windows,
                            const RecordFitStart& start, double samples_per_period) {
  const WholeRecord on = whole_record(record, windows, start, samples_per_period);
  RecordFits result;
  result.decimation = on.samples.factor;
  ModelRanking models(on.samples);
  const LoopStart from = fit_springs(on, models);
  if (!std::isfinite(models.noise())) return result;
  fit_registered(on, from, models);
  result.noise = models.noise();
  const double scale = result.noise * result.noise / on.samples.whiteness / (windows.noise * windows.noise);
  result.fits = models.best_of_each(result.noise, scale);
  choose_best(result);
  if (result.law >= 0)
    result.lack =
        lack_of(result.fits[static_cast<std::size_t>(result.law)], on, record.time[0], result.decimation);
  return result;
}

}  // namespace beamid::experiments
