#include "fem/exact/exact_cantilever.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fem/five_beams.hpp"

namespace beamid::exact_cantilever_test {
namespace {

using fem::ExactMode;

TEST(ExactCantilever, BareBeamHasTheTextbookRoots) {
  // Oracle: roots of 1 + cos b cosh b = 0 [blevins1979, table 8-1].
  const fem::Cantilever bare = test::steel_beam(0.0);
  const double published[] = {1.87510406871196, 4.69409113297417, 7.85475743823761, 10.9955407348755,
                              14.1371683910464};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(ExactMode(bare, i + 1).root(), published[i], 1e-12);
}

TEST(ExactCantilever, FiveBeamsHaveTheFrequenciesFoundIndependently) {
  for (const auto& known : test::five_beams) {
    const ExactMode mode(test::steel_beam(known.tip_mass), 1);
    EXPECT_NEAR(mode.frequency_hz(), known.frequency_hz, 6e-13);  // its last printed digit
    EXPECT_NEAR(mode.mass_at_tip(), known.modal_mass_at_tip, 5e-7);
  }
}

TEST(ExactCantilever, ReleaseGivesTheTabulatedAmplitudesOfEveryMode) {
  for (const auto& known : test::five_beams)
    for (int i = 0; i < 5; ++i) {
      const ExactMode mode(test::steel_beam(known.tip_mass), i + 1);
      const double amplitude = mode.release_amplitude(0.012), omega = mode.angular_frequency();
      const double digit_mm = i == 0 ? 5e-5 : i == 1 ? 5e-6 : 5e-7;  // the table's last digit
      EXPECT_NEAR(1e3 * amplitude, known.amplitude_mm[i], digit_mm);
      EXPECT_NEAR(amplitude * omega * omega, known.acceleration[i], 5e-4);
    }
}

TEST(ExactCantilever, ModalAmplitudesSumToTheReleasedDeflection) {
  // Oracle: completeness of the modes; the remainder falls with the fourth power of the mode number.
  const fem::Cantilever beam = test::steel_beam(0.0198575);
  double sum = 0.0;
  for (int i = 1; i <= 40; ++i) sum += ExactMode(beam, i).release_amplitude(0.012);
  EXPECT_NEAR(sum, 0.012, 1e-8);
}

TEST(ExactCantilever, HighModesKeepTheirShape) {
  // Oracle: at high frequency the free end of a bare beam moves as cos + decaying exponential, so the shape
  // at the root vanishes and consecutive tip slopes alternate; a shape that cancels would lose this from mode
  // 12 on.
  const fem::Cantilever bare = test::steel_beam(0.0);
  for (int i = 1; i <= 30; ++i) {
    const ExactMode mode(bare, i);
    EXPECT_NEAR(mode.shape(0.0), 0.0, 1e-13);
    EXPECT_NEAR(mode.shape(bare.length), 1.0, 1e-13);
    EXPECT_NEAR(mode.mass_at_tip() / bare.mass(), 0.25, 1e-11);  // exact for every mode of a bare cantilever
  }
}

TEST(ExactCantilever, RefusesImpossibleBeams) {
  fem::Cantilever beam = test::steel_beam(1.0);
  EXPECT_THROW(ExactMode(beam, 0), std::invalid_argument);
  beam.tip_mass = -1.0;
  EXPECT_THROW(ExactMode(beam, 1), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::exact_cantilever_test
