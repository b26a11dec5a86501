// Units that lines above the columns state, in headers as strong-motion networks and people write them.
// Oracle: the numbers written, in the units of the networks' own descriptions.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/record/inspect/inspection.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/recognised_text.hpp"

namespace beamid::experiments::stated_unit_test {
namespace {

using testing::AllOf, testing::ElementsAre, testing::HasSubstr;

constexpr double gal = 0.01;

// Three components that reach 1.2, 0.6 and 0.3.
std::string three_columns(double size = 1.2) {
  return signal_rows(60, [=](int, double a) {
    return fmt::format("{:12.6f} {:12.6f} {:12.6f}", size * a, 0.5 * size * a, -0.25 * size * a);
  });
}

// AFAD, Turkey: the unit stands beside the peaks, above names of directions.
std::string afad(const std::string& peaks, double size = 1.2) {
  return "STRONG GROUND MOTION RECORDS OF TURKIYE\n"
         "PLACE                   : GEDIZ\n"
         "EARTHQUAKE DATE         : 2017/07/20 22:31:09 (GMT)\n"
         "EARTHQUAKE DEPTH (km)   : 19.44\n"
         "STATION ALTITUDE (m)    : 735\n"
         "RECORD TIME             : 20/07/2017 22:31:14.000000 (GMT)\n"
         "NUMBER OF DATA          : 60\n"
         "SAMPLING INTERVAL (sec) : 0.01\n" +
         peaks +
         "\nCopyright EARTHQUAKE DEPARTMENT\nDISASTER AND EMERGENCY MANAGEMENT PRESIDENCY\n"
         "       N-S          E-W          U-D\n" +
         three_columns(size);
}

TEST(StatedUnit, BesideThePeaksOfAfadIsThatOfTheColumns) {
  const Record record =
      recognised(afad("RAW PGA VALUES (gal)    : (N-S) 1.218825 (E-W) 0.607812 (U-D) 0.305862"));
  EXPECT_THAT(record.channel_names(), ElementsAre("N-S", "E-W", "U-D"));
  EXPECT_NEAR(record.interval(), 0.01, 1e-12);
  EXPECT_NEAR(record.samples(0, 0), 1.2 * gal, 1e-12);
  EXPECT_NEAR(record.samples(2, 0), -0.3 * gal, 1e-12);
  const Record part =  // before the motion arrives
      recognised(afad("RAW PGA VALUES (gal)    : (N-S) 121.8825 (E-W) 60.7812 (U-D) 30.5862"));
  EXPECT_NEAR(part.samples(0, 0), 1.2 * gal, 1e-12);
}

TEST(StatedUnit, OfPeaksThatTheColumnsDoNotReachIsAQuestion) {
  const std::string other =
      afad("RAW PGA VALUES (gal)    : (N-S) 1.218825 (E-W) 0.607812 (U-D) 0.305862", 30.0);
  EXPECT_THAT(question_of(other),
              AllOf(HasSubstr("a peak of 1.219 gal"), HasSubstr("reach 30"), HasSubstr("--unit g")));
  RecordFormat stated;
  stated.channels = {{Quantity::acceleration, "", 1, gal}};
  EXPECT_EQ(question_of(other, stated), "read at 100 Hz");
  const TemporaryFile file("record.txt", other);
  EXPECT_THAT(inspect(file.path(), {}).warnings, testing::Contains(HasSubstr("a peak of 1.219 gal")));

  EXPECT_THAT(question_of("dt = 0.01\nPeak acceleration: 0.35 g at 12.3 sec\nN E V\n" + three_columns(120.0)),
              HasSubstr("a peak of 0.35 g"));
  const Record in_g =
      recognised("dt = 0.01\nPeak acceleration: 1.25 g at 12.3 sec\nN-S E-W U-D\n" + three_columns());
  EXPECT_NEAR(in_g.samples(0, 0), 1.2 * standard_gravity, 1e-9);
  const Record in_si =
      recognised("dt = 0.01\nMax acceleration = 0.125 g\nN-S E-W U-D\n" + three_columns());  // 1.23 m/s2
  EXPECT_NEAR(in_si.samples(0, 0), 1.2, 1e-12);
  const Record range =
      recognised("dt = 0.01\nMax acceleration range = 16 g\nN-S E-W U-D\n" + three_columns());
  EXPECT_NEAR(range.samples(0, 0), 1.2, 1e-12);
}

TEST(StatedUnit, StandsInAnyLineAboveTheColumns) {
  for (const auto& [head, factor] : {
           std::pair{"UNIDADES DE LOS DATOS                  : Gal (cm/s/s)\n"
                     "ESC. COMPLETA DE SENSORES, C1-C6, (g)  : /2/2/2\n"
                     "   CANAL-1   CANAL-2   CANAL-3\n      N00E      N90E         V\n",
                     gal},                                              // UNAM, Mexico
           {"SITE CODE= 47401\nUNIT  = gal(cm/s/s)\nNS EW UD\n", gal},  // JMA, Japan
           {"UNITS: cm/s^2\nPGA_CM/S^2: 1.2\nSTREAM: HNE\n", gal},      // ESM
           {"UNITS: gal\nN-S E-W U-D\n", gal},
           {"Units = cm/sec/sec\nN-S E-W U-D\n", gal},
           {"Units are cm/sec2\nN-S E-W U-D\n", gal},
           {"UNITS: MG\nN-S E-W U-D\n", 1e-3 * standard_gravity},
           {"CORRECTED ACCELERATION   UNIT: CM/SEC/SEC\nNPTS = 60\n", gal},
           {"ACCELERATION TIME SERIES IN UNITS OF G\nN-S E-W U-D\n", standard_gravity},
           {"UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  =  0.052 G\n", 0.1 * standard_gravity},
           {"ACCELERATION TIME HISTORY IN G\nNPTS = 60\n", standard_gravity},
           {"Ground acceleration (cm/s2)\nN-S E-W U-D\n", gal},
           {"ACELERACION (cm/seg2)\nN-S E-W U-D\n", gal},
           {"Length units: mm\nN-S E-W U-D\n", 1.0},
           {"Time unit: m\nN-S E-W U-D\n", 1.0},
           {"Trigger threshold (gal): 0.5\nN-S E-W U-D\n", 1.0},
           {"Units: counts\nN-S E-W U-D\n", 1.0},
       })
    EXPECT_NEAR(
        recognised(std::string("Sampling interval (s): 0.005\n") + head + three_columns()).samples(0, 0),
        1.2 * factor, 1e-9)
        << head;
}

TEST(StatedUnit, ThatIsNotOneIsAQuestion) {
  for (const char* const head :
       {"UNITS: g\nUNITS: gal\n", "units: s, g, mm\n", "Acceleration units: g, cm/s2\n"}) {
    EXPECT_THAT(question_of(std::string("dt = 0.01\n") + head + "N-S E-W U-D\n" + three_columns()),
                AllOf(HasSubstr("state several units"), HasSubstr("--unit g")))
        << head;
    EXPECT_NEAR(
        recognised(std::string("dt = 0.01\n") + head + "a [m/s2],b [g],c [g]\n" +
                   signal_rows(60, [](int, double a) { return fmt::format("{},{},{}", a, -a, 0.5 * a); }))
            .samples(0, 0),
        1.0, 1e-12)
        << head;
  }
}

// CWA, Taiwan: a comment names the columns, with the polarity of each.
TEST(StatedUnit, AndNamesOfADataSequenceAreTaken) {
  std::string text =
      "#StationCode: ILA005\n#InstrumentKind: CV574(06106600.CVA)\n"
      "#StartTime: 2017/03/07-22:11:14.000\n#RecordLength(sec):   51.000\n#SampleRate(Hz): 200\n"
      "#AmplitudeUnit:  gal. DCoffset(corr)\n#AmplitudeMAX. U:    4.094~   -4.353\n"
      "#DataSequence: Time U(+); N(+); E(+)\n#Data: 4F10.3\n";
  text += signal_rows(60, [](int k, double a) {
    return fmt::format("{:10.3f}{:10.3f}{:10.3f}{:10.3f}", 0.005 * k, 4.0 * a, -2.0 * a, a);
  });
  const Record record = recognised(text);
  EXPECT_THAT(record.channel_names(), ElementsAre("U(+)", "N(+)", "E(+)"));
  for (const Channel& channel : record.channels) EXPECT_EQ(channel.quantity, Quantity::acceleration);
  EXPECT_NEAR(record.interval(), 0.005, 1e-12);
  EXPECT_NEAR(record.samples(0, 0), 4.0 * gal, 1e-12);
  EXPECT_NEAR(record.samples(1, 0), -2.0 * gal, 1e-12);

  const Record bare =
      recognised("# unit: gal\nTime,U,N,E\n" + signal_rows(60, [](int k, double a) {
                   return fmt::format("{:.3f},{:.3f},{:.3f},{:.3f}", 0.005 * k, 4.0 * a, -2.0 * a, a);
                 }));
  EXPECT_EQ(bare.channels.at(0).quantity, Quantity::acceleration);
  EXPECT_NEAR(bare.samples(0, 0), 4.0 * gal, 1e-12);
}

}  // namespace
}  // namespace beamid::experiments::stated_unit_test
