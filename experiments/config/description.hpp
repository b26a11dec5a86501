// How the commands on the beam itself say what they worked on.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/config/experiment.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

// What an experiment file comes to, as results.json keeps it.

/// The keys of the file, of what the command line set, and the defaults of every table that stands once, by
/// the names and in the order of docs/configuration.md: written as TOML they are the same experiment. A
/// default that is worked out from other values is left out, and so are those of tables in arrays.
/// @param also tables whose defaults hold though the file does not have them
nlohmann::ordered_json effective_keys(const TomlTable& root, const std::vector<std::string>& also = {});

/// Those of an experiment's file, with the methods, their options' defaults and the window that were chosen
/// since; nothing where it was read from none.
nlohmann::ordered_json effective_keys(const Experiment& experiment,
                                      const std::vector<std::string>& also = {});

/// The name of a method under a key of its table, and its options.
nlohmann::ordered_json keys_of(const Choice& choice, const char* key);

/// The beam in a sentence or two: length, stiffness, masses, what holds it, mesh.
std::string beam_text(const fem::Beam& beam, int elements, Eigen::Index coordinates);

/// E I [N m2]: "228.96", or "28.62 to 228.96" where it varies.
std::string bending_stiffness_text(const fem::Beam& beam);

/// "rayleigh", "modal and dashpots", "dashpots".
std::string damping_text(const fem::DampingLaw& law, const fem::StructuralSystem& system);

/// With which "configuration" begins: a title, under "experiment" the keys of the file as they hold, under
/// "structure" what they come to.
/// @param also tables whose defaults hold though the file does not have them
nlohmann::ordered_json describe(const Experiment& experiment, const std::vector<std::string>& also = {});

/// A number, or null where there is none.
nlohmann::ordered_json number_or_null(double value);

/// Above so many elements pictures show the same beam with as many.
inline constexpr int most_drawn_elements = 2000;

}  // namespace beamid::experiments
