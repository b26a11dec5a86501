// The modal analysis of records, as a user sees it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/modal/study/merged_modes.hpp"
#include "experiments/results/page/swing_model.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Sections for each record, then one for all of them where there are several; figures, results.json.
Results report(const ModalStudySettings& settings, const std::vector<RecordModes>& records);

/// Stabilisation diagram, measured and reproduced motion and spectrum, singular values; `suffix` of names.
std::vector<Figure> figures(const RecordModes& found, const std::string& suffix);

/// Measured mode shapes, with their phases, on a sketch: the sensors in a line, each moving across it. Absent
/// for one channel, for strain, and where channels measure different quantities.
std::optional<SwingModel> measured_shapes(const RecordModes& found);

/// Poles that are no modes, and why.
nlohmann::ordered_json rejected_values(const Stabilisation& stabilisation);

/// The keys of results.json.
nlohmann::ordered_json values(const std::vector<RecordModes>& records, const std::vector<MergedMode>& merged);
nlohmann::ordered_json configuration(const ModalStudySettings& settings,
                                     const std::vector<RecordModes>& records);

}  // namespace beamid::experiments
