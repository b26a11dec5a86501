#include "experiments/identify/engine/noise_in_estimates.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <unsupported/Eigen/FFT>

#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/identifiability.hpp"
#include "filters/innovation_likelihood.hpp"
#include "filters/latent_inputs.hpp"
#include "filters/sample_walk.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double influence_band = 1.6, fewest_lines = 2;

// Whitened sensitivities of output i at sample k to every direction, in row i N + k (p N x r); zero where
// nothing was read.
MatrixXd sensitivities(filters::DiscreteModel& model, const VectorXd& state, const MatrixXd& directions,
                       const filters::Measurements& record) {
  const Index samples = record.time.size(), p = record.outputs.rows();
  const VectorXd deviation = model.output_noise().diagonal().cwiseSqrt();
  MatrixXd rows = MatrixXd::Zero(p * samples, directions.cols()), moved = directions, sensor;
  filters::walk_samples(model, record, samples, state, moved, [&](Index k, const auto& x, const auto& input) {
    model.output_jacobian(x, input, sensor);
    const MatrixXd read = sensor * moved;
    for (Index i = 0; i < p; ++i)
      if (std::isfinite(record.outputs(i, k))) rows.row(i * samples + k) = read.row(i) / deviation[i];
  });
  return rows;
}

using Eigen::VectorXcd;

// X_k / sqrt(N) of a signal (N), at the lines 0 ... M/2 of the length M that transforms fast, zeros behind
// it: the lines of N themselves take N^2 where it is prime, as 4,001 is.
VectorXcd lines_of(const VectorXd& signal) {
  static thread_local Eigen::FFT<double> transform;
  std::vector<double> values(static_cast<std::size_t>(even_fast_length_around(signal.size())), 0.0);
  Eigen::Map<VectorXd>(values.data(), signal.size()) = signal;
  std::vector<std::complex<double>> lines;
  transform.fwd(lines, values);
  const auto count = static_cast<Index>(values.size()) / 2 + 1;
  return Eigen::Map<const VectorXcd>(lines.data(), count) / std::sqrt(static_cast<double>(signal.size()));
}

VectorXd power(const VectorXd& signal) {
  return lines_of(signal).cwiseAbs2();
}

/// Density of the noise around every line, over that of R, and the lines' weight that it rests on.
struct NoiseDensity {
  VectorXd density, weight;
};

NoiseDensity density_of(const VectorXd& periodogram, const VectorXd& free) {
  const Index lines = periodogram.size();
  VectorXd left(lines + 1), weight(lines + 1);  // running sums
  left[0] = weight[0] = 0.0;
  for (Index k = 0; k < lines; ++k) {
    left[k + 1] = left[k] + periodogram[k];
    weight[k + 1] = weight[k] + free[k];
  }
  NoiseDensity result{VectorXd::Ones(lines), VectorXd::Zero(lines)};
  for (Index k = 0; k < lines; ++k) {
    auto first = static_cast<Index>(std::ceil(static_cast<double>(k) / influence_band)),
         last = static_cast<Index>(static_cast<double>(k) * influence_band);
    first = std::clamp<Index>(first, std::min<Index>(1, lines - 1), lines - 1);
    last = std::clamp<Index>(last, first, lines - 1);
    while (weight[last + 1] - weight[first] < fewest_lines && (first > 1 || last < lines - 1)) {
      if (last < lines - 1) ++last;
      if (first > 1) --first;
    }
    result.weight[k] = weight[last + 1] - weight[first];
    if (result.weight[k] > 0.0) result.density[k] = (left[last + 1] - left[first]) / result.weight[k];
  }
  return result;
}

/// The scatter that the lines of a record bring into an estimate, beside the one that G makes them bring.
struct LineScatter {
  double ratio = 1, freedom = 0;  ///< of variances

  bool is_larger() const {
    constexpr double chance = 1e-3, fewest = 4.0;
    return freedom >= fewest && ratio * freedom > chi_square_limit(freedom, 1.0 - chance);
  }
};

/// The sandwich of the likelihood in frequency: line k moves the estimate by u_k, lines further apart than
/// two are independent, and sum_k u_k (u_k + 4/3 u_(k+1) + 2/3 u_(k+2)) is its variance (Bartlett's weights)
/// whatever the spectra and the coherences of the noise are [white1982]. Noise of
/// an input is in all channels at once and densest at the resonances, which a density averaged around them
/// misses.
/// @param score u_k (lines)
/// @param expected 2 E[u_k^2] by G; what the fit takes of a line makes u_k smaller than that
LineScatter scatter_of(const VectorXd& score, const VectorXd& expected) {
  const double sum = expected.sum();
  if (!(sum > 0.0)) return {};
  const Index lines = score.size();
  double scatter = score.squaredNorm(), widths = 1.0;
  for (const auto& [lag, weight] : {std::pair<Index, double>{1, 2.0 / 3.0}, {2, 1.0 / 3.0}}) {
    scatter += 2.0 * weight * score.head(lines - lag).dot(score.tail(lines - lag));
    widths += 2.0 * weight * weight;
  }
  return {2.0 * scatter / sum, sum * sum / (widths * expected.squaredNorm())};
}

}  // namespace

std::vector<NoiseInEstimate> noise_in_estimates(filters::DiscreteModel& model, const VectorXd& state,
                                                const StartDirections& directions,
                                                const filters::Measurements& record, const MatrixXd& left) {
  const Index samples = record.time.size(), p = record.outputs.rows(), q = directions.unknowns.cols(),
              starts = directions.motion.cols();
  MatrixXd rows = sensitivities(model, state, directions.all(), record);
  const VectorXd size = rows.colwise().norm().transpose().cwiseMax(1e-300);
  rows *= size.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(1e-10);
  qr.compute(rows);
  const Index rank = qr.rank();
  const MatrixXd basis = qr.householderQ() * MatrixXd::Identity(rows.rows(), rank);
  // Influence of the whitened noise on the columns that were chosen: R^-1 Q^T; others are not determined.
  const MatrixXd upper = qr.matrixR().topLeftCorner(rank, rank);
  const VectorXd deviation = model.output_noise().diagonal().cwiseSqrt();

  std::vector<NoiseDensity> density;
  std::vector<VectorXcd> remaining;  // lines of the whitened residual
  for (Index i = 0; i < p; ++i) {
    const VectorXd white = left.row(i).transpose() / deviation[i];
    VectorXd free = VectorXd::Constant(even_fast_length_around(samples) / 2 + 1,
                                       white.array().isFinite().cast<double>().mean());
    for (Index c = 0; c < rank; ++c) free -= power(basis.col(c).segment(i * samples, samples));
    remaining.push_back(lines_of(white.array().isFinite().select(white, 0.0)));
    density.push_back(density_of(remaining.back().cwiseAbs2(), free.cwiseMax(0.0)));
  }

  std::vector<NoiseInEstimate> result(static_cast<std::size_t>(q));
  const auto& places = qr.colsPermutation().indices();
  for (Index c = 0; c < rank; ++c) {
    if (places[c] < starts) continue;
    const VectorXd unit = VectorXd::Unit(rank, c);
    const VectorXd weights = upper.transpose().triangularView<Eigen::Lower>().solve(unit);
    // Row c of R^-1 Q^T is (Q R^-T e_c)^T.
    const VectorXd influence = basis * weights;
    double passed = 0.0, all = 0.0, spread = 0.0;
    VectorXd score = VectorXd::Zero(density[0].density.size()), expected = score;  // of every line
    for (Index i = 0; i < p; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const VectorXcd carried = lines_of(influence.segment(i * samples, samples));
      const VectorXd share = carried.cwiseAbs2();
      const NoiseDensity& noise = density[at];
      score += (carried.conjugate().array() * remaining[at].array()).real().matrix();
      expected += share.cwiseProduct(noise.density);
      for (Index k = 0; k < share.size(); ++k) {
        passed += share[k] * noise.density[k];
        all += share[k];
        spread += share[k] * noise.density[k] / std::max(noise.weight[k], 1.0);
      }
    }
    if (!(all > 0.0) || !(passed > 0.0)) continue;
    NoiseInEstimate& one = result[static_cast<std::size_t>(places[c] - starts)];
    one.ratio = std::sqrt(passed / all);
    // Lines within a band share their noise: var(G) = G^2 / weight, all of it common to one mode.
    one.freedom = std::max(1.0, 2.0 * passed / spread);
    const LineScatter scatter = scatter_of(score, expected);
    if (!scatter.is_larger()) continue;
    one.ratio *= std::sqrt(scatter.ratio);
    one.freedom = std::min(one.freedom, scatter.freedom);
  }
  return result;
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// In units of the deviations known beforehand, which bring all unknowns to one size.
VectorXd bounds_of_unknowns(const MatrixXd& information, const VectorXd& known, const JointModel& model,
                            const VectorXd& values) {
  const MatrixXd scaled = known.asDiagonal() * information * known.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled);
  filters::InformationFactor factor(known.size());
  factor.add(solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose());
  for (Index j = 0; j < known.size(); ++j)
    if (model.unknowns[static_cast<std::size_t>(j)].nuisance)
      factor.add(MatrixXd::Identity(known.size(), known.size()).row(j));
  VectorXd bounds = filters::determined_combinations(factor, VectorXd::Ones(known.size())).bounds;
  for (Index j = 0; j < known.size(); ++j)
    bounds[j] *= known[j] * std::abs(model.unknowns[static_cast<std::size_t>(j)].slope(values[j]));
  return bounds;
}

namespace {

double readings(const filters::Measurements& record) {
  return static_cast<double>(record.outputs.array().isFinite().count());
}

// The record under noise of its inputs, and of its outputs times a root.
class NoisyProblem {
 public:
  NoisyProblem(const JointModel& model, const IdentificationSettings& settings,
               const filters::Gaussian& start, const filters::Measurements& record)
      : noisy_(filters::discretise(model.motion, record.interval(), settings.discretisation,
                                   {{}, settings.output_noise}),
               settings.input_noise),
        root_(VectorXd::Ones(settings.output_noise.rows())),
        problem_(filters::held_problem(noisy_, record, model.unknown_places, noisy_.with_errors(start))) {
    problem_.free_inputs = true;
    problem_.model = [this, of_one = problem_.model](const VectorXd& theta) {
      filters::LinearGaussian scaled = of_one(theta);
      scaled.r = root_.asDiagonal() * scaled.r * root_.asDiagonal();
      return scaled;
    };
  }
  NoisyProblem(const NoisyProblem&) = delete;  // the problem refers to its model
  NoisyProblem& operator=(const NoisyProblem&) = delete;

  void scale_outputs(const VectorXd& root) { root_ = root; }
  filters::InnovationFit fit(const VectorXd& begin) const {
    return filters::fit_innovations(problem_, begin);
  }
  filters::LinearGaussian at(const VectorXd& theta) const { return problem_.model(theta); }
  /// Of the innovations, 1 where the noises are what they are said to be.
  double mean_square(const VectorXd& theta) const {
    const auto pass = filters::innovation_passes({at(theta)}, problem_.record, problem_.interval, false);
    return pass.front().squares / readings(problem_.record);
  }

 private:
  filters::NoisyInputs noisy_;
  VectorXd root_;  // of R's scale (p)
  filters::InnovationProblem problem_;
};

}  // namespace

NoisyInputFit fit_noisy_inputs(const JointModel& model, const IdentificationSettings& settings,
                               const filters::Gaussian& start, const VectorXd& found,
                               const filters::Measurements& record, const std::vector<bool>& noise_is_known) {
  constexpr double enough = 0.02, least_scale = 1e-6;
  constexpr int most_fits = 4, halvings = 20;
  if (!dynamic_cast<const filters::LinearMotion*>(model.motion.get()))
    return {{}, {}, "the model is not linear in its motion"};
  const bool all_known =
      std::find(noise_is_known.begin(), noise_is_known.end(), false) == noise_is_known.end();
  try {
    NoisyProblem problem(model, settings, start, record);
    const auto take = [&](double scale) {
      VectorXd root = VectorXd::Ones(settings.output_noise.rows());
      for (Index i = 0; i < root.size(); ++i)
        if (!noise_is_known[static_cast<std::size_t>(i)]) root[i] = std::sqrt(scale);
      problem.scale_outputs(root);
    };
    double scale = 1.0;
    filters::InnovationFit fit = problem.fit(found(model.unknown_places));
    for (int i = 1; i < most_fits && !all_known; ++i) {
      const double square = problem.mean_square(fit.constants);
      if (std::abs(square - 1.0) < enough || (scale == 1.0 && square > 1.0)) break;
      double low = std::log(least_scale), high = 0.0;  // the square falls as the noise grows
      for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        take(std::exp(middle));
        (problem.mean_square(fit.constants) > 1.0 ? low : high) = middle;
      }
      take(scale = std::exp(high));
      fit = problem.fit(fit.constants);
    }
    const MatrixXd prior = start.covariance(model.unknown_places, model.unknown_places);
    const MatrixXd one = MatrixXd::Identity(prior.rows(), prior.cols());
    const MatrixXd whole = fit.information + prior.llt().solve(one);
    NoisyInputFit result{
        {fit.constants, whole.ldlt().solve(one), {}},
        bounds_of_unknowns(fit.information, prior.diagonal().cwiseSqrt(), model, fit.constants),
        {},
        scale};
    if (!fit.converged) result.failure = "its likelihood has no maximum near the filter's estimate";
    return result;
  } catch (const std::invalid_argument& error) {
    return {{}, {}, error.what()};
  } catch (const std::runtime_error& error) {
    return {{}, {}, error.what()};
  }
}

std::optional<LikeliestInputNoise> likeliest_input_noise(const JointModel& model,
                                                         const IdentificationSettings& settings,
                                                         const filters::Gaussian& start,
                                                         const VectorXd& found,
                                                         const filters::Measurements& record) {
  constexpr double least_share = 1e-4, most_share = 1.0, finer = 2.0;
  if (!dynamic_cast<const filters::LinearMotion*>(model.motion.get())) return {};
  const VectorXd size = root_mean_squares(record.inputs.topRows(model.motion->input_size())),
                 theta = found(model.unknown_places);
  std::vector<double> shares{0.0};
  for (double share = least_share; share <= most_share; share *= finer) shares.push_back(share);
  try {
    std::vector<filters::LinearGaussian> models;
    for (const double share : shares) {
      IdentificationSettings noisy = settings;
      noisy.input_noise = share * size;
      models.push_back(NoisyProblem(model, noisy, start, record).at(theta));
    }
    const auto passes = filters::innovation_passes(models, record, record.interval(), false);
    if (passes[0].failed) return {};
    const double count = readings(record);
    // The likeliest of all noises together.
    const auto scale = [&](std::size_t i) { return passes[i].squares / count; };
    const auto cost = [&](std::size_t i) {
      return 0.5 * (count * std::log(scale(i)) + passes[i].log_determinants);
    };
    LikeliestInputNoise best{VectorXd::Zero(size.size()), 0.0, {}};
    std::size_t at = 0;
    for (std::size_t i = 1; i < shares.size(); ++i)
      if (const double gain = cost(0) - cost(i); !passes[i].failed && gain > best.gain) {
        best = {std::sqrt(scale(i)) * shares[i] * size, gain, {}};
        at = i;
      }
    if (at < 2 || at + 1 == shares.size() || passes[at - 1].failed || passes[at + 1].failed) return best;
    // The least of a parabola in the logarithm of the share.
    const double below = cost(at - 1) - cost(at), above = cost(at + 1) - cost(at),
                 steps = 0.5 * (below - above) / (below + above);
    const auto level = [&](std::size_t i) { return std::log(std::sqrt(scale(i)) * shares[i]); };
    best.deviation = std::exp(level(at) + 0.5 * steps * (level(at + 1) - level(at - 1))) * size;
    return best;
  } catch (const std::invalid_argument&) {  // uneven stamps
    return {};
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace beamid::experiments
