#include "experiments/studies/efficiency/laboratory_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using RecordKind = LaboratoryKind;
using std::numbers::pi;

struct KindDescription {
  RecordKind kind;
  const char* name;
  std::vector<std::string> words;
};

const KindDescription& described(RecordKind kind) {
  static const std::array<KindDescription, laboratory_kinds> all{
      {{RecordKind::plain, "plain", {"noise", "window"}},
       {RecordKind::jitter, "uneven stamps", {"stamps", "uneven", "interval", "resampl"}},
       {RecordKind::gaps, "gaps", {"gap", "missing"}},
       {RecordKind::repeated, "repeated samples", {"repeat"}},
       {RecordKind::clipping, "clipping", {"clip", "saturat", "limit of"}},
       {RecordKind::coarse, "coarse steps", {"coarse", "resol", "quanti"}},
       {RecordKind::dead, "dead channel", {"dead", "constant", "does not move"}},
       {RecordKind::drift, "drifting offset", {"drift", "offset"}},
       {RecordKind::startup, "start-up", {"start-up", "start up", "settl"}},
       {RecordKind::rattle, "rattle", {"rattl", "contact"}},
       {RecordKind::amplitude, "amplitude", {"amplitude"}},
       {RecordKind::by_hand, "by hand", {"release", "let go", "by hand"}}}};
  return all[static_cast<std::size_t>(kind)];
}

/// Numbers drawn one after another.
class Draw {
 public:
  Draw(std::uint64_t seed, int number) : random_(seed, static_cast<std::uint64_t>(number)) {}

  double even(double from, double to) { return from + (to - from) * random_.uniform(); }
  double logarithmic(double from, double to) { return from * std::pow(to / from, random_.uniform()); }
  bool chance(double probability) { return random_.uniform() < probability; }
  int whole(int from, int to) { return from + static_cast<int>((to - from + 1) * random_.uniform()); }
  double either_sign(double size) { return chance(0.5) ? size : -size; }

 private:
  filters::RandomStream random_;
};

struct Cantilever {
  double length, width, height, modulus, density, tip_mass;

  double mass() const { return density * length * width * height; }
  std::string toml(double true_modulus) const {
    return fmt::format(
        "[beam]\nlength_m = {:.4g}\nwidth_m = {:.4g}\nheight_m = {:.4g}\nyoungs_modulus_pa = "
        "{:.6g}\ndensity_kg_per_m3 = {:.6g}\ntip_mass_kg = {:.4g}\n",
        length, width, height, true_modulus, density, tip_mass);
  }
};

Cantilever drawn_beam(Draw& draw) {
  const bool aluminium = draw.chance(0.3);
  const double length = draw.logarithmic(0.25, 1.2), height = length * draw.logarithmic(1.0 / 220, 1.0 / 80);
  Cantilever beam{
      length, draw.even(6, 12) * height, height, aluminium ? 70e9 : 210e9, aluminium ? 2700.0 : 7850.0, 0.0};
  beam.tip_mass = beam.mass() * draw.even(0.1, 2.0);
  return beam;
}

/// Of the first mode, at the tip: frequencies [Hz], and the modal mass [kg] and the share of a static
/// deflection that the first mode takes.
struct CantileverMode {
  double frequency_hz, second_hz, mass, share;
};

CantileverMode first_mode(const std::string& beam, int elements) {
  const Experiment experiment = read_experiment(TomlTable::parse(beam, "the beam"));
  const fem::StructuralSystem system = fem::assemble(experiment.structure, elements);
  const fem::Modes modes = fem::modes(system, 2);
  const double tip = (system.outputs * modes.shape.col(0))(0), w = modes.angular_frequency[0];
  const double stiffness = fem::static_stiffness(system);
  return {modes.frequency_hz()[0], modes.frequency_hz()[1], 1 / (tip * tip), stiffness * tip * tip / (w * w)};
}

/// The lines of one [[sensors]] or [acquisition] table.
struct FileLines {
  std::string text;

  void add(const char* key, double value) { text += fmt::format("{} = {:.4g}\n", key, value); }
};

void spoil_sensor(const std::vector<RecordKind>& kinds, Draw& draw, FileLines& sensor) {
  const auto has = [&](RecordKind kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  if (has(RecordKind::clipping)) sensor.add("clipping", draw.even(0.35, 0.8));
  if (has(RecordKind::coarse)) sensor.add("resolution", draw.logarithmic(0.004, 0.04));
  if (has(RecordKind::drift)) {
    sensor.add("offset", draw.even(-1, 1));
    sensor.add("drift", draw.either_sign(draw.even(0.1, 0.4)));
  }
  if (has(RecordKind::startup)) {
    sensor.add("startup", draw.either_sign(draw.logarithmic(0.5, 3)));
    sensor.add("startup_s", draw.logarithmic(0.05, 0.4));
  }
  if (has(RecordKind::rattle)) {
    sensor.add("rattle", draw.logarithmic(0.05, 0.3));
    sensor.add("rattle_above", draw.even(0.3, 0.6));
  }
}

std::string logger(const std::vector<RecordKind>& kinds, double pretrigger, Draw& draw) {
  const auto has = [&](RecordKind kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  FileLines lines{"[acquisition]\nforce = false\n"};
  if (pretrigger > 0) lines.add("pretrigger_s", pretrigger);
  if (has(RecordKind::jitter)) {
    lines.add("jitter", 0.3);
    lines.add("median_shortfall", draw.even(0.015, 0.12));
  }
  if (has(RecordKind::gaps)) lines.add("gaps", draw.whole(1, 4));
  if (has(RecordKind::repeated)) lines.add("repeated", 0.04);
  return lines.text;
}

std::vector<RecordKind> drawn_kinds(int number, Draw& draw) {
  constexpr double joins = 0.125;
  std::vector<RecordKind> kinds{static_cast<RecordKind>(number % laboratory_kinds)};
  for (int other = 1; other < laboratory_kinds; ++other) {
    const auto kind = static_cast<RecordKind>(other);
    const bool joined = draw.chance(joins);
    if (kinds[0] != RecordKind::plain && kind != kinds[0] && kind != RecordKind::dead && joined)
      kinds.push_back(kind);
  }
  return kinds;
}

/// How the beam is set in motion, and how large its tip's motion becomes [m].
struct MotionStart {
  std::string toml;
  double amplitude;
};

MotionStart drawn_start(const std::vector<RecordKind>& kinds, const Cantilever& beam,
                        const CantileverMode& mode, Draw& draw) {
  const auto has = [&](RecordKind kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  const double deflection = beam.length * draw.logarithmic(0.002, 0.01), period = 1 / mode.frequency_hz;
  const double duration = draw.even(0.3, 1.1) * period, pulse = draw.even(0.05, 0.2) * period;
  const bool hit = draw.chance(0.35);
  if (has(RecordKind::by_hand)) {
    const double turn = 2 * duration / period;
    return {fmt::format("[excitation]\ndeflection_m = {:.4g}\nduration_s = {:.4g}\n", deflection, duration),
            deflection * std::abs(std::cos(pi * turn / 2) / (1 - turn * turn))};
  }
  if (hit && !has(RecordKind::amplitude)) {
    const double momentum = deflection * mode.mass * 2 * pi * mode.frequency_hz;
    return {fmt::format("[excitation]\nkind = \"impulse\"\nmomentum_n_s = {:.4g}\nduration_s = {:.4g}\n",
                        momentum, pulse),
            deflection};
  }
  return {fmt::format("[excitation]\ndeflection_m = {:.4g}\n", deflection), deflection * mode.share};
}

}  // namespace

const char* to_string(LaboratoryKind kind) {
  return described(kind).name;
}

const std::vector<std::string>& cause_words(LaboratoryKind kind) {
  return described(kind).words;
}

LaboratoryTest laboratory_test(std::uint64_t seed, int number) {
  constexpr int elements = 20;
  constexpr double most_samples = 20000, longest = 60, largest_turn = 0.04;
  Draw draw(seed, number);
  LaboratoryTest test;
  test.number = number;
  test.kinds = drawn_kinds(number, draw);
  const auto has = [&](RecordKind kind) {
    return std::find(test.kinds.begin(), test.kinds.end(), kind) != test.kinds.end();
  };
  const Cantilever beam = drawn_beam(draw);
  const double modulus = beam.modulus * draw.even(0.88, 1.12);  // clamps and catalogues are never exact
  const std::string true_beam = beam.toml(modulus) + fmt::format("elements = {}\n", elements);
  const CantileverMode mode = first_mode(true_beam, elements);
  const double f = mode.frequency_hz, w = 2 * pi * f;
  const double rate = std::clamp(draw.logarithmic(50, 2000), 12 * f, 2000.0);
  const bool falling = has(RecordKind::amplitude);
  const double drawn_ratio = draw.logarithmic(0.002, 0.02), small_ratio = draw.even(0.002, 0.003),
               more = draw.even(0.004, 0.006);
  test.least_damping = falling ? small_ratio : drawn_ratio;
  const MotionStart start = drawn_start(test.kinds, beam, mode, draw);
  test.damping_per_metre = falling ? more / start.amplitude : 0;
  const double constants = draw.even(1.5, 4), noise_share = draw.logarithmic(0.0005, 0.02);
  const double motion =
      std::min({std::max(constants / (test.least_damping * w), 20 / f), longest, most_samples / rate});
  const double wait = draw.even(0.2, 1.5);
  const bool waits = draw.chance(0.75) || has(RecordKind::startup);

  std::string rig = fmt::format("title = \"laboratory record {} of seed {}\"\n", number, seed) + true_beam;
  double steps = 8;  // enough for pulses, and for stamps between samples
  if (falling) {
    rig += fmt::format("[[beam.dashpots]]\nposition_m = {:.4g}\nquadratic_n_s2_per_m2 = {:.6g}\n",
                       beam.length, test.damping_per_metre * 3 * pi * mode.mass / 4);
    rig += fmt::format(
        "[damping]\nlaw = \"rayleigh\"\nanchors = [{{ frequency_hz = {:.8g}, ratio = {:.6g} }}, {{ "
        "frequency_hz = {:.8g}, ratio = 0.02 }}]\n",
        f, test.least_damping, mode.second_hz);
    steps = std::max(8.0, std::ceil(w / rate / largest_turn));
  } else {
    rig += fmt::format("[damping]\nratios = [{:.6g}, {:.6g}]\n", test.least_damping,
                       test.least_damping * draw.even(0.5, 1.5));
  }
  const double h = 1 / (rate * steps);
  test.frequency_hz = falling ? std::atan(w * h / 2) / (pi * h) : f;  // that of newmark's discrete time
  rig += start.toml;
  const std::string place = "[[sensors]]\nname = \"tip\"\nquantity = \"acceleration\"\n" +
                            fmt::format("position_m = {:.4g}\n", beam.length);
  FileLines sensor{place};
  sensor.add("noise_m_per_s2", noise_share * start.amplitude * w * w);
  spoil_sensor(test.kinds, draw, sensor);
  std::string sensors = sensor.text;
  if (has(RecordKind::dead)) {
    const std::string dead = "[[sensors]]\nname = \"cable\"\noffset = 1.5\ndead = true\n";
    sensors = draw.chance(0.5) ? dead + sensors : sensors + dead;
  }
  rig += sensors + logger(test.kinds, waits ? wait : 0, draw);
  rig += fmt::format(
      "[simulation]\nduration_s = {:.6g}\nsampling_rate_hz = {:.6g}\nsteps_per_sample = {:g}\nmethod = "
      "\"{}\"\nframes = 0\nseed = {}\n",
      motion, rate, steps, falling ? "newmark" : "modal", number);
  test.rig = rig;
  test.beam =
      "title = \"" + fmt::format("laboratory record {}", number) + "\"\n" + beam.toml(beam.modulus) + place;
  return test;
}

LaboratoryRecord simulate(const LaboratoryTest& test) {
  const TomlTable table = TomlTable::parse(test.rig, "rig.toml");
  const Acquisition acquisition = read_acquisition(table);
  const SimulatedTest simulated = simulate(
      read_experiment(table), {}, 0, [](const std::string&) {}, acquisition);
  LaboratoryRecord result;
  result.record = simulated.record;
  const double rate = read_experiment(table).simulation.sampling_rate;
  result.event = std::round(acquisition.pretrigger * rate) / rate;
  result.time = simulated.response.time.array() + result.event;
  result.motion = simulated.response.displacement.row(0);
  return result;
}

std::pair<double, double> damping_between(const LaboratoryTest& test, const LaboratoryRecord& record,
                                          double from, double to) {
  const double period = 1 / test.frequency_hz;
  const auto amplitude = [&](double begin) {
    double largest = 0;
    for (Eigen::Index k = 0; k < record.time.size(); ++k)
      if (record.time[k] >= begin && record.time[k] <= begin + period)
        largest = std::max(largest, std::abs(record.motion[k]));
    return largest;
  };
  const double most = test.damping_per_metre * amplitude(std::max(from, record.event)),
               least = test.damping_per_metre * amplitude(to - period);
  return {test.least_damping + std::min(least, most), test.least_damping + std::max(least, most)};
}

}  // namespace beamid::experiments
