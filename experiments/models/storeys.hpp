// A chain whose storeys follow laws, as model `beam` makes it.
#pragma once

#include <memory>

#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

/// In the displacements of the floors (storey_motion.hpp), asked about whatever the linear chain may be, and
/// about the parameters of the laws; a region says of which storeys, which then share one value. Without
/// [[parameters]] about all storeys' stiffness, one damping ratio and every parameter of every law.
/// @param options of model `beam`
/// @throws std::invalid_argument, or an InputError at a choice's place, when the structure is no chain or is
/// reduced, supports move, a storey is none of the chain's, or a choice finds no law with its quantity.
std::unique_ptr<JointModel> make_storeys(const ModelSetting& setting, const filters::Options& options);

/// Law and parameter (from 0, of SpringLaw::parameters()) of the storeys that a choice means.
struct LawPlace {
  std::size_t spring = 0;  ///< among the setting's
  std::size_t parameter = 0;
};
/// @param region [m]; absent: all storeys
std::vector<LawPlace> law_places(const fem::Beam& chain, const std::vector<StoreySpring>& springs,
                                 const std::string& quantity,
                                 const std::optional<std::pair<double, double>>& region);

/// The value that all of these storeys have as described; nothing where there are none, or they differ.
std::optional<double> law_value(const fem::Beam& chain, const std::vector<StoreySpring>& springs,
                                const std::string& quantity,
                                const std::optional<std::pair<double, double>>& region);

}  // namespace beamid::experiments
