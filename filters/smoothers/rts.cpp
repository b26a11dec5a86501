// Rauch-Tung-Striebel smoother [rauch1965], extended: linear about the filtered mean,
//
//     E F(z) = F(m),   X = P^1/2,   Y = J P^1/2,   J = dF/dz at m
#include "filters/covariance_factor.hpp"
#include "filters/smoother.hpp"

namespace beamid::filters {
namespace {

class RauchTungStriebel final : public Smoother {
 public:
  TransitionSpread spread(DiscreteModel& model, const Gaussian& filtered,
                          const Eigen::VectorXd& input) override {
    TransitionSpread result;
    result.state = factor_of(filtered);
    result.moved = result.state;
    model.move(filtered.mean, input, result.next, result.moved);
    return result;
  }
};

const bool rts_registered =
    smoother_registry().add({"rts",
                             "Rauch-Tung-Striebel smoother, linear about the filtered mean",
                             "[rauch1965], [sarkka2013]",
                             {},
                             {},
                             [](const Options&) { return std::make_unique<RauchTungStriebel>(); }});

}  // namespace
}  // namespace beamid::filters
