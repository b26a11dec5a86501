// No reduction: Phi = I. It makes "continuum versus reduced" a loop and not a second code path.
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

class None final : public Reduction {
 public:
  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    return {Eigen::MatrixXd::Identity(system.size(), system.size())};
  }
};

const bool registered =
    reduction_registry().add({"none",
                              "every coordinate kept",
                              "",
                              {},
                              {contract::static_exact, contract::modes_exact, contract::complete},
                              [](const filters::Options&) { return std::make_unique<None>(); }});

}  // namespace
}  // namespace beamid::reduction
