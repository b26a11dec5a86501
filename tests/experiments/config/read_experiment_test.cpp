// Oracles: the values written in the files themselves; closed forms of the section's properties.
#include "experiments/config/read_experiment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::read_experiment_test {
namespace {

constexpr const char* complete = R"(title = "steel cantilever"
[beam]
length_m = 1.10
width_m = 0.060
height_m = 0.006
youngs_modulus_pa = 2.12e11
mass_kg = 3.055
tip_mass_kg = 0.36
tip_rotary_inertia_kg_m2 = 1e-4
sensor_mass_kg = 0.04
elements = 20
[record]
file = "hit.csv"
separator = "semicolon"
header_lines = 2
sampling_rate_hz = 1000
window_s = [0.5, 2]
input = "linear"
time = { column = 1, unit = "ms" }
channels = [
  { quantity = "acceleration", column = 3, unit = "g" },
  { quantity = "force", column = "hammer", unit = "kN" },
]
[reduction]
method = "rayleigh"
shape = "one_minus_cosine"
[model]
name = "sdof"
[filter]
method = "ukf"
alpha = 1
discretisation = "runge_kutta_4"
[prior]
stiffness_n_per_m = 500
stiffness_deviation_n_per_m = 100.0
damping_ratio = 0.01
damping_ratio_deviation = 0.02
[noise]
displacement_m = 1e-6
velocity_m_per_s = 1e-5
acceleration_m_per_s2 = 0.05
)";

TEST(ReadExperiment, ReadsEveryKey) {
  const TemporaryFile file("all.toml", complete);
  const Experiment experiment = read_experiment(file.path());
  EXPECT_EQ(experiment.title, "steel cantilever");
  EXPECT_DOUBLE_EQ(experiment.structure.beam().length(), 1.10);
  EXPECT_DOUBLE_EQ(experiment.structure.beam().segments[0].section.bending_stiffness(0),
                   2.12e11 * 0.060 * 0.006 * 0.006 * 0.006 / 12);
  EXPECT_DOUBLE_EQ(experiment.structure.beam().mass(), 3.055);
  EXPECT_DOUBLE_EQ(experiment.structure.beam().tip_mass(), 0.40);  // with the sensor
  EXPECT_DOUBLE_EQ(experiment.structure.beam().bodies.at(0).rotary_inertia, 1e-4);
  EXPECT_EQ(experiment.elements, 20);
  EXPECT_EQ(experiment.record_file, "hit.csv");
  const RecordFormat& format = experiment.format;
  EXPECT_EQ(format.separator, ';');
  EXPECT_EQ(format.header_lines, 2);
  EXPECT_EQ(format.sampling_rate, 1000.0);
  EXPECT_EQ(format.window, std::pair(0.5, 2.0));
  EXPECT_EQ(format.window_place.line, 17u);
  EXPECT_EQ(format.input, InputPath::linear);
  ASSERT_TRUE(format.time);
  EXPECT_EQ(format.time->number, 1);
  EXPECT_EQ(format.time->factor, 1e-3);
  ASSERT_EQ(format.channels.size(), 2u);
  EXPECT_EQ(format.channels[0].quantity, Quantity::acceleration);
  EXPECT_EQ(format.channels[0].number, 3);
  EXPECT_EQ(format.channels[0].factor, 9.80665);
  EXPECT_EQ(format.channels[1].quantity, Quantity::force);
  EXPECT_EQ(format.channels[1].name, "hammer");
  EXPECT_EQ(format.channels[1].factor, 1000);
  EXPECT_EQ(experiment.reduction.name, "rayleigh");
  EXPECT_EQ(experiment.reduction.options.text("shape"), "one_minus_cosine");
  EXPECT_EQ(experiment.model.name, "sdof");
  EXPECT_EQ(experiment.filter.name, "ukf");
  EXPECT_EQ(experiment.filter.options.number("alpha"), 1);
  EXPECT_EQ(experiment.filter.options.number("kappa"), 0);  // the filter's own default
  EXPECT_EQ(experiment.discretisation, "runge_kutta_4");
  EXPECT_EQ(experiment.prior.stiffness, 500);
  EXPECT_EQ(experiment.prior.stiffness_deviation, 100);
  EXPECT_EQ(experiment.prior.damping_ratio, 0.01);
  EXPECT_EQ(experiment.prior.damping_ratio_deviation, 0.02);
  const std::map<Quantity, double> noise{
      {Quantity::displacement, 1e-6}, {Quantity::velocity, 1e-5}, {Quantity::acceleration, 0.05}};
  EXPECT_EQ(experiment.noise, noise);
}

TEST(ReadExperiment, NeedsNothingButABeam) {
  const TemporaryFile file(
      "least.toml",
      "beam = { length_m = 2, bending_stiffness_n_m2 = 100, mass_per_length_kg_per_m = 3 }\r\n");
  const Experiment experiment = read_experiment(file.path());
  EXPECT_EQ(experiment.structure.beam().segments[0].section.bending_stiffness(0), 100);
  EXPECT_EQ(experiment.structure.beam().mass(), 6);
  EXPECT_EQ(experiment.structure.beam().tip_mass(), 0);
  EXPECT_EQ(experiment.elements, 40);
  EXPECT_FALSE(experiment.record_file);
  EXPECT_TRUE(experiment.format.channels.empty());
  EXPECT_EQ(experiment.reduction.name, "rayleigh");
  EXPECT_EQ(experiment.filter.name, "ekf");
  EXPECT_EQ(experiment.discretisation, "exponential");
  EXPECT_TRUE(experiment.noise.empty());
}

TEST(ReadExperiment, TakesADensityWithTheSection) {
  const TemporaryFile file("density.toml",
                           "[beam]\nlength_m = 1\nbending_stiffness_n_m2 = 100\ndensity_kg_per_m3 = 7850\n"
                           "width_m = 0.05\nheight_m = 0.01\n");
  EXPECT_DOUBLE_EQ(read_experiment(file.path()).structure.beam().mass() / 1, 7850 * 0.05 * 0.01);
}

struct Refused {
  const char* content;
  const char* message;
};

/// @param exactly false: the message starts so, and goes on with what is no business of these tests.
void expect_refused(std::initializer_list<Refused> cases, bool exactly = true) {
  for (const Refused& refused : cases) {
    const TemporaryFile file("bad.toml", refused.content);
    std::string message = input_error_of(file, [&] { read_experiment(file.path()); });
    if (!exactly) message.resize(std::min(message.size(), std::string(refused.message).size()));
    EXPECT_EQ(message, refused.message) << "for the file:\n" << refused.content;
  }
}

#define BEAM_KEYS                                                                                           \
  "length_m, width_m, height_m, diameter_m, end_width_m, end_height_m, end_diameter_m, youngs_modulus_pa, " \
  "bending_stiffness_n_m2, mass_kg, mass_per_length_kg_per_m, density_kg_per_m3, theory, poissons_ratio, "  \
  "shear_modulus_pa, shear_factor, shear_stiffness_n, rotary_inertia, rotary_inertia_kg_m, support, "       \
  "root_rotational_stiffness_n_m_per_rad, root_translational_stiffness_n_per_m, tip_mass_kg, "              \
  "tip_rotary_inertia_kg_m2, tip_eccentricity_m, sensor_mass_kg, axial_load_n, mass_model, elements, "      \
  "segments, "                                                                                              \
  "bodies, supports, springs, dashpots, absorbers, damages, added_masses"
#define BEAM "[beam]\nlength_m = 1\nbending_stiffness_n_m2 = 2\nmass_kg = 3\n"  // four lines

TEST(ReadExperiment, RefusesWhatIsNoToml) {
  expect_refused(
      {{"", "bad.toml: an empty file; expected a TOML file"},
       {"title = \"a\x01\"", "bad.toml:1:11: a binary byte (1); expected a TOML file in ASCII or UTF-8"}});
  std::string deep = "\n";  // the parser would exhaust the stack
  for (int i = 0; i < 100000; ++i) deep += "a.";
  expect_refused({{deep.c_str(), "bad.toml:2:4097: a line of 200000 characters; expected at most 4096"}});
  expect_refused({{"[/", "bad.toml:1:2: no valid TOML: "},  // aborts the header-only build of the parser
                  {"[beam]\nlength_m = \n", "bad.toml:2:12: no valid TOML: "},
                  {"[beam]\nlength_m = 1\nlength_m = 2\n", "bad.toml:3:12: no valid TOML: "},
                  {"[beam]\nlength_m = 1,5\n", "bad.toml:2:13: no valid TOML: "},
                  {"title = \"\xff\"", "bad.toml:1:9: no valid TOML: "}},
                 false);
}

TEST(ReadExperiment, RefusesUnknownKeysAndOffersTheNearest) {
  expect_refused(
      {{"title = \"x\"\n", "bad.toml: beam is missing; expected a table"},
       {"beam = 3\n", "bad.toml:1:8: beam is 3; expected a table"},
       {BEAM "[fliter]\n", "bad.toml:5:2: unknown key 'fliter'; did you mean 'filter'?"},
       {BEAM "  colour = 1\n", "bad.toml:5:3: unknown key 'colour' in beam; known: " BEAM_KEYS},
       {"[prior]\ndamping_ration = 1\nstiffness = 2\n[beam]\n",
        "bad.toml:2:1: unknown key 'damping_ration' in prior; did you mean 'damping_ratio'? known: "
        "stiffness_n_per_m, stiffness_deviation_n_per_m, damping_ratio, damping_ratio_deviation\n"
        "bad.toml:3:1: unknown key 'stiffness' in prior; known: stiffness_n_per_m, "
        "stiffness_deviation_n_per_m, damping_ratio, damping_ratio_deviation"},
       {BEAM "[record]\nchannels = [{ quantity = \"force\", colum = 1 }]\n",
        "bad.toml:6:35: unknown key 'colum' in record.channels; did you mean 'column'?"},
       {BEAM "[record.time]\nunits = \"s\"\n",
        "bad.toml:6:1: unknown key 'units' in record.time; did you mean 'unit'? known: column, unit"}});
}

TEST(ReadExperiment, RefusesImpossibleBeams) {
  expect_refused(
      {{"[beam]\nmass_kg = 1\n", "bad.toml:1:1: beam.length_m is missing; expected a positive number"},
       {"[beam]\nlength_m = -1.5\n", "bad.toml:2:12: beam.length_m is -1.5; expected a positive number"},
       {"[beam]\nlength_m = 0\n", "bad.toml:2:12: beam.length_m is 0; expected a positive number"},
       {"[beam]\nlength_m = inf\n", "bad.toml:2:12: beam.length_m is inf; expected a finite number"},
       {"[beam]\nlength_m = nan\n", "bad.toml:2:12: beam.length_m is nan; expected a finite number"},
       {"[beam]\nlength_m = \"1.1 m\"\n",
        "bad.toml:2:12: beam.length_m is the text \"1.1 m\"; expected a positive number"},
       {"[beam]\nlength_m = true\n", "bad.toml:2:12: beam.length_m is true; expected a positive number"},
       {"[beam]\nlength_m = [1, 2]\n",
        "bad.toml:2:12: beam.length_m is an array of 2; expected a positive number"},
       {"[beam]\nlength_m = 2009-01-01\n",
        "bad.toml:2:12: beam.length_m is a date or time; expected a positive number"},
       {"\n [beam]\nlength_m = 1\nmass_kg = 3\n",
        "bad.toml:2:2: bending stiffness is given by no key; expected exactly one of youngs_modulus_pa, "
        "bending_stiffness_n_m2"},
       {BEAM "youngs_modulus_pa = 2e11\n",
        "bad.toml:1:1: bending stiffness is given by youngs_modulus_pa, bending_stiffness_n_m2; expected "
        "exactly one of youngs_modulus_pa, bending_stiffness_n_m2"},
       {"[beam]\nlength_m = 1\nyoungs_modulus_pa = 2e11\nwidth_m = 1\nmass_kg = 1\n",
        "bad.toml:1:1: beam.height_m is missing; expected a positive number beside youngs_modulus_pa"},
       {"[beam]\nlength_m = 1\nbending_stiffness_n_m2 = 1\n",
        "bad.toml:1:1: mass is given by no key; expected exactly one of mass_kg, mass_per_length_kg_per_m, "
        "density_kg_per_m3"},
       {BEAM "density_kg_per_m3 = 7850\n",
        "bad.toml:1:1: mass is given by mass_kg, density_kg_per_m3; expected exactly one of mass_kg, "
        "mass_per_length_kg_per_m, density_kg_per_m3"},
       {BEAM "width_m = 0.1\n",
        "bad.toml:5:1: beam.width_m has no use beside bending_stiffness_n_m2 and mass_kg; expected "
        "youngs_modulus_pa or density_kg_per_m3, or no section"},
       {BEAM "tip_mass_kg = -1\n",
        "bad.toml:5:15: beam.tip_mass_kg is -1; expected zero or a positive number"},
       {BEAM "elements = 0\n",
        "bad.toml:5:12: beam.elements is 0; expected a whole number from 1 to 1000000"},
       {BEAM "elements = 4.5\n",
        "bad.toml:5:12: beam.elements is 4.5; expected a whole number from 1 to 1000000"},
       {"[beam]\nlength_m = 1\nyoungs_modulus_pa = 1e300\nwidth_m = 1e300\nheight_m = 1\nmass_kg = 1\n",
        "bad.toml:3:21: beam.youngs_modulus_pa is 1e+300; expected a positive number of a size from 1e-100 "
        "to "
        "1e+30"},
       {"[beam]\nlength_m = 1e-101\n",
        "bad.toml:2:12: beam.length_m is 1e-101; expected a positive number of a size from 1e-100 to "
        "1e+30"}});
}

TEST(ReadExperiment, RefusesBadRecordTables) {
  expect_refused(
      {{BEAM "[record]\nfile = 3\n", "bad.toml:6:8: record.file is 3; expected a text in quotes"},
       {BEAM "[record]\nfile = \"\"\n",
        "bad.toml:6:8: record.file is the text \"\"; expected the name of a file"},
       {BEAM "[record]\nseparator = \";\"\n",
        "bad.toml:6:13: record.separator is the text \";\"; expected one of auto, tab, comma, semicolon, "
        "bar, "
        "space"},
       {BEAM "[record]\nheader_lines = -1\n",
        "bad.toml:6:16: record.header_lines is -1; expected a whole number from 0 to 1000000"},
       {BEAM "[record]\nsampling_rate_hz = 0\n",
        "bad.toml:6:20: record.sampling_rate_hz is 0; expected a positive number"},
       {BEAM "[record]\nwindow_s = 3\n",
        "bad.toml:6:12: record.window_s is 3; expected two numbers [from, to], the first below the second"},
       {BEAM "[record]\nwindow_s = [2, 1]\n",
        "bad.toml:6:12: record.window_s is [2, 1]; expected two numbers [from, to], the first below the "
        "second"},
       {BEAM "[record]\nwindow_s = [0, \"1\"]\n",
        "bad.toml:6:16: record.window_s holds the text \"1\"; expected two numbers [from, to], the first "
        "below the second"},
       {BEAM "[record]\ntime = { column = 1 }\n",
        "bad.toml:6:8: record.time.unit is missing; expected a unit of time: s, ms, us"},
       {BEAM "[record]\ntime = { column = 0, unit = \"s\" }\n",
        "bad.toml:6:19: record.time.column is 0; expected a whole number from 1 to 100000"},
       {BEAM "[record]\ntime = { column = \"\", unit = \"s\" }\n",
        "bad.toml:6:19: record.time.column is the text \"\"; expected a column's number, from 1, or its "
        "name in the header"},
       {BEAM "[record]\ntime = { unit = \"s\" }\n",
        "bad.toml:6:8: record.time.column is missing; expected a column's number, from 1, or its name in "
        "the header"},
       {BEAM "[record]\nchannels = []\n",
        "bad.toml:6:12: record.channels is an array of 0; expected an array of at least one table"},
       {BEAM "[record]\nchannels = [3]\n", "bad.toml:6:13: record.channels[1] is 3; expected a table"},
       {BEAM "[record]\nchannels = [{ column = 1, unit = \"g\" }]\n",
        "bad.toml:6:13: record.channels[1].quantity is missing; expected one of displacement, velocity, "
        "acceleration, force, strain, base_acceleration, support_acceleration, "
        "angular_acceleration"},
       {BEAM "[[record.channels]]\nquantity = \"torque\"\n",
        "bad.toml:6:12: record.channels[1].quantity is the text \"torque\"; expected one of displacement, "
        "velocity, acceleration, force, strain, base_acceleration, support_acceleration, "
        "angular_acceleration"},
       {BEAM "[[record.channels]]\nquantity = \"acceleration\"\ncolumn = 2\nunit = \"kN\"\n",
        "bad.toml:8:8: record.channels[1].unit is the text \"kN\"; expected a unit of acceleration: m/s2, "
        "mm/s2, g"}});
}

TEST(ReadExperiment, RefusesBadEstimates) {
  expect_refused({{BEAM "[prior]\ndamping_ratio = 1\n",
                   "bad.toml:6:17: prior.damping_ratio is 1; expected a number from 0 to below 1"},
                  {BEAM "[prior]\nstiffness_deviation_n_per_m = 0\n",
                   "bad.toml:6:31: prior.stiffness_deviation_n_per_m is 0; expected a positive number"},
                  {BEAM "[noise]\nvelocity_m_per_s = -1e-3\n",
                   "bad.toml:6:20: noise.velocity_m_per_s is -0.001; expected a positive number"}});
}

TEST(ReadExperiment, RefusesUnknownMethodsAndOptionsAtTheirPlaces) {
  expect_refused(
      {{BEAM "[filter]\nmethod = \"ufk\"\n", "bad.toml:6:10: unknown filter 'ufk'; known: "},
       {BEAM "[filter]\nmethod = 3\n", "bad.toml:6:10: filter.method is 3; expected a text in quotes"},
       {BEAM "[filter]\nmethod = \"ukf\"\n beta = 2\n alpa = 1\n",
        "bad.toml:8:2: unknown option 'alpa' of filter 'ukf'; known: "},
       {BEAM "[filter]\nmethod = \"ukf\"\nalpha = \"wide\"\n",
        "bad.toml:7:1: option 'alpha' of filter 'ukf' expects a number; found a text"},
       {BEAM "[filter]\nmethod = \"ukf\"\nalpha = true\n",
        "bad.toml:7:1: option 'alpha' of filter 'ukf' expects a number; found true or false"},
       {BEAM "[filter]\nmethod = \"ukf\"\nalpha = [1]\n",
        "bad.toml:7:1: option 'alpha' of filter 'ukf' expects a number; found a list of numbers"},
       {BEAM "[filter]\ndiscretisation = \"euler\"\n",
        "bad.toml:6:18: unknown discretisation 'euler'; known: "},
       {BEAM "[reduction]\nmethod = \"ritz\"\n", "bad.toml:6:10: unknown reduction 'ritz'; known: "},
       {BEAM "[reduction]\nshape = \"cubic\"\n",
        "bad.toml:6:1: unknown shape 'cubic' of reduction 'rayleigh'; known: "},
       {BEAM "[model]\nname = \"mdof\"\n", "bad.toml:6:8: unknown model 'mdof'; known: "}},
      false);
}

TEST(ReadExperiment, RefusesWhatIsNoFile) {
  const TemporaryFile file("here.toml", "x");
  const auto missing = file.path().parent_path() / "missing.toml";
  EXPECT_EQ(input_error_of(file, [&] { read_experiment(missing); }),
            "missing.toml: no such file; expected a TOML file");
  const auto folder = file.path().parent_path() / "sub";
  std::filesystem::create_directory(folder);
  EXPECT_EQ(input_error_of(file, [&] { read_experiment(folder); }), "sub: a directory; expected a TOML file");
  std::filesystem::remove(folder);
}

TEST(InputError, KnowsItsPlace) {
  const InputError error({"cantilever.toml", 14, 9}, "unknown filter 'ufk'; known: ekf, enkf, ukf");
  EXPECT_STREQ(error.what(), "cantilever.toml:14:9: unknown filter 'ufk'; known: ekf, enkf, ukf");
  EXPECT_EQ(error.file(), "cantilever.toml");
  EXPECT_EQ(error.line(), 14u);
  EXPECT_EQ(error.column(), 9u);
  EXPECT_STREQ(InputError({"a.csv", 2, 0}, "empty").what(), "a.csv:2: empty");
  EXPECT_STREQ(InputError({"a.csv", 0, 5}, "empty").what(), "a.csv: empty");
}

#undef BEAM_KEYS
#undef BEAM

}  // namespace
}  // namespace beamid::experiments::read_experiment_test
