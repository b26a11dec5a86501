// Poles of a wide band, searched at several sampling rates.
#pragma once

#include <optional>

#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/modal/study/record_lines.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
