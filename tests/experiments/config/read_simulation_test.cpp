// Oracles: the values written in the files themselves.
#include "experiments/config/readers.hpp"

#include <gmock/gmock.h>

#include "experiments/config/read_experiment.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::read_simulation_test {
namespace {

const std::string beam = "beam = { length_m = 2, bending_stiffness_n_m2 = 100, mass_kg = 3 }\n";  // one line

Experiment experiment_of(const std::string& text) {
  const TemporaryFile file("experiment.toml", beam + text);
  return read_experiment(file.path());
}

TEST(ReadDamping, ReadsEveryLaw) {
  EXPECT_TRUE(std::holds_alternative<fem::Undamped>(experiment_of("").damping));
  EXPECT_TRUE(std::holds_alternative<fem::Undamped>(experiment_of("damping.law = \"none\"\n").damping));
  const auto one = std::get<fem::ModalDamping>(experiment_of("damping.ratio = 0.01\n").damping);
  EXPECT_EQ(one.ratios, std::vector{0.01});
  const auto several = std::get<fem::ModalDamping>(
      experiment_of("damping = { law = \"modal\", ratios = [0.01, 0.02] }\n").damping);
  EXPECT_EQ(several.ratios, (std::vector{0.01, 0.02}));
  const std::string anchors =
      "anchors = [{ frequency_hz = 2, ratio = 0.01 }, { frequency_hz = 20, ratio = 0.03 }]\n";
  const auto rayleigh =
      std::get<fem::RayleighDamping>(experiment_of("[damping]\nlaw = \"rayleigh\"\n" + anchors).damping);
  EXPECT_EQ(rayleigh.first.frequency_hz, 2);
  EXPECT_EQ(rayleigh.second.ratio, 0.03);
  EXPECT_EQ(std::get<fem::CaugheyDamping>(experiment_of("[damping]\nlaw = \"caughey\"\n" + anchors).damping)
                .anchors.size(),
            2u);
  EXPECT_EQ(std::get<fem::StructuralDamping>(
                experiment_of("damping = { law = \"structural\", loss_factor = 0.02 }\n").damping)
                .loss_factor,
            0.02);
}

TEST(ReadExcitation, ReadsEveryKind) {
  using Kind = Excitation::Kind;
  EXPECT_EQ(experiment_of("").excitation.kind, Kind::release);
  const Excitation release =
      experiment_of("excitation = { position_m = 1, deflection_m = 0.01 }\n").excitation;
  EXPECT_EQ(release.position, 1.0);
  EXPECT_EQ(release.deflection, 0.01);
  const Excitation step = experiment_of("excitation = { kind = \"static\", force_n = -5 }\n").excitation;
  EXPECT_EQ(step.kind, Kind::step);
  EXPECT_EQ(step.force, -5);
  const Excitation impulse =
      experiment_of("excitation = { kind = \"impulse\", momentum_n_s = 0.5, duration_s = 0.01 }\n")
          .excitation;
  EXPECT_EQ(impulse.momentum, 0.5);
  EXPECT_EQ(impulse.duration, 0.01);
  const Excitation harmonic =
      experiment_of("excitation = { kind = \"harmonic\", amplitude_n = 2, frequency_hz = 3 }\n").excitation;
  EXPECT_EQ(harmonic.amplitude, 2);
  EXPECT_EQ(harmonic.frequency_hz, 3);
  const Excitation base =
      experiment_of("excitation = { kind = \"base\", amplitude_m_per_s2 = 4, frequency_hz = 3 }\n")
          .excitation;
  EXPECT_EQ(base.kind, Kind::base);
  EXPECT_EQ(base.amplitude, 4);
  EXPECT_EQ(experiment_of("excitation = { kind = \"table\", file = \"a.csv\" }\n").excitation.file, "a.csv");
  const Excitation free =
      experiment_of("excitation = { kind = \"none\", velocity_m_per_s = 1, mode = 2 }\n").excitation;
  EXPECT_EQ(free.kind, Kind::free);
  EXPECT_EQ(free.mode, 2);
}

TEST(ReadSimulation, RefusesARootMeanSquareBelowZero) {
  try {
    experiment_of("excitation = { kind = \"random\", amplitude_n = -2, frequency_hz = 3 }\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("not negative"));
  }
}

TEST(ReadSimulation, ReadsSensorsAndMethod) {
  const Experiment read = experiment_of(
      "[[sensors]]\nname = \"a\"\nposition_m = 1\nquantity = \"velocity\"\nnoise_m_per_s = "
      "1e-3\n[[sensors]]\n"
      "[simulation]\nduration_s = 2\nsampling_rate_hz = 500\nsteps_per_sample = 3\nmethod = \"hht_alpha\"\n"
      "alpha = -0.1\nframes = 7\nseed = 9\n");
  ASSERT_EQ(read.sensors.size(), 2u);
  EXPECT_EQ(read.sensors[0].name, "a");
  EXPECT_EQ(read.sensors[0].quantity, Quantity::velocity);
  EXPECT_EQ(read.sensors[0].noise, 1e-3);
  EXPECT_FALSE(read.sensors[1].position);
  EXPECT_EQ(read.simulation.duration, 2);
  EXPECT_EQ(read.simulation.sampling_rate, 500);
  EXPECT_EQ(read.simulation.steps_per_sample, 3);
  EXPECT_EQ(read.simulation.method.name, "hht_alpha");
  EXPECT_EQ(read.simulation.method.options.at("alpha"), -0.1);
  EXPECT_EQ(read.simulation.frames, 7);
  EXPECT_EQ(read.simulation.seed, 9u);
}

TEST(ReadFrequencyResponse, ReadsEveryKey) {
  const auto read = experiment_of(
                        "[frequency_response]\nfrom_hz = 0\nto_hz = 10\npoints = 11\nspacing = \"linear\"\n"
                        "kind = \"mobility\"\nmethod = \"modal\"\nmodes = 5\nresidual_modes = false\n"
                        "pairs = [{ input_m = 1 }, { output_m = 2 }]\n")
                        .frequency_response;
  EXPECT_EQ(read.from_hz, 0.0);
  EXPECT_EQ(read.to_hz, 10.0);
  EXPECT_EQ(read.points, 11);
  EXPECT_FALSE(read.logarithmic);
  EXPECT_EQ(read.kind, FrequencyResponseSettings::Kind::mobility);
  EXPECT_EQ(read.method.name, "modal");
  EXPECT_EQ(read.method.modes, 5);
  EXPECT_FALSE(read.method.residual_modes);
  ASSERT_EQ(read.pairs.size(), 2u);
  EXPECT_EQ(read.pairs[0].input, 1.0);
  EXPECT_FALSE(read.pairs[0].output);
  EXPECT_EQ(read.pairs[1].output, 2.0);
}

struct Refused {
  const char* content;  ///< from line 2 on
  const char* message;
};

TEST(ReadExperiment, RefusesBadTablesOfTheContinuum) {
  const Refused cases[] = {
      {"[damping]\nlaw = \"viscous\"\n",
       "bad.toml:3:7: damping.law is the text \"viscous\"; expected one of none, modal, rayleigh, caughey, "
       "structural"},
      {"[damping]\nlaw = \"modal\"\n",
       "bad.toml:2:1: damping.ratio is missing; expected the damping ratio of every mode, or ratios = "
       "[first, second, ...]"},
      {"[damping]\nratios = [0.1, -0.1]\n",
       "bad.toml:3:16: damping.ratios holds -0.1; expected zero or a positive number"},
      {"[damping]\nlaw = \"rayleigh\"\nratio = 0.1\n",
       "bad.toml:4:1: damping.ratio has no use with law = \"rayleigh\"; of use there: law, anchors"},
      {"[damping]\nlaw = \"rayleigh\"\nanchors = [{ frequency_hz = 1, ratio = 0.1 }]\n",
       "bad.toml:4:11: damping.anchors is an array of 1; expected two of them, { frequency_hz, ratio }; "
       "more are for law = \"caughey\""},
      {"[excitation]\nkind = \"hammer\"\n",
       "bad.toml:3:8: excitation.kind is the text \"hammer\"; expected one of release, static, impulse, "
       "harmonic, random, base, table, none"},
      {"[excitation]\nkind = \"static\"\n", "bad.toml:2:1: excitation.force_n is missing; expected a number"},
      {"[excitation]\nforce_n = 3\n",
       "bad.toml:3:1: excitation.force_n has no use with kind = \"release\"; of use there: kind, "
       "position_m, at, deflection_m, duration_s"},
      {"[excitation]\nkind = \"base\"\n",
       "bad.toml:2:1: excitation.amplitude_m_per_s2 is missing; expected a number, or a file"},
      {"[excitation]\nposition_m = 5\n",
       "bad.toml:3:14: excitation.position_m is 5; expected a number from 0 to the beam's length, 2"},
      {"[[sensors]]\nquantity = \"force\"\n",
       "bad.toml:3:12: sensors[1].quantity is the text \"force\"; expected one of displacement, velocity, "
       "acceleration, strain, angular_acceleration"},
      {"[[sensors]]\nnoise_m = 1e-6\n",
       "bad.toml:3:1: sensors[1].noise_m has no use for a sensor of acceleration; expected noise_m_per_s2, "
       "or no noise_m"},
      {"[simulation]\nmethod = \"verlet\"\n",
       "bad.toml:3:10: simulation.method is the text \"verlet\"; expected one of "},
      {"[simulation]\nbeta = 0.25\n",
       "bad.toml:3:1: unknown option 'beta' of response method 'modal'; known: modes"},
      {"[simulation]\nduration_s = 1e9\n",
       "bad.toml:2:1: 1000000000 s at 1000 Hz make 1e+12 samples; expected 1 to 2e+07"},
      {"[frequency_response]\nfrom_hz = 3\nto_hz = 2\n",
       "bad.toml:4:9: frequency_response.to_hz is 2; expected a number above from_hz, 3"},
      {"[frequency_response]\npoints = 1\n",
       "bad.toml:3:10: frequency_response.points is 1; expected a whole number from 2 to 1000000"},
      {"[frequency_response]\nmethod = \"direct\"\nmodes = 3\n",
       "bad.toml:4:1: frequency_response.modes has no use with method = \"direct\"; expected method = "
       "\"modal\", or no modes"}};
  for (const Refused& refused : cases) {
    const TemporaryFile file("bad.toml", beam + refused.content);
    std::string message = input_error_of(file, [&] { read_experiment(file.path()); });
    const std::string expected = refused.message;
    if (expected.ends_with("expected one of ")) message.resize(std::min(message.size(), expected.size()));
    EXPECT_EQ(message, expected) << refused.content;
  }
}

}  // namespace
}  // namespace beamid::experiments::read_simulation_test
