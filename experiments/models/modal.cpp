// The modes of a reduced model, their frequencies and damping ratios unknown:
//
//     z_i'' + 2 xi_i omega_i z_i' + omega_i^2 z_i = phi_i^T E f / m_i,    y = sum_i (h phi_i) z_i
//
// The participation, shapes phi_i and modal masses m_i, is that of the model at the guess. Every mode is
// scaled to 1 at the output where it is largest, so that z_i is its displacement there [m].
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/models/motion/parametric_motion.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

constexpr double frequency_uncertainty = 0.15;  // as much as 30 % of the stiffness
constexpr double modal_damping_uncertainty = 1.0, usual_modal_ratio = 0.01;
constexpr Index most_modal_modes = 100;

// What drives omega and xi of every mode: an unknown, or -1 and a value.
struct ModePrior {
  VectorXd frequencies, ratios;  // (r) [rad/s], [-]
  std::vector<Index> frequency_unknown, ratio_unknown;
};

class ModalModelMotion final : public SecondOrderMotion {
 public:
  ModalModelMotion(ModePrior estimate, MatrixXd inputs, MotionDescription description, MatrixXd rows)
      : SecondOrderMotion(std::move(description), std::move(rows), "mode"),
        estimate_(std::move(estimate)),
        inputs_(std::move(inputs)) {}

  void evaluate(const VectorXd& state, SecondOrderForm& form,
                std::vector<SecondOrderForm>* slopes) const override {
    const Index r = estimate_.frequencies.size();
    const auto& unknowns = description().unknowns;
    form.stiffness.setZero(r, r);
    form.damping.setZero(r, r);
    form.inputs = inputs_;
    if (slopes) {
      slopes->resize(unknowns.size());
      for (SecondOrderForm& slope : *slopes) {
        slope.stiffness.setZero(r, r);
        slope.damping.setZero(r, r);
        slope.inputs.setZero(r, inputs_.cols());
      }
    }
    const auto value = [&](Index unknown, double fixed, double unit) {
      return unknown < 0 ? fixed
                         : unit * unknowns[static_cast<std::size_t>(unknown)].to_physical(
                                      state[layout().unknowns + unknown]);
    };
    const auto slope = [&](Index unknown) {
      return unknowns[static_cast<std::size_t>(unknown)].slope(state[layout().unknowns + unknown]);
    };
    for (Index i = 0; i < r; ++i) {
      const Index of_frequency = estimate_.frequency_unknown[static_cast<std::size_t>(i)];
      const Index of_ratio = estimate_.ratio_unknown[static_cast<std::size_t>(i)];
      const double omega = value(of_frequency, estimate_.frequencies[i], 2.0 * pi);
      const double ratio = value(of_ratio, estimate_.ratios[i], 1.0);
      form.stiffness(i, i) = omega * omega;
      form.damping(i, i) = 2.0 * ratio * omega;
      if (!slopes) continue;
      if (of_frequency >= 0) {
        SecondOrderForm& by = (*slopes)[static_cast<std::size_t>(of_frequency)];
        by.stiffness(i, i) = 4.0 * pi * omega * slope(of_frequency);
        by.damping(i, i) = 4.0 * pi * ratio * slope(of_frequency);
      }
      if (of_ratio >= 0)
        (*slopes)[static_cast<std::size_t>(of_ratio)].damping(i, i) = 2.0 * omega * slope(of_ratio);
    }
  }
  bool decoupled() const override { return true; }
  VectorXd frequencies() const override { return estimate_.frequencies; }

 private:
  ModePrior estimate_;
  MatrixXd inputs_;  // phi_i^T E / m_i (r x m)

  std::shared_ptr<const SecondOrderMotion> copy() const override {
    return std::make_shared<ModalModelMotion>(*this);
  }
};

// Both numbers of every mode, unless the setting asks for some of them.
std::vector<ParameterChoice> choices_of(const ModelSetting& setting, Index modes) {
  for (const ParameterChoice& choice : setting.parameters) {
    require_quantity(choice, {"frequency", "damping_ratio"}, "modal");
    if (choice.quantity == "frequency" && !choice.mode)
      refuse(choice, "frequency without a mode; expected mode, from 1");
    if (choice.mode && (*choice.mode < 1 || *choice.mode > modes))
      refuse(choice, fmt::format("{} of mode {}; expected one of the model's {} modes", choice.quantity,
                                 *choice.mode, modes));
  }
  if (!setting.parameters.empty()) return setting.parameters;
  std::vector<ParameterChoice> choices;
  for (int mode = 1; mode <= modes; ++mode)
    for (const char* quantity : {"frequency", "damping_ratio"}) {
      choices.push_back({quantity});
      choices.back().mode = mode;
    }
  return choices;
}

// The law's ratios and what the dashpots add.
VectorXd ratios_of(const ModelSetting& setting, const fem::StructuralSystem& system,
                   const fem::Modes& modes) {
  VectorXd ratios = std::holds_alternative<fem::Undamped>(setting.damping)
                        ? VectorXd::Constant(modes.size(), usual_modal_ratio)
                        : fem::damping_ratios(setting.damping, modes.angular_frequency);
  for (Index i = 0; i < modes.size(); ++i)
    ratios[i] +=
        0.5 * modes.shape.col(i).dot(system.damping * modes.shape.col(i)) / modes.angular_frequency[i];
  return ratios;
}

std::unique_ptr<JointModel> make_modal(const ModelSetting& setting, const filters::Options& options) {
  MotionDescription description = describe_sensors("modal", setting, options);
  require_no_supports("modal", setting);
  const reduction::ReducedModel small = reduced(setting);
  const double wanted = options.number("modes");
  const Index all = small.system.size();
  const Index count = wanted > 0.0 ? static_cast<Index>(wanted) : all;
  if (!(wanted >= 0.0 && wanted == std::floor(wanted)) || count > std::min(all, most_modal_modes))
    throw std::invalid_argument(
        fmt::format("model 'modal': {:g} modes of {} coordinates; expected 1 to {}, or fewer coordinates",
                    wanted, all, std::min(all, most_modal_modes)));
  fem::Modes modes = fem::modes(small.system, count);
  if (modes.rigid > 0)
    throw std::invalid_argument(
        "model 'modal' needs a structure that is held; this one moves without strain");
  const std::vector<ParameterChoice> choices = choices_of(setting, count);
  ModePrior estimate{modes.angular_frequency, ratios_of(setting, small.system, modes),
                     std::vector<Index>(static_cast<std::size_t>(count), -1),
                     std::vector<Index>(static_cast<std::size_t>(count), -1)};
  std::vector<ParameterDefault> defaults;
  for (const ParameterChoice& choice : choices) {
    const Index mode = choice.mode.value_or(1) - 1;
    defaults.push_back(choice.quantity == "frequency"
                           ? ParameterDefault{0.5 * estimate.frequencies[mode] / pi, frequency_uncertainty}
                           : ParameterDefault{estimate.ratios[mode], modal_damping_uncertainty});
  }
  description.unknowns = unknowns_of(choices, defaults);
  for (std::size_t j = 0; j < choices.size(); ++j)
    for (Index i = 0; i < count; ++i) {
      auto& driven = choices[j].quantity == "frequency" ? estimate.frequency_unknown : estimate.ratio_unknown;
      Index& unknown = driven[static_cast<std::size_t>(i)];
      const bool its_own = choices[j].mode && *choices[j].mode == i + 1;
      if (its_own || (!choices[j].mode && unknown < 0)) unknown = static_cast<Index>(j);
    }

  auto model = std::make_unique<JointModel>();
  model->unknowns = description.unknowns;
  model->mode_frequencies = modes.angular_frequency;
  model->mode_shapes.setIdentity(count, count);
  const VectorXd scale = scale_of_modes(setting.system, setting.observations, small.lift(modes.shape));
  const MatrixXd shapes = modes.shape * scale.asDiagonal();
  const MatrixXd rows = small.system.outputs * shapes;
  const MatrixXd forces = shapes.transpose() * small.system.inputs;
  const VectorXd inverse_mass = scale.cwiseAbs2().cwiseInverse();
  const MatrixXd inputs = inverse_mass.asDiagonal() * MatrixXd(forces(Eigen::all, description.forces));
  if (count == 1 && rows(0, 0) != 0.0)
    model->equivalent_mass = scale[0] * scale[0] / (rows(0, 0) * rows(0, 0));
  const StateLayout places = layout(description, count);
  for (Index j = 0; j < static_cast<Index>(model->unknowns.size()); ++j)
    model->unknown_places.push_back(places.unknowns + j);
  model->offsets = places.offsets;
  model->motion =
      std::make_shared<ModalModelMotion>(std::move(estimate), inputs, std::move(description), rows);
  return model;
}

std::vector<filters::OptionSpec> modal_options() {
  std::vector<filters::OptionSpec> specs = sensor_options();
  specs.push_back({"modes", 0.0, "", "the lowest so many modes of the reduced model; 0: all"});
  return specs;
}

const bool modal_registered =
    model_registry().add({"modal",
                          "modes with unknown frequency and damping ratio each, participation from the model",
                          "[rayleigh1877]",
                          modal_options(),
                          {},
                          make_modal});

}  // namespace
}  // namespace beamid::experiments
