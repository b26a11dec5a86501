#include "experiments/modal/decay_jump.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "experiments/modal/frequency_step.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/median.hpp"
#include "experiments/signal/sway.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::ArrayXd, Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double jump_samples_per_cycle = 8, window = 12, left_out = 1, fewest = 4;  // periods
constexpr Index kernel_and_more = 50;

/// Re and -Im of e^(rate t) times a shape: coefficients are those of a complex amplitude.
void append(MatrixXd& basis, Index& column, Complex rate, const VectorXd& time, const ArrayXd& shape) {
  const Eigen::ArrayXcd motion = (rate * time.cast<Complex>()).array().exp();
  basis.col(column++) = motion.real() * shape;
  basis.col(column++) = -motion.imag() * shape;
}

/// What is known of the signal at one instant.
struct Instant {
  double time = 0;       ///< [s], from the first sample
  double step = 0;       ///< F of the step, beside nothing
  double beyond = 0;     ///< F of the step, beside the next power of time
  double left = 0;       ///< variance that the step leaves
  Complex before, jump;  ///< amplitudes
};

/// The three motions fitted about an instant, `before` and `behind` samples of it away and more.
class Motions {
 public:
  Motions(Index before, Index behind, Index gap, double interval, const ModalEstimate& mode, int degree)
      : before_(before), behind_(behind) {
    VectorXd time(before + behind);
    time << VectorXd::LinSpaced(before, static_cast<double>(-gap - before + 1), static_cast<double>(-gap)),
        VectorXd::LinSpaced(behind, static_cast<double>(gap), static_cast<double>(gap + behind - 1));
    time *= interval;
    const ArrayXd u = time.array() * mode.frequency_hz / (window + left_out);
    const auto companions = static_cast<Index>(mode.companions.size());
    columns_ = 1 + 2 * (degree + 1) + 2 * companions;
    MatrixXd basis(time.size(), columns_ + 2);
    Index column = 0;
    for (int power = 0; power <= degree; ++power) append(basis, column, mode.rate(), time, u.pow(power));
    basis.col(column++).setOnes();
    for (const CompanionMode& other : mode.companions)
      append(basis, column, other.rate(), time, ArrayXd::Ones(u.size()));
    append(basis, column, mode.rate(), time, u.pow(degree + 1));
    smoother_.compute(basis);
    column = columns_;
    append(basis, column, mode.rate(), time, (u > 0).cast<double>());
    stepped_.compute(basis);
  }

  bool are_of(Index before, Index behind) const { return before == before_ && behind == behind_; }
  bool are_few() const { return before_ + behind_ < 2 * (columns_ + 2); }

  // Of A = Q R, Q^T y behind the first columns is what they leave: the smooth motion's are the step's first.
  Instant seen_in(const VectorXd& samples) const {
    const Index free = samples.size() - columns_ - 2;
    const VectorXd turned = stepped_.householderQ().transpose() * samples,
                   smoother = smoother_.householderQ().transpose() * samples;
    const double squares = turned.tail(free).squaredNorm(), variance = squares / static_cast<double>(free);
    const VectorXd x = stepped_.matrixQR()
                           .topRows(columns_ + 2)
                           .triangularView<Eigen::Upper>()
                           .solve(turned.head(columns_ + 2));
    return {0,
            turned.segment(columns_, 2).squaredNorm() / 2 / variance,
            (smoother.tail(free).squaredNorm() - squares) / 2 / variance,
            variance,
            {x[0], x[1]},
            {x[columns_], x[columns_ + 1]}};
  }

 private:
  Index before_, behind_, columns_ = 0;
  Eigen::HouseholderQR<MatrixXd> smoother_, stepped_;  // with the next power of time, with the step
};

std::vector<Instant> instants_of(const DecimatedSignal& coarse, const ModalEstimate& mode, int degree) {
  const double samples = 1 / (mode.frequency_hz * coarse.interval);  // per period
  const auto count = [&](double periods) {
    return std::max<Index>(1, static_cast<Index>(std::lround(periods * samples)));
  };
  const Index gap = count(left_out), most = count(window), least = count(fewest),
              size = coarse.samples.size();
  std::vector<Instant> instants;
  std::optional<Motions> motions;
  for (Index at = gap + least; at + gap + least <= size; at += count(0.5)) {
    const Index before = std::min(most, at - gap + 1), behind = std::min(most, size - at - gap);
    if (!motions || !motions->are_of(before, behind))
      motions.emplace(before, behind, gap, coarse.interval, mode, degree);
    if (motions->are_few()) continue;
    VectorXd around(before + behind);
    around << coarse.samples.segment(at - gap - before + 1, before), coarse.samples.segment(at + gap, behind);
    instants.push_back(motions->seen_in(around));
    instants.back().time = coarse.start + coarse.interval * static_cast<double>(at);
  }
  return instants;
}

template <class Of>
double median_of(const std::vector<Instant>& instants, Of of) {
  std::vector<double> values;
  for (const Instant& one : instants) values.push_back(of(one));
  return median(std::move(values));
}

/// Nothing where none is a jump.
const Instant* clearest_of(const std::vector<Instant>& instants, double amplitude) {
  constexpr double surely = 15, above_others = 8, as_good = 2, smallest = 0.003, least_amplitude = 0.1;
  if (instants.empty()) return nullptr;
  const double usual = std::max(1.0, median_of(instants, [](const Instant&i) { return i.step; })),
               left = median_of(instants, [](const Instant&i) { return i.left; });
  const Instant* clearest = nullptr;
  for (const Instant& i : instants)
    if (i.beyond > std::max(surely, above_others * usual) && i.left < as_good * left &&
        std::abs(i.jump) > smallest * std::abs(i.before) &&
        std::max(std::abs(i.before), std::abs(i.before + i.jump)) > least_amplitude * amplitude &&
        (!clearest || i.beyond > clearest->beyond))
      clearest = &i;
  return clearest;
}

DecayJump jump_at(const Instant& instant) {
  const Complex ratio = 1.0 + instant.jump / instant.before;
  return {MotionJump{instant.time, std::abs(ratio), std::arg(ratio)}};
}

}  // namespace

std::string MotionJump::words() const {
  return fmt::format("the motion jumps, by {:+.2g} % in amplitude and {:+.2g} degrees in phase",
                     100 * (amplitude_ratio - 1), phase * 180 / std::numbers::pi);
}

double DecayJump::time() const {
  return std::visit([](const auto& jump) { return jump.time; }, kind);
}

const FrequencyJump* DecayJump::frequency() const {
  return std::get_if<FrequencyJump>(&kind);
}

const MotionJump* DecayJump::motion() const {
  return std::get_if<MotionJump>(&kind);
}

std::string DecayJump::words() const {
  return std::visit([](const auto& jump) { return jump.words(); }, kind);
}

std::string DecayJump::sentence(double begin) const {
  return fmt::format("At {:.4g} s {}: {}.", begin + time(), words(),
                     frequency() ? "the sampling rate changed there, or the structure did"
                                 : "something touched the structure, or samples were lost");
}

std::optional<DecayJump> decay_jump(const VectorXd& signal, double interval, const ModalEstimate& mode) {
  if (const auto jump = frequency_jump(signal, interval, mode)) return DecayJump{*jump};
  if (const auto step = frequency_step(signal, interval, mode)) return DecayJump{*step};
  const int factor = decimation_factor(1 / (mode.frequency_hz * interval * jump_samples_per_cycle),
                                       signal.size() / kernel_and_more);
  const DecimatedSignal coarse = without_sway(decimate(signal, interval, factor), 1 / mode.frequency_hz);
  constexpr double confirmed = 5;
  const std::vector<Instant> smooth = instants_of(coarse, mode, 3);
  if (const Instant* found = clearest_of(smooth, mode.amplitude)) return jump_at(*found);
  const std::vector<Instant> straight = instants_of(coarse, mode, 1);
  const Instant* found = clearest_of(straight, mode.amplitude);
  if (found && std::any_of(smooth.begin(), smooth.end(), [&](const Instant& one) {
        return std::abs(one.time - found->time) * mode.frequency_hz < 1 && one.beyond > confirmed;
      }))
    return jump_at(*found);
  return {};
}

}  // namespace beamid::experiments
