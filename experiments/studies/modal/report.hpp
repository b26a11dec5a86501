// The modes of a driven record, as a user sees them.
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/modal/study/driven_study.hpp"
#include "experiments/modal/study/hammer_study.hpp"
#include "experiments/modal/study/mode_objections.hpp"
#include "experiments/modal/universal_modes.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/page/swing_model.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

// Modal masses from a hammer's impulse, as a user sees them.

/// A table `hammer_mass` and `hammer_mass` of results.json, one row for each mode and record:
/// hammer_study.hpp. Nothing where no record has a force with a hit.
/// @param rates of the modes of each record [rad/s]
/// @param coarse_reported whether hits of few samples have their warning already
void add_masses(const std::vector<std::string>& names, const std::vector<Record>& records,
                const std::vector<std::vector<std::complex<double>>>& rates, Results& results,
                bool coarse_reported = false);

/// A section for each record; figures, results.json.
Results report(const ModalStudySettings& settings, const std::vector<DrivenStudy>& studies);

// A column of soil, or a building, in one earthquake after the other.

/// f1 and xi of every record (modal/base_response.hpp) beside its peak acceleration: a table `events`, and a
/// figure `events` of both over the peak.
///
/// Of several accelerometers the last one counts: of files with a surface and a borehole the surface.
/// @throws std::invalid_argument where a record has no base_acceleration or no acceleration, beginning with
/// its name.
Results event_report(const std::vector<std::string>& names, const std::vector<Record>& records,
                     const std::optional<std::pair<double, double>>& band_hz);

// A hammer test as text, tables, figures and JSON.

/// As a user sees it: modes with modal masses, responses with what the modes make of them, coherence.
Results report(const ModalStudySettings& settings, const HammerStudy& study);

// The modal analysis of records, as a user sees it.

/// Sections for each record, then one for all of them where there are several; figures, results.json.
Results report(const ModalStudySettings& settings, const std::vector<RecordModes>& records);

/// The poles of one stability as points of a diagram; a click on one shows its damping ratio, what is known
/// of its standard deviations, and its shape where there are two channels at least.
void add_poles(Panel& panel, const std::vector<DiagramPole>& poles, Stability stability,
               const std::string& label);

/// Names of the channels of shapes in a panel, and their places along a line where all measure one quantity.
void add_channels(Panel& panel, const std::vector<Channel>& channels);

/// Stabilisation diagram, measured and reproduced motion and spectrum, singular values; `suffix` of names.
std::vector<Figure> figures(const RecordModes& found, const std::string& suffix);

/// Measured mode shapes, with their phases, on a sketch: a node for each channel, in their order on a line,
/// moving across it along z. Absent for one channel, for strain, and where channels measure different
/// quantities.
std::optional<NodalModes> measured_shapes(const RecordModes& found);

/// The same as a model that swings: nodes, and the lines between them.
SwingModel swing_model(const NodalModes& modes);

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
