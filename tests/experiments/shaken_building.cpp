#include "tests/experiments/shaken_building.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <complex>
#include <numbers>

#include "experiments/signal/toolbox.hpp"

namespace beamid::test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

constexpr double rate = 100.0;

Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> modes_of(const Vector3d& k) {
  Eigen::Matrix3d matrix;
  matrix << k[0] + k[1], -k[1], 0.0, -k[1], k[1] + k[2], -k[2], 0.0, -k[2], k[2];
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix);
}

}  // namespace

Vector3d ShakenBuilding::frequency_hz() {
  return modes_of(stiffness()).eigenvalues().cwiseSqrt() / (2.0 * std::numbers::pi);
}

experiments::Record ShakenBuilding::record(Index samples) const {
  MatrixXd rows = MatrixXd::Zero(4, samples);
  const VectorXd amplitude = experiments::standard_normal(300, seed, 1),
                 phase = 7.0 * experiments::standard_normal(300, seed, 2);
  for (const int half : {0, 1}) {
    const auto modes = modes_of(stiffness() * (half == 1 ? 1.0 - softening : 1.0));
    const Index first = half == 0 ? 0 : samples / 2, count = half == 0 ? samples / 2 : samples - samples / 2;
    for (Index i = 0; i < amplitude.size(); ++i) {
      const double omega = 2.0 * std::numbers::pi * (0.5 + 24.0 * (static_cast<double>(i) + 0.37) / 300.0);
      Eigen::Vector3cd response = Eigen::Vector3cd::Ones();
      for (int m = 0; m < 3; ++m) {
        const double w = std::sqrt(modes.eigenvalues()[m]);
        const Vector3d shape = modes.eigenvectors().col(m);
        response += shape * shape.sum() * omega * omega /
                    std::complex<double>(w * w - omega * omega, 2.0 * damping[m] * w * omega);
      }
      for (Index n = first; n < first + count; ++n) {
        const auto turn = std::polar(amplitude[i], omega * static_cast<double>(n) / rate + phase[i]);
        rows(0, n) += turn.real();
        for (int floor = 0; floor < 3; ++floor) rows(floor + 1, n) += (response[floor] * turn).real();
      }
    }
  }
  for (Index row = 1; row < 4; ++row)
    rows.row(row) +=
        noise * experiments::standard_normal(samples, seed + 1, static_cast<std::uint64_t>(row)).transpose();
  experiments::Record record;
  record.time = VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1) / rate);
  record.samples = rows;
  record.channels = {{experiments::Quantity::base_acceleration, "table"}};
  for (int floor = 1; floor <= 3; ++floor)
    record.channels.push_back(
        {experiments::Quantity::acceleration, fmt::format("floor_{}", floor), 3.0 * floor});
  return record;
}

}  // namespace beamid::test
