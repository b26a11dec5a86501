#include "experiments/models/motion/beam_equations.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double usual_ratio = 0.01, damping_uncertainty = 1.0;

// Whether the law is C = alpha M + beta K.
bool is_proportional(const fem::DampingLaw& law) {
  if (const auto* caughey = std::get_if<fem::CaugheyDamping>(&law)) return caughey->anchors.size() <= 2;
  return std::holds_alternative<fem::RayleighDamping>(law) || std::holds_alternative<fem::Undamped>(law);
}

}  // namespace

void add_damping_defaults(const fem::DampingLaw& law, const VectorXd& frequencies,
                          const std::vector<ParameterChoice>& choices,
                          std::vector<ParameterDefault>& defaults) {
  const bool described = !std::holds_alternative<fem::Undamped>(law);
  const fem::ProportionalDamping proportional =
      is_proportional(law) ? fem::proportional_coefficients(law) : fem::ProportionalDamping{};
  for (std::size_t j = 0; j < choices.size(); ++j) {
    const ParameterChoice& choice = choices[j];
    if (choice.quantity == "mass_damping") defaults[j] = {proportional.mass, damping_uncertainty};
    if (choice.quantity == "stiffness_damping") defaults[j] = {proportional.stiffness, damping_uncertainty};
    if (choice.quantity != "damping_ratio") continue;
    const int mode = choice.mode.value_or(1);
    if (mode < 1 || mode > frequencies.size())
      refuse(choice,
             fmt::format("damping_ratio of mode {}; expected one of the {} modes that the model damps", mode,
                         frequencies.size()));
    defaults[j] = {described ? fem::damping_ratios(law, frequencies)[mode - 1] : usual_ratio,
                   damping_uncertainty};
  }
}

void describe_damping(const fem::DampingLaw& law, const VectorXd& frequencies, std::vector<DampedMode> modes,
                      MotionDescription& description) {
  const auto asked = [&](Drive::Kind kind) {
    return std::any_of(description.drives.begin(), description.drives.end(),
                       [&](const Drive& drive) { return drive.kind == kind; });
  };
  const bool ratios_asked = asked(Drive::Kind::damping_ratio);
  if (is_proportional(law) && !ratios_asked) {
    const fem::ProportionalDamping proportional = fem::proportional_coefficients(law);
    description.mass_damping = proportional.mass;
    description.stiffness_damping = proportional.stiffness;
    return;
  }
  const VectorXd ratios = fem::damping_ratios(law, frequencies);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    modes[i].number = static_cast<Index>(i);
    modes[i].ratio = ratios[static_cast<Index>(i)];
    for (std::size_t j = 0; j < description.unknowns.size(); ++j) {
      if (description.drives[j].kind != Drive::Kind::damping_ratio) continue;
      const auto& of = description.unknowns[j].mode;
      const bool its_own = of && *of == static_cast<int>(i) + 1;
      if (its_own || (!of && modes[i].unknown < 0)) modes[i].unknown = static_cast<Index>(j);
    }
    if (modes[i].unknown >= 0 || modes[i].ratio > 0.0) description.damped_modes.push_back(modes[i]);
  }
}

namespace {

using Property = fem::BeamParameter::Quantity;

constexpr double stiffness_uncertainty = 0.3, mass_uncertainty = 0.1, dashpot_uncertainty = 1.0;

/// @param asked a ParameterChoice or an Unknown
fem::BeamParameter parameter_of(const auto& asked) {
  return {*beam_quantity(asked.quantity), asked.region, asked.name};
}

bool same_mesh(const fem::StructuralSystem& a, const fem::StructuralSystem& b) {
  if (a.size() != b.size()) return false;
  const double slack = 1e-9 * (b.mesh.nodes.empty() ? 1.0 : std::abs(b.mesh.nodes.back().x));
  for (std::size_t i = 0; i < a.coordinates.size(); ++i)
    if (a.coordinates[i].kind != b.coordinates[i].kind ||
        std::abs(a.coordinates[i].position - b.coordinates[i].position) > slack)
      return false;
  return true;
}

// A row that reads deflections, on another mesh with nodes at the same points.
void move_row(const fem::StructuralSystem& from, Index row, const fem::StructuralSystem& to, MatrixXd& rows) {
  const MatrixXd outputs = MatrixXd(from.outputs.row(row));
  for (Index i = 0; i < outputs.cols(); ++i) {
    if (outputs(0, i) == 0.0) continue;
    const fem::Coordinate& wanted = from.coordinates[static_cast<std::size_t>(i)];
    const int node = wanted.kind == fem::Coordinate::Kind::deflection ? to.mesh.node_at(wanted.position) : -1;
    const auto found =
        std::find_if(to.coordinates.begin(), to.coordinates.end(), [&](const fem::Coordinate& c) {
          return c.kind == fem::Coordinate::Kind::deflection && c.node == node;
        });
    if (node < 0 || found == to.coordinates.end())
      throw std::invalid_argument(
          fmt::format("observation {} reads a strain on a mesh without nodes at the ends of the parameters' "
                      "regions; expected a mesh that has them",
                      row + 1));
    rows(row, found - to.coordinates.begin()) = outputs(0, i);
  }
}

}  // namespace

std::optional<Property> beam_quantity(const std::string& name) {
  if (name == "bending_stiffness") return Property::bending_stiffness;
  if (name == "tip_mass") return Property::tip_mass;
  if (name == "body_mass") return Property::body_mass;
  if (name == "tip_rotary_inertia") return Property::tip_rotary_inertia;
  if (name == "root_rotational_stiffness") return Property::root_rotational_stiffness;
  if (name == "root_translational_stiffness") return Property::root_translational_stiffness;
  if (name == "axial_load") return Property::axial_load;
  if (name == "storey_stiffness") return Property::storey_stiffness;
  if (name == "storey_damping") return Property::storey_damping;
  if (name == "factor") return Property::factor;
  return std::nullopt;
}

const std::vector<std::string>& structure_quantities() {
  static const std::vector<std::string> quantities{"bending_stiffness",
                                                   "tip_mass",
                                                   "body_mass",
                                                   "tip_rotary_inertia",
                                                   "root_rotational_stiffness",
                                                   "root_translational_stiffness",
                                                   "axial_load",
                                                   "storey_stiffness",
                                                   "storey_damping",
                                                   "factor",
                                                   "damping_ratio",
                                                   "mass_damping",
                                                   "stiffness_damping"};
  return quantities;
}

std::vector<ParameterDefault> beam_defaults(const fem::Structure& structure,
                                            const std::vector<ParameterChoice>& choices) {
  std::vector<ParameterDefault> defaults(choices.size());
  for (std::size_t j = 0; j < choices.size(); ++j) {
    const ParameterChoice& choice = choices[j];
    const auto quantity = beam_quantity(choice.quantity);
    if (!quantity) continue;
    const bool mass = *quantity == Property::tip_mass || *quantity == Property::body_mass ||
                      *quantity == Property::tip_rotary_inertia;
    try {
      defaults[j] = {fem::value_of(structure, parameter_of(choice)), mass ? mass_uncertainty
                                                                     : *quantity == Property::storey_damping
                                                                         ? dashpot_uncertainty
                                                                         : stiffness_uncertainty};
    } catch (const std::invalid_argument& error) {
      refuse(choice, choice.quantity + ": " + error.what());
    }
  }
  return defaults;
}

fem::ParametricSystem beam_equations(const ModelSetting& setting, const std::vector<Unknown>& unknowns) {
  if (!setting.continuum)
    throw std::invalid_argument(
        "model 'beam' determines the beam itself; the system was given without the beam it was made from");
  if (!setting.system.nonlinear_forces.empty())
    throw std::invalid_argument(
        fmt::format("model 'beam' is linear; found {} springs or dashpots that are not",
                    setting.system.nonlinear_forces.size()));
  fem::Structure structure = setting.continuum->structure;
  std::vector<fem::BeamParameter> parameters;
  for (const Unknown& unknown : unknowns) {
    if (!beam_quantity(unknown.quantity)) continue;
    parameters.push_back(parameter_of(unknown));
    if (fem::value_of(structure, parameters.back()) != unknown.guess)
      structure = fem::with_value(structure, parameters.back(), unknown.guess);
  }
  fem::ParametricSystem equations =
      fem::assemble_parametric(structure, setting.continuum->elements, setting.continuum->points, parameters);
  fem::StructuralSystem& system = equations.system;
  if (same_mesh(setting.system, system)) {
    system.outputs = setting.system.outputs;
  } else {
    MatrixXd rows = MatrixXd::Zero(setting.system.outputs.rows(), system.size());
    for (Index i = 0; i < rows.rows(); ++i) move_row(setting.system, i, system, rows);
    system.outputs = rows.sparseView();
  }
  system.output_names = setting.system.output_names;
  system.base_shares = setting.system.base_shares;
  return equations;
}

std::vector<Unknown> properties_of(const std::vector<ParameterChoice>& choices,
                                   const std::vector<ParameterDefault>& defaults) {
  std::vector<Unknown> properties;
  for (std::size_t j = 0; j < choices.size(); ++j)
    if (beam_quantity(choices[j].quantity)) properties.push_back(unknown_of(choices[j], defaults[j]));
  return properties;
}

void add_drives(const fem::ParametricSystem& equations, MotionDescription& description) {
  description.reference = equations.values;
  Index property = 0;
  for (const Unknown& unknown : description.unknowns) {
    Drive drive;
    if (unknown.quantity == "damping_ratio")
      drive.kind = Drive::Kind::damping_ratio;
    else if (unknown.quantity == "mass_damping")
      drive.kind = Drive::Kind::mass_damping;
    else if (unknown.quantity == "stiffness_damping")
      drive.kind = Drive::Kind::stiffness_damping;
    else
      drive.index = property++;
    description.drives.push_back(drive);
  }
}

VectorXd scale_of_modes(const fem::StructuralSystem& system, const std::vector<Observation>& observations,
                        const MatrixXd& shapes) {
  const MatrixXd seen = system.outputs * shapes;
  VectorXd scale(shapes.cols());
  for (Index i = 0; i < shapes.cols(); ++i) {
    double largest = 0.0, anywhere = 0.0;
    for (Index k = 0; k < system.size(); ++k)
      if (system.coordinates[static_cast<std::size_t>(k)].kind == fem::Coordinate::Kind::deflection)
        anywhere = std::max(anywhere, std::abs(shapes(k, i)));
    for (Index row = 0; row < seen.rows(); ++row)
      if (observations[static_cast<std::size_t>(row)].quantity != Quantity::strain &&
          std::abs(seen(row, i)) > std::abs(largest))
        largest = seen(row, i);
    if (std::abs(largest) <= 1e-6 * anywhere) largest = anywhere;
    scale[i] = largest != 0.0 ? 1.0 / largest : 1.0;
  }
  return scale;
}

ReducedEquations on_shapes(const fem::ParametricSystem& equations, const MatrixXd& shapes,
                           const VectorXd& frequencies, const std::vector<Index>& forces) {
  const fem::StructuralSystem& system = equations.system;
  const auto kept = [&](const fem::SparseMatrix& inputs) {
    const MatrixXd all = shapes.transpose() * inputs;
    return MatrixXd(all(Eigen::all, forces));
  };
  const auto project = [&](const fem::SparseMatrix& matrix, const MatrixXd& on) {
    const MatrixXd product = on.transpose() * (matrix * on);
    return MatrixXd(0.5 * (product + product.transpose()));
  };
  ReducedEquations reduced;
  reduced.mass = project(system.mass, shapes).diagonal();
  reduced.stiffness = reduced.mass.cwiseProduct(frequencies.cwiseAbs2());
  reduced.damping = project(system.damping, shapes);
  reduced.inputs = kept(system.inputs);
  const MatrixXd strains = equations.strain * shapes;
  for (const fem::ParametricSystem::Derivative& slope : equations.derivatives)
    reduced.derivatives.push_back(
        {project(slope.mass, shapes), project(slope.rigidity, strains), kept(slope.inputs),
         slope.damping.nonZeros() > 0 ? project(slope.damping, shapes) : MatrixXd()});
  return reduced;
}

std::vector<DampedMode> damped_modes(const fem::ParametricSystem& equations, const fem::Modes& modes) {
  const auto a = static_cast<Index>(equations.derivatives.size());
  std::vector<DampedMode> damped;
  for (Index i = modes.rigid; i < modes.size(); ++i) {
    const VectorXd shape = modes.shape.col(i), strains = equations.strain * shape;
    DampedMode mode;
    mode.momentum = equations.system.mass * shape;
    mode.momentum_slopes.resize(shape.size(), a);
    mode.mass_slopes.resize(a);
    mode.stiffness_slopes.resize(a);
    mode.stiffness = modes.angular_frequency[i] * modes.angular_frequency[i];
    for (Index j = 0; j < a; ++j) {
      const auto& slope = equations.derivatives[static_cast<std::size_t>(j)];
      mode.momentum_slopes.col(j) = slope.mass * shape;
      mode.mass_slopes[j] = shape.dot(mode.momentum_slopes.col(j));
      mode.stiffness_slopes[j] = strains.dot(slope.rigidity * strains);
    }
    damped.push_back(std::move(mode));
  }
  return damped;
}

}  // namespace beamid::experiments
