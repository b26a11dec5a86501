// Libraries that are loaded at their first use. Oracle: the published check value of CRC-32, and messages as
// documented.
#include <gtest/gtest.h>

#include <zlib.h>

#include "filters/needed_library.hpp"

namespace beamid::filters::needed_library_test {
namespace {

constexpr NeededLibrary zlib{"libz.so.1", "zlib1g"};
constexpr NeededLibrary missing{"libbeamid_of_another_day.so.9", "libbeamid-another9"};
BEAMID_NEEDED(zlib, zlibVersion);
BEAMID_NEEDED(zlib, crc32);
inline constinit const NeededFunction<decltype(::crc32)> of_missing(missing, "crc32");
inline constinit const NeededFunction<decltype(::crc32)> unknown(zlib, "crc32_of_another_day");

std::string message(const NeededFunction<decltype(::crc32)>& function) {
  try {
    function(0, nullptr, 0);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(NeededLibrary, FunctionsAreCalledAsIfTheyWereLinked) {
  const unsigned char check[] = "123456789";
  EXPECT_EQ(crc32(0, check, 9), 0xcbf43926U);  // the check value of CRC-32
  EXPECT_EQ(zlibVersion()[0], ZLIB_VERSION[0]);
  uLong (*const handed_on)(uLong, const Bytef*, uInt) = crc32;
  EXPECT_EQ(handed_on(0, check, 9), 0xcbf43926U);
}

TEST(NeededLibrary, StatesWhatIsMissing) {
  EXPECT_TRUE(zlib.there() && zlib.has("crc32"));
  EXPECT_FALSE(zlib.has("crc32_of_another_day"));
  EXPECT_FALSE(missing.there() || missing.has("crc32"));
  EXPECT_EQ(message(of_missing),
            "libbeamid_of_another_day.so.9 is missing; expected that library: it is in Debian's package "
            "libbeamid-another9");
  EXPECT_EQ(message(unknown),
            "libz.so.1 has no crc32_of_another_day; expected the version that beamid was built with");
}

}  // namespace
}  // namespace beamid::filters::needed_library_test
