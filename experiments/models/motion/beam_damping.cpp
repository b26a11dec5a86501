#include "experiments/models/motion/beam_damping.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

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

}  // namespace beamid::experiments
