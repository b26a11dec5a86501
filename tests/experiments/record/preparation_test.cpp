// Steps of a record's preparation against known answers, and their costs against closed forms.
#include "experiments/studies/prepare/preparation_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/config/read_experiment.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/record.hpp"
#include "experiments/rig/virtual_rig.hpp"
#include "experiments/signal/butterworth.hpp"
#include "experiments/signal/integration.hpp"
#include "experiments/signal/interpolation.hpp"
#include "experiments/signal/toolbox.hpp"
#include "fem/beam.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/damped_oscillation.hpp"

namespace beamid::experiments::preparation_test {
namespace {

using Complex = std::complex<double>;
using filters::Options;
using test::complex_rate, testing::HasSubstr;
constexpr double pi = std::numbers::pi;

Choice step(const std::string& name, const Options& options = {}) {
  return {name, step_registry().completed(name, options)};
}

template <class Signal>
Record sampled(Eigen::Index count, double interval, Quantity quantity, Signal signal) {
  Record record;
  record.time = interval * Eigen::VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  record.samples = record.time.unaryExpr(signal).transpose();
  record.channels = {{quantity, "tip"}};
  return record;
}

Record decay(Eigen::Index count, double interval, double frequency_hz, double ratio) {
  const Complex rate = complex_rate(frequency_hz, ratio);
  return sampled(count, interval, Quantity::acceleration,
                 [rate](double t) { return std::exp(rate * t).real(); });
}

double largest(const Eigen::MatrixXd& values) {
  return values.cwiseAbs().maxCoeff();
}

// Oracle: the polynomial that was added.
TEST(Detrend, RemovesAPolynomialOfItsOrderExactly) {
  const auto cubic = [](double t) { return 3 - 2 * t + 0.7 * t * t - 0.05 * t * t * t; };
  const Record record =
      prepare(sampled(2001, 0.005, Quantity::strain, cubic), {step("detrend", {{"order", 3.0}})});
  EXPECT_LT(largest(record.samples), 1e-12);
  ASSERT_EQ(record.remarks.size(), 1u);
  EXPECT_THAT(record.remarks[0], HasSubstr("Polynomial of order 3"));
}

// Oracle: the offset that was added, known from 400 samples of noise to 3 of their standard errors.
TEST(Offset, OfTheQuietPartIsThatBeforeTheHit) {
  Record record = sampled(3000, 1e-3, Quantity::acceleration, [](double t) {
    return 30.2 + (t < 0.4 ? 0.0 : std::exp(-(t - 0.4)) * std::cos(50 * (t - 0.4)) + 0.8);
  });
  record.samples += 0.01 * standard_normal(3000, 3, 0).transpose();
  const Record prepared = prepare(record, {step("offset", {{"of", std::string("quiet")}})});
  EXPECT_NEAR(record.samples(0, 0) - prepared.samples(0, 0), 30.2, 3 * 0.01 / std::sqrt(400));
  const Record interval =
      prepare(record, {step("offset", {{"of", std::string("interval")}, {"from_s", 0.1}, {"to_s", 0.3}})});
  EXPECT_NEAR(interval.samples.leftCols(300).rightCols(200).mean(), 0, 1e-4);
}

// Oracle: the exact integrals of sin and cos; one integral by the trapezoidal rule errs by (w dt)^2 / 12.
TEST(Integration, InFrequencyAndInTimeAgreeWithTheExactIntegral) {
  const double w = 2 * pi * 12, dt = 1e-3;
  const Record wave = sampled(20001, dt, Quantity::acceleration, [w](double t) { return std::sin(w * t); });
  const Eigen::ArrayXd inside = wave.time.segment(8000, 4000);
  const Record frequency = prepare(
      wave, {step("integrate", {{"in", std::string("frequency")}, {"times", 2.0}, {"corner_hz", 3.0}})});
  const Record time = prepare(wave, {step("integrate"), step("integrate"), step("detrend")});
  ASSERT_EQ(frequency.channels[0].quantity, Quantity::displacement);
  ASSERT_EQ(time.channels[0].quantity, Quantity::displacement);
  const Eigen::ArrayXd exact = -(w * inside).sin() / (w * w);
  const double f = largest(frequency.samples.row(0).segment(8000, 4000).transpose().array() - exact);
  const double t = largest(time.samples.row(0).segment(8000, 4000).transpose().array() - exact);
  EXPECT_LT(f * w * w, 2e-4);
  EXPECT_LT(t * w * w, 2 * (w * dt) * (w * dt) / 12 + 3e-3);  // and what drift the line leaves
}

// Oracle: exact derivatives; central differences err by (w dt)^2 / 6.
TEST(Differentiation, InFrequencyIsExactWhereDifferencesAreNot) {
  const double w = 2 * pi * 60, dt = 1e-3;
  const Record wave =
      sampled(4000, dt, Quantity::displacement, [w](double t) { return 1 + t + std::sin(w * t + 0.4); });
  const Eigen::ArrayXd exact = 1 + w * (w * wave.time.array() + 0.4).cos();
  const auto error = [&](const std::string& in) {
    const Record slope = prepare(wave, {step("differentiate", {{"in", in}})});
    return largest((slope.samples.row(0).transpose().array() - exact).segment(500, 3000)) / w;
  };
  EXPECT_LT(error("frequency"), 2e-3);
  EXPECT_NEAR(error("time"), w * dt * w * dt / 6, 0.1 * w * dt * w * dt / 6);
}

// Oracle: what lies above the new half rate would fold to 10 Hz; the tone at 7 Hz stays.
TEST(Decimation, LeavesNoAliasOfAToneAboveItsEdge) {
  const auto tones = [](double t) { return std::sin(2 * pi * 7 * t) + std::sin(2 * pi * 90 * t); };
  const Record record =
      prepare(sampled(6000, 1e-3, Quantity::acceleration, tones), {step("decimate", {{"factor", 10.0}})});
  EXPECT_NEAR(record.interval(), 0.01, 1e-12);
  const Eigen::ArrayXd tone = (2 * pi * 7 * record.time.array()).sin();
  EXPECT_LT(largest(record.samples.row(0).transpose().array() - tone), 3e-3);
}

// Oracle: the cubic itself, on which not-a-knot splines are exact, ends included.
TEST(CubicSpline, ReproducesACubicThroughUnequalNodes) {
  const Eigen::VectorXd x{{0.0, 0.3, 1.0, 1.2, 2.5, 3.0, 4.1}};
  const auto cubic = [](double t) { return 1 - t + 2 * t * t - 0.5 * t * t * t; };
  const CubicSpline spline(x, x.unaryExpr(cubic));
  const Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(83, 0, 4.1);
  EXPECT_LT(largest(spline(at) - at.unaryExpr(cubic).eval()), 1e-12);
  EXPECT_THROW(CubicSpline(x.head(3), x.head(3)), std::invalid_argument);
}

// Oracle: the function that was sampled at jittered stamps.
TEST(Resampling, OfIrregularStampsReturnsTheFunctionAndTellsItsError) {
  Record record = decay(2000, 2e-3, 9, 0.01);
  record.time += 2e-4 * standard_normal(2000, 5, 0);
  record.samples =
      record.time.unaryExpr([](double t) { return std::exp(complex_rate(9, 0.01) * t).real(); }).transpose();
  const Record even = prepare(record, {step("resample")});
  const Record filtered = prepare(record, {step("low_pass", {{"corner_hz", 30.0}})});
  EXPECT_EQ(filtered.samples, prepare(even, {step("low_pass", {{"corner_hz", 30.0}})}).samples);
  EXPECT_THAT(filtered.remarks[0], HasSubstr("The stamps are uneven. Resampled at "));
  EXPECT_NEAR(even.time[1000] - even.time[999], even.time[1] - even.time[0], 1e-12);
  const Eigen::VectorXd exact =
      even.time.unaryExpr([](double t) { return std::exp(complex_rate(9, 0.01) * t).real(); });
  EXPECT_LT(largest(even.samples.row(0).transpose() - exact), 1e-4);
  EXPECT_THAT(even.remarks[0], HasSubstr("Resampled at "));
}

// Oracle: the instants at which the decays were begun.
TEST(Event, CutsTheRecordAfterTheHitThatIsAskedFor) {
  Record record = sampled(6000, 1e-3, Quantity::acceleration, [](double t) {
    const auto hit = [&](double at) {
      return t < at ? 0 : std::exp(-3 * (t - at)) * std::cos(60 * (t - at));
    };
    return hit(1.0) + hit(3.5);
  });
  record.samples += 0.001 * standard_normal(6000, 4, 0).transpose();
  const Record cut =
      prepare(record, {step("event", {{"number", 2.0}, {"delay_s", 0.1}, {"duration_s", 1.0}})});
  EXPECT_NEAR(cut.time[0], 3.6, 1e-9);
  EXPECT_NEAR(cut.time[cut.size() - 1], 4.6, 1e-9);
  EXPECT_THAT(cut.remarks[0], HasSubstr("event 2 of 2"));
  EXPECT_THROW(prepare(record, {step("event", {{"number", 3.0}})}), InputError);
}

struct Case {
  std::string name;
  Options options;
};

class CostOfAStep : public testing::TestWithParam<Case> {};

// Oracle: gain and phase in closed form, H(s), H(s) H(-s), of the rules and kernels; and the pole, which no
// linear step moves where its transients are over.
TEST_P(CostOfAStep, IsItsClosedFormWhereItsTransientsAreOver) {
  const Case& tested = GetParam();
  Record record = decay(20000, 1e-3, 4, 0.01);
  if (tested.name == "differentiate") record.channels[0].quantity = Quantity::displacement;
  const PreparationCost cost = preparation_cost({step(tested.name, tested.options)}, record, 4, 0.01);
  ASSERT_EQ(cost.steps.size(), 1u);
  const StepCost& found = cost.steps[0];
  EXPECT_TRUE(found.exact);
  EXPECT_NEAR(std::abs(found.fitted_factor / found.factor - 1.0), 0, 2e-3);
  EXPECT_NEAR(found.settled.frequency, 0, 2e-5);
  EXPECT_NEAR(found.settled.damping_ratio, 0, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Linear, CostOfAStep,
    testing::Values(Case{"high_pass", {{"corner_hz", 0.5}}}, Case{"low_pass", {{"corner_hz", 10.0}}},
                    Case{"low_pass", {{"corner_hz", 6.0}, {"zero_phase", true}}},
                    Case{"high_pass", {{"corner_hz", 2.0}, {"zero_phase", true}}},
                    Case{"band_pass", {{"lower_hz", 1.0}, {"upper_hz", 20.0}}},
                    Case{"decimate", {{"factor", 20.0}}}, Case{"integrate", {}},
                    Case{"integrate", {{"in", std::string("frequency")}, {"times", 2.0}, {"corner_hz", 1.0}}},
                    Case{"differentiate", {}}, Case{"differentiate", {{"in", std::string("frequency")}}}),
    [](const auto& tested) { return tested.param.name + std::to_string(tested.index); });

// Oracle: the closed forms of signal/, at the complex pole; the delay of a symmetric chain is none.
TEST(Cost, OfZeroPhaseIsTheProductForwardsAndBackwards) {
  const CascadedFilter filter = butterworth_low_pass(4, 6, 1e-3);
  const Complex rate = complex_rate(4, 0.01);
  const auto factor = [&](bool zero_phase) {
    return preparation_cost({step("low_pass", {{"corner_hz", 6.0}, {"zero_phase", zero_phase}})},
                            decay(5000, 1e-3, 4, 0.01), 4, 0.01)
        .steps[0]
        .factor;
  };
  EXPECT_NEAR(std::abs(factor(true) - response(filter, rate) * response(filter, -rate)), 0, 1e-12);
  EXPECT_NEAR(std::abs(factor(false) - response(filter, rate)), 0, 1e-12);
}

// Oracle: process_acceleration(), the chain of the paper, which the steps are to repeat to rounding.
TEST(Preparation, RepeatsTheChainOfThePaperCausalAndZeroPhase) {
  Release rig;
  rig.beam =
      fem::Cantilever{1.10, 2.12e11 * fem::rectangle_second_moment(0.060, 0.006), 3.055 / 1.10, 0.36049};
  rig.modes = 3;
  rig.duration = 20;
  const Record record = measure_acceleration(release(rig), 0.05, 1, 0);
  for (const bool zero_phase : {false, true}) {
    ProcessingSettings settings;
    settings.low_pass_hz = 10;
    settings.zero_phase = zero_phase;
    const ProcessedMotion motion =
        process_acceleration(record.samples.row(0).transpose(), record.interval(), settings);
    const Options high{{"corner_hz", 0.5}, {"zero_phase", zero_phase}, {"start", std::string("rest")}};
    const Options low{{"corner_hz", 10.0}, {"zero_phase", zero_phase}, {"start", std::string("rest")}};
    const Options both{{"times", 2.0}, {"keep", true}, {"start", std::string(zero_phase ? "mean" : "rest")}};
    const std::vector<Choice> steps =
        zero_phase
            ? std::vector<Choice>{step("offset"), step("integrate", both), step("high_pass", high),
                                  step("low_pass", low)}
            : std::vector<Choice>{step("high_pass", high), step("low_pass", low), step("integrate", both)};
    const Record prepared = prepare(record, steps);
    ASSERT_EQ(prepared.samples.rows(), 3);
    // Forwards and backwards twice, or once through both filters: the same away from the ends.
    const Eigen::Index margin = zero_phase ? motion.settled_begin : 0, count = record.size() - 2 * margin;
    const auto error = [&](Eigen::Index row, const Eigen::VectorXd& oracle) {
      const Eigen::VectorXd own = prepared.samples.row(row).transpose();
      return largest((own - oracle).segment(margin, count)) / largest(oracle);
    };
    const double tolerance = zero_phase ? 2e-3 : 1e-9;
    EXPECT_LT(error(0, motion.acceleration), tolerance);
    EXPECT_LT(error(1, motion.velocity), tolerance);
    EXPECT_LT(error(2, motion.displacement), tolerance);
  }
}

// Oracle: docs/theory/preparation.md, whose numbers these are. Without a window the low-pass's own transient
// at the decay's abrupt start costs 9 % of the damping ratio; behind the transients nothing is left of that.
TEST(Cost, OfThePapersChainIsThatOfTheDocument) {
  const Record record = decay(2501, 4e-3, 3.4555, 0.0045);
  const Options high{{"corner_hz", 0.5}, {"start", std::string("rest")}};
  const Options low{{"corner_hz", 8.64}, {"start", std::string("rest")}};
  const Options both{{"times", 2.0}, {"keep", true}, {"start", std::string("rest")}};
  const std::vector<Choice> steps{step("high_pass", high), step("low_pass", low), step("integrate", both)};
  const PreparationCost all = preparation_cost(steps, record, 3.4555, 0.0045);
  const PreparationCost window = preparation_cost(steps, record, 3.4555, 0.0045, {{4.0, 10.0}});
  ASSERT_EQ(all.together.size(), 3u);
  EXPECT_NEAR(100 * all.together[0].whole.damping_ratio, -9.04, 0.01);
  EXPECT_NEAR(100 * all.together[2].whole.damping_ratio, -9.00, 0.01);
  for (const StepCost& channel : window.together) {
    EXPECT_NEAR(100 * channel.whole.frequency, 0, 1e-4) << channel.step;
    EXPECT_NEAR(100 * channel.whole.damping_ratio, 0, 0.01) << channel.step;
    EXPECT_NEAR(std::abs(channel.fitted_factor / channel.factor), 1, 1e-4) << channel.step;
  }
}

const char* const beam = "[beam]\nlength_m = 1\nmass_kg = 1\nbending_stiffness_n_m2 = 1\n";

std::string error_of(const std::string& text) {
  const TemporaryFile file("steps.toml", beam + text);
  return input_error_of(file, [&] { read_experiment(file.path()); });
}

TEST(PreparationTables, AreReadInTheirOrderAndRefusedAtTheirPlace) {
  const TemporaryFile file("steps.toml", std::string(beam) +
                                             "[[record.prepare]]\nstep = \"offset\"\n"
                                             "[[record.prepare]]\nstep = \"low_pass\"\ncorner_hz = 20\n");
  const RecordFormat format = read_experiment(file.path()).format;
  ASSERT_EQ(format.preparation.size(), 2u);
  EXPECT_EQ(format.preparation[1].name, "low_pass");
  EXPECT_EQ(format.preparation[1].options.number("corner_hz"), 20);
  EXPECT_EQ(format.preparation[1].options.number("order"), 4);
  EXPECT_THAT(error_of("[[record.prepare]]\nstep = \"lowpass\"\n"),
              HasSubstr("steps.toml:6:8: unknown preparation step 'lowpass'; known: band_pass, "));
  EXPECT_THAT(error_of("[[record.prepare]]\nstep = \"low_pass\"\n"),
              HasSubstr("steps.toml:6:8: step 'low_pass': corner_hz is missing"));
  EXPECT_THAT(error_of("[[record.prepare]]\nstep = \"low_pass\"\ncorner_hz = 20\norder = 2.5\n"),
              HasSubstr("steps.toml:8:1: order is 2.5; expected a whole number from 1 to 8"));
}

// Oracle: the window counts from the times behind the steps; a record without steps is read as ever.
TEST(PreparedRecord, IsCutToItsWindowBehindTheSteps) {
  const TemporaryFile file("decay.csv", to_csv(decay(4000, 1e-3, 5, 0.01)));
  RecordFormat format;
  format.preparation = {step("decimate", {{"factor", 4.0}})};
  format.window = {1.0, 2.0};
  const Record record = prepared_record(file.path(), format);
  EXPECT_NEAR(record.time[0], 1.0, 1e-9);
  EXPECT_EQ(record.size(), 251);
  EXPECT_EQ(record.remarks.size(), 1u);
  format.window = {0.0, 2.0};  // the decimation took the first 20 ms
  EXPECT_THROW(prepared_record(file.path(), format), InputError);
}

}  // namespace
}  // namespace beamid::experiments::preparation_test
