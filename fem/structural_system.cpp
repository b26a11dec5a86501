#include "fem/structural_system.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include <Eigen/SparseCholesky>

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double moved_mass(const StructuralSystem& system, Index input) {
  const VectorXd moved = system.inputs.col(input);
  return moved.dot(Eigen::SimplicialLDLT<SparseMatrix>(system.mass).solve(moved));
}

double moved_share(const StructuralSystem& system, Index input, const MatrixXd& shapes) {
  const VectorXd moved = system.inputs.col(input);
  const double all = moved_mass(system, input);
  return all > 0.0 ? (shapes.transpose() * moved).squaredNorm() / all : 1.0;
}

namespace {

[[noreturn]] void refuse(const std::string& what, double found, const char* expected) {
  std::ostringstream message;
  message << what << " is " << found << "; expected " << expected;
  throw std::invalid_argument(message.str());
}

void require_ratio(double ratio, const std::string& what) {
  if (!(ratio >= 0.0 && std::isfinite(ratio))) refuse(what, ratio, "a finite number of at least 0");
}

// 2 xi omega as a polynomial in omega^2 through the anchors, in Newton's form: no powers of omega are ever
// summed.
class AnchoredRate {
 public:
  AnchoredRate(const char* law, const std::vector<DampingAnchor>& anchors) {
    if (anchors.empty())
      throw std::invalid_argument(std::string(law) + " damping has no anchors; expected at least 1");
    for (const DampingAnchor& anchor : anchors) {
      const std::string which = std::string(law) + " damping: anchor " + std::to_string(squares_.size() + 1);
      if (!(anchor.frequency_hz > 0.0 && std::isfinite(anchor.frequency_hz)))
        refuse(which + ": frequency", anchor.frequency_hz, "a finite number of Hz above 0");
      require_ratio(anchor.ratio, which + ": ratio");
      const double omega = 2.0 * std::numbers::pi * anchor.frequency_hz;
      for (const double other : squares_)
        if (other == omega * omega)
          refuse(which + ": frequency", anchor.frequency_hz, "another one than before");
      squares_.push_back(omega * omega);
      differences_.push_back(2.0 * anchor.ratio * omega);
    }
    for (std::size_t order = 1; order < squares_.size(); ++order)
      for (std::size_t i = squares_.size(); i-- > order;)
        differences_[i] = (differences_[i] - differences_[i - 1]) / (squares_[i] - squares_[i - order]);
  }

  double operator()(double omega) const {
    double rate = 0.0;
    for (std::size_t i = squares_.size(); i-- > 0;)
      rate = rate * (omega * omega - squares_[i]) + differences_[i];
    return rate;
  }
  double constant_term() const { return (*this)(0.0); }
  double linear_term() const {
    return differences_.size() > 1 ? differences_[1] : 0.0;
  }  // of at most two anchors

 private:
  std::vector<double> squares_, differences_;
};

std::vector<DampingAnchor> anchors_of(const RayleighDamping& law) {
  return {law.first, law.second};
}
std::vector<DampingAnchor> anchors_of(const CaugheyDamping& law) {
  return law.anchors;
}

// 2 xi omega of every mode by each law.
struct Rates {
  const VectorXd& omega;

  VectorXd operator()(const Undamped&) const { return VectorXd::Zero(omega.size()); }
  VectorXd operator()(const ModalDamping& law) const {
    if (law.ratios.empty()) throw std::invalid_argument("modal damping has no ratios; expected at least 1");
    for (std::size_t i = 0; i < law.ratios.size(); ++i)
      require_ratio(law.ratios[i], "modal damping: ratio " + std::to_string(i + 1));
    VectorXd rates(omega.size());
    std::size_t next = 0;
    for (Index i = 0; i < omega.size(); ++i) {
      rates[i] = 2.0 * law.ratios[next] * omega[i];
      if (omega[i] > 0.0 && next + 1 < law.ratios.size()) ++next;
    }
    return rates;
  }
  VectorXd operator()(const RayleighDamping& law) const {
    return through(AnchoredRate("rayleigh", anchors_of(law)));
  }
  VectorXd operator()(const CaugheyDamping& law) const {
    return through(AnchoredRate("caughey", anchors_of(law)));
  }
  VectorXd operator()(const StructuralDamping& law) const {
    require_ratio(law.loss_factor, "structural damping: loss factor");
    return law.loss_factor * omega;
  }

  VectorXd through(const AnchoredRate& rate) const {
    VectorXd rates(omega.size());
    for (Index i = 0; i < omega.size(); ++i) {
      rates[i] = rate(omega[i]);
      // Between anchors of no damping rounding may leave less than none.
      if (rates[i] < 0.0 && rates[i] > -1e-12 * omega[i]) rates[i] = 0.0;
    }
    return rates;
  }
};

VectorXd checked_rates(const DampingLaw& law, const VectorXd& omega) {
  VectorXd rates = std::visit(Rates{omega}, law);
  for (Index i = 0; i < omega.size(); ++i) {
    if (rates[i] >= 0.0) continue;
    std::ostringstream message;
    message << name(law) << " damping: mode " << i + 1 << " at " << omega[i] / (2.0 * std::numbers::pi)
            << " Hz would have ";
    if (omega[i] > 0.0)
      message << "the damping ratio " << rates[i] / (2.0 * omega[i]);
    else
      message << "the damping rate " << rates[i] << " 1/s";
    message << "; expected at least 0: move the anchors";
    throw std::invalid_argument(message.str());
  }
  return rates;
}

}  // namespace

const char* name(const DampingLaw& law) {
  constexpr const char* names[] = {"undamped", "modal", "rayleigh", "caughey",
                                   "structural"};  // as in the variant
  return names[law.index()];
}

VectorXd damping_ratios(const DampingLaw& law, const VectorXd& angular_frequency) {
  VectorXd ratios = checked_rates(law, angular_frequency);
  for (Index i = 0; i < ratios.size(); ++i)
    ratios[i] = angular_frequency[i] > 0.0 ? ratios[i] / (2.0 * angular_frequency[i])
                                           : std::numeric_limits<double>::quiet_NaN();
  return ratios;
}

VectorXd damping_rates(const DampingLaw& law, const VectorXd& angular_frequency) {
  if (std::holds_alternative<StructuralDamping>(law))
    throw std::invalid_argument(
        "structural damping holds for harmonic motion only; expected modal ratios of half the loss factor");
  return checked_rates(law, angular_frequency);
}

ProportionalDamping proportional_coefficients(const DampingLaw& law) {
  if (std::holds_alternative<Undamped>(law)) return {};
  std::vector<DampingAnchor> anchors;
  if (const auto* rayleigh = std::get_if<RayleighDamping>(&law)) anchors = anchors_of(*rayleigh);
  if (const auto* caughey = std::get_if<CaugheyDamping>(&law)) {
    if (caughey->anchors.size() > 2)
      throw std::invalid_argument(
          "caughey damping with " + std::to_string(caughey->anchors.size()) +
          " anchors has a full damping matrix; expected at most 2 anchors here, or a modal method");
    anchors = anchors_of(*caughey);
  }
  if (std::holds_alternative<ModalDamping>(law))
    throw std::invalid_argument(
        "modal damping has a full damping matrix; expected the rayleigh law here, or a modal method");
  if (std::holds_alternative<StructuralDamping>(law))
    throw std::invalid_argument(
        "structural damping has no viscous damping matrix; expected the rayleigh law here");
  const AnchoredRate rate(name(law), anchors);
  return {rate.constant_term(), rate.linear_term()};
}

SparseMatrix proportional_damping(const DampingLaw& law, const StructuralSystem& system) {
  const ProportionalDamping c = proportional_coefficients(law);
  SparseMatrix matrix(system.size(), system.size());
  if (c.mass != 0.0) matrix += c.mass * system.mass;
  if (c.stiffness != 0.0) matrix += c.stiffness * system.stiffness.assembled();
  return matrix;
}

}  // namespace beamid::fem
