#include "experiments/studies/noise/noise_study.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/progress.hpp"
#include "fem/assembly.hpp"
#include "fem/free_decay.hpp"
#include "fem/stiffness_solver.hpp"
#include "filters/filter_run.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::Matrix2d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

// e^(A dt), A = [0 1; -k -c]: e^(-c dt/2) (cos I + sin/w (A + c/2 I)), w^2 = k - c^2/4; where the filter's k
// and c do not oscillate, w is imaginary and the same formula holds.
Matrix2d moved(double k, double c, double dt) {
  const std::complex<double> w = std::sqrt(std::complex<double>(k - 0.25 * c * c));
  const double cosine = std::cos(w * dt).real();
  const double sine = std::abs(w * dt) < 1e-9 ? dt : (std::sin(w * dt) / w).real();
  Matrix2d a;
  a << 0.5 * c, 1.0, -k, -0.5 * c;
  return std::exp(-0.5 * c * dt) * (cosine * Matrix2d::Identity() + sine * a);
}

class Bank final : public filters::DiscreteModel {
 public:
  Bank(const std::vector<BankMember>& members, Quantity observed, double interval, double variance)
      : members_(members),
        observed_(observed),
        interval_(interval),
        count_(static_cast<Index>(members.size())),
        noise_(MatrixXd::Constant(1, 1, variance)) {
    for (const BankMember& m : members) {
      if (!(m.stiffness > 0.25 * m.damping * m.damping))
        throw std::invalid_argument("oscillator of stiffness " + std::to_string(m.stiffness) +
                                    " and damping " + std::to_string(m.damping) +
                                    " per unit of mass; expected one that oscillates");
      if (m.unknown && unknown_ < static_cast<Index>(&m - members.data()))
        throw std::invalid_argument("unknown oscillators must come before known ones");
      unknown_ += m.unknown ? 1 : 0;
    }
    process_.setZero(size(), size());
    for (Index i = 0; i < count_; ++i) {
      const BankMember& m = members[i];
      const Matrix2d p = m.shaped * m.shaped * Vector2d(1.0, m.stiffness).asDiagonal(),
                     f = moved(m.stiffness, m.damping, interval);
      process_.block<2, 2>(2 * i, 2 * i) = p - f * p * f.transpose();
    }
  }

  std::vector<filters::Label> state_labels() const override {
    std::vector<filters::Label> labels;
    for (Index i = 1; i <= count_; ++i) {
      labels.push_back({"displacement_" + std::to_string(i), "m"});
      labels.push_back({"velocity_" + std::to_string(i), "m/s"});
    }
    for (Index i = 1; i <= unknown_; ++i) {
      labels.push_back({"stiffness_" + std::to_string(i), "1/s2"});
      labels.push_back({"damping_" + std::to_string(i), "1/s"});
    }
    return labels;
  }
  std::vector<filters::Label> output_labels() const override {
    return {{to_string(observed_), si_unit(observed_)}};
  }
  const MatrixXd& process_noise() const override { return process_; }
  const MatrixXd& output_noise() const override { return noise_; }
  double interval() const override { return interval_; }

  void transition(const VectorXd& state, const VectorXd&, VectorXd& next) override {
    next = state;
    for (Index i = 0; i < count_; ++i)
      next.segment<2>(2 * i) =
          moved(stiffness(state, i), damping(state, i), interval_) * state.segment<2>(2 * i);
  }
  void linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                             MatrixXd& jacobian) override {
    transition(state, input, next);
    jacobian.setIdentity(size(), size());
    for (Index i = 0; i < count_; ++i) {
      const double k = stiffness(state, i), c = damping(state, i);
      jacobian.block<2, 2>(2 * i, 2 * i) = moved(k, c, interval_);
      if (i >= unknown_) continue;
      const double dk = 1e-5 * members_[i].stiffness, dc = 1e-5 * std::sqrt(members_[i].stiffness);
      const auto slope = [&](double a, double b, double step) -> Vector2d {
        return (moved(k + a, c + b, interval_) - moved(k - a, c - b, interval_)) * state.segment<2>(2 * i) /
               (2.0 * step);
      };
      jacobian.block<2, 1>(2 * i, 2 * count_ + 2 * i) = slope(dk, 0.0, dk);
      jacobian.block<2, 1>(2 * i, 2 * count_ + 2 * i + 1) = slope(0.0, dc, dc);
    }
  }
  void output(const VectorXd& state, const VectorXd&, VectorXd& output) override {
    output.setZero(1);
    for (Index i = 0; i < count_; ++i) {
      const double x = state[2 * i], v = state[2 * i + 1];
      output[0] += observed_ == Quantity::displacement ? x
                   : observed_ == Quantity::velocity   ? v
                                                       : -stiffness(state, i) * x - damping(state, i) * v;
    }
  }
  void output_jacobian(const VectorXd& state, const VectorXd&, MatrixXd& jacobian) override {
    jacobian.setZero(1, size());
    for (Index i = 0; i < count_; ++i) {
      if (observed_ == Quantity::displacement) jacobian(0, 2 * i) = 1.0;
      if (observed_ == Quantity::velocity) jacobian(0, 2 * i + 1) = 1.0;
      if (observed_ != Quantity::acceleration) continue;
      jacobian.block<1, 2>(0, 2 * i) << -stiffness(state, i), -damping(state, i);
      if (i < unknown_) jacobian.block<1, 2>(0, 2 * count_ + 2 * i) = -state.segment<2>(2 * i).transpose();
    }
  }

 private:
  std::vector<BankMember> members_;
  Quantity observed_;
  double interval_;
  Index count_, unknown_ = 0;
  MatrixXd process_, noise_;

  Index size() const { return 2 * count_ + 2 * unknown_; }
  double stiffness(const VectorXd& state, Index i) const {
    return i < unknown_ ? state[2 * count_ + 2 * i] : members_[i].stiffness;
  }
  double damping(const VectorXd& state, Index i) const {
    return i < unknown_ ? state[2 * count_ + 2 * i + 1] : members_[i].damping;
  }
};

}  // namespace

std::unique_ptr<filters::DiscreteModel> oscillator_bank(const std::vector<BankMember>& members,
                                                        Quantity observed, double interval, double variance) {
  return std::make_unique<Bank>(members, observed, interval, variance);
}

namespace {

int derivatives(Quantity observed) {
  return observed == Quantity::displacement ? 0 : observed == Quantity::velocity ? 1 : 2;
}

// Spectrum of a half sine of duration T at w, relative to that at 0: cos(w T/2) / (1 - (w T/pi)^2).
double half_sine(double w, double duration) {
  const double u = w * duration / std::numbers::pi;
  return std::abs(u - 1.0) < 1e-6 ? 0.25 * std::numbers::pi
                                  : std::cos(0.5 * std::numbers::pi * u) / (1.0 - u * u);
}

}  // namespace

double ModalMotion::size(Index i, Quantity observed) const {
  return std::abs(amplitude[i]) * std::pow(std::abs(rate[i]), derivatives(observed));
}

ModalMotion modal_motion(const fem::Beam& beam, int elements, const VectorXd& damping_ratios, Blow blow,
                         double deflection, double blow_duration) {
  const fem::StructuralSystem system = fem::assemble(beam, elements);
  const fem::Modes modes = fem::modes(system, damping_ratios.size());
  const VectorXd released = fem::modal_amplitudes(system, modes, fem::static_shape(system));
  ModalMotion motion{Eigen::VectorXcd(modes.size()), Eigen::VectorXcd(modes.size())};
  const auto blown = [&](Index i) {  // displacement that a unit of momentum gives mode i
    const double at_point = (system.outputs.row(0) * modes.shape.col(i))(0), w = modes.angular_frequency[i];
    return at_point * at_point / w * half_sine(w, blow_duration);
  };
  for (Index i = 0; i < modes.size(); ++i) {
    const double w = modes.angular_frequency[i], xi = damping_ratios[i], turn = std::sqrt(1.0 - xi * xi);
    motion.rate[i] = {-xi * w, w * turn};
    // Re a = x(0) and Re(a lambda) = v(0): from rest, or from x = 0 with v = w x(peak).
    motion.amplitude[i] =
        deflection * (blow == Blow::release ? released[i] / released[0] * std::complex(1.0, -xi / turn)
                                            : blown(i) / blown(0) * std::complex(0.0, -1.0 / turn));
  }
  return motion;
}

ModalRecord modal_record(const ModalMotion& motion, Quantity observed, double interval, double duration,
                         double noise, std::uint64_t seed, std::uint64_t stream) {
  filters::RandomStream random(seed, stream);
  const auto count = static_cast<Index>(std::lround(duration / interval)) + 1;
  ModalRecord record{interval, VectorXd::Zero(count), VectorXd::Zero(count), 0.0};
  record.start = random.uniform() * 2.0 * std::numbers::pi / motion.rate[0].imag();
  for (Index i = 0; i < motion.rate.size(); ++i) {
    const std::complex<double> rate = motion.rate[i],
                               a = motion.amplitude[i] * std::pow(rate, derivatives(observed));
    for (Index k = 0; k < count; ++k) {
      const double value = (a * std::exp(rate * (record.start + static_cast<double>(k) * interval))).real();
      record.samples[k] += value;
      if (i > 0) record.higher[k] += value;
    }
  }
  record.samples += noise * random.normal(count, 1).col(0);
  return record;
}

namespace {

constexpr int treatment_passes = 2;
constexpr double stopped = 1e-6;        // of the power of a stopped mode is left: 60 dB
constexpr double guessed_ratio = 0.01;  // damping ratio of a higher mode, before the record is seen

// The least that decimation may leave [Hz]: 0.7 of it and all above is stopped, 0.3 and all below passes.
double least_rate(const ModalMotion& motion) {
  const double first = motion.rate[0].imag() / (2.0 * std::numbers::pi);
  const double second = motion.rate.size() > 1 ? motion.rate[1].imag() / (2.0 * std::numbers::pi) : 8 * first;
  return std::max(4.0 * first, 1.2 * second);
}

// Standard deviation of a displacement: the amplitude over the record, of the mode with index i.
double mean_size(const ModalMotion& motion, const ModalRecord& record, Index i) {
  const double s = -2.0 * motion.rate[i].real(),
               duration = record.interval * static_cast<double>(record.samples.size());
  return std::abs(motion.amplitude[i]) * std::sqrt(0.5 * (1.0 - std::exp(-s * duration)) / (s * duration));
}

std::vector<BankMember> members_of(const ModalMotion& motion, const ModalRecord& record,
                                   Treatment treatment) {
  std::vector<BankMember> members{{0.97 * motion.stiffness(0), 1.5 * motion.damping(0), true, 0.0}};
  for (Index i = 1; i < motion.rate.size(); ++i) {
    const double k = motion.stiffness(i), c = 2.0 * guessed_ratio * std::sqrt(k);
    if (treatment == Treatment::coloured) members.push_back({k, c, false, mean_size(motion, record, i)});
    if (treatment == Treatment::modelled) members.push_back({0.99 * k, c, true, 0.0});
  }
  return members;
}

filters::Gaussian start_of(const std::vector<BankMember>& members, const ModalMotion& motion) {
  const auto count = static_cast<Index>(members.size());
  const auto unknown = std::count_if(members.begin(), members.end(), [](const auto& m) { return m.unknown; });
  filters::Gaussian estimate{VectorXd::Zero(2 * count + 2 * unknown), {}};
  VectorXd deviation(estimate.mean.size());
  for (Index i = 0; i < count; ++i) {
    const double a = std::abs(motion.amplitude[i]), k = members[i].stiffness, c = members[i].damping;
    deviation.segment<2>(2 * i) << a, a * std::sqrt(k);
    if (!members[i].unknown) continue;
    estimate.mean.segment<2>(2 * count + 2 * i) << k, c;
    deviation.segment<2>(2 * count + 2 * i) << (i == 0 ? 0.03 : 0.02) * k, c;
  }
  estimate.covariance = deviation.cwiseAbs2().asDiagonal();
  return estimate;
}

}  // namespace

const char* to_string(Treatment treatment) {
  constexpr const char* names[] = {"sensor", "white", "coloured", "filtered", "modelled"};
  return names[static_cast<int>(treatment)];
}

FirstMode identify_first_mode(const ModalRecord& record, const ModalMotion& motion, Quantity observed,
                              double noise, Treatment treatment, double factor) {
  VectorXd samples = record.samples;
  double interval = record.interval, variance = noise * noise;
  const auto full = static_cast<double>(samples.size());
  if (treatment == Treatment::filtered) {
    const int factor = decimation_factor(1.0 / (least_rate(motion) * interval), samples.size());
    const DecimatedSignal slow = decimate(samples, interval, factor);
    samples = slow.samples;
    interval = slow.interval;
    if (slow.factor > 1)
      variance = variance * slow.kernel.squaredNorm() + stopped * record.higher.squaredNorm() / full;
  }
  if (treatment == Treatment::white) variance += record.higher.squaredNorm() / full;
  if (treatment == Treatment::white || treatment == Treatment::sensor) variance *= factor;
  const std::vector<BankMember> members = members_of(motion, record, treatment);
  const auto filter =
      filters::filter_registry().make("ekf", {}, oscillator_bank(members, observed, interval, variance));
  const auto count = static_cast<double>(samples.size() - 1);
  const filters::Measurements measured{
      VectorXd::LinSpaced(samples.size(), 0.0, count * interval), samples.transpose(), {}};
  filters::Gaussian estimate = start_of(members, motion);
  const Index places = 2 * static_cast<Index>(members.size()), unknown = estimate.mean.size() - places;
  filters::FilterRun run;
  for (int pass = 0; pass < treatment_passes; ++pass) {
    run = filters::run(*filter, estimate, measured);
    if (run.failure) break;
    estimate.mean.tail(unknown) = run.last.mean.tail(unknown);
  }
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (run.failure) return {none, none, none, none, none, variance};
  const double k = motion.stiffness(0), c = motion.damping(0);
  const VectorXd deviation = run.last.deviations();
  return {percent(run.last.mean[places], k), percent(run.last.mean[places + 1], c),
          100.0 * deviation[places] / k,     100.0 * deviation[places + 1] / c,
          run.normalised_squares.mean(),     variance};
}

namespace {

// Failed, or on another motion than the first mode's: one such trial would be all of a mean.
bool is_lost(const FirstMode& f) {
  constexpr double stiffness_lost = 5.0, damping_lost = 100.0;  // [%]
  return !(std::abs(f.stiffness_error) < stiffness_lost && std::abs(f.damping_error) < damping_lost &&
           std::isfinite(f.damping_deviation));
}

NoiseStatistics statistics_of(const std::vector<FirstMode>& found) {
  NoiseStatistics s;
  double count = 0.0, stiffness_deviation = 0.0, damping_deviation = 0.0;
  double squares = 0.0;
  int reached = 0;
  for (const FirstMode& f : found) {
    if (std::isfinite(f.normalised_square)) {
      squares += f.normalised_square;
      ++reached;
    }
    if (is_lost(f)) {
      ++s.failed;
      continue;
    }
    ++count;
    s.stiffness_mean_percent += f.stiffness_error;
    s.damping_mean_percent += f.damping_error;
    s.stiffness_rms_percent += f.stiffness_error * f.stiffness_error;
    s.damping_rms_percent += f.damping_error * f.damping_error;
    stiffness_deviation += f.stiffness_deviation;
    damping_deviation += f.damping_deviation;
  }
  s.stiffness_mean_percent /= count;  // nothing found: 0 / 0, not a number
  s.damping_mean_percent /= count;
  s.stiffness_rms_percent = std::sqrt(s.stiffness_rms_percent / count);
  s.damping_rms_percent = std::sqrt(s.damping_rms_percent / count);
  s.normalised_square = squares / reached;
  s.stiffness_ratio = s.stiffness_rms_percent / (stiffness_deviation / count);
  s.damping_ratio = s.damping_rms_percent / (damping_deviation / count);
  return s;
}

void check_noise_study(const NoiseSettings& s) {
  require_positive(s.noise, "noise");
  require_positive(s.deflection, "deflection");
  require_positive(s.blow, "blow");
  require_positive(s.interval, "interval");
  require_positive(s.duration, "duration");
  if (s.beams.empty()) throw std::invalid_argument("beams: none; expected one at least");
  if (s.trials < 2)
    throw std::invalid_argument("trials: " + std::to_string(s.trials) + "; expected 2 or more");
  for (const NoiseBeam& beam : s.beams)
    if (s.modes < 1 || s.modes > beam.damping_ratios.size())
      throw std::invalid_argument("modes: " + std::to_string(s.modes) + "; expected 1 to " +
                                  std::to_string(beam.damping_ratios.size()));
}

}  // namespace

const NoiseStatistics& NoiseCase::best(const NoiseSettings& settings) const {
  for (std::size_t i = 0; i < settings.factors.size(); ++i)
    if (settings.factors[i] == best_factor) return factors[i];
  return by(Treatment::white);
}

bool harmless(const NoiseStatistics& s) {
  return s.failed == 0 && s.damping_rms_percent < 1.0 && s.damping_ratio < 3.0;
}

namespace {

NoiseCase examine(const NoiseSettings& settings, std::size_t beam, Blow blow, Quantity observed, int modes,
                  Countdown& countdown) {
  const NoiseBeam& tested = settings.beams[beam];
  const ModalMotion motion = modal_motion(tested.beam, settings.elements, tested.damping_ratios.head(modes),
                                          blow, settings.deflection, settings.blow);
  const double highest = motion.rate[modes - 1].imag() / (2.0 * std::numbers::pi);
  if (highest > 0.45 / settings.interval)
    throw std::invalid_argument("interval: " + std::to_string(settings.interval) + " s; expected at most " +
                                std::to_string(0.45 / highest) + " s, for mode " + std::to_string(modes) +
                                " of " + tested.name + " is at " + std::to_string(highest) + " Hz");
  const double noise = settings.noise * motion.size(0, observed);
  const std::size_t choices = treatments.size() + settings.factors.size();
  std::vector<std::vector<FirstMode>> found(choices, std::vector<FirstMode>(settings.trials));
  tbb::parallel_for(0, settings.trials, [&](int trial) {
    // The same noise and instant for every case: they differ by what they are, and not by luck.
    const ModalRecord record = modal_record(motion, observed, settings.interval, settings.duration, noise,
                                            settings.seed, static_cast<std::uint64_t>(trial));
    for (std::size_t i = 0; i < choices; ++i)
      found[i][trial] = i < treatments.size()
                            ? identify_first_mode(record, motion, observed, noise, treatments[i])
                            : identify_first_mode(record, motion, observed, noise, Treatment::white,
                                                  settings.factors[i - treatments.size()]);
    countdown.count();
  });
  NoiseCase result{beam, blow, observed, modes, 0.0, {}, {}, 1.0};
  for (int i = 1; i < modes; ++i)
    result.share += std::pow(motion.size(i, observed) / motion.size(0, observed), 2);
  result.share = std::sqrt(result.share);
  for (std::size_t i = 0; i < choices; ++i)
    (i < treatments.size() ? result.treatments : result.factors).push_back(statistics_of(found[i]));
  double least = result.by(Treatment::white).damping_rms_percent;
  for (std::size_t i = 0; i < settings.factors.size(); ++i)
    if (result.factors[i].failed == 0 && !(result.factors[i].damping_rms_percent >= least)) {
      least = result.factors[i].damping_rms_percent;
      result.best_factor = settings.factors[i];
    }
  return result;
}

}  // namespace

NoiseCase examine(const NoiseSettings& settings, std::size_t beam, Blow blow, Quantity observed, int modes) {
  const Progress unseen = [](const std::string&) {};
  Countdown countdown(unseen, static_cast<std::size_t>(settings.trials), "trials");
  return examine(settings, beam, blow, observed, modes, countdown);
}

NoiseStudy study_higher_modes(const NoiseSettings& settings, const Progress& progress) {
  check_noise_study(settings);
  NoiseStudy study{settings, {}, {}};
  constexpr Quantity sensors[] = {Quantity::displacement, Quantity::velocity, Quantity::acceleration};
  const std::size_t cases = 2 * std::size(sensors) * settings.beams.size() +
                            std::size(sensors) * static_cast<std::size_t>(settings.modes);
  Countdown countdown(progress, cases * static_cast<std::size_t>(settings.trials), "trials");
  for (std::size_t beam = 0; beam < settings.beams.size(); ++beam) {
    countdown.begin(settings.beams[beam].name);
    for (const Blow blow : {Blow::release, Blow::hammer})
      for (const Quantity observed : sensors)
        study.cases.push_back(examine(settings, beam, blow, observed, settings.modes, countdown));
  }
  countdown.begin("number of modes");
  for (const Quantity observed : sensors)
    for (int modes = 1; modes <= settings.modes; ++modes)
      study.kept.push_back(examine(settings, 0, Blow::release, observed, modes, countdown));
  return study;
}

}  // namespace beamid::experiments
