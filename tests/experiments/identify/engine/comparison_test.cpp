// Oracles: the beam that the record was simulated from, Rayleigh's tabulated frequency errors, the closed
// form of the discretisation's bias, and the Cramer-Rao bound.
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/studies/compare/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "fem/response/response.hpp"

namespace beamid::experiments::comparison_test {
namespace {

const Progress silent = [](const std::string&) {};

// S(11.8), released, an accelerometer on its tip; 8 s keep the test short.
Experiment released(const std::vector<std::string>& reductions, const std::string& more = "") {
  Experiment e = read_experiment(TomlTable::parse(
      "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = "
      "3.055\n"
      "tip_mass_kg = 0.36049\nelements = 40\n[damping]\nratios = [0.0045, 0.005]\n"
      "[simulation]\nduration_s = 8\nseed = 11\n[[sensors]]\nnoise_m_per_s2 = 0.05\n"
      "[model]\nname = \"beam\"\n"
      "[[parameters]]\nquantity = \"bending_stiffness\"\nguess_n_m2 = 200\nrelative_deviation = 0.3\n"
      "[[parameters]]\nquantity = \"damping_ratio\"\nmode = 1\nguess = 0.01\ndeviation = 0.01\n" +
          more,
      "test.toml"));
  for (const std::string& text : reductions) e.reductions.push_back(parse_reduction(text, "test"));
  if (e.filters.empty()) e.filters = {e.filter};
  if (e.discretisations.empty()) e.discretisations = {e.discretisation};
  return e;
}

Comparison compared(const Experiment& e) {
  return compare(e, simulated_record(e, {}, silent), {}, silent);
}

TEST(Comparison, FindsTheBeamOnTheModelThatHasItsModes) {
  const Comparison found = compared(released({"modal_truncation:modes=7"}));
  const ComparedRun& run = found.runs[0];
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  for (const ComparedParameter& p : run.parameters) {
    EXPECT_LT(std::abs(p.estimate.value - *p.truth), 4.0 * p.estimate.deviation) << p.estimate.name;
    EXPECT_NEAR(*p.bound_ratio(), 1.0, 0.02) << p.estimate.name;
  }
  EXPECT_LT(std::abs(*run.parameters[0].error_percent()), 0.005);
  EXPECT_NEAR(run.noise[0], 0.05, 0.005);
}

// The same beam under a smooth blow of 40 ms at its middle, which is measured; moved in steps of 1/8 ms,
// sampled every ms.
ComparedRecord struck(const Experiment& e) {
  constexpr int steps = 8;
  constexpr double interval = 1e-3;
  const fem::StructuralSystem system =
      fem::assemble(e.structure, e.elements, {{"middle", 0.55}, {"tip", 1.1}});
  const Eigen::Index samples = 1001;
  fem::Loading loading{{}, {}, Eigen::MatrixXd::Zero(system.inputs.cols(), (samples - 1) * steps + 1)};
  for (Eigen::Index k = 0; k < 40 * steps; ++k)
    loading.inputs(0, k + 100 * steps) =
        20.0 * std::pow(std::sin(std::numbers::pi * static_cast<double>(k) / (40.0 * steps)), 4);
  const fem::Response response =
      fem::respond(system, e.damping, loading, {interval / steps, loading.inputs.cols()});
  ComparedRecord record;
  record.name = "struck";
  record.record.time = Eigen::VectorXd::LinSpaced(samples, 0.0, interval * static_cast<double>(samples - 1));
  record.record.samples.resize(2, samples);
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.005);
  for (Eigen::Index k = 0; k < samples; ++k)
    record.record.samples.col(k) << response.acceleration(1, k * steps) + noise(random),
        loading.inputs(0, k * steps);
  record.record.channels = {{Quantity::acceleration, "tip"}, {Quantity::force, "hammer", 0.55}};
  record.sensor_noise = Eigen::VectorXd::Zero(1);
  record.truth = e;
  return record;
}

TEST(Comparison, FindsTheBeamUnderAMeasuredForceOnTheWholeMeshToo) {
  // Held, the force left 49 to 90 % of the response on the mesh, and a stiffness 7 to 58 deviations off.
  Experiment e = released({"none", "modal_truncation:modes=7"});
  e.elements = 16;
  e.passes = 2;
  ComparedRecord record = struck(e);
  const Comparison found = compare(e, record, {}, silent);
  for (const ComparedRun& run : found.runs) {
    ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reduction << ": " << run.reason;
    EXPECT_LT(std::abs(run.parameters[0].estimate.value - *run.parameters[0].truth),
              4.0 * run.parameters[0].estimate.deviation)
        << run.reduction;
  }
  EXPECT_LT(found.runs[0].response_error_percent, 1.1 * found.runs[1].response_error_percent);

  record.record.input_path = InputPath::held;
  e.reductions.pop_back();
  EXPECT_THAT(
      [&] { compare(e, record, {}, silent); },
      testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("expected input = \"band_limited\"")));
}

TEST(Comparison, ShowsRayleighsMassErrorAsAStiffnessError) {
  // The static shape is 0.65267 % too fast on S(11.8): E I comes out (1.0065267)^-2.
  const Comparison found = compared(released({"rayleigh", "modal_truncation"}));
  EXPECT_NEAR(*found.runs[0].parameters[0].error_percent(), 100.0 * (std::pow(1.0065267, -2) - 1.0), 0.02);
  EXPECT_NEAR(*found.runs[1].parameters[0].error_percent(), 0.0, 0.02);
  EXPECT_THAT(words(found), testing::Contains(testing::HasSubstr("bending_stiffness of rayleigh")));
}

TEST(Comparison, ShowsTheBiasOfForwardEuler) {
  const Comparison found =
      compared(released({"modal_truncation"}, "[compare]\ndiscretisations = [\"forward_euler\"]\n"));
  const ComparedRun& run = found.runs[0];
  const double omega = 2.0 * 3.14159265358979 * 3.455527194845, xi = 0.0045, dt = 1e-3;
  // C_f / C - 1 = omega dt (1 - 2 xi^2) / (2 xi), to first order.
  const double expected = 100.0 * omega * dt * (1.0 - 2.0 * xi * xi) / (2.0 * xi);
  EXPECT_NEAR(*run.parameters[1].error_percent() / expected, 1.0, 0.02);
}

TEST(Comparison, AgreesAcrossFilters) {
  const Comparison found =
      compared(released({"modal_truncation:modes=4"},
                        "[[filters]]\nmethod = \"ekf\"\n[[filters]]\nmethod = \"low_rank_ekf\"\n"));
  const auto& dense = found.runs[0].parameters;
  const auto& thin = found.runs[1].parameters;
  for (std::size_t j = 0; j < dense.size(); ++j) {
    EXPECT_NEAR(thin[j].estimate.value, dense[j].estimate.value, 1e-6 * dense[j].estimate.deviation);
    EXPECT_NEAR(thin[j].estimate.deviation / dense[j].estimate.deviation, 1.0, 1e-6);
  }
}

TEST(Comparison, TakesTheWholeMeshInItsOwnForm) {
  // Oracle: seven modes of the record are all there is of it; the mesh, damped and started in five, and its
  // modes agree on the stiffness. The step's own bias (w dt)^4 / 360 is 1e-9 in mode 1.
  Experiment asked = released({"none", "modal_truncation:modes=5"}, "[compare]\npasses = 1\n");
  asked.model.options.set("coordinates", std::string("mesh"));
  asked.model.options.set("modes", 5.0);
  const Comparison found = compared(asked);
  const ComparedRun& mesh = found.runs[0];
  EXPECT_EQ(mesh.filter + " " + mesh.discretisation, "low_rank_ekf pade");
  ASSERT_EQ(mesh.status, ComparedRun::Status::converged) << mesh.reason;
  EXPECT_EQ(mesh.coordinates, 80);
  EXPECT_NEAR(mesh.parameters[0].estimate.value / found.runs[1].parameters[0].estimate.value, 1.0, 1e-4);
  EXPECT_EQ(reference_run(found), &mesh);
}

TEST(Comparison, TakesTheWholeMeshInItsOwnModes) {
  // Oracle: the reduction to the same modes, which are exact as long as their shapes stay.
  const Comparison found = compared(released({"none", "modal_truncation:modes=8"}));
  const ComparedRun& mesh = found.runs[0];
  EXPECT_EQ(mesh.filter + " " + mesh.discretisation, "low_rank_ekf exponential");
  ASSERT_EQ(mesh.status, ComparedRun::Status::converged) << mesh.reason;
  EXPECT_EQ(mesh.coordinates, 8);
  EXPECT_NEAR(mesh.parameters[0].estimate.value / found.runs[1].parameters[0].estimate.value, 1.0, 1e-7);
}

TEST(Comparison, KeepsWhatCannotBeMadeAsARefusal) {
  Experiment e = released({"modal_truncation:modes=3", "rayleigh"});
  e.model = {"sdof", {}};
  e.parameters.clear();
  const Comparison found = compared(e);
  EXPECT_EQ(found.runs[0].status, ComparedRun::Status::refused);
  EXPECT_THAT(found.runs[0].reason, testing::HasSubstr("needs a reduction to one coordinate"));
  EXPECT_EQ(found.runs[1].status, ComparedRun::Status::converged) << found.runs[1].reason;
  // K and C against the model's own mass: Rayleigh's mass error is not counted.
  EXPECT_LT(std::abs(*found.runs[1].parameters[0].error_percent()), 0.02);
}

TEST(Comparison, RefusesARecordOfForcesOnly) {
  const Experiment e = released({"rayleigh"});
  ComparedRecord forces;
  forces.record = {Eigen::VectorXd::LinSpaced(100, 0.0, 0.1),
                   Eigen::MatrixXd::Ones(1, 100),
                   {{Quantity::force, "f"}},
                   0.0,
                   {}};
  EXPECT_THROW(compare(e, forces, {}, silent), std::invalid_argument);
}

TEST(Report, HasTheKeysOfARun) {
  const Experiment e = released({"modal_truncation"});
  const nlohmann::ordered_json json = to_json(report(e, compared(e)));
  const auto& run = json["runs"][0];
  EXPECT_EQ(run["reduction"], "modal_truncation");
  EXPECT_EQ(run["status"], "converged");
  for (const char* key : {"estimate", "standard_deviation", "error_percent", "bound_ratio"})
    EXPECT_TRUE(run["parameters"]["bending_stiffness"][key].is_number()) << key;
  EXPECT_TRUE(run["response_error_percent"].is_number());
}

}  // namespace
}  // namespace beamid::experiments::comparison_test
