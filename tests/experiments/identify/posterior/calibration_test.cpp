// Simulation-based calibration [talts2018]: parameters drawn from the prior, modes made from them, ranks
// among the posterior's draws uniform. Two storeys, each of whose posteriors may have a twin at (3 k2, k1 /
// 3).
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdlib>

#include "tests/experiments/identify/posterior/posterior_cases.hpp"

namespace beamid::experiments::calibration_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t rank_draws = 199, thinning = 2;

struct CalibrationRun {
  std::size_t rank[2] = {},
              depth = 0;  // draws below the truth in each parameter; draws less likely than the truth
  std::size_t humps = 0;
};

CalibrationRun calibration_run(const Experiment& chain, std::uint64_t seed) {
  const ModalCase described =
      modal_case(chain, measured_frequencies(two_storey_frequencies(958.61, 958.61), 0.03));
  filters::RandomStream random(seed, 7);
  const VectorXd truth = random.normal(2, 1), noise = random.normal(2, 1);
  const VectorXd k = described.likelihood->physical(truth);
  std::vector<double> f = two_storey_frequencies(k[0], k[1]);
  ModalData data = measured_frequencies(two_storey_frequencies(958.61, 958.61), 0.03);
  for (std::size_t i = 0; i < 2; ++i)
    data.modes[i].frequency_hz = f[i] + data.modes[i].deviation_hz * noise[static_cast<Index>(i)];
  const ModalCase measured = modal_case(chain, data);
  PosteriorSettings settings;
  settings.seed = seed;
  settings.particles = 200;
  settings.importance_draws = 1000;
  settings.chains = {1, rank_draws * thinning, 60};
  const Posterior found = sample_posterior(*measured.likelihood, MatrixXd(2, 0), settings);
  const double at_truth = posterior_log(measured.likelihood->at(truth, false), truth);
  CalibrationRun run;
  run.humps = found.humps.size();
  const PosteriorChain& drawn = found.chains.front();
  for (std::size_t i = 0; i < rank_draws; ++i) {
    const auto column = static_cast<Index>(i * thinning);
    for (Index j = 0; j < 2; ++j) run.rank[j] += drawn.draws(j, column) < truth[j] ? 1 : 0;
    run.depth += drawn.log_posterior[column] < at_truth ? 1 : 0;
  }
  return run;
}

/// p of chi^2 of ten equal bins.
double uniformity(const std::vector<CalibrationRun>& runs, std::size_t count, int parameter) {
  double bins[10] = {};
  for (std::size_t i = 0; i < count; ++i) bins[runs[i].rank[parameter] * 10 / (rank_draws + 1)] += 1.0;
  double chi_square = 0.0;
  const double expected = static_cast<double>(count) / 10.0;
  for (const double bin : bins) chi_square += (bin - expected) * (bin - expected) / expected;
  return cdf(complement(boost::math::chi_squared(9), chi_square));
}

// With BEAMID_LONG_POSTERIOR 1,000 runs for the ranks and 2,000 for the regions of highest density.
TEST(PosteriorCalibration, RanksAreUniformAndRegionsHoldTheTruthAsOftenAsTheySay) {
  const bool all = std::getenv("BEAMID_LONG_POSTERIOR") != nullptr;
  const std::size_t runs = all ? 2000 : 60;
  const Experiment chain = two_storeys("form = \"logarithmic\"\nrelative_deviation = 0.5\n");
  std::vector<CalibrationRun> found(runs);
  tbb::parallel_for(std::size_t{0}, runs,
                    [&](std::size_t i) { found[i] = calibration_run(chain, 1000 + i); });
  double covered = 0.0, with_twin = 0.0;
  for (const CalibrationRun& run : found) {
    covered += run.depth >= (rank_draws + 1) / 20 ? 1.0 / static_cast<double>(runs) : 0.0;
    with_twin += run.humps > 1 ? 1.0 / static_cast<double>(runs) : 0.0;
  }
  const double p[] = {uniformity(found, std::min<std::size_t>(runs, 1000), 0),
                      uniformity(found, std::min<std::size_t>(runs, 1000), 1)};
  EXPECT_GT(p[0], 0.01);
  EXPECT_GT(p[1], 0.01);
  EXPECT_GT(with_twin, 0.3);
  const double deviation = std::sqrt(0.95 * 0.05 / static_cast<double>(runs));
  EXPECT_NEAR(covered, 0.95, all ? 0.015 : 3.0 * deviation);
  RecordProperty("p_1", std::to_string(p[0]));
  RecordProperty("p_2", std::to_string(p[1]));
  RecordProperty("covered", std::to_string(covered));
  if (all)
    std::printf("p %.3f %.3f, covered %.4f, with a twin %.3f of %zu runs\n", p[0], p[1], covered, with_twin,
                runs);
}

}  // namespace
}  // namespace beamid::experiments::calibration_test
