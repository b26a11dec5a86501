// What the lines above the columns of a text state, and what is no part of the table. Oracle: what was
// written.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/experiments/record/recognised_text.hpp"

namespace beamid::experiments::stated_rate_test {
namespace {

TEST(StatedRate, TakesARateThatWordsForOneState) {
  const std::string rows = signal_rows(40, [](int, double a) { return fmt::format("{:.5f}", a); });
  for (const char* const head : {"Sampling rate: 400 Hz",
                                 "Abtastfrequenz = 0,4 kHz",
                                 "Messrate: 400,00 Hz",
                                 "Frequence d'echantillonnage : 400 Hz",
                                 "Fréquence d'échantillonnage : 400 Hz",
                                 "Frecuencia de muestreo = 400 Hz",
                                 "Frequenza di campionamento: 400 Hz",
                                 "Samples per second: 400",
                                 "ODR = 400 Hz",
                                 "Scan rate: 400 scans/s",
                                 "FPS: 400",
                                 "Sampling: 0.4 kS/s",
                                 "\"SampleRate\",400,400",
                                 "\"HResolution\",2.5E-03,2.5E-03",
                                 "TIMESERIES X_Y_Z, 40 samples, 400 sps, SLIST",
                                 "Sampled at 0.4 kHz",
                                 "3 channels, 400 samples/s",
                                 "Recorded with 400 samples per second",
                                 "Sampling time: 2.5 ms",
                                 "ADC sampling rate: 3200 Hz\nOutput data rate: 400 Hz",
                                 "points at equal intervals of .0025 sec",
                                 "//  Update Rate: 400.0Hz",
                                 "File of ActiGraph, date format dd.MM.yyyy at 400 Hz  Filter Normal",
                                 "\"Sampling cycle\",\"2.5ms\"",
                                 "fs = 400"})
    EXPECT_EQ(question_of(std::string(head) + "\nAcc (g)\n" + rows), "read at 400 Hz") << head;
}

// A rate of something else is no sampling rate, and of two the file does not say which.
TEST(StatedRate, AsksForTheRateWhereTheNumberIsOfSomethingElse) {
  const std::string rows = signal_rows(40, [](int, double a) { return fmt::format("{:.5f}", a); });
  for (const char* const head : {"GPS rate: 10 Hz",
                                 "Update rate: 1 Hz (display)",
                                 "Update rate: 10 Hz",
                                 "// Update rate: 10 Hz (display)",
                                 "Trigger rate: 1 Hz",
                                 "Sweep rate: 2 Hz/s",
                                 "Max sample rate: 3200 Hz",
                                 "Max sample rate: 3200 samples/s",
                                 "up to 3200 samples/s",
                                 "Sampling time: 0.5 s",
                                 "Total sampling rate: 1200 Hz (3 channels)",
                                 "Full scale fs = 10 V",
                                 "FS = 5 g",
                                 "dt = 2.5",
                                 "dt = 20 K",
                                 "dt: 2.5 s (heating)",
                                 "Increment: 1 mm",
                                 "Abtastrate: 1.200 Hz",
                                 "Sampling rate: 1,200 Hz",
                                 "Sampling rate: 2000 Hz\nDecimation: 5",
                                 "Sample rate: 400 Hz\nSample rate: 200 Hz",
                                 "Refresh rate 60 Hz",
                                 "Sampling rate: 12'800 Hz",
                                 "Sampling rate: 51 200 Hz",
                                 "fs = 2*200 Hz",
                                 "Sampling rate: > 400 Hz",
                                 "Sampling rate: 400 Hz -> 200 Hz",
                                 "Sampling rate: 1000 Hz (resampled to 400 Hz)",
                                 "Sampling rate: 1200 Hz total, 400 Hz per channel",
                                 "Sampling rate: 3200 Hz\nOutput rate: 400 Hz",
                                 "Original sampling rate: 2000 Hz",
                                 "Sampling rate (max): 3200 Hz",
                                 "Audio sample rate: 44100 Hz",
                                 "Sample rate code: 7",
                                 "Sampling rate setting: 3 (400 Hz)"})
    EXPECT_THAT(question_of(std::string(head) + "\nAcc (g)\n" + rows), testing::HasSubstr("--rate HZ"))
        << head;
}

// A line that states the rate, or a number of channels, names no columns and is no row, however many words it
// has.
TEST(StatedRate, TakesNoStatementForNamesOrForARow) {
  const auto rows = [](const char* separator) {
    return signal_rows(40, [&](int k, double a) {
      return fmt::format("{:.5f}{}{:.5f}{}{:.5f}{}{:.5f}", a, separator, 0.5 * a + 1.0, separator, 2.0 * a,
                         separator, 0.01 * k * k);
    });
  };
  for (const char* const separator : {",", " ", "\t", ";"})
    for (const char* const head :
         {"Sampling rate 400 Hz", "Sampling rate: 400 Hz", "dt=0.0025 s, N=40", "Sample interval 2.5ms",
          "Data rate 400 Hz; bandwidth 200 Hz; range 2 g", "Samples: 40, fs: 400 Hz, n=4"}) {
      const Record record = recognised(std::string(head) + "\n" + rows(separator));
      EXPECT_EQ(record.channels.size(), 4u) << head << separator;
      EXPECT_EQ(record.size(), 40) << head << separator;
      EXPECT_NEAR(record.interval(), 0.0025, 1e-12) << head << separator;
      EXPECT_NEAR(record.samples(2, 0), 2.0, 1e-12) << head << separator;
    }
  RecordFormat with_rate;
  with_rate.sampling_rate = 400.0;
  EXPECT_EQ(recognised("Channels: 4\n" + rows(","), with_rate).channels.size(), 4u);
}

TEST(StatedRate, ComparesItsStampsWithTheRateThatIsStated) {
  const auto stamped = [](double step, const char* form = "{:.4f},{:.5f}") {
    return "Sampling rate: 400 Hz\nTime (s),acc (g)\n" +
           signal_rows(60, [&](int k, double a) { return fmt::format(fmt::runtime(form), step * k, a); });
  };
  EXPECT_THAT(question_of(stamped(2.5)), testing::HasSubstr("--time 1:ms"));
  const Record other = recognised(stamped(0.001));
  EXPECT_NEAR(other.interval(), 0.001, 1e-9);
  ASSERT_FALSE(other.objections.empty());
  EXPECT_THAT(other.objections[0].text, testing::HasSubstr("states 400 Hz"));
  EXPECT_EQ(question_of(stamped(0.0025, "{:.2f},{:.5f}")), "read at 400 Hz");  // printed too coarsely
}

TEST(StatedRate, JoinsNumbersThatAreWrittenSeveralToALine) {
  std::string rows;
  for (int k = 0; k < 320; ++k) rows += fmt::format("{:.5f}{}", std::sin(0.05 * k), k % 8 == 7 ? "\n" : " ");
  for (const char* const head :
       {"Sampling rate: 400 Hz\nNumber of points: 320\n", "Sampling rate: 400 Hz\n"}) {
    const Record record = recognised(head + rows + "0.1 0.2 0.3\n");
    ASSERT_EQ(record.channels.size(), 1u) << head;
    EXPECT_EQ(record.size(), 323);
    EXPECT_NEAR(record.samples(0, 100), std::sin(5.0), 1e-5);
  }
  // Eight sensors beside each other are no series.
  std::string sensors;
  for (int k = 0; k < 40; ++k) {
    for (int i = 0; i < 8; ++i)
      sensors += fmt::format("{:.5f} ", (1.0 + 0.3 * i) * std::sin(0.05 * k + 0.7 * i * i));
    sensors += "\n";
  }
  EXPECT_EQ(recognised("Sampling rate: 400 Hz\n" + sensors).channels.size(), 8u);
}

TEST(StatedRate, JoinsNoChannelsWhoseNumberIsThatOfAllValues) {
  const auto text = [](const char* head, double gain, double offset) {
    return std::string(head) + "\n" + signal_rows(40, [&](int, double a) {
             return fmt::format("{:.5f} {:.5f} {:.5f}", a, gain * a, 0.7 * a + offset);
           });
  };
  for (const auto& [gain, offset] : {std::pair{0.45, 0.0}, {1.0, 9.81}})
    EXPECT_EQ(recognised(text("Sampling rate: 400 Hz\nNumber of samples: 120", gain, offset)).channels.size(),
              3u)
        << gain;
  EXPECT_EQ(recognised(text("Sampling rate: 400 Hz\nChannels: 3\nNumber of samples: 120", 1.0, 0.0))
                .channels.size(),
            3u);
}

TEST(StatedRate, ReadsOneColumnWithDecimalCommas) {
  const auto commas = [](double value, int digits) {
    std::string text = fmt::format("{:.{}f}", value, digits);
    std::replace(text.begin(), text.end(), '.', ',');
    return text;
  };
  for (const char* const head : {"Abtastrate: 400 Hz", "Abtastrate: 400 Hz\nBeschleunigung [m/s²]"}) {
    const Record record =
        recognised(std::string(head) + "\n" + signal_rows(60, [&](int, double a) { return commas(a, 5); }));
    ASSERT_EQ(record.channels.size(), 1u) << head;
    EXPECT_NEAR(record.samples(0, 0), 1.0, 1e-9) << head;
    EXPECT_NEAR(record.interval(), 0.0025, 1e-12) << head;
  }
  // Two columns of whole numbers stay two.
  RecordFormat with_rate;
  with_rate.sampling_rate = 400.0;
  const Record two = recognised(
      signal_rows(
          60,
          [](int k, double a) { return fmt::format("{},{}", 500 + k % 7, 512 + static_cast<int>(300 * a)); }),
      with_rate);
  EXPECT_EQ(two.channels.size(), 2u);
}

}  // namespace
}  // namespace beamid::experiments::stated_rate_test
