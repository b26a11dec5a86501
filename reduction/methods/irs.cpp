// Improved reduced system: Guyan's slaves follow the masters' inertia forces too [ocallahan1989], which may
// be taken from the improved system itself, again and again [friswell1995]:
//
//     Phi_0 = Guyan's,    Phi_i+1 = Phi_0 + S M Phi_i M_i^-1 K_i,    S = [ 0    0     ]
//                                                                      [ 0  K_ss^-1  ]
//
// with M_i = Phi_i^T M Phi_i and K_i = Phi_i^T K Phi_i. It converges to the shapes that keep the lowest modes
// exactly, as many as there are masters: SEREP's.
#include <Eigen/Cholesky>

#include "reduction/constrained_statics.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

using Eigen::MatrixXd;

const std::string irs_owner = "reduction 'irs'";

class ImprovedReducedSystem final : public Reduction {
 public:
  explicit ImprovedReducedSystem(const filters::Options& options)
      : masters_(options.numbers("masters_m")), iterations_(count_option(options, "iterations", "irs", 0)) {}

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    const std::vector<int> masters = master_coordinates(system, masters_, irs_owner);
    const ConstrainedStatics statics(system, unit_rows(masters, system.size()), irs_owner);
    MatrixXd shapes = statics.unit_shapes();
    for (Eigen::Index i = 0; i < iterations_; ++i) {
      const MatrixXd strain = system.stiffness.strain * shapes;
      const MatrixXd stiffness = strain.transpose() * (system.stiffness.rigidity * strain);
      const MatrixXd load = system.mass * shapes, mass = shapes.transpose() * load;
      const Eigen::LLT<MatrixXd> factor(mass);
      if (factor.info() != Eigen::Success)
        throw std::invalid_argument(irs_owner + ": the masters have no mass to move; expected other masters");
      shapes = statics.unit_shapes() + statics.deflection_under(load * factor.solve(stiffness));
    }
    return {shapes};
  }

 private:
  std::vector<double> masters_;
  Eigen::Index iterations_;
};

const bool irs_registered = reduction_registry().add(
    {"irs",
     "as guyan, the rest following inertia forces too; iterated, if requested",
     "[ocallahan1989], [friswell1995]",
     {{"masters_m", std::vector<double>{}, "m", "positions of the masters; none: where the outputs are"},
      {"iterations", 1.0, "", "0: Guyan's shapes, 1: improved, more: iterated"}},
     {contract::rigid_exact},
     [](const filters::Options& options) { return std::make_unique<ImprovedReducedSystem>(options); }});

}  // namespace
}  // namespace beamid::reduction
