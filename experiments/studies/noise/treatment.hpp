// What a filter of one mode does with the modes it does not ask about.
#pragma once

#include <array>

#include "experiments/studies/noise/modal_record.hpp"

namespace beamid::experiments {

/// sensor: R is the sensor's alone; white: R is raised by their mean square; coloured: a second-order shaping
/// filter each, of known frequency, driven by white noise; filtered: a finite low-pass and fewer samples;
/// modelled: each with its own unknown stiffness and damping.
enum class Treatment { sensor, white, coloured, filtered, modelled };
inline constexpr std::array<Treatment, 5> treatments{Treatment::sensor, Treatment::white, Treatment::coloured,
                                                     Treatment::filtered, Treatment::modelled};
const char* to_string(Treatment treatment);

/// Of the first mode, relative to the truth [%]. Not finite where the filter failed.
struct FirstMode {
  double stiffness_error = 0.0, damping_error = 0.0;
  double stiffness_deviation = 0.0, damping_deviation = 0.0;  ///< as the filter says [%]
  double normalised_square = 0.0;  ///< mean innovation^2 / its variance; 1 where the filter is consistent
  double variance = 0.0;           ///< R that was used [SI]
};

/// An extended Kalman filter, exact discretisation, two passes, K and C from first guesses 3 % and 50 % off.
/// @param noise standard deviation of the sensor [SI] @param factor on the R of `sensor` and `white`
FirstMode identify_first_mode(const ModalRecord& record, const ModalMotion& motion, Quantity observed,
                              double noise, Treatment treatment, double factor = 1.0);

}  // namespace beamid::experiments
