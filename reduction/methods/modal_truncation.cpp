// Modal truncation: the r lowest mode shapes, each scaled to 1 at the first output where it moves there.
#include <cmath>

#include "fem/modes.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

class ModalTruncation final : public Reduction {
 public:
  explicit ModalTruncation(double modes) {
    if (!(modes >= 1.0 && modes <= 1e6 && modes == std::floor(modes)))
      throw std::invalid_argument("option 'modes' of reduction 'modal_truncation' is " +
                                  std::to_string(modes) + "; expected a whole number from 1 to 1000000");
    modes_ = static_cast<Eigen::Index>(modes);
  }

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    Eigen::MatrixXd shapes = fem::modes(system, modes_).shape;
    const Eigen::MatrixXd seen = system.outputs * shapes;
    for (Eigen::Index i = 0; i < modes_; ++i)
      if (std::abs(seen(0, i)) > 1e-6 * seen.row(0).cwiseAbs().maxCoeff()) shapes.col(i) /= seen(0, i);
    return {shapes};
  }

 private:
  Eigen::Index modes_ = 0;
};

const bool registered =
    reduction_registry().add({"modal_truncation",
                              "the lowest mode shapes",
                              "[craig2006, ch. 11]",
                              {{"modes", 1.0, "", "number of modes kept"}},
                              {contract::modes_exact},
                              [](const filters::Options& options) {
                                return std::make_unique<ModalTruncation>(options.number("modes"));
                              }});

}  // namespace
}  // namespace beamid::reduction
