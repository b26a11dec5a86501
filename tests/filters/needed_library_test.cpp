// Libraries that are loaded at their first use. Oracle: the published value of a Bessel function, and
// messages as documented.
#include <gtest/gtest.h>

#include <math.h>

#include <needed_library.hpp>

namespace beamid::filters::needed_library_test {
namespace {

constexpr NeededLibrary mathematics{"libm.so.6", "libc6"};
constexpr NeededLibrary missing{"libbeamid_of_another_day.so.9", "libbeamid-another9"};
BEAMID_NEEDED(mathematics, j0);
inline constinit const NeededFunction<decltype(::j0)> of_missing(missing, "j0");
inline constinit const NeededFunction<decltype(::j0)> unknown(mathematics, "j0_of_another_day");

std::string message(const NeededFunction<decltype(::j0)>& function) {
  try {
    function(0.0);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(NeededLibrary, FunctionsAreCalledAsIfTheyWereLinked) {
  constexpr double published = 0.765197686557967;  // J_0(1) [abramowitz1964, table 9.1]
  EXPECT_NEAR(j0(1.0), published, 1e-15);
  double (*const handed_on)(double) = j0;
  EXPECT_NEAR(handed_on(1.0), published, 1e-15);
}

TEST(NeededLibrary, StatesWhatIsMissing) {
  EXPECT_TRUE(mathematics.there() && mathematics.has("j0"));
  EXPECT_FALSE(mathematics.has("j0_of_another_day"));
  EXPECT_FALSE(missing.there() || missing.has("j0"));
  EXPECT_EQ(message(of_missing),
            "libbeamid_of_another_day.so.9 is missing; expected that library: it is in Debian's package "
            "libbeamid-another9");
  EXPECT_EQ(message(unknown),
            "libm.so.6 has no j0_of_another_day; expected the version that beamid was built with");
}

}  // namespace
}  // namespace beamid::filters::needed_library_test
