// Several records of one beam. Oracles: one least-squares fit of all of them, and the truth they were
// simulated with.
#include "experiments/identify/engine/joint_comparison.hpp"
#include "experiments/studies/identify/report.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "experiments/modal/subspace_realisation.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::joint_identification_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

const test::SimulatedBeam simulated;

IdentifiedRecord identified(const Record& record, const std::string& name = "record") {
  return {name, record, identify_record(simulated.experiment(), record)};
}

RecordEstimate estimate(double mean, double deviation) {
  return {{VectorXd::Constant(1, mean), MatrixXd::Constant(1, 1, deviation * deviation)},
          MatrixXd::Constant(1, 1, 1e12)};
}

TEST(JointEstimate, WeighsByInverseVariance) {
  // 10 +- 1 and 11 +- 2: (10 + 11/4) / (5/4), variance 4/5, chi^2 = 1/5
  const JointEstimate joint = joint_estimate({estimate(10, 1), estimate(11, 2)});
  EXPECT_NEAR(joint.unknowns.mean[0], 10.2, 1e-9);
  EXPECT_NEAR(joint.unknowns.covariance(0, 0), 0.8, 1e-6);
  EXPECT_NEAR(joint.chi_squared, 0.2, 1e-9);
  EXPECT_EQ(joint.freedom, 1);
  EXPECT_NEAR(joint.probability, std::erfc(std::sqrt(0.2 / 2)), 1e-6);
  EXPECT_TRUE(joint.agree());
}

TEST(JointEstimate, WidensByTheScatterOfRecordsThatDisagree) {
  // 0, 0, 9 +- 1 each: chi^2 = 54 on 2 degrees of freedom; the deviation is that of the mean of three
  const JointEstimate joint = joint_estimate({estimate(0, 1), estimate(0, 1), estimate(9, 1)});
  EXPECT_FALSE(joint.agree());
  EXPECT_NEAR(joint.scatter[0], std::sqrt(27.0), 1e-6);
  EXPECT_NEAR(std::sqrt(joint.unknowns.covariance(0, 0)), std::sqrt(27.0 / 3), 1e-4);
}

TEST(JointEstimate, CountsThePriorOnce) {
  // Both began with variance 4 and were told 1: each record's own information is 3/4.
  const RecordEstimate one{{VectorXd::Zero(1), MatrixXd::Ones(1, 1)}, MatrixXd::Constant(1, 1, 4.0)};
  EXPECT_NEAR(joint_estimate({one, one}).unknowns.covariance(0, 0), 1 / (0.25 + 2 * 0.75), 1e-8);
  EXPECT_NEAR(joint_estimate({one}).unknowns.covariance(0, 0), 1.0, 1e-8);
}

// Two records read a + b with variance 1; b is known beforehand to +-2, the same b in both. Closed form: the
// variance of a is 1/2 + 4, and not half of 1 + 4.
TEST(JointEstimate, CountsWhatIsKnownOfNuisanceParametersOnce) {
  const MatrixXd prior = Eigen::Vector2d(1e6, 4.0).asDiagonal();
  const Eigen::Matrix2d covariance = (Eigen::Matrix2d::Ones() + Eigen::Matrix2d(prior.inverse())).inverse();
  std::vector<RecordEstimate> records;
  for (const double read : {1.0, 3.0}) {
    RecordEstimate record{{Eigen::Vector2d(read, 0.0), covariance}, prior};
    record.nuisance = {false, true};
    record.start = Eigen::Vector2d(read, 0.0);
    records.push_back(record);
  }
  const JointEstimate joint = joint_estimate(records);
  EXPECT_NEAR(joint.unknowns.mean[0], 2.0, 1e-3);
  EXPECT_NEAR(joint.unknowns.mean[1], 0.0, 1e-3);
  EXPECT_NEAR(joint.unknowns.covariance(0, 0), 4.5, 1e-3);
  EXPECT_NEAR(joint.unknowns.covariance(1, 1), 4.0, 1e-3);
  EXPECT_EQ(joint.freedom, 1);
}

TEST(JointIdentification, OfOneRecordIsThatRecords) {
  const JointIdentification joint =
      joint_identification({identified(simulated.record({Quantity::acceleration}, 0.01, 3))});
  const RecordIdentification& alone = joint.records[0].found;
  EXPECT_NEAR(joint.identification.found.stiffness, alone.identification.found.stiffness,
              1e-9 * alone.identification.found.stiffness);
  EXPECT_NEAR(joint.identification.stiffness_deviation,
              alone.interval_factor * alone.identification.stiffness_deviation,
              1e-3 * joint.identification.stiffness_deviation);
}

// Oracle: one least-squares fit of both records, K and C shared, amplitude and phase of each its own. Knows
// no filter: chi^2(K, C) with the best amplitudes of each, its minimum and curvature by differences.
TEST(JointIdentification, IsTheLeastSquaresFitOfBothRecords) {
  const Record first = simulated.record({Quantity::displacement}, 0.01, 21).window(0, 5),
               second = simulated.record({Quantity::displacement}, 0.03, 22).window(2, 10);
  const JointIdentification joint = joint_identification({identified(first), identified(second)});
  const Eigen::Vector2d found(joint.identification.found.stiffness, joint.identification.found.damping),
      told(joint.identification.stiffness_deviation, joint.identification.damping_deviation);
  const auto cost = [&](const Eigen::Vector2d& steps) {  // in deviations told, from the joint estimate
    double sum = 0;
    for (const IdentifiedRecord& one : joint.records) {
      const Oscillator at{joint.identification.found.mass, found[0] + steps[0] * told[0],
                          found[1] + steps[1] * told[1]};
      const MatrixXd left =
          one.record.samples -
          fit_shapes(one.record.samples, one.record.interval(), {at.eigenvalue()}, {true}).reconstruction;
      sum += left.squaredNorm() / (2 * std::pow(one.found.near_mode.deviation, 2));
    }
    return sum;
  };
  constexpr double h = 0.1;
  const double here = cost({0, 0});
  Eigen::Vector2d slope;
  Eigen::Matrix2d curvature;
  for (const Index i : {0, 1}) {
    const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(i);
    slope[i] = (cost(step) - cost(-step)) / (2 * h);
    curvature(i, i) = (cost(step) - 2 * here + cost(-step)) / (h * h);
  }
  curvature(0, 1) = curvature(1, 0) =
      (cost({h, h}) - cost({h, -h}) - cost({-h, h}) + cost({-h, -h})) / (4 * h * h);
  const Eigen::Vector2d away = -curvature.inverse() * slope;
  EXPECT_LT(away.cwiseAbs().maxCoeff(), 0.03);
  // Student's factor is in the deviations told, 2 % at most
  const Eigen::Vector2d bound = curvature.inverse().diagonal().cwiseSqrt();
  EXPECT_NEAR(bound[0], 0.985, 0.025);
  EXPECT_NEAR(bound[1], 0.985, 0.025);
}

// Binomial bands of 99.9 %: of 95 % of the pairs; and of 5 % that are thought to disagree.
TEST(JointIdentification, HoldsTheTruthInItsIntervalsAsOftenAsItSays) {
  constexpr int pairs = 40;
  int stiffness = 0, damping = 0, disagree = 0;
  for (std::uint64_t seed = 1; seed <= pairs; ++seed) {
    std::vector<IdentifiedRecord> records;
    records.push_back(identified(simulated.record({Quantity::acceleration}, 0.02, 1000 + seed).window(0, 4)));
    records.push_back(identified(simulated.record({Quantity::acceleration}, 0.04, 2000 + seed).window(0, 5)));
    const JointIdentification joint = joint_identification(std::move(records));
    const Identification& i = joint.identification;
    stiffness += std::abs(i.found.stiffness - simulated.truth.stiffness) < 1.959964 * i.stiffness_deviation;
    damping += std::abs(i.found.damping - simulated.truth.damping) < 1.959964 * i.damping_deviation;
    disagree += !joint.estimate.agree();
  }
  const boost::math::binomial inside(pairs, 0.95), outside(pairs, 0.05);
  EXPECT_GE(stiffness, quantile(inside, 0.0005));
  EXPECT_GE(damping, quantile(inside, 0.0005));
  EXPECT_LE(disagree, quantile(outside, 0.9995));
}

TEST(JointIdentification, SaysThatRecordsOfAnotherBeamDisagree) {
  const Record record = simulated.record({Quantity::displacement}, 0.01, 31);
  Record slower = record;
  slower.time *= 1.005;
  const JointIdentification joint = joint_identification({identified(record), identified(slower)});
  EXPECT_FALSE(joint.estimate.agree());
  const Identification &a = joint.records[0].found.identification, &b = joint.records[1].found.identification;
  // wide enough to hold both
  EXPECT_GT(1.959964 * joint.identification.stiffness_deviation,
            0.5 * std::abs(a.found.stiffness - b.found.stiffness));
  const Results results = report(simulated.experiment(), joint);
  EXPECT_FALSE(results.values.at("agreement").at("agree").get<bool>());
  EXPECT_EQ(results.values.at("records").size(), 2u);
}

}  // namespace
}  // namespace beamid::experiments::joint_identification_test
