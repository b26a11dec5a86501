// Whether something happened to a free decay while it rang: a knock, samples lost, another sampling rate.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/frequency_jump.hpp"

namespace beamid::experiments {

/// The motion behind an instant is not the continuation of the motion before it.
struct MotionJump {
  double time = 0;             ///< [s], from the first sample
  double amplitude_ratio = 1;  ///< behind it over before
  double phase = 0;            ///< by which it is ahead behind it [rad]

  std::string words() const;  ///< "the motion jumps, by +10 % in amplitude and 2.1 degrees in phase"
};

/// What happened to a decay at one instant.
struct DecayJump {
  std::variant<MotionJump, FrequencyJump> kind;

  double time() const;                     ///< [s], from the first sample
  const FrequencyJump* frequency() const;  ///< null where it is the motion that jumps
  const MotionJump* motion() const;        ///< null where it is the frequency
  std::string words() const;
  /// "At 8 s the motion jumps, ...: something touched the structure, or samples were lost."
  /// @param begin time of the first sample [s]
  std::string sentence(double begin) const;
};

/// The clearest jump of a decay (N, finite), where there is one: of its frequency (frequency_jump.hpp,
/// decay_jump.cpp), or else of its amplitude and phase. Over twelve periods before and behind an instant,
/// but for one period to either side, the signal, decimated to eight samples per cycle and freed of what
/// sways below the mode, is
///
///     e^(s t) (a_0 + a_1 t + a_2 t^2 + a_3 t^3 + j H(t)) + an offset + companions e^(s_i t),
///
/// s the modal analysis' rate, H the unit step, everything complex but the offset: an amplitude and a
/// frequency that change smoothly are no jump; then without a_2 and a_3, where that shows none but an F of 5.
/// It is one where j explains what a_4 t^4 does not, by F = (r_4 - r_j) / 2 / (r_j / freedom) > 15; eight
/// times the F of the median instant's step, as beats of modes that were not found have some everywhere, and
/// 25 times what that is above 1, as wandering phases do; where the fit is as good as elsewhere; where |j| is
/// 0.3 % of the amplitude; and where that is a tenth of the first one: where friction stops a motion it has a
/// corner. None of 200 healthy records has one.
std::optional<DecayJump> decay_jump(const Eigen::VectorXd& signal, double interval,
                                    const ModalEstimate& mode);

}  // namespace beamid::experiments
