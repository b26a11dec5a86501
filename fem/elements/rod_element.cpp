#include "fem/elements/rod_element.hpp"

#include <cmath>

#include "fem/elements/element_shapes.hpp"

namespace beamid::fem {

RodMatrices rod_matrices(const Section& section, const Mesh::Element& element, const Variation& stiffness,
                         const Variation& mass_per_length, MassModel mass_model) {
  const ElementSection p{section, element};
  const double h = element.length;
  const auto mean = [&](const auto& f) {
    return p.integral<Eigen::Vector<double, 1>>([&](double s) { return Eigen::Vector<double, 1>(f(s)); })[0];
  };
  RodMatrices result;
  if (p.along(stiffness, 0.0) > 0.0 && p.along(stiffness, 1.0) > 0.0) {
    result.flexibility = h * mean([&](double s) { return 1.0 / p.along(stiffness, s); });
    result.rigidity = 1.0 / result.flexibility;
  } else {  // a sharp end stretches without bound; a linear displacement does not
    result.rigidity = mean([&](double s) { return p.along(stiffness, s); }) / h;
    result.flexibility = 1.0 / result.rigidity;
  }
  const auto mass = [&](int power_first, int power_second) {
    return h * mean([&](double s) {
             return p.along(mass_per_length, s) * std::pow(1.0 - s, power_first) * std::pow(s, power_second);
           });
  };
  if (mass_model == MassModel::lumped)
    result.mass << mass(1, 0), 0.0, 0.0, mass(0, 1);
  else
    result.mass << mass(2, 0), mass(1, 1), mass(1, 1), mass(0, 2);
  return result;
}

}  // namespace beamid::fem
