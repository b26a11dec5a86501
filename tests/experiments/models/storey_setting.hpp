// A chain whose storeys follow laws, as models are made of it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/models/joint_model.hpp"
#include "fem/shear_building.hpp"

namespace beamid::test {

experiments::StoreySpring spring(int storey, const std::string& law, const filters::Options& options);

/// alpha 0.3, beta 60 /m, gamma 25 /m.
extern const filters::Options bouc_wen;

/// Three floors on storeys of 400, 320 and 240 kN/m, 3 m high each, with dashpots.
extern const fem::Storeys three;

/// Every floor's displacement, then velocity, then acceleration is observed; the top is pushed, the base
/// moves.
experiments::ModelSetting setting_of(const fem::Storeys& storeys,
                                     const std::vector<experiments::StoreySpring>& springs);

experiments::ParameterChoice asked(const std::string& quantity,
                                   std::optional<std::pair<double, double>> region = {});

}  // namespace beamid::test
