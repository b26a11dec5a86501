// Updated parameters as a user sees them.
#pragma once

#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/update/update_study.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Verdict, parameters, sets, modes, what would decide; a figure; results.json.
Results report(const Experiment& experiment, const UpdateStudy& study);

/// What the modes say in one sentence, and whether it is good news.
std::pair<std::string, bool> update_verdict(const UpdateStudy& study);
/// "6 sets of parameters explain these modes equally well"
std::string sets_text(const Updating& updating);
/// Where several stiffnesses are asked about: how many sets of them have the frequencies of the structure as
/// described; empty where it is the only one, where the parameters are too many to look, or not stiffnesses.
std::string twins_warning(const Experiment& experiment);
/// What else there is to say, a sentence each.
std::vector<std::string> update_sentences(const UpdateStudy& study);
/// What no interval counts: all that is not asked about.
std::string described_text();
/// "storey_stiffness_1 up by 1 % with storey_stiffness_2 down by 0.8 %"
std::string direction_text(const UpdateStudy& study, const OpenDirection& direction);
/// Whether the list of sets can lack one.
std::string completeness_text(const UpdateStudy& study);
/// "a second sensor at 3 m, mode 2: ..."
std::string deciding_text(const DecidingMeasurement& one);

Table parameter_table(const UpdateStudy& study);
/// A column for each set, parameters in rows; `most` sets. @param all with those that do not fit as well
Table set_table(const UpdateStudy& study, std::size_t most, bool all);
Table measured_mode_table(const UpdateStudy& study);
Table deciding_table(const std::vector<DecidingMeasurement>& deciding);
/// A click on a set shows its values, and its lowest mode swings.
Figure update_figure(const UpdateStudy& study, const std::string& name);
/// The modes measured, of the structure as described and of every set in the figure, 12 at most, as
/// modes.glb; nothing for a structure without a mesh.
void add_swinging_modes(const UpdateStudy& study, Results& results);
nlohmann::ordered_json update_values(const UpdateStudy& study);
/// Title, trust, starts.
nlohmann::ordered_json update_configuration(const Experiment& experiment, const UpdateStudy& study);

}  // namespace beamid::experiments
