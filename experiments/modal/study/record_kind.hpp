// What a record is, which part of it a modal analysis can use, and which method suits it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/record/record.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {

/// Whether its only input is a force that rests but for two hits of a hammer or more: four fifths of its
/// samples below a twentieth of its largest.
bool is_struck(const Record& record);

/// Whether an input was measured, of a base or a force, that acts for a part of the record: a thirtieth of
/// its samples above a twentieth of its largest. A single hit does not; pulses of a base do.
bool is_driven(const Record& record);

/// The channel of motion that moves most, of those that measure what the first does, goes before the others:
/// a command that follows one channel follows it, which a remark states.
void put_strongest_first(Record& record);

// The lines of a record, those of its first moments included.

struct RecordLine {
  double frequency_hz = 0;
  double resolution_hz = 0;  ///< two resolutions of the window that shows it
  double share = 0;          ///< of the strongest line of that window
};

/// Root mean square of all channels of a channel's quantity, for each channel (p).
Eigen::VectorXd scales_of(const Record& record);

/// Lines of a free decay (samples p x N, channels of about the same size) by rising frequency: of the whole
/// record and of its first quarter, sixteenth, ... down to 128 samples. A mode that has died out after a
/// tenth of the record is averaged away in the whole, and clear in the beginning. A line has a fiftieth of
/// the strongest one's amplitude in its window and lies 6 times above the noise around it
/// (mode_by_mode.hpp).
std::vector<RecordLine> record_lines(const Eigen::MatrixXd& samples, double interval);

/// "22.8 and 65.74 Hz"; of more than 6 the first and how many there are.
std::string frequencies_text(const std::vector<double>& frequencies_hz);

// Where in frequency the modes of a record lie.

/// From 2 cycles in the record (samples p x N) to 1.3 times the highest frequency at which a channel's
/// spectrum reaches a twentieth of its peak [Hz], at most 0.45 of the sampling rate.
std::pair<double, double> signal_band(const Eigen::MatrixXd& samples, double interval);

/// The same of a free decay: at least to 1.3 times its highest line, however soon that dies out.
std::pair<double, double> decay_band(const Eigen::MatrixXd& samples, double interval,
                                     const std::vector<RecordLine>& lines);

/// @throws std::invalid_argument unless 0 <= from < to < half the sampling rate, with 2 cycles of `to` in the
/// record.
void check_band(std::pair<double, double> band_hz, double interval, Eigen::Index count);

// Poles of a wide band, searched at several sampling rates.

/// A record decimated for a band.
struct CoarseRecord {
  Eigen::MatrixXd samples;  ///< (p x M)
  DecimatedSignal last;     ///< of the last channel: interval, start and response are those of all
};

/// As far as the band up to `highest_hz` (0.3 of the new rate, untouched by the low-pass) and 100 samples
/// allow.
CoarseRecord coarse_record(const Record& record, double highest_hz);

/// Sets found.search, found.stabilisation and the modes of found.band_hz: the poles that stay where they are
/// over the orders.
///
/// A realisation sees as many samples as its matrix has rows: at the rate that the highest mode asks for, a
/// mode of a twentieth of its frequency does not even complete a cycle in them. Where a line lies below an
/// eighth of the band's top, what lies below is therefore searched anew at a rate of its own, and so on; each
/// level answers for its own part of the band.
/// @param finest decimated for the whole band
void search_levels(const ModalMethod& method, const ModalStudySettings& settings,
                   const Eigen::VectorXd& scales, const std::vector<RecordLine>& lines,
                   const CoarseRecord& finest, RecordModes& found);

// The part of a record that a modal analysis can use.

/// Samples begin ... begin + count - 1.
Record part_of(const Record& record, Eigen::Index begin, Eigen::Index count);

/// Channels that move: forces are no response.
/// @throws std::invalid_argument when there is none.
Record motion_of(const Record& record);

/// The longest part in which every channel has all its readings (missing ones, NaN, are those of a clipped
/// sensor or a drop-out); what was left out is a sentence of `remarks`.
/// @throws std::invalid_argument when no part has 64 samples, with the place.
Record complete_part(const Record& record, std::vector<std::string>& remarks);

/// From the largest reading on, relative to each channel's own size; of a record with several hits, the
/// longest decay between two of them. Where a hammer's force is measured, behind its pulses; where a
/// deflection was held, behind its release.
/// @param measured the record with its forces
Record from_release(const Record& record, const Record& measured, std::vector<std::string>& remarks);

/// Sets found.record: the decay from its release on, unless a window was given, without the drift of its
/// sensor. What is larger than the motion hides the release, too, which is then sought anew. A hold and its
/// release are no drift.
/// @param measured the record with its forces
/// @param whole the complete part of the record; without its drift afterwards
/// @param lines of what is analysed, returned
/// @returns the period of the mean that was taken off [s]; absent: no drift
std::optional<double> take_decay(const Record& measured, bool windowed, Record& whole,
                                 std::vector<RecordLine>& lines, RecordModes& found);

/// Whether several hits rise above what moved before, each from rest.
bool has_hits(const Record& record);

/// @throws std::invalid_argument unless the intervals are equal within 20 %.
void check_intervals(const Record& record);

}  // namespace beamid::experiments
