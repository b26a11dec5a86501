// How a reduction is compared with its mesh: by the shapes of its modes, by the decay after a release, and by
// what an identification with it gets wrong.
#include "experiments/studies/reduce/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/results/results.hpp"
#include "experiments/results/table.hpp"
#include "fem/response/response.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

MatrixXd squared_cosines(const MatrixXd& products, const VectorXd& phi, const VectorXd& psi) {
  return phi.cwiseInverse().asDiagonal() * products.cwiseAbs2() * psi.cwiseInverse().asDiagonal();
}

}  // namespace

MatrixXd mac(const MatrixXd& phi, const MatrixXd& psi, const fem::SparseMatrix& mass) {
  const MatrixXd weighted = mass * psi;
  return squared_cosines(phi.transpose() * weighted, phi.cwiseProduct(mass * phi).colwise().sum(),
                         psi.cwiseProduct(weighted).colwise().sum());
}

MatrixXd mac(const MatrixXd& phi, const MatrixXd& psi) {
  return squared_cosines(phi.transpose() * psi, phi.colwise().squaredNorm(), psi.colwise().squaredNorm());
}

std::vector<Index> partners(const MatrixXd& mac) {
  std::vector<Index> found;
  for (Index i = 0; i < mac.rows(); ++i) {
    Index best = -1;
    if (mac.cols() > 0 && !(mac.row(i).maxCoeff(&best) > 0.5)) best = -1;
    found.push_back(best);
  }
  return found;
}

VectorXd comac(const MatrixXd& phi, const MatrixXd& psi) {
  VectorXd found = VectorXd::Constant(phi.rows(), std::numeric_limits<double>::quiet_NaN());
  if (phi.cols() < 2) return found;
  for (Index p = 0; p < phi.rows(); ++p) {
    const double product = phi.row(p).cwiseAbs().dot(psi.row(p).cwiseAbs());
    const double squares = phi.row(p).squaredNorm() * psi.row(p).squaredNorm();
    if (squares > 0.0) found[p] = product * product / squares;
  }
  return found;
}

LowestComac lowest_comac(const VectorXd& comac) {
  LowestComac found{std::numeric_limits<double>::quiet_NaN(), -1};
  for (Index p = 0; p < comac.size(); ++p)
    if (!std::isnan(comac[p]) && !(comac[p] >= found.value)) found = {comac[p], p};
  if (found.value > 1.0 - 1e-9) found.point = -1;
  return found;
}

// The decay after a release.

namespace {

// The study's 1 kHz has 241 samples in a period of S(0.65). A rate that does not show the first mode, or
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

// The order of a reduction.

void add_orders(const RunContext& context, const ComparedRun& run, Results& results) {
  const std::vector<OrderError> all = errors_by_order(context, run);
  if (all.empty()) return;
  Table table{"orders", fmt::format("Expected errors by the order r of {}", all[0].method)};
  table.column({"parameter", "parameter"})
      .column({"r", "coordinates", "{:.0f}"})
      .column({"bias [%]", "reduction_bias_percent", "{:+.2g}"})
      .column({"other modes [%]", "other_modes_percent", "{:.2g}"})
      .column({"standard deviation [%]", "standard_deviation_percent", "{:.2g}"})
      .column({"expected error [%]", "expected_error_percent", "{:.2g}"});
  std::vector<const OrderError*> best(run.parameters.size());
  for (const OrderError& one : all) {
    const std::string& name = run.parameters[one.parameter].estimate.name;
    table.row({name, static_cast<double>(one.order), 100.0 * one.bias, 100.0 * one.others,
               100.0 * one.deviation, 100.0 * one.expected()});
    const OrderError*& least = best[one.parameter];
    if (!least || one.expected() < least->expected()) least = &one;
    nlohmann::ordered_json row{{"method", all[0].method}};
    for (const Column& column : table.columns)
      if (const double* number = number_of(column.cells.back()))
        row[column.key] = *number;
      else
        row[column.key] = name;
    results.values["orders"].push_back(std::move(row));
  }
  table.note =
      "Predicted from the modes in the record. Bias: by the frequencies that the reduction moves. Other "
      "modes: coloured noise of the omitted ones, root mean square over their phases. Standard deviation: "
      "Cramer-Rao bound of the modes kept, in the noise of the sensors.";
  results.table(table);
  std::string text;
  for (const OrderError* one : best)
    if (one)
      text += fmt::format(
          "{}r = {} minimises the expected error of {}: bias {:.2g} %, other modes {:.2g} %, "
          "standard deviation {:.2g} %.",
          text.empty() ? "" : " ", one->order, run.parameters[one->parameter].estimate.name,
          100.0 * one->bias, 100.0 * one->others, 100.0 * one->deviation);
  results.paragraph(text);
}

}  // namespace beamid::experiments
