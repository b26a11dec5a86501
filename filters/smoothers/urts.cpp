// Unscented Rauch-Tung-Striebel smoother [sarkka2008], in difference form. Points z_i = m +- sqrt(c) L_j with
// L the columns of P^1/2, d_i = F(z_i) - F(m), W = 1/(2c), s = W sum d_i:
//
//     E F(z) = F(m) + s,   X = [L, -L, 0] / sqrt(2),   Y = [sqrt(W) d_i, sqrt(beta - alpha^2) s]
#include <cmath>

#include "filters/algorithms/scaled_spread.hpp"
#include "filters/covariance_factor.hpp"
#include "filters/smoother.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class UnscentedRauchTungStriebel final : public Smoother {
 public:
  explicit UnscentedRauchTungStriebel(const Options& options) : options_(options) {}

  TransitionSpread spread(DiscreteModel& model, const Gaussian& filtered, const VectorXd& input) override {
    const auto [distance, centre, centred] =
        algorithms::scaled_spread("urts", options_, static_cast<std::size_t>(filtered.mean.size()));
    const MatrixXd root = factor_of(filtered);
    const Index n = root.rows(), m = root.cols();
    TransitionSpread result;
    result.state.setZero(n, 2 * m + 1);
    result.state.leftCols(m) = std::sqrt(0.5) * root;
    result.state.middleCols(m, m) = -std::sqrt(0.5) * root;
    result.moved.setZero(n, 2 * m + 1);
    VectorXd moved;
    model.transition(filtered.mean, input, result.next);
    for (Index i = 0; i < 2 * m; ++i) {
      const VectorXd point = filtered.mean + (i < m ? distance : -distance) * root.col(i % m);
      model.transition(point, input, moved);
      result.moved.col(i) = (moved - result.next) * (std::sqrt(0.5) / distance);
    }
    const VectorXd shift = result.moved.leftCols(2 * m).rowwise().sum() * (std::sqrt(0.5) / distance);
    result.moved.col(2 * m) = (centred ? std::sqrt(centre) : 0.0) * shift;
    result.next += shift;
    return result;
  }

 private:
  Options options_;
};

const bool urts_registered = smoother_registry().add(
    {"urts",
     "unscented Rauch-Tung-Striebel smoother, sigma points about the filtered mean",
     "[sarkka2008]",
     algorithms::scaled_spread_options(),
     {},
     [](const Options& options) { return std::make_unique<UnscentedRauchTungStriebel>(options); }});

}  // namespace
}  // namespace beamid::filters
