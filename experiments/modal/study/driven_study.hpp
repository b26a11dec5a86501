// Modes of one record whose inputs were measured: a moving base, a shaker, several of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/modal/driven_poles.hpp"
#include "experiments/modal/input_responses.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

/// A mode of a driven record. Deviations are those of 95 % intervals over 1.96.
struct DrivenMode {
  Pole pole;                ///< shape (p): that of the input to which it answers most, 1 at the largest
  std::vector<int> orders;  ///< at which it was stable
  /// (p m) of channel i under input j in row i + p j, from (b + b' p) / p^k with k derivatives in the
  /// channel: Gamma phi_i [-] where a base moves, phi_i phi_j / m [1/kg] under a force. Real where damping is
  /// classical.
  Eigen::VectorXcd participation;
  double share = 0.0;  ///< of the largest channel's size that goes with it
};

struct DrivenStudy {
  std::string name;                      ///< of the record
  Record record;                         ///< what was analysed, inputs included
  std::vector<Channel> outputs, inputs;  ///< p, m
  std::pair<double, double> band_hz;
  InputResponses responses;  ///< all lines
  std::vector<OrderPoles> orders;
  Stabilisation stabilisation;
  DrivenLines lines;
  DrivenPoles fit;
  std::vector<DrivenMode> modes;  ///< by rising frequency
  int sections = 0;               ///< over which poles were asked for their scatter; 0: too few
  std::vector<std::string> remarks;
  std::vector<Objection> objections;

  double explained() const { return 1.0 - fit.left_share; }  ///< of the root mean square
};

/// Poles of the averaged responses over orders of a common denominator [guillaume1998]; those that are stable
/// start the fit of all lines, and each has to be more than the noise around it.
/// @throws std::invalid_argument when record, band and orders do not fit, or no input was measured.
DrivenStudy study_driven(const std::string& name, const Record& record, const ModalStudySettings& settings);

/// A record as its inputs explain it, and as a free decay: one of them where one explains less, or is
/// impossible.
struct DrivenOrDecaying {
  std::optional<DrivenStudy> driven;    ///< present: the inputs make the motion
  std::optional<RecordModes> decaying;  ///< present where it was asked for and has modes
};

/// Of a record for which is_driven() holds: the high-passed force of one hit rings as long as the motion
/// does.
DrivenOrDecaying driven_or_decaying(const std::string& name, const Record& record, bool windowed,
                                    const ModalStudySettings& settings);

/// For commands that follow a motion of the structure's own.
/// @throws InputError where a measured input drives the motion.
void refuse_driven(const std::string& file, const Record& record, bool windowed);

/// The same as modes of the motion alone, for what takes modes of any record. There is no target.
RecordModes modes_of(const DrivenStudy& study);

}  // namespace beamid::experiments
