// What a measured force does between its samples, and what a fit makes of it. Oracle: the closed form of an
// oscillator under forces that are sums of sinusoids, continuous in time.
#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <random>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/oscillator.hpp"
#include "filters/batch_estimator.hpp"

namespace beamid::experiments::measured_force_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double frequency = 3.45, mass = 3.0;  // [Hz], [kg]

struct Truth {
  double stiffness, damping;
  explicit Truth(double ratio)
      : stiffness(mass * std::pow(2.0 * pi * frequency, 2)),
        damping(2.0 * ratio * std::sqrt(mass * stiffness)) {}
};

// Lines of one force [Hz], of equal size and any phase.
std::vector<double> lines(double from, double to, double step) {
  std::vector<double> found;
  for (double f = from; f <= to; f += step) found.push_back(f);
  return found;
}

// The steady motion under the lines: displacement, force.
Record record(const Truth& truth, const std::vector<double>& lines, double samples_per_period,
              double periods) {
  Record made;
  const double dt = 1.0 / (frequency * samples_per_period);
  const auto n = static_cast<Index>(samples_per_period * periods) + 1;
  made.time = VectorXd::LinSpaced(n, 0.0, dt * static_cast<double>(n - 1));
  made.samples.setZero(2, n);
  made.channels = {{Quantity::displacement, "x"}, {Quantity::force, "f"}};
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * pi);
  for (const double line : lines) {
    const double omega = 2.0 * pi * line;
    const Complex size = std::polar(1.0, phase(random)),
                  moved = size / Complex(truth.stiffness - mass * omega * omega, truth.damping * omega);
    for (Index k = 0; k < n; ++k) {
      const Complex turn = std::polar(1.0, omega * made.time[k]);
      made.samples(0, k) += (moved * turn).real();
      made.samples(1, k) += (size * turn).real();
    }
  }
  return made;
}

struct Found {
  double stiffness, damping, mass;
  double residual;  // rms, over that of the response

  double frequency_error() const { return std::sqrt(stiffness / mass) / (2.0 * pi * frequency) - 1.0; }
  double ratio() const { return damping / (2.0 * std::sqrt(stiffness * mass)); }
};

// Maximum likelihood of the start, K, C and, where asked for, M.
Found fit(const Truth& truth, Record given, std::optional<InputPath> path, bool mass_unknown = true) {
  given.input_path = path;
  ModelSetting setting;
  setting.system = one_coordinate({mass, truth.stiffness, truth.damping});
  setting.observations = {{Quantity::displacement, "x"}};
  setting.forces = {0};
  const auto model = model_registry().make("sdof", {{"sensor_bias", false}}, setting);
  const double size = given.samples.row(0).cwiseAbs().maxCoeff();
  const auto discrete = filters::discretise(model->motion, given.interval(), "exponential",
                                            {{}, MatrixXd::Constant(1, 1, 1e-6 * size * size)});
  VectorXd state(5), scale(5);
  state << 0.0, 0.0, truth.stiffness, truth.damping, mass;
  scale << size, size * 2.0 * pi * frequency, truth.stiffness, truth.damping, mass;
  const MatrixXd directions = MatrixXd(scale.asDiagonal()).leftCols(mass_unknown ? 5 : 4);
  const filters::BatchEstimate found = estimate_batch(*discrete, state, directions, measurements(given));
  // Beside a large residual the last steps are rounding: stalled.
  EXPECT_TRUE(found.status == filters::BatchStatus::converged ||
              (path == InputPath::held && found.status == filters::BatchStatus::stalled))
      << found.reason;
  return {found.state[2], found.state[3], found.state[4],
          found.residuals.norm() / given.samples.row(0).norm()};
}

TEST(MeasuredForce, StraightBetweenSamplesGivesFrequencyAndRatio) {
  // Oracle: the truth; targets of 0.001 % and 0.05 % at 29 samples per period.
  const Truth truth(0.02);
  const Found found = fit(truth, record(truth, lines(0.8, 6.0, 0.037), 29, 60), InputPath::linear);
  EXPECT_LT(std::abs(found.frequency_error()), 1e-5);
  EXPECT_NEAR(found.ratio() / 0.02, 1.0, 5e-4);
  EXPECT_LT(found.residual, 1e-3);
}

TEST(MeasuredForce, BandLimitedGivesStiffnessDampingAndMassAtTenSamplesPerPeriod) {
  // Oracle: the truth, 0.05 % of each; that path is the one of a record that says nothing.
  for (const double ratio : {0.002, 0.02, 0.1}) {
    const Truth truth(ratio);
    const Found found = fit(truth, record(truth, lines(0.8, 6.0, 0.037), 10, 60), {});
    EXPECT_NEAR(found.stiffness / truth.stiffness, 1.0, 5e-4) << ratio;
    EXPECT_NEAR(found.damping / truth.damping, 1.0, 5e-4) << ratio;
    EXPECT_NEAR(found.mass / mass, 1.0, 5e-4) << ratio;
  }
}

TEST(MeasuredForce, LeavesTheNoiseAndNothingElse) {
  // Oracle: the noise added, 0.2 % of the largest reading; held, the residual is many times that.
  const Truth truth(0.01);
  Record given = record(truth, lines(0.8, 6.0, 0.037), 10, 500);
  const double noise = 0.002 * given.samples.row(0).cwiseAbs().maxCoeff();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, noise);
  for (Index k = 0; k < given.size(); ++k) given.samples(0, k) += normal(random);
  const double root = given.samples.row(0).norm() / std::sqrt(static_cast<double>(given.size()));
  EXPECT_NEAR(fit(truth, given, {}).residual * root / noise, 1.0, 0.02);
  EXPECT_GT(fit(truth, given, InputPath::held).residual * root / noise, 10.0);
}

TEST(MeasuredForce, HeldAndStraightErrByTheirClosedFormsUnderOneLine) {
  // Oracle: docs/theory/discretisation_bias.md, K' - M w^2 + i C' w = i C w P, p = pi f dt.
  for (const double samples : {10.0, 14.0, 29.0}) {
    const double ratio = 0.01, p = pi / samples, sinc = std::sin(p) / p;
    const Truth truth(ratio);
    const Record given = record(truth, {frequency}, samples, 40);
    const Found held = fit(truth, given, InputPath::held, false);
    const double bias = held.stiffness / truth.stiffness - 1.0, change = held.damping / truth.damping;
    EXPECT_NEAR(bias / (2.0 * ratio * sinc * std::sin(p)), 1.0, 1e-3) << samples;
    EXPECT_NEAR(change, sinc * std::cos(p), 1e-4) << samples;
    EXPECT_NEAR(bias / (2.0 * ratio * change * std::tan(p)), 1.0, 1e-3) << samples;
    const Found straight = fit(truth, given, InputPath::linear, false);
    EXPECT_NEAR(straight.stiffness / truth.stiffness, 1.0, 1e-6) << samples;
    EXPECT_NEAR(straight.damping / truth.damping, sinc * sinc, 1e-4) << samples;
  }
}

TEST(MeasuredForce, HeldAndStraightErrByTheirClosedFormsUnderAWhiteForce) {
  // Oracle: likewise, the best oscillator under a force of all frequencies. Here they are those from 0.5
  // to 1.5 f.
  const double ratio = 0.005;
  const Truth truth(ratio);
  const std::vector<double> white = lines(0.5 * frequency, 1.5 * frequency, frequency / 600.0);
  for (const double samples : {10.0, 16.0}) {
    const double p = pi / samples, sinc = std::sin(p) / p, t = std::tan(0.5 * p);
    const Record given = record(truth, white, samples, 600);
    const Found held = fit(truth, given, InputPath::held);
    EXPECT_NEAR(held.frequency_error() / (2.0 * ratio * t), 1.0, 0.03) << samples;
    EXPECT_NEAR(held.mass / mass, t / (0.5 * p), 0.004) << samples;
    EXPECT_NEAR(held.residual / std::sqrt(1.0 - std::pow(std::cos(0.5 * p), 4)), 1.0, 0.015) << samples;
    const Found straight = fit(truth, given, InputPath::linear);
    EXPECT_NEAR(straight.mass / mass, sinc * sinc, 5e-4) << samples;
    EXPECT_NEAR(straight.stiffness / truth.stiffness, sinc * sinc, 5e-4) << samples;
    EXPECT_LT(std::abs(straight.frequency_error()), 1e-4) << samples;
  }
}

TEST(RecordInputs, AreBandLimitedWhereStampsAreEven) {
  Record given = record(Truth(0.01), {frequency}, 20, 10);
  EXPECT_EQ(record_inputs(given)->path, InputPath::band_limited);
  EXPECT_EQ(measurements(given).inputs.rows(), 5);
  for (Index k = 1; k < given.size(); k += 2) given.time[k] += 0.2 * given.interval();
  EXPECT_EQ(record_inputs(given)->path, InputPath::linear);
  EXPECT_EQ(measurements(given).inputs.rows(), 2);
  given.input_path = InputPath::band_limited;
  EXPECT_THROW(measurements(given), std::invalid_argument);
  given.input_path = InputPath::held;
  EXPECT_EQ(measurements(given).inputs, given.samples.bottomRows(1));
}

TEST(RecordInputs, AreStraightAcrossAGapAndSaySo) {
  Record given = record(Truth(0.01), {frequency}, 20, 10);
  given.time.tail(50).array() += 0.5;
  const auto inputs = record_inputs(given);
  EXPECT_EQ(inputs->path, InputPath::band_limited);
  EXPECT_EQ(inputs->straight, 1);
  EXPECT_NE(words(*inputs).find("straight over 1 of 200 intervals"), std::string::npos) << words(*inputs);
}

TEST(RecordInputs, AreThoseOfEveryPartOfTheRecord) {
  Record given = record(Truth(0.01), {frequency}, 20, 10);
  given.input_path = InputPath::held;
  given.objections = {{"clipped", "clipped"}};
  const Record part = given.window(0.5, 2.0);
  EXPECT_EQ(part.input_path, InputPath::held);
  EXPECT_EQ(texts(part.objections), texts(given.objections));
  const ComparedRecord chosen = chosen_channels({"", given, {}, {}, {}}, {"x"});
  EXPECT_EQ(chosen.record.input_path, InputPath::held);
  EXPECT_EQ(texts(chosen.record.objections), texts(given.objections));
}

TEST(RecordInputs, MustAllBeThere) {
  Record given = record(Truth(0.01), {frequency}, 20, 10);
  given.samples(1, 7) = std::nan("");
  EXPECT_THROW(measurements(given), std::invalid_argument);
}

TEST(RecordInputs, OfFreeMotionAreNone) {
  Record given = record(Truth(0.01), {frequency}, 20, 10);
  given.channels[1].quantity = Quantity::velocity;
  EXPECT_FALSE(record_inputs(given));
  EXPECT_EQ(measurements(given).inputs.size(), 0);
}

}  // namespace
}  // namespace beamid::experiments::measured_force_test
