// A record as lines of its spectrum.
#include "experiments/identify/parts/line_likelihood.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace beamid::experiments::record_lines_test {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;
using Complex = std::complex<double>;

filters::Measurements record_of(const MatrixXd& outputs, double interval) {
  filters::Measurements record;
  record.time = interval * VectorXd::LinSpaced(outputs.cols(), 0.0, static_cast<double>(outputs.cols() - 1));
  record.outputs = outputs;
  return record;
}

TEST(RecordLines, AreSumsOverTheSamples) {
  // Oracle: the sum itself, of 250 samples: the last of 251, a prime, is left out.
  const MatrixXd outputs = MatrixXd::Random(2, 251), inputs = MatrixXd::Random(1, 251);
  const RecordLines lines = record_lines(record_of(outputs, 0.01), inputs, 30.0);
  ASSERT_EQ(lines.samples, 250);
  ASSERT_EQ(lines.omega.size(), 75);
  for (const Index k : {Index{1}, Index{40}, Index{75}}) {
    const double omega = 2.0 * std::numbers::pi * static_cast<double>(k) / 2.5;
    EXPECT_NEAR(lines.omega[k - 1], omega, 1e-12 * omega);
    Eigen::Vector3cd sum = Eigen::Vector3cd::Zero();
    for (Index t = 0; t < 250; ++t)
      sum += Eigen::Vector3d(outputs(0, t), outputs(1, t), inputs(0, t)) *
             std::exp(Complex(0.0, -omega * 0.01 * static_cast<double>(t))) / std::sqrt(250.0);
    EXPECT_LT((lines.outputs.col(k - 1) - sum.head(2)).norm(), 1e-12);
    EXPECT_LT(std::abs(lines.inputs(0, k - 1) - sum[2]), 1e-12);
  }
}

TEST(RecordLines, OfFreeMotionAreThoseOfItsSamples) {
  // Oracle: the lines of the sampled decay Re and Im h e^(lambda t), in proportion.
  SupportedResponse::FreeMotion motion;
  motion.poles.resize(1);
  motion.poles[0] = {-1.5, 47.0};
  motion.shapes.resize(2, 1);
  motion.shapes << Complex(1.0, 0.3), Complex(-0.4, 2.0);
  MatrixXd samples(4, 200);
  for (Index t = 0; t < 200; ++t) {
    const Eigen::Vector2cd there =
        motion.shapes.col(0) * std::exp(motion.poles[0] * 0.01 * static_cast<double>(t));
    samples.col(t) << there.real(), there.imag();
  }
  const RecordLines lines = record_lines(record_of(samples, 0.01), MatrixXd(0, 200), 40.0);
  const MatrixXcd found = free_lines(motion, lines);
  ASSERT_EQ(found.cols(), 2);
  const MatrixXcd real = lines.outputs.topRows(2), imaginary = lines.outputs.bottomRows(2);
  EXPECT_NEAR(std::abs(found.col(0).dot(real.reshaped())) / real.norm(), 1.0, 1e-9);
  EXPECT_NEAR(std::abs(found.col(1).dot(imaginary.reshaped())) / imaginary.norm(), 1.0, 1e-9);
}

TEST(RecordLines, RefuseWhatHasNone) {
  MatrixXd outputs = MatrixXd::Random(1, 100);
  filters::Measurements record = record_of(outputs, 0.01);
  EXPECT_THROW(record_lines(record, MatrixXd(0, 100), 50.0), std::invalid_argument);  // half the rate
  EXPECT_THROW(record_lines(record, MatrixXd(0, 100), 5.0), std::invalid_argument);   // five lines
  record.time[50] += 0.003;
  EXPECT_THROW(record_lines(record, MatrixXd(0, 100), 30.0), std::invalid_argument);
  outputs(0, 7) = std::nan("");
  EXPECT_THROW(record_lines(record_of(outputs, 0.01), MatrixXd(0, 100), 30.0), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::record_lines_test
