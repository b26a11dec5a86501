// The force law of an oscillator out of windows of changing amplitude: `beamid backbone`.
#pragma once

#include "experiments/identify/backbone/whole_record_fit.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

struct BackboneSettings {
  WindowSettings windows;
  bool mass_known = false;  ///< else forces are those of 1 kg
  double linear = 0.01;     ///< change of K(A) below which the spring counts as linear
};

enum class SpringKind { linear, softening, hardening, not_determined };
enum class LoopKind { none, elastic, masing, between, not_determined };
const char* to_string(SpringKind kind);
const char* to_string(LoopKind kind);

struct BackboneStudy {
  AmplitudeWindows windows;  ///< amplitudes are largest displacements here, by `elastic`
  ForceLaw secants;          ///< K(A) as a curve, the naive reading
  ForceLaw elastic, masing;  ///< describing function inverted, either way
  RecordFits record;
  bool by_record = false;  ///< whether the backbone is the whole record's, or the windows'
  ForceLaw backbone;       ///< the one to use
  SpringKind spring = SpringKind::not_determined;
  LoopKind loop = LoopKind::none;
  double change = 0,
         change_deviation = 0;  ///< of K(A) from the smallest window's amplitude to the largest's, relative
  double ratio = 1;             ///< of the largest amplitude to the smallest
  std::vector<Objection> objections;

  const RecordFit* law() const;  ///< the whole record's; nullptr where the windows' backbone is used
  /// Up to where the backbone is known: what the law's motion asks for, or the windows' largest amplitude
  /// [m].
  double largest() const;
  double smallest() const { return windows.last_amplitude; }
  /// Amplitude of the stiffness against which the backbone's secants are held [m]: zero by a law that
  /// determines it there within 5 %, and whose record falls to a seventh of its largest amplitude (below that
  /// a spring of the third power changes by 2 % of what it does in all); else the smallest.
  double first_amplitude() const;
  std::string first_place() const { return first_amplitude() > 0.0 ? "the smallest amplitude" : "rest"; }
  double first_stiffness() const { return backbone.secant(first_amplitude()); }  ///< F / x there
  /// Of ln(secant at x over first_stiffness()).
  double ratio_deviation(double x) const;
  /// BIC of `linear` over that of the law: below zero where a line says as much of the record.
  double linear_bic() const;
  /// What a cycle of the amplitude A dissipates by the law [J]; NaN without one.
  double energy(double amplitude, double omega) const;
};

/// Windows, their readings, the fits to the whole record (once more behind the windows' low-pass where
/// another mode disturbs them), and which backbone is to be used: the law of least BIC where it leaves no
/// more than 1.5 times the variance that the windows leave, else the inversion of the windows as an elastic
/// spring.
/// @throws std::invalid_argument as amplitude_windows().
BackboneStudy study_backbone(const Record& record, const BackboneSettings& settings);

/// The first line.
std::string backbone_verdict(const BackboneStudy& study);

}  // namespace beamid::experiments
