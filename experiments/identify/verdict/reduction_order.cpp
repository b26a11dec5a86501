// The order of a reduction: how many coordinates least errors need.
//
// A free decay is a sum of damped sines, y(t) = sum_k Re(h_k exp(lambda_k t)), h_k what the sensors show of
// mode k. A model of order r has the first r of them. Over the noise of the sensors, and to first order, its
// least squares are a projection, with the columns J of ln p_j and of the amplitudes Re h_k, Im h_k, k <= r:
//
//     d ln p = (J^T J + L)^-1 J^T (sum_(k > r) Re(h_k exp(lambda_k t)) - sum_(k <= r) Re(h_k e_k t
//     exp(lambda_k t)))
//
// L = diag((p_j / s0_j)^2) is the prior's information, e_k the rate lambda_k of the reduced model less that
// of the mesh. The second sum is the bias of the reduction. The first is what the omitted modes add:
// coloured noise, for their phases are not known. The standard deviation is the Cramer-Rao bound, the root of
// the diagonal of (J^T J + L)^-1. A mode whose phase the model would lose, |e_k + d lambda_k| min(T, 1 /
// sigma_k) > 1 behind all corrections, is not followed by a filter: it counts as omitted.
//
// All products are sums over the samples of t^n exp(gamma t) with gamma = lambda_k + lambda_l or lambda_k +
// conj(lambda_l).
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/choice.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd, Eigen::MatrixXcd, Eigen::VectorXcd;

/// Oscillations of a free model at given parameters, the slowest first.
struct OrderModes {
  VectorXcd rate;         ///< lambda (k) [rad/s]
  MatrixXcd seen;         ///< h by the sensors, of any amplitude (p x k)
  MatrixXcd slope;        ///< d lambda / d ln p (k x q); 0 for parameters that the model lacks
  Index coordinates = 0;  ///< r
};

VectorXcd oscillating_rates(const filters::LinearMotion& motion, const VectorXd& state,
                            MatrixXcd* seen = nullptr) {
  MatrixXd matrix;
  motion.motion_matrix(state, matrix);
  const Eigen::EigenSolver<MatrixXd> solver(matrix, seen != nullptr);
  std::vector<Index> places;
  for (Index i = 0; i < matrix.rows(); ++i)
    if (solver.eigenvalues()[i].imag() > 0.0) places.push_back(i);
  std::ranges::sort(places, {}, [&](Index i) { return std::abs(solver.eigenvalues()[i]); });
  if (seen) {
    MatrixXd sensors;
    motion.output_jacobian(state, VectorXd::Zero(motion.input_size()), sensors);
    *seen = sensors.leftCols(matrix.rows()) * solver.eigenvectors()(Eigen::all, places);
  }
  return solver.eigenvalues()(places);
}

/// The structure reduced in one way, with these values of the unknowns of a run; absent without such a model.
std::optional<OrderModes> order_modes(const RunContext& context, const ComparedRun& run,
                                      const VectorXd& values, const Choice& reduction) {
  constexpr double change = 1e-4;
  const Choice& choice = context.experiment.model;
  try {
    const ModelSetting setting = model_setting(context.experiment, context.analysis.even.record, reduction);
    JointModel model = *model_registry().make(choice.name, choice.options, setting);
    VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
    std::vector<Index> of_run(model.unknowns.size(), -1);
    for (std::size_t i = 0; i < model.unknowns.size(); ++i) {
      const Unknown& unknown = model.unknowns[i];
      const auto same = std::ranges::find(run.unknowns, unknown.name, &Unknown::name);
      if (same != run.unknowns.end()) of_run[i] = same - run.unknowns.begin();
      state[model.unknown_places[i]] = unknown.to_state(of_run[i] < 0 ? unknown.guess : values[of_run[i]]);
    }
    model = on_basis_at(choice, setting, model, state);
    const auto* const motion = dynamic_cast<const filters::LinearMotion*>(model.motion.get());
    if (!motion) return {};
    OrderModes found;
    found.coordinates = model.motion_size();
    found.rate = oscillating_rates(*motion, state, &found.seen);
    found.slope = MatrixXcd::Zero(found.rate.size(), values.size());
    for (std::size_t i = 0; i < model.unknowns.size(); ++i) {
      if (of_run[i] < 0) continue;
      const auto moved = [&](double factor) {
        VectorXd there = state;
        there[model.unknown_places[i]] = model.unknowns[i].to_state(factor * values[of_run[i]]);
        return oscillating_rates(*motion, there);
      };
      const VectorXcd above = moved(1.0 + change), below = moved(1.0 - change);
      if (above.size() != found.rate.size() || below.size() != found.rate.size()) return {};
      found.slope.col(of_run[i]) = (above - below) / (2.0 * change);
    }
    return found;
  } catch (const std::exception&) {  // an order that the method cannot have, or no such structure
    return {};
  }
}

/// sum_j (j dt)^n exp(gamma j dt), n = 0, 1, 2, over the samples.
std::array<Complex, 3> decaying_sums(Complex gamma, double dt, Index samples) {
  const Complex factor = std::exp(gamma * dt);
  std::array<Complex, 3> sum{};
  Complex power = 1.0;
  constexpr double nothing = 1e-40;  // squared
  for (Index j = 0; j < samples && std::norm(power) > nothing; ++j, power *= factor) {
    const double t = dt * static_cast<double>(j);
    sum[0] += power;
    sum[1] += t * power;
    sum[2] += t * t * power;
  }
  return sum;
}

/// Products of the motions Re(i^c h_k t^n exp(lambda_k t)), n and c 0 or 1, over channels and samples: index
/// 4 k
/// + 2 n + c (4k x 4k).
MatrixXd motion_products(const VectorXcd& rate, const MatrixXcd& seen, double dt, Index samples) {
  const Complex turned[] = {1.0, {0.0, 1.0}};
  MatrixXd products(4 * rate.size(), 4 * rate.size());
  for (Index k = 0; k < rate.size(); ++k)
    for (Index l = 0; l <= k; ++l) {
      const auto with = decaying_sums(rate[k] + rate[l], dt, samples),
                 against = decaying_sums(rate[k] + std::conj(rate[l]), dt, samples);
      const Complex one = (seen.col(k).array() * seen.col(l).array()).sum(),
                    other = seen.col(l).dot(seen.col(k));
      for (Index at = 0; at < 16; ++at) {
        const Index n = at / 8, c = at / 4 % 2, m = at / 2 % 2, d = at % 2;
        const double product = 0.5 * (turned[c] * turned[d] * one * with[n + m] +
                                      turned[c] * std::conj(turned[d]) * other * against[n + m])
                                         .real();
        products(4 * k + 2 * n + c, 4 * l + 2 * m + d) = product;
        products(4 * l + 2 * m + d, 4 * k + 2 * n + c) = product;
      }
    }
  return products;
}

/// The line at which channels that are faded by a mode's own decay are strongest, within a twentieth of its
/// frequency: the mode's, wherever the description has it [rad/s].
double line_of_mode(const MatrixXd& faded, Complex rate, double dt) {
  constexpr double near = 0.05;
  const auto length = static_cast<Index>(std::bit_ceil(2 * static_cast<std::size_t>(faded.cols())));
  const double spacing = 2.0 * std::numbers::pi / (static_cast<double>(length) * dt);
  const auto first = std::max<Index>(2, static_cast<Index>((1.0 - near) * rate.imag() / spacing)),
             last = std::min(length / 2 - 1, static_cast<Index>((1.0 + near) * rate.imag() / spacing));
  if (last <= first) return rate.imag();
  MatrixXd padded = MatrixXd::Zero(faded.rows(), length);
  padded.leftCols(faded.cols()) = faded;
  const VectorXd power = spectrum_lines(padded, length, last + 1).cwiseAbs2().colwise().sum().transpose();
  Index peak = first;
  for (Index i = first; i <= last; ++i)
    if (power[i - 1] > power[peak - 1]) peak = i;  // line i is column i - 1
  if (peak == first || peak == last) return rate.imag();
  const double left = std::log(power[peak - 2]), centre = std::log(power[peak - 1]),
               right = std::log(power[peak]);
  const double curvature = left - 2.0 * centre + right;
  return spacing * (static_cast<double>(peak) + (curvature < 0.0 ? 0.5 * (left - right) / curvature : 0.0));
}

/// The modes up to the highest that a record holds, `seen` at their amplitudes, over the noise of each
/// sensor; absent where it holds fewer than two. Noise is by the median of the spectrum, but not above what
/// the filter assumed. Amplitudes are least squares of all modes at once; a mode counts from ten of its
/// standard deviations.
std::optional<OrderModes> modes_in_record(const RunContext& context, const ComparedRun& run,
                                          OrderModes modes) {
  constexpr Index most = 8;
  constexpr double sure = 10.0, most_products = 4e8;
  const Record& record = context.analysis.even.record;
  const double dt = record.interval();
  const auto samples = static_cast<Index>(record.size());
  MatrixXd outputs = record.samples(output_channels(record), Eigen::all);
  if (!outputs.allFinite() || modes.seen.rows() != outputs.rows() || run.noise.size() != outputs.rows())
    return {};
  Index count = 0;
  while (count < std::min(most, modes.rate.size()) &&
         std::abs(modes.rate[count]) * dt < 0.99 * std::numbers::pi)
    ++count;
  if (static_cast<double>(samples * count * count) > most_products) return {};
  for (Index i = 0; i < outputs.rows(); ++i) {
    outputs.row(i).array() -= outputs.row(i).mean();
    const VectorXd squares = amplitude_spectrum(outputs.row(i).transpose(), dt).amplitude.cwiseAbs2();
    // Under Hann's window white noise has the mean square 6 s^2 / N of a line, ln 2 of it the median.
    const double floor =
                     std::sqrt(median(squares) * static_cast<double>(samples) / (6.0 * std::numbers::ln2)),
                 noise = std::max(std::min(floor, run.noise[i]), 1e-9 * run.noise[i]);
    if (!(noise > 0.0)) return {};
    outputs.row(i) /= noise;
    modes.seen.row(i) /= noise;
  }
  VectorXcd there = modes.rate.head(count);
  VectorXd product(2 * count);
  for (Index k = 0; k < count; ++k) {
    const Eigen::RowVectorXd fading =
        (modes.rate[k].real() * dt *
         Eigen::RowVectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)))
            .array()
            .exp();
    there[k].imag(line_of_mode(outputs * fading.asDiagonal(), modes.rate[k], dt));
    const Complex factor = std::exp(there[k] * dt);
    Complex power = 1.0, sum = 0.0;
    for (Index j = 0; j < samples; ++j, power *= factor) {
      Complex shown = 0.0;
      for (Index i = 0; i < outputs.rows(); ++i) shown += modes.seen(i, k) * outputs(i, j);
      sum += shown * power;
    }
    product.segment(2 * k, 2) << sum.real(), -sum.imag();
  }
  const MatrixXd all = motion_products(there, modes.seen.leftCols(count), dt, samples);
  MatrixXd amplitudes(2 * count, 2 * count);
  for (Index a = 0; a < 2 * count; ++a)
    for (Index b = 0; b < 2 * count; ++b) amplitudes(a, b) = all(4 * (a / 2) + a % 2, 4 * (b / 2) + b % 2);
  const MatrixXd covariance = amplitudes.ldlt().solve(MatrixXd::Identity(2 * count, 2 * count));
  const VectorXd fitted = covariance * product;
  Index held = 0;
  for (Index k = 0; k < count; ++k) {
    const Complex fit(fitted[2 * k], fitted[2 * k + 1]);
    const bool is_held =
        std::norm(fit) > sure * sure * (covariance(2 * k, 2 * k) + covariance(2 * k + 1, 2 * k + 1));
    modes.seen.col(k) *= is_held ? fit : 0.0;
    if (is_held) held = k + 1;
  }
  if (held < 2) return {};
  return OrderModes{modes.rate.head(held), modes.seen.leftCols(held), modes.slope.topRows(held), held};
}

/// Predicted errors of ln p (q each).
struct PredictedErrors {
  VectorXd bias, others, deviation;
};

/// What a model with the rates `reduced` makes of the modes. @param prior its information on ln p (q)
PredictedErrors predicted_errors(const OrderModes& modes, const MatrixXd& products, const VectorXcd& reduced,
                                 const VectorXd& prior, double duration) {
  constexpr double rounding = 1e-9;
  const Index all = modes.rate.size(), q = prior.size();
  std::vector<bool> followed(static_cast<std::size_t>(all), false);
  std::fill_n(followed.begin(), std::min(all, reduced.size()), true);
  while (true) {
    MatrixXd columns = MatrixXd::Zero(4 * all, q + 2 * all);
    VectorXd wrong = VectorXd::Zero(4 * all);
    for (Index k = 0; k < all; ++k) {
      if (!followed[static_cast<std::size_t>(k)]) continue;
      for (Index j = 0; j < q; ++j)
        columns.block(4 * k + 2, j, 2, 1) << modes.slope(k, j).real(), modes.slope(k, j).imag();
      columns.block(4 * k, q + 2 * k, 2, 2).setIdentity();
      const Complex error = modes.rate[k] - reduced[k];
      if (std::abs(error) > rounding * std::abs(reduced[k]))
        wrong.segment(4 * k + 2, 2) << error.real(), error.imag();
    }
    const MatrixXd seen = columns.transpose() * products;
    MatrixXd information = seen * columns;
    information.diagonal().head(q) += prior;
    for (Index j = q; j < q + 2 * all; ++j)
      if (!(information(j, j) > 0.0)) information(j, j) = 1.0;  // of an omitted mode, or of none
    const MatrixXd covariance = information.ldlt().solve(MatrixXd::Identity(q + 2 * all, q + 2 * all)),
                   gain = (covariance * seen).topRows(q);
    PredictedErrors found{gain * wrong, VectorXd::Zero(q),
                          covariance.diagonal().head(q).cwiseMax(0.0).cwiseSqrt()};
    Index lost = -1;
    double most = 1.0;  // rad
    for (Index k = 0; k < all; ++k) {
      if (!followed[static_cast<std::size_t>(k)]) {  // either phase has half of the mean square
        found.others += 0.5 * (gain.col(4 * k).cwiseAbs2() + gain.col(4 * k + 1).cwiseAbs2());
        continue;
      }
      const Complex moved = modes.slope.row(k).dot(found.bias.cast<Complex>()),
                    error = Complex(wrong[4 * k + 2], wrong[4 * k + 3]);
      const double phase =
          std::abs(std::conj(moved) - error) * std::min(duration, -1.0 / modes.rate[k].real());
      if (phase > most) most = phase, lost = k;
    }
    found.others = found.others.cwiseSqrt();
    if (lost < 0) return found;
    followed[static_cast<std::size_t>(lost)] = false;
  }
}

/// Of what a reduction has its order by: "modes", "moments"; empty where its order is not a number.
std::string order_option(const std::string& method) {
  if (method == "none") return {};
  for (const filters::OptionSpec& option : reduction::reduction_registry().find(method).options)
    if (option.name == "modes" || option.name == "moments") return option.name;
  return {};
}

}  // namespace

double OrderError::expected() const {
  return std::hypot(bias, others, deviation);
}

std::vector<OrderError> errors_by_order(const RunContext& context, const ComparedRun& run) {
  constexpr int most = 8;
  const Record& record = context.analysis.even.record;
  if (!run.model || !run.has_estimate() || run.unknowns.size() != run.parameters.size() ||
      !input_channels(record).empty() || std::ranges::none_of(run.unknowns, [](const Unknown& one) {
        return beam_quantity(one.quantity).has_value();
      }))
    return {};
  const auto& registry = reduction::reduction_registry();
  const Choice lowest = parse_choice("modal_truncation", "", registry);
  Choice chosen = parse_choice(run.reduction, "", registry);
  if (order_option(chosen.name).empty()) chosen = lowest;
  const auto of_order = [](Choice choice, int order) {
    choice.options.set(order_option(choice.name), static_cast<double>(order));
    return choice;
  };
  const VectorXd shift = reduction_bias(context, run);
  const auto q = static_cast<Index>(run.parameters.size());
  VectorXd values(q), prior(q);
  for (Index j = 0; j < q; ++j) {
    const Estimate& found = run.parameters[static_cast<std::size_t>(j)].estimate;
    values[j] = found.value / (shift.size() > 0 ? 1.0 + shift[j] : 1.0);
    prior[j] = std::pow(values[j] / found.prior_deviation, 2);
  }
  std::optional<OrderModes> modes;
  for (int order = most; order > 1 && !modes; --order)
    modes = order_modes(context, run, values, of_order(lowest, order));
  if (modes) modes = modes_in_record(context, run, *std::move(modes));
  if (!modes) return {};
  const auto samples = static_cast<Index>(record.size());
  const MatrixXd products = motion_products(modes->rate, modes->seen, record.interval(), samples);
  std::vector<OrderError> all;
  for (int order = 1; order <= modes->rate.size(); ++order) {
    const auto model = order_modes(context, run, values, of_order(chosen, order));
    if (!model) continue;
    const PredictedErrors errors = predicted_errors(*modes, products, model->rate, prior,
                                                    record.interval() * static_cast<double>(samples));
    for (Index j = 0; j < q; ++j)
      if (!run.unknowns[static_cast<std::size_t>(j)].nuisance && model->slope.col(j).norm() > 0.0)
        all.push_back({chosen.name, model->coordinates, static_cast<std::size_t>(j),
                       std::expm1(errors.bias[j]), errors.others[j], errors.deviation[j]});
  }
  return all;
}

}  // namespace beamid::experiments
