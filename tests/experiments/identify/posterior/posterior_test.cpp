// The posterior of parameters. Oracles: the closed form of a linear model, quadrature on a grid of the
// closed-form frequencies of two storeys, the published building of three storeys and its quadrature by
// SciPy.
#include "experiments/identify/posterior/posterior.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "tests/experiments/identify/posterior/posterior_cases.hpp"

namespace beamid::experiments::posterior_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

PosteriorSettings draws_of(std::size_t draws, std::size_t particles = 1000) {
  PosteriorSettings settings;
  settings.particles = particles;
  settings.chains.draws = draws;
  settings.importance_draws = 4 * draws;
  return settings;
}

/// y = A u + noise of one standard deviation: the posterior is normal.
class LinearLikelihood final : public Likelihood {
 public:
  LinearLikelihood(MatrixXd slopes, VectorXd measured)
      : slopes_(std::move(slopes)), measured_(std::move(measured)) {}
  Index size() const override { return slopes_.cols(); }
  LikelihoodValue at(const VectorXd& u, bool) const override {
    const VectorXd rest = measured_ - slopes_ * u;
    return {
        -0.5 * rest.squaredNorm() - 0.5 * static_cast<double>(rest.size()) * std::log(2.0 * std::numbers::pi),
        slopes_.transpose() * rest, slopes_.transpose() * slopes_};
  }
  MatrixXd slopes_;
  VectorXd measured_;
};

LinearLikelihood three_unknowns() {
  return {MatrixXd{{20.0, 3.0, 0.0}, {1.0, 9.0, -4.0}, {0.0, 2.0, 30.0}, {5.0, 5.0, 5.0}},
          VectorXd{{18.0, 3.0, -12.0, 1.0}}};
}

MatrixXd all_draws(const Posterior& posterior) {
  MatrixXd all(posterior.chains.front().draws.rows(), 0);
  for (const PosteriorChain& chain : posterior.chains) {
    all.conservativeResize(Eigen::NoChange, all.cols() + chain.draws.cols());
    all.rightCols(chain.draws.cols()) = chain.draws;
  }
  return all;
}

TEST(Posterior, OfALinearModelIsTheNormalOneOfTheClosedForm) {
  const LinearLikelihood model = three_unknowns();
  const Posterior found = sample_posterior(model, MatrixXd(3, 0), draws_of(10000));
  EXPECT_TRUE(found.complaints().empty()) << found.complaints().front();
  ASSERT_EQ(found.humps.size(), 1u);
  const MatrixXd covariance =
      (model.slopes_.transpose() * model.slopes_ + MatrixXd::Identity(3, 3)).inverse();
  const VectorXd mean = covariance * model.slopes_.transpose() * model.measured_;
  EXPECT_LT((found.humps[0].covariance - covariance).norm(), 1e-9 * covariance.norm());
  const MatrixXd draws = all_draws(found);
  for (Index j = 0; j < 3; ++j) {
    const double deviation = std::sqrt(covariance(j, j));
    EXPECT_NEAR(draws.row(j).mean(), mean[j], 0.03 * deviation);
    const double sampled = std::sqrt((draws.row(j).array() - draws.row(j).mean()).square().mean());
    EXPECT_NEAR(sampled / deviation, 1.0, 0.01);
  }
  // y is normal with the covariance A A^T + 1
  const MatrixXd marginal = model.slopes_ * model.slopes_.transpose() + MatrixXd::Identity(4, 4);
  const double evidence = -0.5 * model.measured_.dot(marginal.ldlt().solve(model.measured_)) -
                          0.5 * std::log(marginal.determinant()) - 2.0 * std::log(2.0 * std::numbers::pi);
  EXPECT_NEAR(found.importance.log_evidence, evidence, 0.02);
  EXPECT_NEAR(found.tempered.log_evidence, evidence, 0.5);
}

TEST(Posterior, IsTheSameForAnyNumberOfThreads) {
  const LinearLikelihood model = three_unknowns();
  std::vector<Posterior> found;
  for (const std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    found.push_back(sample_posterior(model, MatrixXd(3, 0), draws_of(200, 200)));
  }
  EXPECT_EQ(all_draws(found[0]), all_draws(found[1]));
  EXPECT_EQ(found[0].importance.log_evidence, found[1].importance.log_evidence);
}

/// Sums over a grid of k1, k2, of each side of k1 = 3 k2: (k1, k2) and (3 k2, k1 / 3) have the same
/// frequencies.
struct TwoStoreyQuadrature {
  double log_evidence = 0.0, first_share = 0.0;  // of the side with k1 < 3 k2
};
TwoStoreyQuadrature two_storey_quadrature(const ModalData& data, double from, double to) {
  constexpr int points = 1500;
  const double width = (to - from) / points;
  double sums[2] = {};
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {
      const double k1 = from + width * (i + 0.5), k2 = from + width * (j + 0.5);
      const std::vector<double> f = two_storey_frequencies(k1, k2);
      double log = 0.0;
      for (std::size_t m = 0; m < 2; ++m) {
        const double s = data.modes[m].deviation_hz, gap = (f[m] - data.modes[m].frequency_hz) / s;
        log -= 0.5 * gap * gap + std::log(s * std::sqrt(2.0 * std::numbers::pi));
      }
      sums[k1 > 3.0 * k2] += std::exp(log) / (points * static_cast<double>(points));
    }
  return {std::log(sums[0] + sums[1]), sums[0] / (sums[0] + sums[1])};
}

// Both masses of the two-mode posterior of the published chain within 1 %, the evidence within 0.05 nat.
TEST(Posterior, WeighsTheTwoHumpsOfTwoStoreysAsQuadratureDoes) {
  const ModalData data = measured_frequencies(two_storey_frequencies(958.61, 958.61), 0.025);
  const ModalCase chain = modal_case(two_storeys("lower_n_per_m = 150\nupper_n_per_m = 4500\n"), data);
  const Posterior found = sample_posterior(*chain.likelihood, MatrixXd(2, 0), draws_of(10000));
  EXPECT_TRUE(found.complaints().empty()) << found.complaints().front();
  ASSERT_EQ(found.humps.size(), 2u);
  const TwoStoreyQuadrature exact = two_storey_quadrature(data, 150.0, 4500.0);
  const VectorXd top = chain.likelihood->physical(found.humps[0].top);
  const double first = top[0] < 3.0 * top[1] ? found.share[0] : found.share[1];
  EXPECT_NEAR(first / exact.first_share, 1.0, 0.01);
  EXPECT_NEAR((1.0 - first) / (1.0 - exact.first_share), 1.0, 0.01);
  EXPECT_NEAR(found.log_evidence(), exact.log_evidence, 0.05);
  double drawn = 0.0;
  const MatrixXd draws = all_draws(found);
  for (Index i = 0; i < draws.cols(); ++i) {
    const VectorXd k = chain.likelihood->physical(draws.col(i));
    drawn += k[0] < 3.0 * k[1] ? 1.0 / static_cast<double>(draws.cols()) : 0.0;
  }
  EXPECT_NEAR(drawn, exact.first_share, 0.02);
}

Experiment three_storeys_with(const std::string& prior) {
  std::string text = "[chain]\nmasses_kg = [5.36, 5.36, 5.36]\nstiffnesses_n_per_m = [60000, 60000, 60000]\n";
  for (int storey = 0; storey < 3; ++storey)
    text += "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = " + std::to_string(storey) +
            ".0\nto_m = " + std::to_string(storey + 1) + ".0\n" + prior;
  return experiment_of(text);
}

// The frequencies' deviations are not published: these give the published standard deviations of the
// stiffnesses.
ModalData three_storey_data() {
  ModalData data = frequencies(three_frequencies);
  const double deviations[] = {0.0767, 0.0592, 0.0544};
  for (std::size_t i = 0; i < 3; ++i) data.modes[i].deviation_hz = deviations[i];
  return data;
}

// Published (TMCMC of 1,000 draws): 52,508(1,428) 56,956(2,074) 66,778(2,501) N/m. SciPy's importance
// sampling, 400,000 draws, over this hump: 52,524(1,430) 56,992(2,084) 66,722(2,507), 99.75 % of the
// probability, evidence -6.4765.
TEST(Posterior, OfThreeStoreysUnderTheAuthorsPriorIsThePublishedOne) {
  const ModalCase frame =
      modal_case(three_storeys_with("lower_n_per_m = 20000\nupper_n_per_m = 150000\n"), three_storey_data());
  const Posterior found = sample_posterior(*frame.likelihood, MatrixXd(3, 0), draws_of(10000));
  EXPECT_TRUE(found.complaints().empty()) << found.complaints().front();
  EXPECT_NEAR(found.share[0], 0.9975, 0.002);
  EXPECT_NEAR(found.log_evidence(), -6.4765, 0.05);
  const double mean[] = {52524, 56992, 66722}, deviation[] = {1430, 2084, 2507},
               published[] = {52508, 56956, 66778};
  const MatrixXd draws = all_draws(found);
  for (Index j = 0; j < 3; ++j) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (Index i = 0; i < draws.cols(); ++i) {
      const VectorXd k = frame.likelihood->physical(draws.col(i));
      if (k[0] > 100000.0) continue;
      sum += k[j];
      squares += k[j] * k[j];
      ++count;
    }
    EXPECT_NEAR(sum / count, mean[j], 0.04 * deviation[j]);
    EXPECT_NEAR(std::sqrt(squares / count - sum * sum / count / count) / deviation[j], 1.0, 0.03);
    EXPECT_NEAR(sum / count, published[j], 0.1 * deviation[j]);  // error of a thousand draws, not independent
  }
}

// The same without bounds, log-uniform within a factor of ten: SciPy's importance sampling, 400,000 draws,
// weighs the published set 77.3 % and the second, 155,200 31,830 40,550 N/m, 22.7 %, evidence -8.4025.
TEST(Posterior, OfThreeStoreysWithoutThePriorShowsTheSecondSet) {
  const ModalCase frame = modal_case(three_storeys_with(""), three_storey_data());
  const Posterior found = sample_posterior(*frame.likelihood, MatrixXd(3, 0), draws_of(4000));
  EXPECT_TRUE(found.complaints().empty()) << found.complaints().front();
  ASSERT_GE(found.humps.size(), 2u);
  EXPECT_NEAR(found.share[0], 0.773, 0.01);
  EXPECT_NEAR(found.share[1], 0.227, 0.01);
  EXPECT_NEAR(found.log_evidence(), -8.4025, 0.05);
  const VectorXd second = frame.likelihood->physical(found.humps[1].top);
  EXPECT_NEAR(second[0], 155200, 1000);
}

// Oracle: Markov's inequality. A tempering's evidence has the true one as its mean: it may be far too small,
// as that of 200 particles on a narrow posterior is, and is e^3 times too large once in 20 times at most.
TEST(Posterior, DoubtsItsHumpsWhereTheTemperingsHoldMoreThanThem) {
  Posterior found;
  found.importance.log_evidence = 631.3;
  found.importance.effective_share = 0.5;
  found.tempered_apart = 5.0;
  found.tempered.log_evidence = 626.0;
  EXPECT_FALSE(found.humps_are_uncertain());
  found.tempered.log_evidence = 635.0;
  EXPECT_TRUE(found.humps_are_uncertain());
  found.importance.effective_share = 0.01;  // the humps are not weighed: temperings that disagree are all
  EXPECT_TRUE(found.humps_are_uncertain());
  found.tempered_apart = 1.0;
  EXPECT_FALSE(found.humps_are_uncertain());
}

TEST(Posterior, IsRefusedWhereThePriorCannotHaveProducedTheModes) {
  class Impossible final : public Likelihood {
    Index size() const override { return 1; }
    LikelihoodValue at(const VectorXd&, bool) const override { return {}; }
  };
  EXPECT_THROW(sample_posterior(Impossible(), MatrixXd(1, 0), draws_of(100, 100)), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::posterior_test
