// The five steel beams of the 2009 paper and their exact frequencies (roots of the frequency
// equation, found outside this project).
#pragma once

#include "beamid/testing/steel_beam.hpp"

namespace beamid::test {

struct KnownBeam {
  double tip_mass, frequency_hz, modal_mass_at_tip;
  double amplitude_mm[5], acceleration[5];  // of modes 1-5 at the tip after a 12 mm release [mm, m/s2]
};

inline constexpr KnownBeam five_beams[] = {{0.0198575,
                                            4.145510989755,
                                            0.782414,
                                            {11.6663, 0.28420, 0.034836, 0.008710, 0.003061},
                                            {7.915, 7.577, 7.285, 6.998, 6.724}},
                                           {0.360490,
                                            3.455527194845,
                                            1.109401,
                                            {11.8415, 0.14519, 0.010818, 0.001786, 0.000447},
                                            {5.582, 2.978, 1.844, 1.218, 0.857}},
                                           {1.338090,
                                            2.515654977346,
                                            2.073088,
                                            {11.9565, 0.04123, 0.001935, 0.000249, 0.000054},
                                            {2.987, 0.676, 0.294, 0.158, 0.098}},
                                           {2.330965,
                                            2.068201252526,
                                            3.061047,
                                            {11.9803, 0.01879, 0.000763, 0.000092, 0.000019},
                                            {2.023, 0.287, 0.112, 0.058, 0.035}},
                                           {3.644615,
                                            1.729901652424,
                                            4.371662,
                                            {11.9904, 0.00917, 0.000342, 0.000040, 0.000008},
                                            {1.417, 0.134, 0.050, 0.025, 0.015}}};

}  // namespace beamid::test
