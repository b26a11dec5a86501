// Strong-motion files of three components: GeoNet, BHRC and RENADIC; and uncorrected ones of CSMIP. Oracle:
// the numbers written into the files, in the networks' forms.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "experiments/record/read_record.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"

namespace beamid::experiments::strong_motion_components_test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

// Numbers in cells, ten a line.
std::string cells(const std::vector<double>& values, const char* form) {
  std::string text;
  for (std::size_t k = 0; k < values.size(); ++k)
    text += fmt::format(fmt::runtime(form), values[k]) + (k % 10 == 9 || k + 1 == values.size() ? "\n" : "");
  return text;
}

std::vector<double> motion(int count, double scale) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(scale * (k % 5 - 2 + 0.1 * k));
  return values;
}

struct Geonet {
  int raw = 24, processed = 0;  // samples; 0: uncorrected
  double interval = 0.005, length = 0.12;
};

std::string geonet(const std::string& direction, const Geonet& of, const std::vector<double>& accelerations) {
  const bool corrected = of.processed > 0;
  std::vector<double> numbers(100, 0.0);
  numbers[30] = of.raw;
  numbers[33] = corrected ? of.processed : of.raw;
  if (corrected) numbers[34] = numbers[35] = of.processed;
  numbers[60] = 327.68, numbers[63] = of.length, numbers[64] = 0.005, numbers[65] = of.interval,
  numbers[69] = 9806.6;
  std::string text =
      (corrected ? "Corrected" : "Uncorrected") +
      std::string(
          " accelerogram 20161113_110256_WTMC_20 GNS Science\n"
          "Site WTMC      42 37 10S  173 03 13E     Cusp file:  20161113_110259_WTMC\n"
          "Te Mara Farm Waiau\nInstrument Cusp_10462\n"
          "Resolution: 18-bit   Instr Period: 0.0050 s   Damping: 0.700\n"
          "Accelerogram 20161113_110256_WTMC_20                 Processed 2016 December 09\n"
          "5 km south-west of Waiau\n2016 November 13         11:02:56 UT\n"
          "Epicentre  42 41 33S 173 01 19E  Bearing S18W  Dist    9km  Depth   15km Mw 7.82\n");
  text += fmt::format("Number of points  {}    Duration {} s\n", numbers[33], of.length);
  text += corrected ? "Instrument corrected data at 0.020 sec intervals\n"
                      "Band-pass filter transition bands are .10-.25 Hz and 24.50-25.50 Hz\n"
                    : "Raw readings in units of 1.00 mm/s/s  at intervals of 0.005 s\nData is unfiltered\n";
  text += "Component " + direction +
          "\nAcceleration:  peak  -9733.1 mm/s/s at  44.88 sec     rms    719.0 mm/s/s\n";
  text += corrected ? "Velocity:      peak -1016.55 mm/s   at  46.58 sec     rms    96.10 mm/s\n"
                      "Displacement:  peak  234.852 mm     at  46.36 sec     rms   38.013 mm\n"
                    : "Velocity record unevaluated\nDisplacement record unevaluated\n";
  text += cells(numbers, "{:8g}") + cells(accelerations, "{:8.1f}");
  if (corrected)
    for (const double scale : {7.0, 9.0}) text += cells(motion(of.processed, scale), "{:8.1f}");
  return text;
}

TEST(StrongMotionComponents, OfGeonetAreReadInCellsWithoutBlanks) {
  const Geonet raw;
  const std::vector<double> north = motion(24, -4000.0);
  const TemporaryFile file("20161113.V1A", geonet("N28W", raw, north) + geonet("S62W", raw, motion(24, 3.0)) +
                                               geonet("Up", raw, motion(24, 5.0)));
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), 24);
  EXPECT_THAT(record.channel_names(), ElementsAre("n28w", "s62w", "up"));
  EXPECT_NEAR(record.interval(), 0.005, 1e-15);
  EXPECT_NEAR(record.samples(0, 23), 1e-3 * north[23], 1e-12);  // "-13200.0" fills its cell
  EXPECT_NEAR(record.samples(2, 0), -0.01, 1e-12);
}

TEST(StrongMotionComponents, OfGeonetPassOverVelocitiesAndDisplacements) {
  const Geonet processed{65536, 32, 0.02, 0.64};
  const TemporaryFile file("20161113.V2A",
                           geonet("N28W  Longitudinal Accelerometer Axis", processed, motion(32, 1.0)) +
                               geonet("N28W  Transverse Accelerometer Axis", processed, motion(32, 2.0)) +
                               geonet("Up", processed, motion(32, 3.0)));
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), 32);
  EXPECT_THAT(record.channel_names(), ElementsAre("n28w", "n28w_2", "up"));
  EXPECT_NEAR(record.interval(), 0.02, 1e-15);
  EXPECT_NEAR(record.samples(1, 7), 2e-3 * (7 % 5 - 2 + 0.7), 1e-12);
  EXPECT_THAT(record.remarks, testing::Contains(HasSubstr("6 series of other quantities than acceleration")));
}

TEST(StrongMotionComponents, OfGeonetHaveTheIntervalOfTheirLength) {
  const Geonet fine{2560, 0, 0.0078, 20.0};  // of 128 Hz, printed to 0.1 ms
  const TemporaryFile file("x.V1A", geonet("Up", fine, motion(2560, 1.0)));
  EXPECT_NEAR(read_record(file.path()).interval(), 1.0 / 128.0, 2e-6);
}

std::string bhrc(const std::string& component, int count, const std::string& units = "SECONDS AND G/10") {
  std::string text =
      "* VOL1DS FILE:  5523/01\nInst Type = SSA-2\nOrigin Time : 2012/08/11   12:23:16\n\n" +
      component.substr(0, 1) + "\n   \nCOMP " + component +
      "   \nAmand       Station   38.231 N 46.156 E   Altitude 1495m   Azimuth L 177   T 267\n"
      "Epicenter 38.520 N 46.860 E   FD 12 Km mb      Ms      Mw6.1   M        ML   (BHRC   )\n"
      "INSTR PERIOD =  .020 SEC   DAMPING =  .640\n";
  text += fmt::format("NO. OF POINTS = {:6d}      DURATION = {:7.3f}\nUNITS ARE {}\n   \n", count,
                      0.005 * count, units);
  text +=
      "    0    0    0    0    0    0    0    0    0    0    0    0    0    0\n"
      "    0    0    0    0    0    0    0    0    0    0    013056    0    0\n";
  for (int k = 0; k < 5; ++k) text += "    0    0    0    0\n";
  text +=
      "  .199601E-01  .640000E+00  .652800E+02  .000000E+00  .100000E+00  .00\n"
      "  .200000E+03  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .00\n";
  for (int k = 0; k < 5; ++k) text += "  .000000E+00  .000000E+00\n";
  return text + cells(motion(count, component == "V2" ? -1e-3 : 1e-3), "{:13.6E}") + "/&\n";
}

TEST(StrongMotionComponents, OfBhrcAreInTenthsOfGravity) {
  const TemporaryFile file("5523-1.V1", bhrc("L1", 36) + bhrc("V2", 36) + bhrc("T3", 36));
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), 36);
  EXPECT_THAT(record.channel_names(), ElementsAre("l", "v", "t"));
  EXPECT_NEAR(record.interval(), 0.005, 1e-15);
  EXPECT_NEAR(record.samples(0, 12), 1e-3 * 1.2 * 0.1 * standard_gravity, 1e-9);
  EXPECT_NEAR(record.samples(1, 12), -record.samples(0, 12), 1e-15);
}

std::string renadic(int channel, const std::string& stamp_of_last) {
  std::string text = fmt::format(
      "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 06/30/2011\n0911131\n"
      "11/13/2009 3:05:27 (GMT)                (ORIGIN: 11/13/2009 3:05:27 GMT)\n"
      "                                   TRIGGER TIME: 11/13/2009 3:06:17.600 GMT\n"
      "STATION NO.         18.483S   70.314W  ETNA      S/N  815 (4  CHNS OF 4  AT STA)\nARICA S/N 815\n"
      "CHAN  {}: NS       (STA CHN:  1)\nUNIVERSIDAD DE CHILE - RENADIC\n"
      "HYPOCENTER:   0.000N    0.000E  H=   0.0KM   ML= 0.00\n"
      "INSTR PERIOD = 0.0195 SEC,  DAMPING =0.6500,  SENSITIVITY =2.508 VDC/G\n"
      "NO. OF POINTS =      6  RECORD LENGTH =  0.030 SEC\n"
      "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  =  0.052 G, AT  14.100 SEC\n"
      "RMS ACCEL OF COMPLETE RECORD = 0.005 G\n",
      channel);
  for (int k = 0; k < 14; ++k) text += "    0    0    0    0\n";
  return text + "131.175  0.009131.180  0.009131.185 -0.010131.190  0.007131.195  0.005\n" + stamp_of_last +
         fmt::format(" {:6.3f}\n/&  ----------  END OF DATA FOR CHANNEL {}  ----------\n", 0.001 * channel,
                     channel);
}

TEST(StrongMotionComponents, OfRenadicArePairsOfTimeAndValue) {
  const TemporaryFile file("arica.v1", renadic(1, "131.200") + renadic(2, "131.200"));
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), 6);
  EXPECT_THAT(record.channel_names(), ElementsAre("chan_1", "chan_2"));
  EXPECT_NEAR(record.interval(), 0.005, 1e-12);
  EXPECT_NEAR(record.samples(0, 2), -0.001 * standard_gravity, 1e-12);
  EXPECT_NEAR(record.samples(1, 5), 2e-4 * standard_gravity, 1e-12);
}

TEST(StrongMotionComponents, ThatAreUncorrectedOnesOfCsmipStateTheirRate) {
  const TemporaryFile file(
      "CE89146.V1",
      "Uncorrected Accelerogram Data             Processed: 02/13/12, CGS  146be002\n"
      "Record of Mon Feb 13, 2012 13:06:45.0 PST             (Avol1 v9.2,12/11 CSMIP)\nChan  1: 360 Deg\n"
      "No. of Points =      5  Record Length =   .025 sec   at 200 Samples/sec\n"
      "    1  100    1    3    3  200\n  .0108814  .6700000 66.000000\n"
      "     5 Accelerogram points at 200 pts/sec in units of g .      Format: (3f9.6)\n"
      "  .000010 -.000007-1.000000\n  .000002  .500000\n");
  const Record record = read_record(file.path());
  ASSERT_EQ(record.size(), 5);
  EXPECT_NEAR(record.interval(), 0.005, 1e-12);
  EXPECT_NEAR(record.samples(0, 2), -standard_gravity, 1e-12);
}

TEST(StrongMotionComponents, ThatAreCutOrContradictThemselvesAreRefused) {
  const auto error = [](const std::string& text) {
    const TemporaryFile file("x.v1", text);
    return input_error_of(file, [&] { read_record(file.path()); });
  };
  const std::string whole = geonet("Up", {}, motion(24, 1.0));
  EXPECT_THAT(error(whole.substr(0, whole.size() - 40)), HasSubstr("of 24 numbers"));
  EXPECT_THAT(error(geonet("Up", {}, motion(34, 1.0))),
              HasSubstr("expected the first line of another component"));
  EXPECT_THAT(error(geonet("Up", {24, 0, 0.005, 0.24}, motion(24, 1.0))), HasSubstr("a length of 0.24 s"));
  EXPECT_THAT(error(bhrc("L1", 36, "SECONDS AND COUNTS")), HasSubstr("unit 'counts'; expected cm/sec2"));
  EXPECT_THAT(error(bhrc("L1", 36, "UNKNOWN")), HasSubstr("expected one"));
  EXPECT_THAT(error(renadic(1, "131.290")), HasSubstr("expected pairs of a time and a value"));
}

TEST(StrongMotionComponents, ThatAreDamagedAreReadOrRefused) {
  expect_read_or_refused("x.V2A", geonet("Up", {640, 32, 0.02, 0.64}, motion(32, 1.0)), {}, 1, 200);
  expect_read_or_refused("x.V1", bhrc("L1", 36) + bhrc("V2", 36), {}, 2, 200);
  expect_read_or_refused("y.V1", renadic(1, "131.200"), {}, 3, 200);
}

}  // namespace
}  // namespace beamid::experiments::strong_motion_components_test
