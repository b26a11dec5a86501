// Proper orthogonal decomposition [sirovich1987], [feeny1998]: of the motions X = (q(t_1), ..., q(t_N)) the r
// shapes that hold most of them in the least squares of the mass norm,
//
//     M^1/2 X = (M^1/2 Phi) S V^T,     Phi^T M Phi = I,
//
// S falling. The motions are those given (training), spread over the mesh by least strain energy; or, where
// none are given, a response that is computed here.
#include <numbers>

#include <Eigen/SVD>

#include "fem/modes.hpp"
#include "fem/response/response.hpp"
#include "fem/stiffness_solver.hpp"
#include "reduction/constrained_statics.hpp"
#include "reduction/orthonormal_basis.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

const std::string pod_owner = "reduction 'pod'";

struct Run {
  std::string response;
  double periods;
  Index samples;
};

double lowest_flexible_frequency(const fem::StructuralSystem& system) {
  const Index rigid = fem::StiffnessSolver(system.stiffness).rigid_motions().cols();
  if (rigid >= system.size())
    throw std::invalid_argument(pod_owner + ": no motion of the structure strains it");
  return fem::modes(system, rigid + 1).angular_frequency[rigid];
}

fem::Loading loading(const fem::StructuralSystem& system, const Run& run, Index samples) {
  const bool from_base = run.response == "base_pulse";
  const std::vector<int> forces = force_inputs(system);
  const int input = from_base ? base_input(system) : forces.empty() ? -1 : forces.front();
  if (input < 0)
    throw std::invalid_argument(pod_owner + ": the system has no input for response '" + run.response + "'");
  fem::Loading loading;
  if (run.response == "release") {
    const fem::StiffnessSolver solver(system.stiffness);
    if (solver.rigid_motions().cols() > 0)
      throw std::invalid_argument(pod_owner +
                                  ": a structure that can move without strain cannot be released "
                                  "from rest; expected response = \"pulse\" or training");
    loading.initial_displacement = solver.solve(MatrixXd(system.inputs.col(input)));
  } else {
    loading.inputs = MatrixXd::Zero(system.inputs.cols(), samples);
    loading.inputs(input, 0) = 1.0;  // falls to zero over the first interval
  }
  return loading;
}

// Motions of the whole mesh (n x samples). Nonlinear ones are integrated in finer steps.
MatrixXd simulated(const fem::StructuralSystem& system, const Run& run) {
  const bool nonlinear = !system.nonlinear_forces.empty();
  const Index fineness = nonlinear ? 20 : 1;
  fem::TimeGrid grid;
  grid.interval = run.periods * 2.0 * std::numbers::pi / lowest_flexible_frequency(system) /
                  static_cast<double>(run.samples * fineness);
  grid.samples = run.samples * fineness;
  for (Index i = 0; i < run.samples; ++i) grid.frames.push_back(i * fineness);
  return fem::respond(system, {}, loading(system, run, grid.samples), grid,
                      {nonlinear ? "newmark" : "modal", {}})
      .field_displacement;
}

class ProperOrthogonal final : public Reduction {
 public:
  explicit ProperOrthogonal(const filters::Options& options)
      : modes_(count_option(options, "modes", "pod", 1)),
        run_{options.text("response"), positive_option(options, "periods", "pod"),
             count_option(options, "samples", "pod", 2)} {
    if (run_.response != "release" && run_.response != "pulse" && run_.response != "base_pulse" &&
        run_.response != "record")
      throw std::invalid_argument("unknown response '" + run_.response +
                                  "' of reduction 'pod'; known: base_pulse, pulse, record, release");
  }

  Bases bases(const fem::StructuralSystem& system, const Training& training) const override {
    require_at_most(modes_, system.size(), "modes", "pod");
    if (training.empty() && run_.response == "record")
      throw std::invalid_argument(
          "reduction 'pod' learns from a record here, and there is none: expected one that holds motion");
    if (training.empty()) {
      const MatrixXd motions = simulated(system, run_);
      return decompose(system, motions, MatrixXd::Identity(motions.cols(), motions.cols()));
    }
    return decompose(system, static_interpolation(system, training, pod_owner), training.deflections);
  }

 private:
  Index modes_;
  Run run_;

  // Of the motions shapes (n x p) times histories (p x N): with V an M-orthonormal basis of the shapes, the
  // singular value decomposition of V^T M shapes histories.
  Bases decompose(const fem::StructuralSystem& system, const MatrixXd& shapes,
                  const MatrixXd& histories) const {
    OrthonormalBasis basis(system.mass);
    basis.add_all(shapes);
    const MatrixXd motions = (basis.columns().transpose() * (system.mass * shapes)) * histories;
    if (!(motions.cwiseAbs().maxCoeff() > 0.0) || !motions.allFinite())
      throw std::invalid_argument(pod_owner + ": the motions it learns from have no mass that moves");
    const Eigen::BDCSVD<MatrixXd> svd(motions, Eigen::ComputeThinU);
    const VectorXd values = svd.singularValues() / svd.singularValues()[0];
    const Index rank = (values.array() > 1e-14).count();
    if (modes_ > rank)
      throw std::invalid_argument(pod_owner + ": the motions it learns from hold " + std::to_string(rank) +
                                  " shapes; expected at least the " + std::to_string(modes_) + " of modes");
    return {basis.columns() * svd.matrixU().leftCols(modes_), values, "singular value over the largest [-]"};
  }
};

const bool pod_registered = reduction_registry().add(
    {"pod",
     "shapes that hold most of a motion, given or simulated",
     "[sirovich1987], [feeny1998]",
     {{"modes", 1.0, "", "number of shapes kept"},
      {"response", "release", "", "release (from rest), pulse, base_pulse, or record: what the sensors saw"},
      {"periods", 5.0, "", "length of that response in periods of the first mode"},
      {"samples", 200.0, "", "motions taken from it"}},
     {},
     [](const filters::Options& options) { return std::make_unique<ProperOrthogonal>(options); }});

}  // namespace
}  // namespace beamid::reduction
