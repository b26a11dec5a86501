#include "experiments/identify/engine/run_bound.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "experiments/identify/verdict/noise_near_mode.hpp"
#include "filters/fisher_information.hpp"
#include "filters/identifiability.hpp"

namespace beamid::experiments {
namespace {

// What counts for frequency and damping is the density of the noise at the mode, whatever R says of all of
// it.
std::vector<double> by_mode(const RunContext& context, ComparedRun& run) {
  const NoiseNearMode& near = *context.analysis.near_mode;
  const double density = near.deviation / run.noise[0], factor = near.student() * density;
  run.near_mode = near;
  if (factor > 1.0) {
    run.noise_ratio = density;
    run.noise_freedom = near.freedom;
    run.interval_factor = factor;
    run.remarks.push_back(fmt::format(
        "Near the mode the noise density, from {} spectral lines, is {:.3g} times that of white noise of the "
        "standard deviation assumed: intervals are widened by {:.3g}.",
        near.lines, density, factor));
  }
  std::vector<double> factors(run.parameters.size(), run.interval_factor);
  return factors;
}

std::vector<double> by_influence(ComparedRun& run) {
  std::vector<double> factors(run.parameters.size(), 1.0);
  std::string widened;
  for (std::size_t j = 0; j < factors.size() && j < run.noise_in.size(); ++j) {
    const NoiseInEstimate& noise = run.noise_in[j];
    factors[j] = std::max(1.0, student_factor(noise.freedom) * noise.ratio);
    if (factors[j] > run.interval_factor) {
      run.interval_factor = factors[j];
      run.noise_ratio = std::max(noise.ratio, 1.0);
      run.noise_freedom = noise.freedom;
    }
    constexpr double worth_saying = 1.1;
    if (factors[j] > worth_saying)
      widened += fmt::format("{}{} by {:.3g}", widened.empty() ? "" : ", ", run.parameters[j].estimate.name,
                             factors[j]);
  }
  if (!widened.empty())
    run.remarks.push_back(
        "The record's noise is denser where these are determined than white noise of the standard deviation "
        "assumed: "
        "intervals are widened, " +
        widened + ".");
  return factors;
}

// The scatter of a driven record's sections, where it is larger: what the model lacks, counted.
void by_sections(ComparedRun& run, std::vector<double>& factors) {
  constexpr double worth_saying = 1.5;
  std::string widened;
  for (std::size_t j = 0; j < factors.size(); ++j) {
    const auto place = static_cast<Eigen::Index>(j);
    const ComparedParameter& p = run.parameters[j];
    const double formal = std::sqrt(run.unknown_state.covariance(place, place)),
                 factor = section_factor(*run.sections, place, formal);
    if (!(factor > factors[j]) || p.estimate.value == 0.0) continue;
    if (factor > worth_saying * factors[j])
      widened += fmt::format("{}{} by {:.2g} % ({:.2g} times)", widened.empty() ? "" : ", ", p.estimate.name,
                             100.0 * factor * p.estimate.deviation / std::abs(p.estimate.value), factor);
    factors[j] = factor;
  }
  if (widened.empty()) return;
  run.remarks.push_back(
      fmt::format("Over {} sections of {:.3g} periods the estimates vary by more than noise makes them: {}. "
                  "Intervals are "
                  "widened to hold this; in brackets, over the formal standard deviation.",
                  run.sections->sections, run.sections->periods, widened));
}

// Where the estimates of the sections follow the size of their motion, which of them are meant.
void follow_size(ComparedRun& run) {
  std::string following;
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const auto place = static_cast<Eigen::Index>(j);
    const SizeTrend trend = trend_with_size(*run.sections, place);
    if (!trend.exists(run.unknown_state.mean.size())) continue;
    const SizeChange change = by_twice_the_motion(trend, run.unknowns[j]);
    following += fmt::format("{}{} changes by {:+.2g} % (+- {:.2g} %)", following.empty() ? "" : ", ",
                             run.parameters[j].estimate.name, 100.0 * change.share,
                             100.0 * quantile_95 * change.deviation);
  }
  if (!following.empty())
    run.remarks.push_back("The estimates follow the size of the motion. Where it is twice as large, " +
                          following + ". The estimates are a mean over the record's sizes.");
}

// A filter more certain than record and prior allow has been linearised elsewhere, or has lost its spread:
// its deviation becomes the least there is.
double to_bound(ComparedParameter& p, double factor) {
  if (!p.bound) return factor;
  const double part = overconfidence(factor * p.estimate.deviation, *p.bound, p.estimate.prior_deviation);
  if (!(part > 0.0)) return factor;
  if (part < 1.0) p.overconfidence = part;
  return factor / part;
}

}  // namespace

double formal_deviation(const ComparedRun& run, std::size_t j) {
  const auto place = static_cast<Eigen::Index>(j);
  return std::abs(run.unknowns[j].slope(run.unknown_state.mean[place])) *
         std::sqrt(run.unknown_state.covariance(place, place));
}

void set_interval(ComparedRun& run, std::size_t j, double spread) {
  const Unknown& unknown = run.unknowns[j];
  const auto place = static_cast<Eigen::Index>(j);
  const double mean = run.unknown_state.mean[place];
  const double half = quantile_95 * spread * std::sqrt(run.unknown_state.covariance(place, place));
  Estimate& estimate = run.parameters[j].estimate;
  estimate.lower_95 = unknown.to_physical(mean - half);
  estimate.upper_95 = unknown.to_physical(mean + half);
  if (unknown.quantity != "damping_ratio" || !(estimate.value < 1.0)) return;
  constexpr double none = 1e-6;  // a decay over a hundred thousand cycles
  if (estimate.lower_95 < none) estimate.lower_95 = 0.0;
  estimate.upper_95 = std::min(estimate.upper_95, 1.0);
}

double overconfidence(double deviation, double bound, double prior_deviation) {
  constexpr double clearly = 0.8;
  const double least = 1.0 / std::hypot(1.0 / bound, 1.0 / prior_deviation), part = deviation / least;
  return part < clearly ? part : 1.0;
}

void widen(ComparedRun& run, std::size_t j, double factor) {
  factor = to_bound(run.parameters[j], factor);
  double& deviation = run.parameters[j].estimate.deviation;
  deviation *= factor;
  const double formal = formal_deviation(run, j);
  set_interval(run, j, formal > 0.0 ? deviation / formal : factor);  // of all that widened it
}

void hold_scatter_of_lines(ComparedRun& run) {
  constexpr double white = 1e-3, worth_saying = 1.25;
  constexpr double surely = 3.0;  // of one line of white noise with a probability of e^-9
  const Eigen::VectorXd& deviations = run.description.deviations;
  if (deviations.size() != static_cast<Eigen::Index>(run.parameters.size())) return;
  const bool coloured = run.diagnostics && run.diagnostics->consistency &&
                        run.diagnostics->consistency->whiteness_p_value < white;
  const double least = coloured ? worth_saying : surely;
  std::string widened;
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const auto place = static_cast<Eigen::Index>(j);
    const double slope = std::abs(run.unknowns[j].slope(run.unknown_state.mean[place])),
                 factor = slope * deviations[place] / run.parameters[j].estimate.deviation;
    if (!(factor > least) || !std::isfinite(factor)) continue;
    widen(run, j, factor);
    widened +=
        fmt::format("{}{} by {:.2g}", widened.empty() ? "" : ", ", run.parameters[j].estimate.name, factor);
  }
  if (!widened.empty())
    run.remarks.push_back(
        "The lines of the spectrum that determine these scatter by more than noise of that level, as under "
        "forces that are not measured. Intervals are widened: " +
        widened + ".");
}

namespace {

// Where frequency or damping surely follow the amplitude of a free decay, intervals hold what they are over
// it, as those of K and C do: a stiffness or a mass twice the share of a frequency.
void hold_sections(const AmplitudeSections& sections, ComparedRun& run) {
  if (sections.sections.empty() || !run.mode) return;
  for (std::size_t j = 0; j < run.parameters.size() && j < run.unknowns.size(); ++j) {
    const Estimate& found = run.parameters[j].estimate;
    const bool damping = run.unknowns[j].quantity.find("damping") != std::string::npos;
    const double value = damping ? run.mode->damping_ratio : run.mode->frequency_hz,
                 times = damping ? 1.0 : 2.0,
                 deviation = found.deviation / std::abs(found.value) * value / times;
    if (!(deviation > 0.0) || !std::isfinite(deviation)) continue;
    const SectionTrend& trend = damping ? sections.damping : sections.frequency;
    if (!trend.varies()) continue;
    const double half = section_half_width(trend, value, deviation, deviation);
    if (half > quantile_95 * deviation) widen(run, j, half / (quantile_95 * deviation));
  }
}

}  // namespace

void widen_intervals(const RunContext& context, ComparedRun& run) {
  std::vector<double> factors =
      run.noise_in.empty() && context.analysis.modal ? by_mode(context, run) : by_influence(run);
  if (run.sections) {
    by_sections(run, factors);
    if (run.sections->is_long()) follow_size(run);
  }
  for (std::size_t j = 0; j < factors.size(); ++j) widen(run, j, factors[j]);
  hold_sections(context.analysis.sections, run);
  if (!run.mode) return;
  run.mode->damping_ratio_deviation *= run.interval_factor;
  run.mode->frequency_deviation_hz *= run.interval_factor;
  if (!run.sections) return;
  const filters::Gaussian scattered{run.unknown_state.mean, run.sections->covariance, {}};
  const auto modes = recorded_modes(*run.model, run.run.last.mean, scattered, run.mode->frequency_hz);
  if (!modes) return;
  const double student = student_factor(run.sections->freedom.minCoeff());
  run.mode->damping_ratio_deviation =
      std::max(run.mode->damping_ratio_deviation, student * modes->shown.damping_ratio_deviation);
  run.mode->frequency_deviation_hz =
      std::max(run.mode->frequency_deviation_hz, student * modes->shown.frequency_deviation_hz);
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

VectorXd run_bounds(filters::DiscreteModel& discrete, const JointModel& model, const VectorXd& state,
                    const StartDirections& directions, const filters::Measurements& record) {
  filters::InformationFactor information =
      filters::information_factor(discrete, state, record.time.size(), directions.all(), record.inputs);
  const Index first = directions.motion.cols(), all = information.unknowns();
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    if (model.unknowns[j].nuisance)
      information.add(MatrixXd::Identity(all, all).row(first + static_cast<Index>(j)));
  const auto slips = static_cast<Index>(model.slips.size());
  for (Index i = first - slips; i < first; ++i) information.add(MatrixXd::Identity(all, all).row(i));
  VectorXd bound =
      filters::determined_combinations(information, VectorXd::Ones(all)).bounds.tail(all - first);
  const double read = record.outputs.array().isFinite().cast<double>().mean();  // share of the samples
  for (Index j = 0; j < bound.size(); ++j) {
    const Index place = model.unknown_places[j];
    bound[j] *=
        directions.unknowns(place, j) * std::abs(model.unknowns[j].slope(state[place])) / std::sqrt(read);
  }
  return bound;
}

namespace {

// |C v| of every eigenvector of the motion: what the sensors see of it.
VectorXd sight_of(const filters::LinearMotion& motion, const VectorXd& state,
                  const Eigen::EigenSolver<MatrixXd>& solver) {
  MatrixXd sensors;
  motion.output_jacobian(state, VectorXd::Zero(motion.input_size()), sensors);
  return (sensors.leftCols(solver.eigenvalues().size()) * solver.eigenvectors()).colwise().norm();
}

// How far the measured inputs reach every eigenvalue of the motion, and the sensors see it, as a share of the
// largest: |C v| |w^T B| of its right and left eigenvectors v, w; of a free motion |C v|. Eigenvalues that
// are the same share theirs.
VectorXd shares_of_record(const filters::LinearMotion& motion, const VectorXd& state, const MatrixXd& rates,
                          const Eigen::EigenSolver<MatrixXd>& solver) {
  constexpr double same = 1e-6;
  const Index n = rates.rows();
  MatrixXd through;
  motion.input_matrix(state, through);
  const Eigen::VectorXcd& lambda = solver.eigenvalues();
  const VectorXd sight = sight_of(motion, state, solver);
  VectorXd reach = VectorXd::Ones(n);
  if (through.size() > 0 && !through.isZero(0.0)) {
    const Eigen::EigenSolver<MatrixXd> left(rates.transpose());
    const VectorXd pushed = (through.transpose() * left.eigenvectors()).colwise().norm();
    for (Index i = 0; i < n; ++i) {
      reach[i] = 0.0;
      for (Index k = 0; k < n; ++k)
        if (std::abs(left.eigenvalues()[k] - lambda[i]) <= same * std::abs(lambda[i])) reach[i] += pushed[k];
    }
  }
  VectorXd share(n);
  for (Index i = 0; i < n; ++i) {
    double sum = 0.0;
    for (Index k = 0; k < n; ++k)
      if (std::abs(lambda[k] - lambda[i]) <= same * std::abs(lambda[i])) sum += sight[k];
    share[i] = sum * reach[i];
  }
  const double largest = share.maxCoeff();
  return largest > 0.0 ? VectorXd(share / largest) : VectorXd::Ones(n);
}

// Oscillations that the record holds, with their shares of it; the slowest first.
std::vector<std::pair<FoundMode, double>> oscillations(const filters::LinearMotion& motion,
                                                       const VectorXd& state) {
  constexpr double at_rest = 1e-6;  // of the fastest rate: what rounding makes of a motion without stiffness
  constexpr double in_record = 1e-8;
  MatrixXd rates;
  motion.motion_matrix(state, rates);
  const Eigen::EigenSolver<MatrixXd> solver(rates);
  const Eigen::VectorXcd& eigenvalues = solver.eigenvalues();
  const double fastest = eigenvalues.cwiseAbs().maxCoeff();
  const VectorXd share = shares_of_record(motion, state, rates, solver);
  std::vector<std::pair<FoundMode, double>> found;
  for (Index i = 0; i < eigenvalues.size(); ++i) {
    const std::complex<double> lambda = eigenvalues[i];
    if (!(lambda.imag() > at_rest * fastest) || !(share[i] > in_record)) continue;
    const double frequency = std::abs(lambda) / (2.0 * std::numbers::pi);
    found.emplace_back(FoundMode{frequency, -lambda.real() / std::abs(lambda)}, share[i]);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first.frequency_hz < b.first.frequency_hz; });
  return found;
}

// Of the slowest and of those with a tenth of the largest share, the one nearest to a frequency.
FoundMode nearest(const std::vector<std::pair<FoundMode, double>>& found, double hz) {
  constexpr double strong = 0.1;
  const auto distance = [&](const FoundMode& mode) { return std::abs(std::log(mode.frequency_hz / hz)); };
  FoundMode best = found.front().first;
  for (const auto& [mode, share] : found)
    if (share > strong && distance(mode) < distance(best)) best = mode;
  return best;
}

void add_deviations(const filters::LinearMotion& motion, const VectorXd& state,
                    const filters::Gaussian& unknowns, const std::vector<Index>& places, FoundMode& found) {
  constexpr double part = 0.01;  // of a deviation
  MatrixXd slopes = MatrixXd::Zero(2, unknowns.mean.size());
  for (Index j = 0; j < slopes.cols(); ++j) {
    const double step = part * std::sqrt(unknowns.covariance(j, j));
    VectorXd moved = state;
    moved[places[static_cast<std::size_t>(j)]] += step;
    if (const auto modes = oscillations(motion, moved); !modes.empty() && step > 0.0) {
      const FoundMode mode = nearest(modes, found.frequency_hz);
      slopes.col(j) << (mode.frequency_hz - found.frequency_hz) / step,
          (mode.damping_ratio - found.damping_ratio) / step;
    }
  }
  const Eigen::Vector2d variance =
      (slopes * unknowns.covariance * slopes.transpose()).diagonal().cwiseMax(0.0);
  found.frequency_deviation_hz = std::sqrt(variance[0]);
  found.damping_ratio_deviation = std::sqrt(variance[1]);
}

}  // namespace

std::optional<RecordedModes> recorded_modes(const JointModel& model, const VectorXd& state,
                                            const filters::Gaussian& unknowns,
                                            std::optional<double> record_hz) {
  const auto* motion = dynamic_cast<const filters::LinearMotion*>(model.motion.get());
  if (!motion) return {};
  const auto found = oscillations(*motion, state);
  if (found.empty()) return {};
  const FoundMode& lowest = found.front().first;
  RecordedModes modes{lowest, record_hz ? nearest(found, *record_hz) : lowest};
  add_deviations(*motion, state, unknowns, model.unknown_places, modes.shown);
  return modes;
}

std::vector<std::complex<double>> seen_rates(const JointModel& model, const VectorXd& state, double least) {
  const auto* motion = dynamic_cast<const filters::LinearMotion*>(model.motion.get());
  if (!motion) return {};
  MatrixXd rates;
  motion->motion_matrix(state, rates);
  const Index n = rates.rows();
  const Eigen::EigenSolver<MatrixXd> solver(rates);
  const Eigen::VectorXcd part =  // of the motion
      solver.eigenvectors().fullPivLu().solve(state.head(n).cast<std::complex<double>>());
  const VectorXd seen = sight_of(*motion, state, solver).cwiseProduct(part.cwiseAbs());
  std::vector<std::complex<double>> found;
  for (Index i = 0; i < n; ++i)
    if (solver.eigenvalues()[i].imag() > 0.0 && seen[i] > least * seen.maxCoeff())
      found.push_back(solver.eigenvalues()[i]);
  return found;
}

}  // namespace beamid::experiments
