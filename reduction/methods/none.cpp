// No reduction: Phi = I. It makes "continuum versus reduced" a loop and not a second code path.
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

class None final : public Reduction {
 public:
  Bases bases(const fem::StructuralSystem&, const Training&) const override {
    Bases bases;
    bases.identity = true;
    return bases;
  }
};

const bool none_registered = reduction_registry().add(
    {"none",
     "every coordinate kept",
     "",
     {},
     {contract::static_exact, contract::modes_exact, contract::complete, contract::rigid_exact},
     [](const filters::Options&) { return std::make_unique<None>(); }});

}  // namespace
}  // namespace beamid::reduction
