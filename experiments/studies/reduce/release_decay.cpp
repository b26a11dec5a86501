#include "experiments/studies/reduce/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/results/results.hpp"
#include "fem/response/response.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

// The study's 1 kHz has 241 samples in a period of S(0.65). A rate that tells nothing of the first mode, or
// makes its ten periods a million samples long, gives way to one that suits it as well.
double sampling_rate(double wanted_hz, double first_hz, std::vector<std::string>& notes) {
  constexpr double fewest = 20.0, most = 20000.0, as_in_the_study = 250.0;  // samples a period
  if (wanted_hz >= fewest * first_hz && wanted_hz <= most * first_hz) return wanted_hz;
  notes.push_back(fmt::format(
      "Decays are compared as sampled at {:.4g} Hz: {:g} Hz do not suit a first mode of {:.4g} Hz.",
      as_in_the_study * first_hz, wanted_hz, first_hz));
  return as_in_the_study * first_hz;
}

}  // namespace

VectorXd ReleaseTest::time() const {
  return VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1) / sampling_rate_hz);
}

ReleaseTest plan_release(const Experiment& experiment, const fem::DampingLaw& damping,
                         const fem::StructuralSystem& system, Index input, const fem::Point& point,
                         double first_hz, std::vector<std::string>& notes) {
  constexpr double periods = 10.0;
  ReleaseTest test;
  test.point = point;
  test.damping = damping;
  if (const auto* structural = std::get_if<fem::StructuralDamping>(&damping)) {
    test.damping = fem::ModalDamping{{0.5 * structural->loss_factor}};
    notes.emplace_back("Decays are those of modal ratios of half the loss factor.");
  }
  if (experiment.excitation.kind == Excitation::Kind::release)
    test.deflection = experiment.excitation.deflection.value_or(test.deflection);
  else
    notes.push_back(
        fmt::format("The decays compared are those of a release from {:g} m at the {}, not of the "
                    "excitation of the file, \"{}\".",
                    test.deflection, point.name, to_string(experiment.excitation.kind)));
  try {
    test.initial = test.deflection * fem::static_shape(system, input, input);
  } catch (const std::runtime_error&) {
    notes.emplace_back("The beam can move without strain: it has no static deflection to be released from.");
    return test;
  }
  test.sampling_rate_hz = sampling_rate(experiment.simulation.sampling_rate, first_hz, notes);
  test.samples = static_cast<Index>(std::llround(periods / first_hz * test.sampling_rate_hz)) + 1;
  return test;
}

fem::Motion decay(const ReleaseTest& test, const fem::StructuralSystem& system, const fem::Modes& modes,
                  const Eigen::MatrixXd& shapes, const fem::SparseMatrix& mass) {
  const Index below = (modes.frequency_hz().array() < test.limit_hz()).count();
  if (test.samples == 0) return {};
  if (below == 0)
    return {VectorXd::Zero(test.samples), VectorXd::Zero(test.samples), VectorXd::Zero(test.samples)};
  fem::Loading loading;
  loading.initial_displacement =
      modes.shape.leftCols(below) * (shapes.leftCols(below).transpose() * (mass * test.initial));
  const fem::TimeGrid grid{1.0 / test.sampling_rate_hz, test.samples, {}};
  const fem::Response found =
      fem::respond(system, test.damping, loading, grid, {"modal", {{"modes", static_cast<double>(below)}}});
  return {found.displacement.row(0), found.velocity.row(0), found.acceleration.row(0)};
}

}  // namespace beamid::experiments
