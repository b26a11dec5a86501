// Modal truncation: the r lowest mode shapes U, each scaled to 1 at the first output where it moves there.
//
// With static correction (modal truncation augmentation [dickens1997]) there is a Ritz vector more for each
// force, the static deflection that the modes leave out,
//
//     K^-1 (E - M U U^T E),     U^T M U = I,
//
// made orthonormal; those that the others already say are left out. The static deflection under the forces is
// exact then, and so is the antiresonance that depends on it nearly.
#include <cmath>

#include "fem/modes.hpp"
#include "reduction/constrained_statics.hpp"
#include "reduction/orthonormal_basis.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class ModalTruncation final : public Reduction {
 public:
  explicit ModalTruncation(const filters::Options& options)
      : modes_(count_option(options, "modes", "modal_truncation", 1)),
        static_correction_(options.flag("static_correction")) {}

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    require_at_most(modes_, system.size(), "modes", "modal_truncation");
    const MatrixXd modes = fem::modes(system, modes_).shape;
    MatrixXd shapes = static_correction_ ? augmented(system, modes) : modes;
    if (system.outputs.rows() == 0) return {shapes};
    const MatrixXd seen = system.outputs * modes;
    for (Index i = 0; i < modes_; ++i)
      if (std::abs(seen(0, i)) > 1e-6 * seen.row(0).cwiseAbs().maxCoeff()) shapes.col(i) /= seen(0, i);
    return {shapes};
  }

  bool spans_lowest_modes() const override { return !static_correction_; }

 private:
  Index modes_;
  bool static_correction_;

  static MatrixXd augmented(const fem::StructuralSystem& system, const MatrixXd& modes) {
    const ElasticStatics statics(system);
    OrthonormalBasis basis(system.mass, modes);
    for (const int input : force_inputs(system)) {
      const VectorXd force = system.inputs.col(input);
      VectorXd unseen = force;
      for (int pass = 0; pass < 2; ++pass) unseen -= system.mass * (modes * (modes.transpose() * unseen));
      if (unseen.norm() > 1e-11 * force.norm()) basis.add(statics.solve(unseen));
    }
    return basis.columns();
  }
};

const bool modal_truncation_registered = reduction_registry().add(
    {"modal_truncation",
     "the lowest mode shapes, with static correction if requested",
     "[craig2006, ch. 11], [dickens1997]",
     {{"modes", 1.0, "", "number of modes kept"},
      {"static_correction", false, "", "whether to add the static deflection that the modes omit"}},
     {contract::modes_exact, contract::rigid_exact, contract::grows},
     [](const filters::Options& options) { return std::make_unique<ModalTruncation>(options); }});

}  // namespace
}  // namespace beamid::reduction
