// The modal analysis of records, as a user sees it.
#pragma once

#include <string>
#include <vector>

#include "experiments/modal/study/merged_modes.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Sections for each record, then one for all of them where there are several; figures, results.json.
Results report(const ModalStudySettings& settings, const std::vector<RecordModes>& records);

/// Stabilisation diagram, measured and reproduced motion and spectrum, singular values; `suffix` of names.
std::vector<Figure> figures(const RecordModes& found, const std::string& suffix);

/// Poles that are no modes, and why.
nlohmann::ordered_json rejected_values(const Stabilisation& stabilisation);

/// The keys of results.json.
nlohmann::ordered_json values(const std::vector<RecordModes>& records, const std::vector<MergedMode>& merged);
nlohmann::ordered_json configuration(const ModalStudySettings& settings,
                                     const std::vector<RecordModes>& records);

// How frequency and damping ratio depend on amplitude, as a user sees it.

/// A table `amplitude` (a few points of every mode of every record), a figure `amplitude_dependence` (all of
/// them, the records of a mode together, six modes at most), and all points under `amplitude_dependence`.
///
/// Amplitudes are those of the channel in which the mode is largest beside the channel's own size.
/// @throws std::invalid_argument when a record was not taken for a free decay.
void add_amplitude(const std::vector<RecordModes>& records, const std::vector<MergedMode>& merged,
                   Results& results);

}  // namespace beamid::experiments
