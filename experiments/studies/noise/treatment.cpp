#include "experiments/studies/noise/treatment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/studies/noise/oscillator_bank.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

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

}  // namespace beamid::experiments
