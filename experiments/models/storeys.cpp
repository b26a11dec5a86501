#include "experiments/models/storeys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/models/motion/parametric_motion.hpp"
#include "experiments/models/motion/storey_motion.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double law_uncertainty = 1.0;  // of the value described

std::unique_ptr<SpringLaw> spring_law_of(const StoreySpring& spring) {
  return spring_law_registry().make(spring.law.name, spring.law.options);
}

// Heights of the floors below and above a storey.
std::pair<double, double> heights_of(const fem::Beam& chain, int storey) {
  double below = 0.0;
  for (int i = 1; i < storey; ++i) below += chain.segments[static_cast<std::size_t>(i) - 1].length;
  return {below, below + chain.segments[static_cast<std::size_t>(storey) - 1].length};
}

void require_chain(const ModelSetting& setting) {
  if (!setting.continuum || !setting.continuum->structure.is_chain())
    throw std::invalid_argument("springs of storeys without a chain; expected [chain]");
  if (!setting.supports.empty())
    throw std::invalid_argument(
        "a part of a chain whose storeys follow laws is not identified between supports; expected the whole "
        "chain, or storeys without a law");
  if (setting.reduction && !reduce(setting.system, *setting.reduction, setting.training).identity)
    throw std::invalid_argument(
        "a chain whose storeys follow laws is not reduced; expected [reduction] method = \"none\"");
  const auto floors = setting.continuum->structure.beam().segments.size();
  for (const StoreySpring& spring : setting.storey_springs)
    if (spring.storey < 1 || spring.storey > static_cast<int>(floors))
      throw std::invalid_argument(fmt::format("storey {} of a chain of {}", spring.storey, floors));
}

bool is_of_laws(const std::string& quantity) {
  for (const auto& [name, entry] : spring_law_registry().entries())
    for (const SpringParameter& parameter : spring_law_registry().make(name, {})->parameters())
      if (parameter.quantity.name == quantity) return true;
  return false;
}

std::vector<ParameterChoice> own_storey_choices(const ModelSetting& setting) {
  std::vector<ParameterChoice> choices{{"storey_stiffness"}, {"damping_ratio"}};
  for (const StoreySpring& spring : setting.storey_springs)
    for (const SpringParameter& parameter : spring_law_of(spring)->parameters()) {
      ParameterChoice choice{parameter.quantity.name};
      choice.region = heights_of(setting.continuum->structure.beam(), spring.storey);
      choices.push_back(choice);
    }
  return choices;
}

// Floors from the lowest up: their places among the coordinates.
std::vector<Index> floors_of(const fem::StructuralSystem& system) {
  std::vector<Index> floors(system.coordinates.size());
  std::iota(floors.begin(), floors.end(), Index{0});
  std::sort(floors.begin(), floors.end(), [&](Index a, Index b) {
    return system.coordinates[static_cast<std::size_t>(a)].position <
           system.coordinates[static_cast<std::size_t>(b)].position;
  });
  return floors;
}

// b of storey s (from 1): its upper floor against the lower one.
VectorXd drift_of(const std::vector<Index>& floors, int storey) {
  VectorXd drift = VectorXd::Zero(static_cast<Index>(floors.size()));
  drift[floors[static_cast<std::size_t>(storey) - 1]] = 1.0;
  if (storey > 1) drift[floors[static_cast<std::size_t>(storey) - 2]] = -1.0;
  return drift;
}

// All floors from this storey up: no other storey drifts.
VectorXd moved_above(const std::vector<Index>& floors, int storey) {
  VectorXd moved = VectorXd::Zero(static_cast<Index>(floors.size()));
  for (std::size_t i = static_cast<std::size_t>(storey) - 1; i < floors.size(); ++i) moved[floors[i]] = 1.0;
  return moved;
}

LawStorey storey_of(const StoreySpring& spring, const fem::ParametricSystem& equations,
                    const std::vector<Index>& floors) {
  LawStorey storey;
  storey.number = spring.storey;
  storey.law = spring_law_of(spring);
  storey.drift = drift_of(floors, spring.storey);
  const VectorXd moved = moved_above(floors, spring.storey);
  storey.stiffness = moved.dot(equations.system.stiffness.assembled() * moved);
  storey.stiffness_slopes.resize(static_cast<Index>(equations.derivatives.size()));
  const VectorXd strains = equations.strain * moved;
  for (Index j = 0; j < storey.stiffness_slopes.size(); ++j)
    storey.stiffness_slopes[j] =
        strains.dot(equations.derivatives[static_cast<std::size_t>(j)].rigidity * strains);
  storey.parameters = spring_parameters(*storey.law, storey.stiffness);
  storey.unknowns.assign(static_cast<std::size_t>(storey.parameters.size()) - 1, -1);
  return storey;
}

// A force along b of each storey, as inputs behind the system's own.
fem::ParametricSystem with_storey_forces(fem::ParametricSystem equations,
                                         const std::vector<LawStorey>& storeys) {
  const auto widened = [&](const fem::SparseMatrix& inputs, bool along) {
    MatrixXd all = MatrixXd::Zero(inputs.rows(), inputs.cols() + static_cast<Index>(storeys.size()));
    all.leftCols(inputs.cols()) = MatrixXd(inputs);
    for (std::size_t s = 0; along && s < storeys.size(); ++s)
      all.col(inputs.cols() + static_cast<Index>(s)) = storeys[s].drift;
    return fem::SparseMatrix(all.sparseView());
  };
  equations.system.inputs = widened(equations.system.inputs, true);
  for (auto& slope : equations.derivatives) slope.inputs = widened(slope.inputs, false);
  return equations;
}

void require_law(const ParameterChoice& choice, const fem::Beam& chain,
                 const std::vector<StoreySpring>& springs) {
  if (!law_places(chain, springs, choice.quantity, choice.region).empty()) return;
  refuse(choice,
         fmt::format("no storey{} has a law with {}; expected [[chain.storeys]] with one, or from_m and "
                     "to_m around such a storey",
                     choice.region ? fmt::format(" between {:g} and {:g} m", choice.region->first,
                                                 choice.region->second)
                                   : "",
                     choice.quantity));
}

ParameterDefault law_default(const ParameterChoice& choice, const fem::Beam& chain,
                             const std::vector<StoreySpring>& springs) {
  require_law(choice, chain, springs);
  const auto value = law_value(chain, springs, choice.quantity, choice.region);
  if (!value && !choice.guess)
    refuse(choice, "the storeys that share " + choice.quantity +
                       " have several values of it; expected from_m and to_m around one, or a guess");
  return {value.value_or(0.0), law_uncertainty};
}

}  // namespace

std::vector<LawPlace> law_places(const fem::Beam& chain, const std::vector<StoreySpring>& springs,
                                 const std::string& quantity,
                                 const std::optional<std::pair<double, double>>& region) {
  std::vector<LawPlace> places;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const auto [below, above] = heights_of(chain, springs[i].storey);
    const double middle = 0.5 * (below + above);
    if (region && !(region->first < middle && middle < region->second)) continue;
    const std::vector<SpringParameter> parameters = spring_law_of(springs[i])->parameters();
    for (std::size_t j = 0; j < parameters.size(); ++j)
      if (parameters[j].quantity.name == quantity) places.push_back({i, j});
  }
  return places;
}

std::optional<double> law_value(const fem::Beam& chain, const std::vector<StoreySpring>& springs,
                                const std::string& quantity,
                                const std::optional<std::pair<double, double>>& region) {
  std::optional<double> value;
  for (const LawPlace& place : law_places(chain, springs, quantity, region)) {
    const double one = spring_law_of(springs[place.spring])->parameters()[place.parameter].value;
    if (value && *value != one) return {};
    value = one;
  }
  return value;
}

std::unique_ptr<JointModel> make_storeys(const ModelSetting& setting, const filters::Options& options) {
  require_chain(setting);
  const fem::Beam& chain = setting.continuum->structure.beam();
  const std::vector<StoreySpring>& springs = setting.storey_springs;
  MotionDescription description = describe_sensors("beam", setting, options);
  const std::vector<ParameterChoice> choices =
      setting.parameters.empty() ? own_storey_choices(setting) : setting.parameters;

  std::vector<ParameterChoice> linear;
  for (const ParameterChoice& choice : choices)
    if (!is_of_laws(choice.quantity)) {
      require_quantity(choice, structure_quantities(), "beam");
      linear.push_back(choice);
    }
  std::vector<ParameterDefault> defaults = beam_defaults(setting.continuum->structure, linear);
  const fem::ParametricSystem asked = beam_equations(setting, properties_of(linear, defaults));
  const Index n = asked.system.size(), own_inputs = asked.system.inputs.cols();
  const fem::Modes modes = fem::modes(asked.system, n);
  add_damping_defaults(setting.damping, modes.angular_frequency, linear, defaults);

  // All together, so that names and regions are checked in the order of the file.
  std::vector<ParameterDefault> all_defaults;
  std::size_t next = 0;
  for (const ParameterChoice& choice : choices)
    all_defaults.push_back(is_of_laws(choice.quantity) ? law_default(choice, chain, springs)
                                                       : defaults[next++]);
  const std::vector<Unknown> unknowns = unknowns_of(choices, all_defaults);

  const std::vector<Index> floors = floors_of(asked.system);
  std::vector<LawStorey> storeys;
  for (const StoreySpring& spring : springs) storeys.push_back(storey_of(spring, asked, floors));
  std::vector<Unknown> of_laws;
  std::vector<std::pair<bool, Index>> numbers;  // of each unknown: of a law?, its number among these
  for (const Unknown& unknown : unknowns) {
    const bool law = is_of_laws(unknown.quantity);
    std::vector<Unknown>& list = law ? of_laws : description.unknowns;
    numbers.emplace_back(law, static_cast<Index>(list.size()));
    list.push_back(unknown);
    if (law)
      for (const LawPlace& place : law_places(chain, springs, unknown.quantity, unknown.region))
        storeys[place.spring].unknowns[place.parameter] = numbers.back().second;
  }

  const fem::ParametricSystem equations = with_storey_forces(asked, storeys);
  for (Index s = 0; s < static_cast<Index>(storeys.size()); ++s) description.forces.push_back(own_inputs + s);
  description.carried.conservativeResize(Eigen::NoChange, static_cast<Index>(description.forces.size()));
  description.carried.rightCols(static_cast<Index>(storeys.size())).setZero();
  add_drives(equations, description);
  ReducedEquations small = on_shapes(equations, modes.shape, modes.angular_frequency, description.forces);
  describe_damping(setting.damping, modes.angular_frequency, damped_modes(small), description);

  auto model = std::make_unique<JointModel>();
  model->unknowns = unknowns;
  model->mode_frequencies = modes.angular_frequency;
  model->mode_shapes =
      modes.shape * scale_of_modes(asked.system, description.observations, modes.shape).asDiagonal();
  const MatrixXd rows = asked.system.outputs;
  if (n == 1 && rows(0, 0) != 0.0)
    model->equivalent_mass = asked.system.mass.coeff(0, 0) / (rows(0, 0) * rows(0, 0));
  auto in_modes =
      std::make_shared<ReducedMotion>(std::move(small), std::move(description), rows * modes.shape, "mode");
  auto motion =
      std::make_shared<StoreyMotion>(std::make_shared<FloorMotion>(std::move(in_modes), modes.shape, rows),
                                     std::move(storeys), std::move(of_laws));
  for (const auto& [law, number] : numbers)
    model->unknown_places.push_back((law ? motion->law_unknowns_at() : motion->floors().layout().unknowns) +
                                    number);
  model->offsets = motion->floors().layout().offsets;
  for (Index t = 0; t < motion->slips(); ++t) model->slips.push_back(motion->slips_at() + t);
  model->motion = std::move(motion);
  return model;
}

}  // namespace beamid::experiments
