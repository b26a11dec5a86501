// Files as people and their instruments write them, read without a word about them. Oracle: what was written.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "experiments/record/read_record.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/recognised_text.hpp"

namespace beamid::experiments::recognised_record_test {
namespace {

TEST(RecognisedRecord, RecognisesHeadersAsPeopleWriteThem) {
  struct Case {
    const char* header;
    double time, value;  // of one unit in the file, in SI units
    char separator;
  };
  for (const auto& [header, time, value, separator] :
       {Case{"time [s],acceleration [m/s2]", 1, 1, ','}, Case{"Time (s),Acceleration (m/s^2)", 1, 1, ','},
        Case{"t/s,a/(m/s2)", 1, 1, ','}, Case{"t,a", 1, 1, ','},
        Case{"time_ms,acc_g", 1e-3, standard_gravity, ','}, Case{"Time (s),gFx", 1, standard_gravity, ','},
        Case{"Zeit [s];Beschleunigung [m/s²]", 1, 1, ';'},
        Case{"temps (ms);accélération (mm/s2)", 1e-3, 1e-3, ';'},
        Case{"tiempo [s];aceleración [m/s2]", 1, 1, ';'},
        Case{"tempo (s);accelerazione (g)", 1, standard_gravity, ';'},
        Case{"Time\tAcc\ns\tm/s^2", 1, 1, '\t'}, Case{"time_s,Linear Acceleration x (m/s^2)", 1, 1, ','},
        Case{"Time (s),Accel-Tip (mg)", 1, 1e-3 * standard_gravity, ','},
        Case{"Time,Acc\nsec,m/s^2", 1, 1, ','}}) {
    std::string text = std::string(header) + "\n";
    for (int k = 0; k < 20; ++k)
      text += fmt::format("{:.6f}{}{}\n", 0.0025 * (k + 1) / time, separator, 4.0 - 0.1 * k);
    const Record record = recognised(text);
    ASSERT_EQ(record.channels.size(), 1u) << header;
    EXPECT_EQ(record.channels[0].quantity, Quantity::acceleration) << header;
    EXPECT_NEAR(record.interval(), 0.0025, 1e-8) << header;
    EXPECT_NEAR(record.samples(0, 1), 3.9 * value, 1e-12) << header;
  }
}

TEST(RecognisedRecord, TakesNoOrientationAndNoCountForAChannelOrATime) {
  std::string text = "sep=,\nDeviceTag: 1\n\nPacketCounter,SampleTimeFine,Euler_X,Acc_X,Gyr_X\n";
  for (int k = 0; k < 20; ++k)
    text += fmt::format("{},{},{},{},{}\n", 17 + k, 991011697 + 8333 * k, 10.5, k == 0 ? 0.0 : 0.25 + 0.1 * k,
                        1.5);
  RecordFormat format;
  format.header_lines = 4;
  const Record record = recognised(text, format);
  ASSERT_EQ(record.channels.size(), 1u);
  EXPECT_EQ(record.channels[0].name, "Acc_X");
  EXPECT_NEAR(record.interval(), 0.008333, 1e-9);
  EXPECT_EQ(record.size(), 19) << "the first sample is a logger's zero";
}

// 0.1 ms or 1 us, by the instrument: at 400 Hz it cannot be the one that counts microseconds, and nothing
// states the other.
TEST(RecognisedRecord, AsksForTheUnitOfASampleTimeFineThatIsTooFast) {
  std::string text = "PacketCounter,SampleTimeFine,Acc_X\n";
  for (int k = 0; k < 20; ++k) text += fmt::format("{},{},{}\n", k, 25 * k, 0.25 + 0.1 * k);
  try {
    recognised(text);
    FAIL();
  } catch (const InputError& asked) {
    EXPECT_THAT(asked.what(),
                testing::HasSubstr("'SampleTimeFine' rises by 25 from row to row and states no unit"));
  }
}

TEST(RecognisedRecord, ReadsDurationsOfMatlabSectionsOfALoggerAndRatesWithTheirUnit) {
  std::string durations = "Time,Acc\n",
              sections =
                  "*CREATOR\nMSR 5.4\n*STARTTIME\n2026-11-01;10:00:00;\n*CHANNEL\n"
                  "TIME;ACC y;\ns;G;\n*DATA\n",
              rate = "Sampling Frequency (kHz),0.4\nsample,acc\n",
              robot = "%time,field.header.seq,field.header.stamp,acc.x\n";
  for (int k = 0; k < 20; ++k) {
    const double t = 0.0025 * k, a = 4.0 - 0.1 * k;
    durations += fmt::format("{:.4f} sec,{}\n", t, a);
    sections += fmt::format("{:.4f};{};\n", t, a);
    rate += fmt::format("{},{}\n", k, a);
    robot += fmt::format("{0},{1},{0},{2}\n", 1732000000000000000 + 2500000LL * k, k, a);
  }
  for (const std::string& text : {durations, sections, rate, robot}) {
    const Record record = recognised(text);
    ASSERT_EQ(record.channels.size(), 1u) << text.substr(0, 40);
    EXPECT_NEAR(record.interval(), 0.0025, 1e-8) << text.substr(0, 40);
    EXPECT_EQ(record.size(), 20) << text.substr(0, 40);
  }
}

TEST(RecognisedRecord, ReadsStampsOfADateAndIntervalsStatedAboveTheColumns) {
  std::string stamped = "timestamp,x\n", stated = "# Sample rate: 400 Hz\nSample,Acc X [g]\n", bare;
  for (int k = 0; k < 20; ++k) {
    stamped += fmt::format("2026-11-26T23:59:{:06.3f}Z,{}\n", 58.0 + 0.05 * k, 1 + k);
    stated += fmt::format("{},{}\n", k, 1 + k);
    bare += fmt::format("{:.4f} {}\n", 0.0025 * k, 1 + k);
  }
  EXPECT_NEAR(recognised(stamped).interval(), 0.05, 1e-6);
  const Record counted = recognised(stated);
  EXPECT_NEAR(counted.interval(), 0.0025, 1e-12);
  EXPECT_NEAR(counted.samples(0, 0), standard_gravity, 1e-12);
  EXPECT_NEAR(recognised(bare).interval(), 0.0025, 1e-9);
}

// Every file holds 40 samples at 200 Hz, the k-th of 4 - k / 10.
TEST(RecognisedRecord, ReadsStampsOfClocksDaysAndSpreadsheets) {
  struct Case {
    const char* header;
    std::string (*stamp)(int);
  };
  for (const auto& [header, stamp] :
       {Case{"Time,Acc\n", [](int k) { return fmt::format("23:59:59.{:03},", 900 + 5 * k); }},
        Case{"Date,Time,Acc [g]\n",
             [](int k) { return fmt::format("2026-11-27,10:00:{:02}.{:03},", k / 20, 50 * (k % 20)); }},
        Case{"epoch,acc\n", [](int k) { return fmt::format("{},", 1700000000000LL + 5 * k); }},
        Case{"time,acc\n", [](int k) { return fmt::format("{},", 1700000000000000LL + 5000 * k); }},
        Case{"Date,acc\n", [](int k) { return fmt::format("{:.10f},", 45000.0 + 0.005 * k / 86400.0); }},
        Case{"Source,CH1\nSecond,Volt\n", [](int k) { return fmt::format("{:.6e},", 0.005 * k - 0.1); }},
        Case{"Recorder: X100\nOperator,me\nDate: 2026-11-27\n\ntime (s),a\n",
             [](int k) { return fmt::format("{:.3f},", 0.005 * k); }},
        Case{"// logger\n// fs = 200\nt,a\n", [](int k) { return fmt::format("{:.3f},", 0.005 * k); }}}) {
    std::string text = header;
    for (int k = 0; k < 20; ++k) text += stamp(k) + fmt::format("{:.1f}\n", 4.0 - 0.1 * k);
    const Record record = recognised(text);
    ASSERT_EQ(record.channels.size(), 1U) << header;
    const double interval = std::string(header).starts_with("Date,Time") ? 0.05 : 0.005;
    EXPECT_NEAR(record.interval(), interval, 2e-6) << header;
    EXPECT_EQ(record.size(), 20) << header;
  }
}

TEST(RecognisedRecord, GoesOnPastMidnight) {
  std::string text = "Time,Acc\n";
  for (int k = 0; k < 20; ++k)
    text += (k < 10 ? fmt::format("23:59:59.{:02},", 90 + k) : fmt::format("00:00:00.{:02},", k - 10)) +
            fmt::format("{}\n", k % 7);
  EXPECT_NEAR(recognised(text).interval(), 0.01, 1e-9);
}

TEST(RecognisedRecord, TakesGapsOfAFileThatNobodyDescribedForWhatTheyAre) {
  std::string text = "t,a\n";
  const char* const gaps[] = {"", "NaN", "OVERFLOW", "n/a"};
  for (int k = 0; k < 40; ++k)
    text +=
        fmt::format("{:.3f},{}\n", 0.005 * k, k >= 10 && k < 14 ? gaps[k - 10] : fmt::format("{}", k % 7));
  const Record record = recognised(text);
  EXPECT_EQ(record.size(), 40);
  EXPECT_EQ(record.samples.array().isNaN().count(), 4);
}

TEST(RecognisedRecord, LeavesOutAnAxisThatDoesNotMove) {
  std::string text = "t,ax,ay,az\n";
  for (int k = 0; k < 20; ++k) text += fmt::format("{:.3f},{},0,9.81\n", 0.005 * k, k % 7);
  const Record record = recognised(text);
  ASSERT_EQ(record.channels.size(), 1U);
  EXPECT_EQ(record.channels[0].name, "ax");
}

// A zip archive of one stored array of 16 doubles and a number fs = 100, and what is left of it.
TEST(RecognisedRecord, ReadsStoredArchivesOfArraysAndRefusesDamagedOnes) {
  std::string bytes, directory;
  const auto number = [](std::size_t value, int length) {
    std::string text;
    for (int k = 0; k < length; ++k, value >>= 8) text += static_cast<char>(value & 0xFF);
    return text;
  };
  const auto add = [&](const std::string& name, const std::string& shape, const std::vector<double>& values) {
    std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': " + shape + ", }\n",
                array = "\x93NUMPY\x01" + std::string(1, '\0') + number(header.size(), 2) + header;
    array.append(reinterpret_cast<const char*>(values.data()), 8 * values.size());
    std::uint32_t sum = 0xFFFFFFFF;  // CRC-32, bit by bit
    for (const unsigned char c : array) {
      sum ^= c;
      for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ (sum & 1 ? 0xEDB88320 : 0);
    }
    const std::string sizes = number(~sum, 4) + number(array.size(), 4) + number(array.size(), 4) +
                              number(name.size(), 2) + number(0, 2),
                      common = number(20, 2) + number(0, 2) + number(0, 2) + number(0, 4) + sizes;
    directory += "PK\x01\x02" + number(20, 2) + common + number(0, 2) + number(0, 2) + number(0, 2) +
                 number(0, 4) + number(bytes.size(), 4) + name;
    bytes += "PK\x03\x04" + common + name + array;
  };
  std::vector<double> values;
  for (int k = 0; k < 16; ++k) values.push_back(k % 5);
  add("meta.npy", "(3,)", {1.0, 2.0, 3.0});
  add("acc.npy", "(16,)", values);
  add("fs.npy", "()", {100.0});
  const std::string whole = bytes + directory + "PK\x05\x06" + number(0, 4) + number(3, 2) + number(3, 2) +
                            number(directory.size(), 4) + number(bytes.size(), 4) + number(0, 2);
  const TemporaryFile file("record.npz", whole);
  const Record record = read_record(file.path(), {});
  ASSERT_EQ(record.size(), 16);
  EXPECT_EQ(record.channels[0].name, "acc");
  EXPECT_THAT(record.remarks, testing::Contains("Omitted, as not of 16 samples: meta (3)."));
  EXPECT_NEAR(record.interval(), 0.01, 1e-12);
  for (std::size_t length = 8; length + 22 < whole.size(); length += 7) {
    const TemporaryFile cut("cut.npz", whole.substr(0, length));
    EXPECT_THROW(read_record(cut.path(), {}), InputError) << length;
  }
}

// Two channels of 16 bits at 400 Hz. Oracle: the format's own bytes; full scale, 32768, is 1.
TEST(RecognisedRecord, ReadsSoundFilesAtTheirOwnRate) {
  const auto number = [](std::size_t value, int length) {
    std::string text;
    for (int k = 0; k < length; ++k, value >>= 8) text += static_cast<char>(value & 0xFF);
    return text;
  };
  constexpr std::size_t frames = 50;
  std::string data;
  for (std::size_t k = 0; k < frames; ++k)
    data += number(1000 * (k % 7 + 1), 2) + number(65536 - 2000 * (k % 5 + 1), 2);
  const std::string whole = "RIFF" + number(36 + data.size(), 4) + "WAVEfmt " + number(16, 4) + number(1, 2) +
                            number(2, 2) + number(400, 4) + number(1600, 4) + number(4, 2) + number(16, 2) +
                            "data" + number(data.size(), 4) + data;
  const TemporaryFile file("sound.wav", whole);
  const Record record = read_record(file.path(), {});
  ASSERT_EQ(record.size(), static_cast<Eigen::Index>(frames));
  ASSERT_EQ(record.channels.size(), 2U);
  EXPECT_NEAR(record.interval(), 1.0 / 400.0, 1e-12);
  EXPECT_DOUBLE_EQ(record.samples(0, 3), 4000.0 / 32768.0);
  EXPECT_DOUBLE_EQ(record.samples(1, 4), -10000.0 / 32768.0);
  const TemporaryFile cut("cut.wav", whole.substr(0, 20));
  EXPECT_THROW(read_record(cut.path(), {}), InputError);
}

TEST(RecognisedRecord, ReadsUtf16) {
  std::string text = "\xFF\xFE";
  std::string plain = "Zeit [s];Beschl. [m/s2]\n";
  for (int k = 0; k < 20; ++k) plain += fmt::format("{:.3f};{}\n", 0.005 * k, k % 7);
  for (const char byte : plain) text += byte, text += '\0';
  EXPECT_EQ(recognised(text).size(), 20);
  EXPECT_EQ(recognised(text.substr(2)).size(), 20) << "without its mark";
  std::string high;
  for (const char byte : plain) high += '\0', high += byte;
  EXPECT_EQ(recognised(high).size(), 20) << "high bytes first";
}

TEST(RecognisedRecord, AsksForTheUnitOfTimesWhoseStepsAreThoseOfAnother) {
  const auto stamped = [](const std::string& header, double first, double step) {
    return header + "\n" + signal_rows(40, [&](int k, double a) {
             return fmt::format("{:.9g},{:.5f}", first + step * k, a);
           });
  };
  EXPECT_THAT(question_of(stamped("time,acc", 0.0, 0.2)), testing::HasSubstr("--time 1:ms (5000 Hz)"));
  EXPECT_THAT(question_of(stamped("time,acc", 0.0, 2.5e6)), testing::HasSubstr("--time 1:ns (400 Hz)"));
  EXPECT_THAT(question_of(stamped("Time,acc", 0.4166667, 5.787037e-8)), testing::HasSubstr("--time 1:d ("));
  const auto whole = [](const std::string& header, std::int64_t first, std::int64_t step) {
    return header + "\n" +
           signal_rows(40, [&](int k, double a) { return fmt::format("{},{:.5f}", first + step * k, a); });
  };
  // Nanoseconds since a telephone was switched on have the size of microseconds since 1970.
  EXPECT_THAT(question_of(whole("timestamp,acc", 1728000000000000, 2500000)),
              testing::HasSubstr("--time 1:ns (400 Hz)"));
  EXPECT_EQ(question_of(whole("sensor_timestamp_ns,acc", 1728000000000000, 2500000)), "read at 400 Hz");
  EXPECT_THAT(question_of(whole("Ticks,acc", 639272484000000000, 25000)),
              testing::StartsWith("read at 400.0"));
  for (const char* const header : {"Time(mS),a", "TIME_MS,a", "Zeit in Millisekunden,a", "uptime_ms,a",
                                   "Laufzeit [ms],a", "Time <ms>,a", "ticks_ms,a"})
    EXPECT_EQ(question_of(stamped(header, 0.0, 2.5)), "read at 400 Hz") << header;
  // The answer is taken, and a stated rate in place of it.
  RecordFormat stated;
  stated.time = ColumnDescription{};
  stated.time->number = 1;
  stated.time->factor = 1e-3;
  EXPECT_EQ(question_of(stamped("t,a", 0.0, 2.5), stated), "read at 400 Hz");
  RecordFormat with_rate;
  with_rate.sampling_rate = 400.0;
  EXPECT_EQ(question_of(stamped("t,a", 0.0, 2.5), with_rate), "read at 400 Hz");
}

TEST(RecognisedRecord, ReadsMonitorsAndTakesTheTimesThatRise) {
  const auto stamp = [](int k) { return fmt::format("10:00:{:06.3f}", 0.01 * k); };
  const auto monitor = [&](const char* arrow, const char* form) {
    return signal_rows(
        40, [&](int k, double a) { return stamp(k) + arrow + fmt::format(fmt::runtime(form), a); });
  };
  for (const char* const arrow : {" -> ", " > "})
    for (const char* const form :
         {"{0:.3f},{0:.4f}", "{0:.3f}\t{0:.4f}", "{0:.3f}", "X: {0:.3f}\tY: {0:.4f}"})
      EXPECT_THAT(question_of(monitor(arrow, form)), testing::StartsWith("read at 100")) << arrow << form;
  const std::string bridge =
      "Date,Time,Elapsed (s),Acc (g)\n" + signal_rows(40, [](int k, double a) {
        return fmt::format("2026-11-26,10:00:{:02d},{:.3f},{:.5f}", k / 20, 0.05 * k, a);
      });
  EXPECT_EQ(question_of(bridge), "read at 20 Hz");
  const std::string two_clocks =
      "Time_A,Sensor_A,Time_B,Sensor_B\n" + signal_rows(40, [](int k, double a) {
        return fmt::format("{:.4f},{:.5f},{:.4f},{:.5f}", 0.0025 * k, a, 0.01 * k, a);
      });
  EXPECT_THAT(question_of(two_clocks), testing::HasSubstr("times of two clocks"));
  const std::string spectrum =
      "Freq,Mag\n" + signal_rows(40, [](int k, double a) { return fmt::format("{},{:.5f}", 0.1 * k, a); });
  EXPECT_THAT(question_of(spectrum), testing::HasSubstr("a spectrum"));
}

TEST(RecognisedRecord, RefusesStampsOfTransfersAndTakesAStatedRateForThem) {
  std::string bursts = "time (s),acc\n" + signal_rows(640, [](int k, double a) {
                         return fmt::format("{:.5f},{:.5f}", 0.08 * (k / 16) + 0.00012 * (k % 16), a);
                       });
  RecordFormat as_they_are;
  as_they_are.irregular = true;
  EXPECT_THAT(question_of(bursts, as_they_are),
              testing::AllOf(testing::HasSubstr("bursts"), testing::HasSubstr("--rate")));
  RecordFormat with_rate;
  with_rate.sampling_rate = 200.0;
  EXPECT_EQ(question_of(bursts, with_rate), "read at 200 Hz");
  with_rate.sampling_rate = 210.0;  // which the stamps contradict
  EXPECT_THAT(question_of(bursts, with_rate), testing::HasSubstr("as stated"));
}

// Microseconds of an Arduino start again every 71 minutes.
TEST(RecognisedRecord, GoesOnWhereACounterOf32BitsStartsAgain) {
  const std::string text =
      "micros,ax\n" + signal_rows(60, [](int k, double a) {
        return fmt::format("{},{:.5f}", (4294900000u + 2500u * static_cast<unsigned>(k)), a);
      });
  EXPECT_EQ(question_of(text), "read at 400 Hz");
}

TEST(RecognisedRecord, PassesOverWhatIsNoPartOfTheRecord) {
  const auto row = [](int k, double a) {
    return fmt::format("{:.4f},{:.5f},{:.2f},{:.2f}", 0.0025 * k, a, 21.0, 0.3 * k);
  };
  std::string text = "Time (s),Acc (g),PTemp_C,gyro x\n" + signal_rows(80, row);
  text += "Max,1.0,21.0,9.0\nMean,0.1,21.0,4.0\n";
  const Record with_footer = recognised(text);
  EXPECT_EQ(with_footer.size(), 80);
  ASSERT_EQ(with_footer.channels.size(), 1u);
  EXPECT_EQ(with_footer.channels[0].name, "Acc (g)");
  std::string cut =
      "Time (s),Acc (g),b (g)\n" +
      signal_rows(80, [](int k, double a) { return fmt::format("{:.4f},{:.5f},{:.5f}", 0.0025 * k, a, a); }) +
      "0.2000,0.1";
  EXPECT_EQ(recognised(cut).size(), 80);
}

TEST(RecognisedRecord, ReadsStampsWithZonesAndOfOtherForms) {
  const auto question = [](const char* form) {
    return question_of("stamp,acc\n" + signal_rows(40, [&](int k, double a) {
                         return fmt::format(fmt::runtime(form), fmt::format("{:06.3f}", 0.01 * k),
                                            fmt::format("{:.4f}", a));
                       }));
  };
  for (const char* const form :
       {"2026-11-26 10:00:{} +0100,{}", "2026-11-26 10:00:{} CET,{}", "2026-11-26T10.00.{},{}",
        "20261126T1000{}Z,{}", "2026-11-26-10:00:{},{}", "0 days 00:00:{},{}"})
    EXPECT_THAT(question(form), testing::StartsWith("read at 100")) << form;
}

// Units of times that stand in a name, and those that no one could read.
TEST(RecognisedRecord, ReadsTheUnitOfTimesFromTheirName) {
  const auto rows = [](double step) {
    return signal_rows(40, [&](int k, double a) { return fmt::format("{:.9g},{:.5f}", step * k, a); });
  };
  for (const char* const name : {"time_min", "t_min", "Zeit/min", "elapsed_min", "tmin"})
    EXPECT_EQ(question_of(std::string(name) + ",acc\n" + rows(0.0025 / 60.0)), "read at 400 Hz") << name;
  for (const char* const name :
       {"Time-ms", "timeMs", "tms", "ms since start", "Zeit (Millisekunden)", "t_milli", "X [ms]"})
    EXPECT_EQ(question_of(std::string(name) + ",acc\n" + rows(2.5)), "read at 400 Hz") << name;
  for (const char* const name : {"Time (x10 ms)", "t [1/100 s]"})
    EXPECT_THAT(question_of(std::string(name) + ",acc\n" + rows(0.25)), testing::HasSubstr("not understood"))
        << name;
}

// Numbers beside the sensors: counts, what a phone computes from them, and readings of something else.
TEST(RecognisedRecord, TakesNeitherCountsNorMagnitudesForMotion) {
  const auto names = [](const Record& record) {
    std::string all;
    for (const Channel& channel : record.channels) all += channel.name + ";";
    return all;
  };
  const std::string rows = signal_rows(60, [](int k, double a) {
    const double b = 0.7 * a + 0.1, c = 9.81 - 0.2 * a;
    return fmt::format("{:.4f},{},{:.6f},{:.6f},{:.6f},{:.6f},{}", 0.0025 * k, 500 + k, a, b, c,
                       std::sqrt(a * a + b * b + c * c), -60 - k % 3);
  });
  EXPECT_EQ(names(recognised("Time (s),RECORD,ax,ay,az,Absolute acceleration (m/s^2),rssi\n" + rows)),
            "ax;ay;az;");
  EXPECT_EQ(names(recognised("Time (s),loggingSample(N),ax,ay,az,total,rssi\n" + rows)), "ax;ay;az;");
}

TEST(RecognisedRecord, ReadsUnitsFromLinesAboveAndRowsBelowTheNames) {
  const std::string rows =
      signal_rows(40, [](int k, double a) { return fmt::format("{:.4f},{:.6f}", 0.0025 * k, a); });
  for (const char* const head :
       {"# unit: g\ntime,acc", "UNITS: g\ntime,acc", "Einheit: g\ntime,acc", "Y Unit,g\ntime,acc",
        "# units: s, g\ntime,acc", "time,acc\nCh0,Ch1\ns,g", "s,g\ntime,acc",
        "time,acc\n[s],[g]\nfloat,float", "time,accG", "time,Acc-G"})
    EXPECT_NEAR(recognised(std::string(head) + "\n" + rows).samples(0, 0), 9.80665, 1e-9) << head;
  for (const char* const head : {"time,acc_mg", "time,acc (milli-g)"})
    EXPECT_NEAR(recognised(std::string(head) + "\n" + rows).samples(0, 0), 9.80665e-3, 1e-12) << head;
  for (const char* const head : {"time,a_mm_s2", "UNIT: MM/S/S\ntime,acc"})
    EXPECT_NEAR(recognised(std::string(head) + "\n" + rows).samples(0, 0), 1e-3, 1e-12) << head;
}

TEST(RecognisedRecord, ReadsRowsWhoseLastCellsAreEmpty) {
  const std::string rows = signal_rows(40, [](int k, double a) {
    return fmt::format("{:.4f};{:.5f};{};;", 0.0025 * k, a, k == 3 ? "ok" : "");
  });
  EXPECT_EQ(question_of("Zeit [s];Beschleunigung [m/s2];Kommentar;;\n" + rows), "read at 400 Hz");
}

// Nodes, addresses and states beside the numbers of each row, and stamps that no separator parts from them.
TEST(RecognisedRecord, ReadsRowsThatHoldWordsBesideTheirNumbers) {
  const auto stamp = [](int k) { return fmt::format("2026-11-26 10:00:{:06.3f}", 0.01 * k); };
  const auto rows = [&](const char* form) {
    return signal_rows(40, [&](int k, double a) {
      return fmt::format(fmt::runtime(form), fmt::arg("stamp", stamp(k)), fmt::arg("t", 0.01 * k),
                         fmt::arg("ms", 10 * k), fmt::arg("a", a), fmt::arg("hex", 7919 * k % 65536));
    });
  };
  for (const auto& [head, form] :
       {std::pair{"address\tTime(s)\tax(g)\n", "0x50\t{stamp}\t{a:.4f}"},
        std::pair{"Date,NodeName,X (g),\n", "{stamp},SensorTile @1A,{a:.4f},"},
        std::pair{"CLEARDATA\nLABEL,Time,Timer,ax\n", "DATA,{stamp},{t:.3f},{a:.4f}"},
        std::pair{"time_ms,acc,crc\n", "{ms},{a:.4f},0x{hex:04X}"}, std::pair{"", "{stamp} {a:.4f},{t:.4f}1"},
        std::pair{"", "[{stamp}] {a:.4f} {t:.3f}1"},
        std::pair{"Vendor,Logger\nStart,2026/11/26,10:00:00\nNumber,Date&Time,CH1,Alarm\nNO.,Time,g,A1\n",
                  "{ms},{stamp},{a:+.4f},LLLL"},
        std::pair{"Channels Sampled:,1\nSample Rate:,100\n\nTime,CHANNEL0,Events\n", "{t:.3f},{a:.5f},"}}) {
    const std::string text = head + rows(form);
    EXPECT_THAT(question_of(text), testing::StartsWith("read at 100")) << text.substr(0, 160);
  }
  std::string labels = rows("X: {a:.2f}  Y: {t:.3f}1  m/s^2");
  EXPECT_THAT(question_of("Sensor:  ADXL\nRange:  +/- 16 g\nData Rate: 100 Hz\n\n" + labels),
              testing::StartsWith("read at 100"));
  std::string minus = "Time (s),Acc (g)\n" + rows("{t:.3f},{a:.5f}");
  for (std::size_t at = 0; (at = minus.find('-', at)) != minus.npos;) minus.replace(at, 1, "\xE2\x88\x92");
  EXPECT_THAT(question_of(minus), testing::StartsWith("read at 100"));
  const std::string seconds = "Sample rate: 20 Hz\nTime,Acc (g)\n" + signal_rows(60, [](int k, double a) {
                                return fmt::format("10:00:{:02d},{:.5f}", k / 20, a);
                              });
  EXPECT_EQ(question_of(seconds), "read at 20 Hz");
}

}  // namespace
}  // namespace beamid::experiments::recognised_record_test
