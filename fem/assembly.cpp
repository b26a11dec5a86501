#include "fem/assembly.hpp"

#include <stdexcept>
#include <string>

namespace beamid::fem {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

SparseMatrix sparse(Eigen::Index rows, Eigen::Index columns, const Triplets& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Consistent mass of [w1, h theta1, w2, h theta2], m h / 420 times these integers [przemieniecki1968,
// eq. 11.43].
constexpr double element_mass[4][4] = {
    {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};

// Rows: natural strains; columns: [w1, h theta1, w2, h theta2].
constexpr double element_strain[2][4] = {{1, 1, -1, 0}, {1, 0, -1, 1}};

Eigen::VectorXd nodal(const StructuralSystem& system, const Eigen::VectorXd& q, Coordinate::Kind kind) {
  if (q.size() != system.size())
    throw std::invalid_argument("motion has " + std::to_string(q.size()) + " entries; expected " +
                                std::to_string(system.size()));
  std::vector<double> values{0.0};  // the clamped root
  for (Eigen::Index i = 0; i < system.size(); ++i)
    if (system.coordinates[i].kind == kind) values.push_back(q[i] / system.coordinates[i].scale);
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

StructuralSystem assemble(const Beam& beam, int elements) {
  validate(beam);
  if (elements < 1)
    throw std::invalid_argument("elements is " + std::to_string(elements) + "; expected at least 1");
  const double h = beam.length / elements;
  const double rigidity = beam.bending_stiffness / (h * h * h);
  const double element_scale = beam.mass_per_length * h / 420.0;

  StructuralSystem system;
  Triplets mass, strain, stiff, flexible;
  for (int e = 0; e < elements; ++e) {
    const int first = 2 * e - 2;  // coordinate of w1; negative coordinates belong to the clamped root
    for (int i = 0; i < 4; ++i) {
      if (first + i < 0) continue;
      for (int j = 0; j < 4; ++j)
        if (first + j >= 0) mass.emplace_back(first + i, first + j, element_scale * element_mass[i][j]);
      for (int s = 0; s < 2; ++s)
        if (element_strain[s][i] != 0.0) strain.emplace_back(2 * e + s, first + i, element_strain[s][i]);
    }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        stiff.emplace_back(2 * e + i, 2 * e + j, rigidity * (i == j ? 4.0 : 2.0));
        flexible.emplace_back(2 * e + i, 2 * e + j, (i == j ? 1.0 / 3.0 : -1.0 / 6.0) / rigidity);
      }
    const double x = (e + 1) * h;
    system.coordinates.push_back({Coordinate::Kind::deflection, x, 1.0});
    system.coordinates.push_back({Coordinate::Kind::rotation, x, h});
  }
  const int n = 2 * elements, tip = n - 2;
  mass.emplace_back(tip, tip, beam.tip_mass);
  mass.emplace_back(tip + 1, tip + 1, beam.tip_rotary_inertia / (h * h));

  system.mass = sparse(n, n, mass);
  system.damping = SparseMatrix(n, n);
  system.stiffness = {sparse(n, n, strain), sparse(n, n, stiff), sparse(n, n, flexible)};
  system.inputs = sparse(n, 1, {{tip, 0, 1.0}});
  system.outputs = sparse(1, n, {{0, tip, 1.0}});
  system.input_names = {"tip_force"};
  system.output_names = {"tip_deflection"};
  return system;
}

Eigen::VectorXd nodal_deflection(const StructuralSystem& system, const Eigen::VectorXd& q) {
  return nodal(system, q, Coordinate::Kind::deflection);
}

Eigen::VectorXd nodal_rotation(const StructuralSystem& system, const Eigen::VectorXd& q) {
  return nodal(system, q, Coordinate::Kind::rotation);
}

Eigen::VectorXd nodal_position(const StructuralSystem& system) {
  Eigen::VectorXd positions(system.size());
  for (Eigen::Index i = 0; i < system.size(); ++i)
    positions[i] = system.coordinates[i].position * system.coordinates[i].scale;
  return nodal(system, positions, Coordinate::Kind::deflection);
}

}  // namespace beamid::fem
