// Guyan's static condensation [guyan1965]: the deflections of some master points are kept, all else follows
// them as it would at rest,
//
//     Phi = [     I          ]   masters
//           [ -K_ss^-1 K_sm  ]   slaves
//
// Exact under static forces at the masters; every frequency comes out too high, the sooner the slaves have
// modes of their own.
#include "reduction/constrained_statics.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

const std::string guyan_owner = "reduction 'guyan'";

class Guyan final : public Reduction {
 public:
  explicit Guyan(std::vector<double> masters) : masters_(std::move(masters)) {}

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    const std::vector<int> masters = master_coordinates(system, masters_, guyan_owner);
    return {ConstrainedStatics(system, unit_rows(masters, system.size()), guyan_owner).unit_shapes()};
  }

 private:
  std::vector<double> masters_;
};

const bool guyan_registered = reduction_registry().add(
    {"guyan",
     "deflections of master points, the rest follows statically",
     "[guyan1965]",
     {{"masters_m", std::vector<double>{}, "m", "positions of the masters; none: where the outputs are"}},
     {contract::static_exact, contract::rigid_exact},
     [](const filters::Options& options) { return std::make_unique<Guyan>(options.numbers("masters_m")); }});

}  // namespace
}  // namespace beamid::reduction
