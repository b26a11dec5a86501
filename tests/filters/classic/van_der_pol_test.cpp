// Van der Pol's oscillator with its nonlinearity unknown [vanderpol1926]:
//
//     x'' = mu (1 - x^2) x' - x,   mu' = 0,   z = [x, x', mu],   y = x + v
//
// From a guess of mu at half the truth, 0.1 of noise beside an amplitude of 2.
#include <gtest/gtest.h>

#include <cmath>

#include "filters/filter_run.hpp"
#include "filters/random.hpp"

namespace beamid::test::van_der_pol_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

class VanDerPol final : public filters::ContinuousModel {
 public:
  std::vector<filters::Label> state_labels() const override {
    return {{"x", ""}, {"v", "1/s"}, {"mu", "1/s"}};
  }
  std::vector<filters::Label> output_labels() const override { return {{"x", ""}}; }
  void rate(const VectorXd& z, const VectorXd&, VectorXd& rate) const override {
    rate = Eigen::Vector3d(z[1], z[2] * (1.0 - z[0] * z[0]) * z[1] - z[0], 0.0);
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& y) const override { y = z.head(1); }
};

constexpr double dt = 0.05, noise = 0.1;
const Eigen::Vector3d truth(2.0, 0.0, 1.0);

std::unique_ptr<filters::DiscreteModel> van_der_pol(const char* scheme = "runge_kutta_4") {
  return filters::discretise(std::make_shared<VanDerPol>(), dt, scheme,
                             {{}, MatrixXd::Constant(1, 1, noise * noise)});
}

filters::Measurements record(filters::RandomStream& random, Index samples) {
  const auto model = van_der_pol("cvode");
  filters::Measurements result{dt * VectorXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)),
                               noise * random.normal(1, samples),
                               {}};
  VectorXd z = truth, next;
  for (Index k = 0; k < samples; ++k) {
    result.outputs(0, k) += z[0];
    model->transition(z, {}, next);
    z.swap(next);
  }
  return result;
}

class VanDerPolBy : public testing::TestWithParam<std::string> {};

TEST_P(VanDerPolBy, IsIdentifiedWithHonestDeviations) {
  // Oracle: the truth that CVODES moved; the filters move with RK4. NEES of mu over 20 records: chi-square of
  // 20 degrees lies between 4 and 50 in 99.99 % of consistent runs.
  filters::RandomStream random(1926);
  const Eigen::Vector3d deviation(0.1, 0.1, 0.5);
  filters::Options options;
  if (GetParam() == "particle") options.set("particles", 500.0);
  double nees = 0.0, largest = 0.0;
  for (int i = 0; i < 20; ++i) {
    const auto data = record(random, 400);
    const Eigen::Vector3d drawn = deviation.cwiseProduct(random.normal(3, 1));
    Eigen::Vector3d mean = truth + drawn;
    mean[2] = 0.5;  // one deviation off
    const auto filter = filter_registry().make(GetParam(), options, van_der_pol());
    const auto run = filters::run(*filter, {mean, MatrixXd(deviation.cwiseAbs2().asDiagonal())}, data);
    ASSERT_FALSE(run.failure) << run.failure->reason;
    const double error = run.last.mean[2] - truth[2];
    largest = std::max(largest, std::abs(error));
    nees += std::pow(error / run.last.deviations()[2], 2);
  }
  EXPECT_LT(largest, 0.1);
  const bool promised = filter_registry().find(GetParam()).contracts.contains(filters::contract::consistent);
  EXPECT_LT(nees, promised ? 50.0 : 200.0);
  EXPECT_GT(nees, promised ? 4.0 : 0.0);
}

std::vector<std::string> nonlinear_filters() {
  std::vector<std::string> names;
  for (const auto& [name, entry] : filter_registry().entries())
    if (!entry.contracts.contains(filters::contract::linear_models_only) &&
        !entry.contracts.contains(filters::contract::linear_motion_only))
      names.push_back(name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Registered, VanDerPolBy, testing::ValuesIn(nonlinear_filters()),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace beamid::test::van_der_pol_test
