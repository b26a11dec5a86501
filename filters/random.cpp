#include "filters/random.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/QR>

#include "filters/batch_avx2.hpp"
#include "filters/normal_avx2.hpp"

namespace beamid::filters {

Eigen::VectorXd normal_noise(Eigen::Index count, std::uint64_t seed, std::uint64_t stream) {
  static const bool avx2 = algorithms::normal_compiled_for_avx2() && algorithms::processor_has_avx2();
  if (!avx2) return RandomStream(seed, stream).normal(count, 1);
  Eigen::VectorXd numbers(count + count % 2);
  algorithms::normal_avx2(numbers.data(), numbers.size(), seed, stream);
  return numbers.head(count);
}

namespace {

double fraction(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (static_cast<std::uint64_t>(high) << 32 | low) >> 11;
  return (static_cast<double>(bits) + 0.5) * 0x1p-53;
}

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t first = 0xD2511F53ull * counter[0], second = 0xCD9E8D57ull * counter[2];
    counter = {
        static_cast<std::uint32_t>(second >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
        static_cast<std::uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

std::array<std::uint32_t, 4> RandomStream::words() {
  const std::uint64_t here = counter_++;
  return philox({static_cast<std::uint32_t>(here), static_cast<std::uint32_t>(here >> 32),
                 static_cast<std::uint32_t>(stream_), static_cast<std::uint32_t>(stream_ >> 32)},
                {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)});
}

double RandomStream::uniform() {
  const auto drawn = words();
  return fraction(drawn[0], drawn[1]);
}

Eigen::MatrixXd RandomStream::normal(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd numbers(rows, columns);
  for (Eigen::Index i = 0; i < numbers.size(); i += 2) {
    const auto drawn = words();
    const double radius = std::sqrt(-2.0 * std::log(fraction(drawn[0], drawn[1])));
    const double angle = 2.0 * std::numbers::pi * fraction(drawn[2], drawn[3]);
    numbers.data()[i] = radius * std::cos(angle);
    if (i + 1 < numbers.size()) numbers.data()[i + 1] = radius * std::sin(angle);
  }
  return numbers;
}

using Eigen::Index, Eigen::MatrixXd;

Draws exact_draws(RandomStream& random, Index rows, Index count, const MatrixXd& others) {
  Draws draws{random.normal(rows, count), false};
  if (count < rows + others.rows() + 1) {
    const Eigen::VectorXd mean = draws.values.rowwise().mean();
    draws.values.colwise() -= mean;
    return draws;
  }
  // Columns 1, others^T, draws^T: the last of an orthonormal basis are the draws, freed of all before them.
  MatrixXd all(count, 1 + others.rows() + rows);
  all << Eigen::VectorXd::Ones(count), others.transpose(), draws.values.transpose();
  for (Index j = 0; j < all.cols(); ++j)
    if (const double norm = all.col(j).norm(); norm > 0.0) all.col(j) /= norm;
  const Eigen::HouseholderQR<MatrixXd> qr(all);
  MatrixXd basis = MatrixXd::Zero(count, rows);
  basis.bottomRows(count - all.cols() + rows).topRows(rows).setIdentity();
  basis.applyOnTheLeft(qr.householderQ());
  // The sign of each is that of the draw, so that nothing but its length and correlations changes.
  for (Index j = 0; j < rows; ++j)
    if (basis.col(j).dot(draws.values.row(j)) < 0.0) basis.col(j) = -basis.col(j);
  draws.values = std::sqrt(static_cast<double>(count - 1)) * basis.transpose();
  draws.exact = true;
  return draws;
}

}  // namespace beamid::filters
