// Particle filter: N states z_i of weights w_i, the estimate their mean and covariance [gordon1993].
//
//     predict   z_i = F(z_i, u) + v_i,  v_i ~ N(0, Q)
//     correct   w_i := w_i N(y; h(z_i), R),  scaled to sum to one
//
// When the effective sample size falls below a share of N, systematic resampling [kitagawa1996] makes the
// weights equal again. Entries without process noise (constants; all of a motion without noise) would keep
// their first values for ever: a kernel moves these afterwards [musso2001], shrunk so that it leaves their
// mean and covariance as they are [liu2001]. A reading far sharper than the cloud is worked in by powers of
// its likelihood, p^d1 p^d2 ..., d1 + d2 + ... = 1, each just strong enough to bring about a resampling:
// progressive correction [musso2001].
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "filters/covariance_factor.hpp"
#include "filters/innovation.hpp"
#include "filters/particle_cloud.hpp"
#include "filters/random.hpp"
#include "filters/whole_number.hpp"

namespace beamid::filters {
namespace {

// A likelihood worked in by powers of itself [musso2001].

/// Weights w_i exp(-share c_i / 2), scaled to sum to one, and the logarithm of their sum before.
struct Reweighted {
  Eigen::VectorXd weights;
  double log_sum = 0.0;
};

/// @param squares c_i = -2 log of the likelihood of each of N samples, without its constant (N).
Reweighted reweighted(const Eigen::VectorXd& weights, const Eigen::VectorXd& squares, double share);

/// The largest share of the likelihood, up to `left`, after which the effective sample size 1 / sum w_i^2 is
/// still `enough`; to 1 %.
double affordable_share(const Eigen::VectorXd& weights, const Eigen::VectorXd& squares, double left,
                        double enough);

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

Reweighted reweighted(const VectorXd& weights, const VectorXd& squares, double share) {
  const double least = squares.minCoeff();
  Reweighted result{weights.array() * (-0.5 * share * (squares.array() - least)).exp(), 0.0};
  const double sum = result.weights.sum();
  result.weights /= sum;
  result.log_sum = std::log(sum) - 0.5 * share * least;
  return result;
}

double affordable_share(const VectorXd& weights, const VectorXd& squares, double left, double enough) {
  const auto size = [&](double share) {
    return 1.0 / reweighted(weights, squares, share).weights.squaredNorm();
  };
  if (size(left) >= enough) return left;
  double low = 0.0, high = left;
  for (int i = 0; i < 60 && high - low > 1e-2 * high; ++i) {
    const double middle = low > 0.0 ? std::sqrt(low * high) : 1e-2 * high;
    if (size(middle) >= enough)
      low = middle;
    else
      high = middle;
  }
  return low > 0.0 ? low : high;
}

class ParticleFilter final : public Filter {
 public:
  ParticleFilter(std::unique_ptr<DiscreteModel> model, const Options& options)
      : Filter(std::move(model)),
        count_(whole_number(options.number("particles"), 2, "particle", "particles", 1000000)),
        seed_(whole_number(options.number("seed"), 0, "particle", "seed")),
        resample_below_(options.number("resample_below")),
        regularise_(options.flag("regularise")),
        random_(static_cast<std::uint64_t>(seed_)) {
    if (!(resample_below_ > 0.0 && resample_below_ <= 1.0))
      throw std::invalid_argument("particle: resample_below is " + std::to_string(resample_below_) +
                                  "; expected a share between 0 and 1");
  }

  void reset(const Gaussian& estimate) override {
    check_estimate(estimate, model_);
    random_ = RandomStream(static_cast<std::uint64_t>(seed_));
    const MatrixXd root = factor_of(estimate);
    // Draws have the divisor N - 1, the cloud's covariance N.
    const double scale = std::sqrt(static_cast<double>(count_) / static_cast<double>(count_ - 1));
    cloud_.states = scale * root * exact_draws_of(root.cols());
    cloud_.states.colwise() += estimate.mean;
    cloud_.weights.setConstant(count_, 1.0 / static_cast<double>(count_));
    estimate_ = cloud_.moments();
    smallest_size_ = static_cast<double>(count_);
    resamplings_ = corrections_ = powers_ = starved_ = 0;
  }

  void predict(const VectorXd& input) override {
    for (Index i = 0; i < count_; ++i) {
      point_ = cloud_.states.col(i);
      model_.transition(point_, input, value_);
      cloud_.states.col(i) = value_;
    }
    const MatrixXd& q = model_.process_noise();
    if (q.size() > 0 && !q.isZero(0.0)) {
      const MatrixXd root = factor_of(q);
      cloud_.states += root * random_.normal(root.cols(), count_);
    }
    form();
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    noise_factor_.compute(model_.output_noise());
    if (noise_factor_.info() != Eigen::Success)
      throw FilterFailure("the output noise is not positive definite; expected so by a particle filter",
                          std::numeric_limits<double>::quiet_NaN());
    see(output, input);
    weigh_innovation(output);
    double left = 1.0, log_likelihood = 0.0;
    for (int power = 0; left > 0.0; ++power) {
      if (power > 0) see(output, input);
      const double share = power < most_powers_ ? next_share(left) : left;
      log_likelihood += apply(share);
      left = share < left ? left - share : 0.0;
      const double size = cloud_.effective_size();
      smallest_size_ = std::min(smallest_size_, size);
      starved_ += size < static_cast<double>(few_);
      if (left == 0.0) form();  // from the weights: what resampling adds is noise
      if (size < resample_below_ * static_cast<double>(count_)) resample();
      powers_ += left > 0.0;
    }
    ++corrections_;
    const double log_scale = noise_factor_.matrixLLT().diagonal().array().log().sum();
    correction_.log_likelihood = log_likelihood - log_scale -
                                 0.5 * static_cast<double>(output.size()) * std::log(2.0 * std::numbers::pi);
  }

  const Gaussian& estimate() const override { return estimate_; }

  std::vector<std::string> remarks() const override {
    std::vector<std::string> result{
        "effective sample size: " + std::to_string(std::lround(cloud_.effective_size())) + " of " +
        std::to_string(count_) + " particles at the end, " + std::to_string(std::lround(smallest_size_)) +
        " at the least; resampled " + std::to_string(resamplings_) + " times in " +
        std::to_string(corrections_) + " corrections"};
    if (cloud_.distinct() < few_)
      result.push_back("the particles have become copies of " + std::to_string(cloud_.distinct()) +
                       ": without process noise only the kernel makes them differ");
    if (starved_ > 0)
      result.push_back(
          "after " + std::to_string(starved_) +
          " corrections fewer than 10 particles counted: the standard deviations there are too small");
    if (powers_ > 0)
      result.push_back("readings sharper than the cloud of particles were worked in by powers of their " +
                       ("likelihood, " + std::to_string(powers_)) + " more than there are readings");
    return result;
  }

 private:
  static constexpr int most_powers_ = 50;
  static constexpr Index few_ = 10;

  MatrixXd exact_draws_of(Index rows) {
    return exact_draws(random_, rows, count_, MatrixXd(0, count_)).values;
  }

  // -2 log of the likelihood of every particle, without its constant.
  void see(const VectorXd& output, const VectorXd& input) {
    seen_.resize(output.size(), count_);
    for (Index i = 0; i < count_; ++i) {
      point_ = cloud_.states.col(i);
      model_.output(point_, input, value_);
      seen_.col(i) = value_;
    }
    const MatrixXd residual = (-seen_).colwise() + output;
    squares_ = noise_factor_.matrixL().solve(residual).colwise().squaredNorm();
    if (!squares_.allFinite())
      throw FilterFailure("a particle's output or the measurement is not finite",
                          std::numeric_limits<double>::quiet_NaN());
  }

  void weigh_innovation(const VectorXd& output) {
    const VectorXd expected = seen_ * cloud_.weights;
    const MatrixXd about = (seen_.colwise() - expected) * cloud_.weights.cwiseSqrt().asDiagonal();
    correction_.innovation = output - expected;
    correction_.innovation_covariance = covariance_of(about) + model_.output_noise();
    weigh(correction_, MatrixXd(0, output.size()), factor_);
  }

  double apply(double share) {
    const Reweighted now = reweighted(cloud_.weights, squares_, share);
    if (!now.weights.allFinite() || !std::isfinite(now.log_sum))
      throw FilterFailure("no particle is near the measurement", std::numeric_limits<double>::quiet_NaN());
    cloud_.weights = now.weights;
    return now.log_sum;
  }

  // How much of the likelihood to work in before the next resampling: all where that brings nothing new, else
  // what leaves half the effective size that asks for it.
  double next_share(double left) const {
    if (moved().empty()) return left;
    const double enough = 0.5 * resample_below_ * static_cast<double>(count_);
    return affordable_share(cloud_.weights, squares_, left, enough);
  }

  void resample() {
    cloud_.resample(random_);
    ++resamplings_;
    if (const std::vector<Index> entries = moved(); !entries.empty()) cloud_.regularise(entries, random_);
  }

  // Entries that the kernel moves: those without process noise.
  std::vector<Index> moved() const {
    std::vector<Index> entries;
    if (!regularise_) return entries;
    const MatrixXd& q = model_.process_noise();
    for (Index i = 0; i < cloud_.states.rows(); ++i)
      if (q.size() == 0 || q(i, i) == 0.0) entries.push_back(i);
    return entries;
  }

  void form() {
    estimate_ = cloud_.moments();
    check_finite(estimate_);
  }

  Index count_, seed_;
  double resample_below_;
  bool regularise_;
  RandomStream random_;
  ParticleCloud cloud_;
  Gaussian estimate_;
  double smallest_size_ = 0.0;
  Index resamplings_ = 0, corrections_ = 0, powers_ = 0, starved_ = 0;
  VectorXd point_, value_, squares_;
  MatrixXd seen_;
  Eigen::LLT<MatrixXd> factor_, noise_factor_;
};

const bool particle_registered = filter_registry().add(
    {"particle",
     "particle filter: systematic resampling, regularised where there is no process noise",
     "[gordon1993], [kitagawa1996], [musso2001], [liu2001]",
     {{"particles", 2000.0, "", "how many"},
      {"resample_below", 0.5, "",
       "share of the particles below which the effective size triggers resampling"},
      {"regularise", true, "", "whether a kernel moves entries without process noise after resampling"},
      {"seed", 1.0, "", "of the random draws: a whole number"}},
     {contract::sampled_on_linear_gaussian},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<ParticleFilter>(std::move(model), options);
     }});

}  // namespace

}  // namespace beamid::filters
