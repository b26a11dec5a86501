// The finite-element beam itself, on any reduction, none included:
//
//     M(p) q'' + C(p) q' + K(p) q = E(p) f,    q = Phi z
//
// with the beam's properties p and its damping unknown. Phi is that of the guess and stays. What the filter
// sees of a reduced model are its modes at the guess, z, each scaled to 1 at the output where it is largest:
// the same space, in coordinates in [m] that are independent at the guess. A mesh that nobody has reduced is
// seen in its own coordinates, or, when it decays freely and its shapes depend on what is asked, in its
// lowest modes as they follow the unknowns (following_motion.hpp). So is a reduction to the lowest modes
// whose shapes depend on what is asked. A chain whose storeys follow laws is not linear (storeys.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/models/banded/continuum_motion.hpp"
#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/models/motion/following_motion.hpp"
#include "experiments/models/motion/parametric_motion.hpp"
#include "experiments/models/motion/supported_motion.hpp"
#include "experiments/models/storeys.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// A mesh with more coordinates than this is not made into dense matrices.
constexpr Index most_dense = 30;

// What is asked where the file asks nothing: the stiffness of all, or each factor, and the damping.
std::vector<ParameterChoice> own_choices(const ModelSetting& setting) {
  constexpr Index most_ratios = 6;
  std::vector<ParameterChoice> choices;
  if (!setting.continuum || setting.continuum->structure.is_beam())
    choices.push_back({setting.continuum && setting.continuum->structure.is_chain() ? "storey_stiffness"
                                                                                    : "bending_stiffness"});
  else
    for (const std::string& name : fem::factor_names(setting.continuum->structure))
      choices.push_back({"factor", name});
  // Joints damp each mode of a real structure by a ratio of its own, and a measured input shows all of them.
  const Index modes = setting.forces.empty() || !setting.supports.empty() ? 0 : setting.system.size();
  if (modes > 0 && modes <= most_ratios)
    for (int i = 1; i <= modes; ++i) choices.push_back({"damping_ratio", "", {}, i});
  else
    choices.push_back({"damping_ratio"});
  return choices;
}

// A measured input lets a search go far from the guess: what is positive by its nature stays so, by its
// logarithm, unless a form or bounds are stated.
std::vector<ParameterChoice> choices_of(const ModelSetting& setting) {
  std::vector<ParameterChoice> choices =
      setting.parameters.empty() ? own_choices(setting) : setting.parameters;
  for (ParameterChoice& choice : choices) {
    require_quantity(choice, structure_quantities(), "beam");
    choice.keep_positive = !setting.forces.empty();
  }
  return choices;
}

// Ratios of modes that a reduction has left out are not asked about: reductions are compared on one list.
void drop_ratios_above(Index modes, std::vector<ParameterChoice>& choices,
                       std::vector<ParameterDefault>& defaults) {
  for (std::size_t j = choices.size(); j-- > 0;)
    if (choices[j].quantity == "damping_ratio" && choices[j].mode.value_or(1) > modes) {
      choices.erase(choices.begin() + static_cast<std::ptrdiff_t>(j));
      defaults.erase(defaults.begin() + static_cast<std::ptrdiff_t>(j));
    }
}

bool asks_about_dashpots(const fem::ParametricSystem& equations) {
  return std::any_of(equations.derivatives.begin(), equations.derivatives.end(),
                     [](const auto& slope) { return slope.damping.nonZeros() > 0; });
}

VectorXd elastic(const fem::Modes& modes) {
  return modes.angular_frequency.tail(modes.size() - modes.rigid);
}

// Whether every mode moves by itself: nothing couples them, and no moving base, whose force depends on the
// masses asked about, drives them.
bool moves_in_modes(const fem::ParametricSystem& equations, const fem::Modes& modes,
                    const MotionDescription& description) {
  return description.base < 0 && modes.rigid == 0 && equations.system.damping.nonZeros() == 0 &&
         !asks_about_dashpots(equations);
}

// Whether the lowest modes of the mesh tell its motion. A force moves those above, too: the mesh's own
// coordinates know them, but not what happens to the start when shapes change.
bool lowest_show_the_motion(const fem::ParametricSystem& equations, const MotionDescription& description) {
  return description.forces.empty() || !keeps_mode_shapes(equations);
}

// Whether what is asked turns the shapes of a reduction to the lowest modes out of the space that they span
// at the guess.
bool leaves_its_modes(const reduction::Reduction* reduction, const fem::ParametricSystem& equations,
                      const fem::Modes& modes) {
  return reduction && reduction->spans_lowest_modes() && modes.size() < equations.system.size() &&
         !keeps_mode_shapes(equations);
}

// Forces read as outputs, below those observed: phi^T E of a mode.
fem::ParametricSystem with_forces_as_outputs(fem::ParametricSystem equations,
                                             const std::vector<Index>& forces) {
  fem::StructuralSystem& system = equations.system;
  const MatrixXd observed = system.outputs, all = system.inputs;
  MatrixXd rows(observed.rows() + static_cast<Index>(forces.size()), system.size());
  rows << observed, all(Eigen::all, forces).transpose();
  system.outputs = rows.sparseView();
  return equations;
}

FollowingMotion::Equations equations_at(const ModelSetting& setting, const std::vector<Unknown>& properties,
                                        const std::vector<Index>& forces) {
  return [setting, properties, forces](const VectorXd& values) {
    std::vector<Unknown> there = properties;
    for (std::size_t j = 0; j < there.size(); ++j) there[j].guess = values[static_cast<Index>(j)];
    return with_forces_as_outputs(beam_equations(setting, there), forces);
  };
}

void place_unknowns(const StateLayout& places, JointModel& model) {
  for (Index j = 0; j < static_cast<Index>(model.unknowns.size()); ++j)
    model.unknown_places.push_back(places.unknowns + j);
  model.offsets = places.offsets;
}

// What lies between supports whose motion was measured (supported_motion.hpp). Its modes are those with the
// supports at rest; where these move, what is inside follows in static shapes.
std::unique_ptr<JointModel> make_part(const ModelSetting& setting, MotionDescription description,
                                      const std::vector<ParameterChoice>& choices,
                                      std::vector<ParameterDefault>& defaults) {
  if (setting.reduction && !reduce(setting.system, *setting.reduction, setting.training).identity)
    throw std::invalid_argument(
        "a part between supports is identified in its own coordinates; expected [reduction] method = "
        "\"none\"");
  const fem::ParametricSystem equations = beam_equations(setting, properties_of(choices, defaults));
  SupportedEquations part =
      supported_equations(equations, description.forces, setting.supports, description.base);
  const fem::ParametricSystem held = held_at_supports(equations, part);
  const Index inside = part.inside(), n = inside + part.supports;
  const fem::Modes modes = fem::modes(held.system, inside);
  if (modes.rigid > 0)
    throw std::invalid_argument("the part between the supports moves without strain; expected more supports");
  add_damping_defaults(setting.damping, modes.angular_frequency, choices, defaults);
  description.unknowns = unknowns_of(choices, defaults);
  add_drives(equations, description);
  describe_damping(setting.damping, modes.angular_frequency, damped_modes(held, modes), description);

  auto model = std::make_unique<JointModel>();
  model->unknowns = description.unknowns;
  const VectorXd scale = scale_of_modes(held.system, description.observations, modes.shape);
  // Accelerometers do not see where a support was at first, nor how fast: from there any motion x_0 + x_1 t
  // of the supports, what is inside following in static shapes, has no acceleration. It is taken from rest at
  // zero, which then loses nothing.
  const bool sees_supports =
      std::any_of(description.observations.begin(), description.observations.end(),
                  [](const Observation& one) { return reads(one.quantity) != Reads::accelerations; });
  const Index moved = sees_supports ? part.supports : 0;
  MatrixXd shapes = MatrixXd::Zero(n, inside + moved);
  shapes.topLeftCorner(inside, 1) = scale[0] * modes.shape.col(0);
  shapes.topRightCorner(inside, inside - 1) =
      modes.shape.rightCols(inside - 1) * scale.tail(inside - 1).asDiagonal();
  if (moved > 0) {
    shapes.block(0, 1, inside, moved) = -part.stiffness.topLeftCorner(inside, inside)
                                             .ldlt()
                                             .solve(part.stiffness.topRightCorner(inside, moved));
    shapes.block(inside, 1, moved, moved).setIdentity();
  }
  model->mode_shapes = shapes;
  model->mode_frequencies.setConstant(inside + moved, modes.angular_frequency[0]);
  model->mode_frequencies.tail(inside - 1) = modes.angular_frequency.tail(inside - 1);

  VectorXd typical = VectorXd::Constant(n, modes.angular_frequency[0]);
  typical.head(inside) =
      (part.stiffness.diagonal().head(inside).array() / part.mass.diagonal().head(inside).array())
          .cwiseMax(0.0)
          .sqrt()
          .max(modes.angular_frequency[0]);
  const MatrixXd rows = MatrixXd(equations.system.outputs)(Eigen::all, part.coordinates);
  const StateLayout places = layout(description, n);
  model->motion = std::make_shared<SupportedMotion>(std::move(part), std::move(description), rows, typical);
  place_unknowns(places, *model);
  return model;
}

std::unique_ptr<JointModel> make_beam(const ModelSetting& setting, const filters::Options& options) {
  if (!setting.storey_springs.empty()) return make_storeys(setting, options);
  MotionDescription description = describe_sensors("beam", setting, options);
  std::vector<ParameterChoice> choices = choices_of(setting);
  if (!setting.continuum) beam_equations(setting, {});  // says what is missing
  std::vector<ParameterDefault> defaults = beam_defaults(setting.continuum->structure, choices);

  if (!setting.supports.empty()) return make_part(setting, std::move(description), choices, defaults);
  // The equations need no more than the guesses of the beam's own properties.
  const std::vector<Unknown> properties = properties_of(choices, defaults);
  fem::ParametricSystem equations = beam_equations(setting, properties);
  reduction::ReducedModel reduced;
  if (setting.reduction)
    reduced = reduce(equations.system, *setting.reduction, setting.training);
  else
    reduced = {equations.system, {}, true};
  const std::string& coordinates = options.text("coordinates");
  if (coordinates != "modes" && coordinates != "mesh")
    throw std::invalid_argument("coordinates is '" + coordinates + "'; expected modes or mesh");
  const bool in_modes = coordinates == "modes";
  const bool dense = reduced.system.size() <= most_dense || !reduced.identity;
  const double kept = options.number("modes");
  if (!(kept >= 1.0 && kept == std::floor(kept)))
    throw std::invalid_argument(fmt::format("modes is {:g}; expected a whole number of at least 1", kept));
  const fem::Modes modes =
      fem::modes(reduced.system, dense ? reduced.system.size()
                                       : std::min<Index>(static_cast<Index>(kept), reduced.system.size()));

  if (setting.reduction) drop_ratios_above(elastic(modes).size(), choices, defaults);
  add_damping_defaults(setting.damping, elastic(modes), choices, defaults);
  description.unknowns = unknowns_of(choices, defaults);
  add_drives(equations, description);
  auto model = std::make_unique<JointModel>();
  model->unknowns = description.unknowns;
  model->mode_frequencies = modes.angular_frequency;
  fem::Modes on_mesh = modes;
  on_mesh.shape = reduced.lift(modes.shape);
  if (description.base >= 0 && dense && modes.size() < equations.system.size())
    model->moved_share = fem::moved_share(
        equations.system, description.forces[static_cast<std::size_t>(description.base)], on_mesh.shape);
  const VectorXd scale = scale_of_modes(equations.system, description.observations, on_mesh.shape);
  const MatrixXd shapes = on_mesh.shape * scale.asDiagonal();
  const bool follows = moves_in_modes(equations, modes, description) &&
                       (dense ? leaves_its_modes(setting.reduction.get(), equations, modes)
                              : in_modes && lowest_show_the_motion(equations, description));
  StateLayout places;
  if (follows) {
    describe_damping(setting.damping, elastic(modes), damped_modes(equations, on_mesh), description);
    const MatrixXd rows = equations.system.outputs * on_mesh.shape;
    if (modes.size() == 1 && rows(0, 0) != 0.0) model->equivalent_mass = 1.0 / (rows(0, 0) * rows(0, 0));
    model->mode_shapes.setIdentity(modes.size(), modes.size());
    places = layout(description, modes.size());
    const std::vector<Index> forces = description.forces;
    const MatrixXd reading = with_forces_as_outputs(equations, forces).system.outputs * on_mesh.shape;
    model->motion =
        std::make_shared<FollowingMotion>(equations_at(setting, properties, forces), std::move(description),
                                          modes.angular_frequency, reading, scale);
  } else if (dense) {
    ReducedEquations small = on_shapes(equations, shapes, modes.angular_frequency, description.forces);
    describe_damping(setting.damping, elastic(modes), damped_modes(small), description);
    const MatrixXd rows = equations.system.outputs * shapes;
    if (modes.size() == 1 && rows(0, 0) != 0.0)
      model->equivalent_mass = small.mass[0] / (rows(0, 0) * rows(0, 0));
    model->mode_shapes.setIdentity(modes.size(), modes.size());
    places = layout(description, modes.size());
    model->motion = std::make_shared<ReducedMotion>(std::move(small), std::move(description), rows, "mode");
  } else {
    describe_damping(setting.damping, elastic(modes), damped_modes(equations, modes), description);
    model->mode_shapes = shapes;
    places = layout(description, equations.system.size());
    model->motion = std::make_shared<ContinuumMotion>(std::move(equations), std::move(description));
  }
  place_unknowns(places, *model);
  return model;
}

std::vector<filters::OptionSpec> beam_model_options() {
  std::vector<filters::OptionSpec> specs = sensor_options();
  specs.push_back(
      {"coordinates", std::string("modes"), "",
       "of a mesh that is not reduced: modes, its lowest ones, where no parameter couples them; or mesh"});
  specs.push_back(
      {"modes", 8.0, "", "of a mesh that is not reduced: how many modes its start is in, and are damped"});
  return specs;
}

const bool beam_registered = model_registry().add(
    {"beam",
     "the structure itself, beam, chain, frame or system: stiffness, masses, root, axial "
     "load, factors and damping unknown, as [[parameters]] requests",
     "[rayleigh1877]",
     beam_model_options(),
     {},
     make_beam});

}  // namespace
}  // namespace beamid::experiments
