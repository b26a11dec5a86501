// Heads and rows as instruments and telephones write them, shortened. Oracle: the numbers written, and the
// units and names of the makers' own files.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>

#include "experiments/record/inspect/inspection.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/recognised_text.hpp"

namespace beamid::experiments::instrument_files_test {
namespace {

using testing::Contains, testing::ElementsAre, testing::HasSubstr;

constexpr int rows = 60;

std::string two_signals(const char* separator = ",") {
  return signal_rows(rows, [=](int k, double a) {
    return fmt::format("{:.4f}{}{:.5f}{}{:.5f}", 0.0025 * k, separator, a, separator, 0.5 * a);
  });
}

TEST(RowOfUnits, HasTheNamesAboveItWhateverTheyAre) {
  const Record scanner = recognised("Time,101,102\ns,g,mm\n" + two_signals());
  EXPECT_THAT(scanner.channel_names(), ElementsAre("101", "102"));
  EXPECT_EQ(scanner.channels[1].quantity, Quantity::displacement);
  EXPECT_NEAR(scanner.samples(0, 0), standard_gravity, 1e-9);
  EXPECT_NEAR(scanner.samples(1, 0), 0.5e-3, 1e-12);
  const Record catman = recognised("Time CH=1\tAcc CH=2\tLVDT CH=14\ns\tg\tmm\n" + two_signals("\t"));
  EXPECT_NEAR(catman.samples(1, 0), 0.5e-3, 1e-12);
  const Record scope = recognised("X,CH1,CH2\nSecond,Volt,Volt\n" + two_signals());
  EXPECT_THAT(scope.channel_names(), ElementsAre("CH1", "CH2"));
}

TEST(RowOfUnits, CountsWhereItsLastCellIsEmpty) {
  const Record record = recognised("Time,AccTop,AccMid\ns,g,\n" + two_signals());
  EXPECT_NEAR(record.samples(0, 0), standard_gravity, 1e-9);
}

TEST(Volts, OfChannelsAreBroughtToOneUnit) {
  const Record record = recognised("Time,A,B\n(s),(mV),(V)\n" + two_signals());
  EXPECT_NEAR(record.samples(1, 0) / record.samples(0, 0), 500.0, 1e-9);
  EXPECT_THAT(record.remarks, Contains(HasSubstr("1 mV taken for 1 m/s2")));
}

TEST(StatementAbove, IsNoHeader) {
  const Record record = recognised("Units: g\nSample rate: 100 Hz\n" + signal_rows(rows, [](int, double a) {
                                     return fmt::format("{:.5f}\t{:.5f}", a, -a);
                                   }));
  EXPECT_NEAR(record.interval(), 0.01, 1e-12);
  EXPECT_NEAR(record.samples(0, 0), standard_gravity, 1e-9);
}

TEST(StatementAbove, NamesUnitsOfChannelsByNumber) {
  const std::string head =
      "SampleRate=10000\nNumChannels=1\nInputName_1=Lager 12\nMeasurandName_1=acceleration\nUnit_1=1\n"
      "UnitName_1=mm/s\xc2\xb2\n";
  const Record record =
      recognised(head + signal_rows(rows, [](int, double a) { return fmt::format("{:.5f}", a); }));
  EXPECT_NEAR(record.interval(), 1e-4, 1e-12);
  EXPECT_NEAR(record.samples(0, 0), 1e-3, 1e-12);
}

// The rows of the head have other cells than those of the record.
TEST(DataLogger, HasTheRestOfTheSecondsInAColumnOfItsOwn) {
  std::string text =
      "Vendor,GRAPHTEC Corporation\nSampling interval,10ms\nTotal data points,60\nCH,Signal name,Unit\n"
      "CH3,Acc_top,m/s2\nData\nNumber,Date,Time,us,CH3,CH5,AlarmOut\nNO.,Date,Time,us,m/s2,mm,A1234\n";
  for (int k = 0; k < rows; ++k)
    text += fmt::format("{},2026/07/02,17:02:{:02},{:06},{:+.4f},{:+.3f},LLLL\n", k + 1, 5 + k / 100,
                        10000 * (k % 100), std::cos(0.3 * k), 2.0 * std::sin(0.3 * k));
  const Record record = recognised(text);
  EXPECT_EQ(record.size(), rows);
  EXPECT_NEAR(record.interval(), 0.01, 1e-9);
  EXPECT_THAT(record.channel_names(), ElementsAre("CH3", "CH5"));
  EXPECT_EQ(record.channels[1].quantity, Quantity::displacement);
  EXPECT_NEAR(record.samples(1, 1), 2e-3 * std::sin(0.3), 1e-6);
}

TEST(RecordingOscilloscope, NamesItsTracesByKeys) {
  std::string text =
      "\"Header Size\",        16\n\"TraceName\",\"CH1\",\"CH2\"\n\"BlockSize\",      60,      60\n"
      "\"VUnit\",\"m/s2\",\"g\"\n\"HResolution\", 1.0E-03, 1.0E-03\n\"Date\",\"2013/05/10\",\"2013/05/10\"\n"
      "\"Time\",\"10:11:12.123456\",\"10:11:12.123456\"\n";
  text += signal_rows(rows, [](int, double a) { return fmt::format("       , {:.5E}, {:.5E}", a, 0.5 * a); });
  const Record record = recognised(text);
  EXPECT_EQ(record.size(), rows);
  EXPECT_NEAR(record.interval(), 1e-3, 1e-12);
  EXPECT_THAT(record.channel_names(), ElementsAre("CH1", "CH2"));
  EXPECT_NEAR(record.samples(1, 0), 0.5 * standard_gravity, 1e-9);
}

TEST(Wristband, StatesStartAndRateInItsFirstRows) {
  std::string text =
      "1642471872.000000, 1642471872.000000, 1642471872.000000\n32.000000, 32.000000, 32.000000\n";
  for (int k = 0; k < rows; ++k)
    text += fmt::format("{:.0f},{:.0f},{:.0f}\n", 60.0 * std::cos(0.3 * k), 30.0 * std::sin(0.3 * k),
                        64.0 - k % 3);
  const Record record = recognised(text);
  EXPECT_EQ(record.size(), rows);
  EXPECT_NEAR(record.interval(), 1.0 / 32.0, 1e-12);
}

TEST(Telephone, WritesNumbersBesideTextNotNewtons) {
  const std::string text =
      "loggingTime(txt),loggingSample(N),accelerometerAccelerationX(G),label(N)\n" +
      signal_rows(rows, [](int k, double a) {
        return fmt::format("2026-03-01 10:00:00.{:03},{},{:.5f},{}", 10 * k, k + 1, a, k / 20 % 2);
      });
  EXPECT_THAT(recognised(text).channel_names(), ElementsAre("accelerometerAccelerationX(G)"));
}

TEST(Telephone, HoldsReadingsOverTheRowsOfItsOtherSensors) {
  std::string text = "time,gFx,gFy,ax\n";
  for (int k = 0; k < 3 * rows; ++k)
    text += fmt::format("{:.3f},{:.4f},{:.4f},{:.4f}\n", 0.02 * k, std::cos(0.4 * (k / 3)),
                        std::sin(0.4 * (k / 3)), std::cos(0.4 * ((k + 1) / 3)));
  const Record record = recognised(text);
  EXPECT_NEAR(record.interval(), 0.06, 1e-9);
  EXPECT_NEAR(static_cast<double>(record.size()), rows, 2);
  EXPECT_THAT(record.remarks, Contains(HasSubstr("repeated over 3 rows")));
}

TEST(Times, AreTheSumOfIntervals) {
  const Record record = recognised(
      "ax,time diff in ms\n" + signal_rows(rows, [](int, double a) { return fmt::format("{:.5f},20", a); }));
  EXPECT_NEAR(record.interval(), 0.02, 1e-12);
}

TEST(Times, OfAnUnevenClockMayRepeat) {
  std::string text = "time,ax\n";
  for (int k = 0; k < rows; ++k) {
    const double time = 0.01 * k + 0.004 * std::sin(1.7 * k);
    text +=
        fmt::format("{:.3f},{:.4f}\n", k % 10 == 9 ? 0.01 * (k - 1) + 0.004 * std::sin(1.7 * (k - 1)) : time,
                    std::cos(0.3 * k));
  }
  RecordFormat uneven;
  uneven.irregular = true;
  const Record record = recognised(text, uneven);
  EXPECT_EQ(record.size(), rows - 6);
  EXPECT_THAT(record.remarks, Contains(HasSubstr("has the stamp of the line before it")));
}

TEST(ColumnsWithoutNames, ThatOnlyRiseAreNoMotion) {
  const Record record = recognised(signal_rows(2 * rows, [](int k, double a) {
    return fmt::format("{:.4f} {:.4f} {:.5f}", 0.0025 * k, 8902.7 + 0.0025 * k + 1e-4 * (k % 3), a);
  }));
  EXPECT_THAT(record.channel_names(), ElementsAre("column_3"));
  EXPECT_THAT(record.remarks, Contains(HasSubstr("only rise, omitted: 2")));
}

TEST(RowOfUnits, MayMixThoseOfUdunitsWithOthers) {
  const Record record =
      recognised("Time,Accel,Velocity,LVDT\ns,g,cm/s,in\n" + signal_rows(rows, [](int k, double a) {
                   return fmt::format("{:.4f},{:.5f},{:.5f},{:.5f}", 0.0025 * k, a, a, a);
                 }));
  EXPECT_NEAR(record.samples(1, 0), 1e-2, 1e-9);
  EXPECT_EQ(record.channels[2].quantity, Quantity::displacement);
  EXPECT_NEAR(record.samples(2, 0), 0.0254, 1e-9);
}

TEST(ColumnsBesideAccelerations, OfNeitherQuantityNorUnitAreOmitted) {
  const Record inertial = recognised("t,Ax,Ay,Gx,Gy,p\n" + signal_rows(rows, [](int k, double a) {
                                       return fmt::format("{:.4f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}",
                                                          0.0025 * k, a, -a, 0.3 * a, 2.0, 0.1 * a);
                                     }));
  EXPECT_THAT(inertial.channel_names(), ElementsAre("Ax", "Ay"));
  const Record scope = recognised("Time,A,B\n" + two_signals());  // channels by letters
  EXPECT_THAT(scope.channel_names(), ElementsAre("A", "B"));
}

TEST(DigitalLines, AreNoMotion) {
  const Record record =
      recognised("Time (s),Acceleration (m/s2),D0,D1\n" + signal_rows(rows, [](int k, double a) {
                   return fmt::format("{:.4f},{:.5f},0,{}", 0.0025 * k, a, k % 2);
                 }));
  EXPECT_THAT(record.channel_names(), ElementsAre("Acceleration (m/s2)"));
}

// A second run beside the first, over fewer rows.
TEST(TwoClocks, AreAQuestionWhereTheirRowsEndApart) {
  const std::string text =
      "Time A [s],A [g],Time B [s],B [g]\n" + signal_rows(rows, [](int k, double a) {
        return k < 40 ? fmt::format("{:.4f},{:.5f},{:.4f},{:.5f}", 0.0025 * k, a, 0.004 * k, a)
                      : fmt::format("{:.4f},{:.5f},,", 0.0025 * k, a);
      });
  EXPECT_THAT(question_of(text),
              HasSubstr("times of two clocks, the first over 60 rows, the second over 40"));
}

TEST(CommentAboveOneColumn, ThatStatesSomethingIsNoName) {
  const auto column = [](int, double a) { return fmt::format("{:.5f}", a); };
  for (const char* text : {"# Sample rate: 100 Hz\n", "# dt = 0.01 s\n",
                           "# Sample rate: 100 Hz\n# Displacement of the shaker: 5 mm\n"}) {
    const Record record = recognised(text + signal_rows(rows, column));
    EXPECT_NEAR(record.interval(), 0.01, 1e-12) << text;
    EXPECT_EQ(record.channels[0].quantity, Quantity::acceleration) << text;
    EXPECT_NEAR(record.samples(0, 0), 1.0, 1e-9) << text;
  }
}

// The first and the last row alone fill the cells at their ends.
TEST(Logger, HasCellsAtTheEndsOfRowsThatHoldNothing) {
  const Record record =
      recognised("\"#\",\"Time (s)\",\"X Accel, g\",\"Started\",\"End Of File\"\n" +
                 signal_rows(rows, [](int k, double a) {
                   return fmt::format("{},{:.4f},{:.5f},{},{}", k + 1, 0.0025 * k, a, k == 0 ? "Logged" : "",
                                      k == rows - 1 ? "Logged" : "");
                 }));
  EXPECT_THAT(record.channel_names(), ElementsAre("X Accel, g"));
  EXPECT_EQ(record.size(), rows);
}

TEST(Telephone, WritesSoManyOfSoMany) {
  const Record record = recognised(
      "ACCELEROMETER X (m/s\xc2\xb2);Satellites in range;TIME SINCE START (ms)\n" +
      signal_rows(rows, [](int k, double a) { return fmt::format("{:.5f};6 / 12;{}", a, 10 * k); }));
  EXPECT_THAT(record.channel_names(), ElementsAre("ACCELEROMETER X (m/s\xc2\xb2)"));
}

// np.save of [('t', '<M8[ns]'), ('acc', '<f8')].
TEST(NumpyRecords, MayHoldInstants) {
  const std::string header =
      "{'descr': [('t', '<M8[ns]'), ('acc', '<f8')], 'fortran_order': False, 'shape': (60,), }\n";
  std::string bytes = "\x93NUMPY\x01" + std::string(1, '\0') + static_cast<char>(header.size()) +
                      std::string(1, '\0') + header;
  for (std::int64_t k = 0; k < rows; ++k) {
    const std::int64_t instant = 1'764'528'000'000'000'000 + 2'500'000 * k;
    const double value = std::cos(0.3 * static_cast<double>(k));
    bytes.append(reinterpret_cast<const char*>(&instant), 8).append(reinterpret_cast<const char*>(&value), 8);
  }
  const TemporaryFile file("record.npy", bytes);
  const Record record = read_record(file.path(), {});
  EXPECT_EQ(record.size(), rows);
  EXPECT_NEAR(record.interval(), 0.0025, 1e-12);
  EXPECT_NEAR(record.samples(0, 1), std::cos(0.3), 1e-12);
}

TEST(Inspection, ReadsWhatOtherCommandsRead) {
  const TemporaryFile file(
      "logger.dat",
      "\"TOA5\",\"station\",\"CR1000\",\"1\"\n\"TIMESTAMP\",\"RECORD\",\"AccX\",\"AccY\"\n"
      "\"TS\",\"RN\",\"g\",\"g\"\n\"\",\"\",\"Smp\",\"Smp\"\n" +
          signal_rows(rows, [](int k, double a) {
            return fmt::format("\"2026-03-01 10:00:00.{:03}\",{},{:.5f},{:.5f}", 10 * k, k, a, -a);
          }));
  const Inspection found = inspect(file.path(), {});
  EXPECT_EQ(found.channels.back().name, "AccY");
}

// A head whose lines have as many words as the rows have cells, the last of which hold nothing.
TEST(RowOfUnits, CountsWhereAllLinesEndInSeparators) {
  const std::string body = signal_rows(
      rows, [](int k, double a) { return fmt::format("{:.4f}\t{:.5f}\t{:.5f}\t", 0.0025 * k, a, 0.5 * a); });
  const Record machine = recognised(
      "MTS793|MPT|ENU\n\nStation Name: Frame 1\nTime\tAxial Displacement\tAxial Force\t\nsec\tmm\tkN\t\n" +
      body);
  EXPECT_EQ(machine.channels[0].quantity, Quantity::displacement);
  EXPECT_NEAR(machine.samples(0, 0), 1e-3, 1e-12);
  EXPECT_EQ(machine.channels[1].quantity, Quantity::force);
  const Record program = recognised(
      "DASYLab - V 13.00.00\nDelta : 0.0025 sec.\nNumber of channels : 2\nMeasuring time[s];Tip [g];Middle "
      "[g];\n" +
      signal_rows(rows, [](int k, double a) {
        return fmt::format("{:.4f};{:.5f};{:.5f};", 0.0025 * k, a, 0.5 * a);
      }));
  EXPECT_THAT(program.channel_names(), ElementsAre("Tip [g]", "Middle [g]"));
  EXPECT_NEAR(program.samples(0, 0), standard_gravity, 1e-9);
}

TEST(Keys, StandInFrontOfNamesAndUnitsOrAboveThem) {
  const Record analyser =
      recognised("NVGate\nTitle\tTip\tMid\nX axis\tTime\tTime\nX unit\ts\ts\nY unit\tg\tg\nX\tTr1\tTr2\n" +
                 two_signals("\t"));
  EXPECT_THAT(analyser.channel_names(), ElementsAre("Tip", "Mid"));
  EXPECT_NEAR(analyser.samples(0, 0), standard_gravity, 1e-9);
  const Record logger =
      recognised("*CREATOR\nMSR\n*CHANNEL\nTIME;ACC x;ACC y;\n*UNIT\nTIME;g;g;\n*CALIBRATION\n\n*DATA\n" +
                 signal_rows(rows, [](int k, double a) {
                   return fmt::format("2026-11-26 10:00:00.{:03};{:.5f};{:.5f};", 10 * k, a, 0.5 * a);
                 }));
  EXPECT_THAT(logger.channel_names(), ElementsAre("ACC x", "ACC y"));
  EXPECT_NEAR(logger.samples(1, 0), 0.5 * standard_gravity, 1e-9);
}

TEST(Camera, NumbersTheComponentsOfASensor) {
  const Record record = recognised(
      "\"cts\",\"date\",\"Accelerometer (z) [m/s2]\",\"1\",\"2\",\"temperature [\xc2\xb0\x43]\"\n" +
      signal_rows(rows, [](int k, double a) {
        return fmt::format("{:.2f},2026-11-26T10:00:00.{:03}Z,{:.5f},{:.5f},{:.5f},38.2", 21.5 + 10 * k,
                           10 * k, a, 0.5 * a, -a);
      }));
  EXPECT_THAT(record.channel_names(),
              ElementsAre("Accelerometer (z) [m/s2]", "1: Accelerometer [m/s2]", "2: Accelerometer [m/s2]"));
  EXPECT_NEAR(record.interval(), 0.01, 1e-9);
}

TEST(UnitOfAColumn, StandsBeforeASerialNumberOrANumberAndSaysMoreThanALetter) {
  const Record pendant =
      recognised("Time (s),\"X Accel, g (LGR S/N: 12, SEN S/N: 12)\",Acc_mg_2\n" + two_signals());
  EXPECT_NEAR(pendant.samples(0, 0), standard_gravity, 1e-9);
  EXPECT_NEAR(pendant.samples(1, 0), 0.5e-3 * standard_gravity, 1e-9);
  const Record images = recognised("Time_0,u [mm],v [mm]\n" + two_signals());
  EXPECT_EQ(images.channels[1].quantity, Quantity::displacement);
  EXPECT_NEAR(images.samples(1, 0), 0.5e-3, 1e-12);
}

// Names in Shift-JIS, which are no UTF-8.
TEST(UnitOfAColumn, IsEnoughBesideAWordOfOtherLetters) {
  const Record record = recognised("\x8e\x9e\x8a\xd4(s),\x89\xc1\x91\xac\x93x(g),B (g)\n" + two_signals());
  EXPECT_NEAR(record.interval(), 0.0025, 1e-12);
  EXPECT_NEAR(record.samples(0, 0), standard_gravity, 1e-9);
}

TEST(Telephone, AddsAMagnitudeWithoutItsMeanAndGravity) {
  const Record record =
      recognised("Time(s),AccX,AccY,AccZ,G(calibrated),GRAVITY X (m/s\xc2\xb2)\n" +
                 signal_rows(rows, [](int k, double a) {
                   const double b = 0.3 * std::sin(0.2 * k), c = 9.81 + 0.2 * std::cos(0.5 * k);
                   return fmt::format("{:.4f},{:.6f},{:.6f},{:.6f},{:.6f},{:.5f}", 0.0025 * k, a, b, c,
                                      std::sqrt(a * a + b * b + c * c) - 9.81, 0.001 * std::cos(0.1 * k));
                 }));
  EXPECT_THAT(record.channel_names(), ElementsAre("AccX", "AccY", "AccZ"));
}

TEST(Console, HasCountersInFrontOfItsRows) {
  const Record log =
      recognised("I (312) main_task: Calling app_main()\n" + signal_rows(rows, [](int k, double a) {
                   return fmt::format("I ({}) imu: ax={:.5f} ay={:.5f}", 1000 + 10 * k, a, -a);
                 }));
  EXPECT_THAT(log.channel_names(), ElementsAre("ax", "ay"));
  EXPECT_NEAR(log.interval(), 0.01, 1e-12);
  EXPECT_THAT(
      question_of(signal_rows(
          rows, [](int k, double a) { return fmt::format("{}: {:.5f}, {:.5f}", 1234 + 10 * k, a, -a); })),
      HasSubstr("--time 1:ms"));
}

TEST(Json, IsReadByRowsAndByColumns) {
  const auto row = [](int k, double a) {
    return fmt::format("{{\"t\": {:.4f}, \"ax\": {:.5f}}}", 0.0025 * k, a);
  };
  const std::string lines = signal_rows(rows, row);
  std::string document = "[\n" + signal_rows(rows, [&](int k, double a) { return row(k, a) + ","; });
  document.resize(document.rfind(','));
  std::string column = "{\"fs\": 400, \"acc_g\": [1.0";
  for (int k = 1; k < rows; ++k) column += fmt::format(",{:.5f}", std::exp(-0.002 * k) * std::cos(0.08 * k));
  for (const std::string& text :
       {lines, document + "]", "{\"data\": " + document + "], \"fs\": 400}", column + "]}"}) {
    const Record record = recognised(text);
    EXPECT_EQ(record.size(), rows);
    EXPECT_NEAR(record.interval(), 0.0025, 1e-9);
  }
  EXPECT_NEAR(recognised(column + "]}").samples(0, 0), standard_gravity, 1e-9);
  EXPECT_THAT(question_of("{\"device\": \"x\", \"items\": {}}"), HasSubstr("an array of objects"));
}

// Python writes NaN, of which JSON has none: what was not read. Oracle: the sample that is missing.
TEST(Json, HoldsNotANumberAndItsErrorsHaveAPlace) {
  std::string document = "[\n";
  for (int k = 0; k < rows; ++k)
    document += fmt::format("{{\"t\": {:.4f}, \"NaN acc\": {}}},\n", 0.0025 * k,
                            k == 7 ? "NaN" : fmt::format("{:.5f}", std::cos(0.08 * k)));
  const std::string whole = document.substr(0, document.rfind(',')) + "]";
  RecordFormat gaps;
  gaps.malformed = MalformedRows::as_missing;
  const Record record = recognised(whole, gaps);
  ASSERT_EQ(record.size(), rows);
  EXPECT_TRUE(std::isnan(record.samples(0, 7)));
  EXPECT_THAT(question_of(document + "{\"t\": }]"), HasSubstr(fmt::format("txt:{}:7: JSON", rows + 2)));
  for (const char* const beyond : {"[{\"t\": 0},\n{\"t\": 1e999}]", "{\"t\": [0],\n\"a\": 1e999}",
                                   "{\"t\": 0}\n{\"t\": 1e999}\n{\"t\": 2}"})
    EXPECT_THAT(question_of(beyond), HasSubstr("txt:2:")) << beyond;
}

// Columns of pandas, and a unit and a rate beside the samples. Oracle: the decay.
TEST(Json, HoldsColumnsOfPandasAndTheUnitBesideSamples) {
  std::string times, values, samples;
  for (int k = 0; k < rows; ++k) {
    times += fmt::format("{}\"{}\": {:.4f}", k > 0 ? "," : "", k, 0.0025 * k);
    values += fmt::format("{}\"{}\": {:.5f}", k > 0 ? "," : "", k, std::cos(0.08 * k));
    samples += fmt::format("{}{:.5f}", k > 0 ? "," : "", std::cos(0.08 * k));
  }
  for (const auto& [text, factor] :
       {std::pair{"{\"t\": {" + times + "}, \"acc\": {" + values + "}}", 1.0},
        std::pair{"{\"sampling_rate_hz\": 400, \"unit\": \"g\", \"samples\": [" + samples + "]}",
                  standard_gravity}}) {
    const Record record = recognised(text);
    ASSERT_EQ(record.size(), rows);
    EXPECT_NEAR(record.interval(), 0.0025, 1e-9);
    EXPECT_NEAR(record.samples(0, 9), factor * std::cos(0.72), 1e-4 * factor);
  }
}

TEST(Inspection, TakesTheUnitThatStandsAboveTheColumns) {
  const TemporaryFile file("record.csv", "Units: g\nTime (s),X,Y\n" + two_signals());
  const Inspection found = inspect(file.path(), {});
  EXPECT_EQ(found.channels[0].quantity, Quantity::acceleration);
  EXPECT_NEAR(found.channels[0].samples[0], standard_gravity, 1e-9);
}

}  // namespace
}  // namespace beamid::experiments::instrument_files_test
