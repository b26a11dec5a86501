// Texts from outside may be shown anywhere: on a terminal, in a page, in a plot.
#include "experiments/text/fields.hpp"

#include <gtest/gtest.h>

#include "experiments/text/toml_table.hpp"

namespace beamid::experiments::clean_text_test {
namespace {

// Oracle: ISO 8859-1 has the code points of Unicode's first block; sequences by hand from the table of RFC
// 3629.
TEST(CleanText, TurnsLatin1IntoUtf8AndKeepsUtf8) {
  EXPECT_EQ(clean_text("Beschleunigung [m/s\xb2]"), "Beschleunigung [m/s²]");
  EXPECT_EQ(clean_text("K\xf6rper \xb5m/m"), "Körper µm/m");
  for (const char* text : {"ξ√M_{eq}", "加速度 [m/s²]", "\xF0\x9F\x94\xA8", "plain"})
    EXPECT_EQ(clean_text(text), text);
  // Overlong, a surrogate, beyond U+10FFFF, cut off: none of them is UTF-8.
  EXPECT_EQ(clean_text("\xC0\xAF"), "À¯");
  EXPECT_EQ(clean_text("\xED\xA0\xC0"), "í\u00a0À");
  EXPECT_EQ(clean_text("\xF5"), "õ");
  EXPECT_EQ(clean_text("a\xC3"), "aÃ");
}

TEST(CleanText, DropsWhatCommandsATerminalAPageOrAPlot) {
  EXPECT_EQ(clean_text(std::string("\x1b[2J\x1b]0;x\x07 A\0,B\x7f", 17)), "[2J]0;x A,B");
  EXPECT_EQ(clean_text("C1 \xC2\x9B"
                       "31m and \x9b"
                       "31m"),
            "C1 31m and 31m");
  EXPECT_EQ(clean_text("two\r\nlines\tand\ra tab"), "two lines and a tab");
  EXPECT_EQ(clean_lines("two\r\nlines\x1b[m\n"), "two\nlines[m\n");
  // An override shows "gpj.exe" as "exe.jpg".
  EXPECT_EQ(clean_text("a\u202egpj.exe\u2067b\u2069"), "agpj.exeb");
  EXPECT_EQ(clean_text("\u05d0\u05d1 \u200e1"), "\u05d0\u05d1 \u200e1");
  EXPECT_EQ(find_control("ξ ok"), std::string::npos);
  EXPECT_EQ(find_control("ξ\x1b"), 2u);
}

// The attack that ran shell commands: NUL in a sensor's name turned the quotes of a plot's script inside out.
TEST(TomlTexts, WithControlCharactersAreRefusedAtTheirPlace) {
  const auto error = [](const std::string& text) {
    try {
      TomlTable::parse(text, "rig.toml").table("sensors").find_text("name");
    } catch (const InputError& refused) {
      return std::string(refused.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(
      error("[sensors]\nname = \"A,x\\\\\\u0000,`touch OWNED`\"\n"),
      "rig.toml:2:8: sensors.name holds a control character (byte 5 of the text, 0x00); expected a text of "
      "one line, without any");
  EXPECT_NE(error("[sensors]\nname = \"\\u001b[2J\"\n"), "no error");
  EXPECT_NE(error("[sensors]\nname = \"two\\nlines\"\n"), "no error");
  EXPECT_EQ(error("[sensors]\nname = \"tip 'a' `b` \\\"c\\\" ξ\"\n"), "no error");
  EXPECT_THROW(TomlTable::parse("vary = [\"a\", \"b\\u0000\"]", "rig.toml").find_texts("vary"), InputError);
}

}  // namespace
}  // namespace beamid::experiments::clean_text_test
