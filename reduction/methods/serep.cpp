// System equivalent reduction expansion process [ocallahan1989b]: the lowest modes, told by the deflections
// of master points,
//
//     Phi = U (U_m)^+,     U (n x k): modes, U_m (m x k): their deflections at the masters
//
// With as many modes as masters, k = m, the coordinates are the masters' deflections. With fewer that matrix
// has rank k and the projected equations would be singular: the coordinates are then those of the modes, z
// being (U_m)^+ of what the masters see, and Phi = U. Either way the k frequencies and shapes are exact.
#include <Eigen/QR>

#include "fem/modes.hpp"
#include "reduction/constrained_statics.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr double told_apart = 1e-8;  // what the masters must see of a mode whose largest motion is 1

class Serep final : public Reduction {
 public:
  explicit Serep(const filters::Options& options)
      : masters_(options.numbers("masters_m")), modes_(count_option(options, "modes", "serep", 0)) {}

  Bases bases(const fem::StructuralSystem& system, const Training&) const override {
    const std::vector<int> masters = master_coordinates(system, masters_, "reduction 'serep'");
    const auto m = static_cast<Index>(masters.size()), k = modes_ > 0 ? modes_ : m;
    if (k > m)
      throw std::invalid_argument("reduction 'serep' has " + std::to_string(m) + " masters for " +
                                  std::to_string(k) + " modes; expected as many at least");
    const MatrixXd shapes = fem::modes(system, k).shape;
    const MatrixXd seen = shapes(masters, Eigen::all);
    const Eigen::VectorXd largest = shapes.cwiseAbs().colwise().maxCoeff();
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(seen * largest.cwiseInverse().asDiagonal());
    if (!(qr.matrixQR().diagonal().cwiseAbs().minCoeff() > told_apart))
      throw std::invalid_argument("reduction 'serep': the " + std::to_string(m) +
                                  " masters do not distinguish the " + std::to_string(k) +
                                  " modes; expected masters where they move differently");
    if (k < m) return {shapes};
    return {seen.transpose().colPivHouseholderQr().solve(shapes.transpose()).transpose()};
  }

  bool spans_lowest_modes() const override { return true; }

 private:
  std::vector<double> masters_;
  Index modes_;
};

const bool serep_registered = reduction_registry().add(
    {"serep",
     "the lowest modes, by the deflections of master points",
     "[ocallahan1989b]",
     {{"masters_m", std::vector<double>{}, "m", "positions of the masters; none: where the outputs are"},
      {"modes", 0.0, "", "number of modes kept, at most one per master; 0: one per master"}},
     {contract::modes_exact, contract::rigid_exact},
     [](const filters::Options& options) { return std::make_unique<Serep>(options); }});

}  // namespace
}  // namespace beamid::reduction
