#include "experiments/studies/continuum/report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/results/result_directory.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXcd, Eigen::VectorXd;
using ResponseKind = FrequencyResponseSettings::Kind;

// Laws of ratios have no sparse matrix, and no direct form.
std::string method_for(const fem::DampingLaw& law) {
  const auto* caughey = std::get_if<fem::CaugheyDamping>(&law);
  const bool full =
      std::holds_alternative<fem::ModalDamping>(law) || (caughey && caughey->anchors.size() > 2);
  return full ? "modal" : "direct";
}

bool is_damped(const fem::DampingLaw& law, const fem::StructuralSystem& system,
               const VectorXd& frequency_hz) {
  if (system.damping.nonZeros() > 0) return true;
  const VectorXd ratios = fem::damping_ratios(law, 2.0 * std::numbers::pi * frequency_hz);
  return (ratios.array() > 0.0).any();
}

VectorXd grid(const FrequencyResponseSettings& settings, const VectorXd& natural, Index rigid) {
  const double first = natural[std::min(rigid, natural.size() - 1)];
  const double third = natural[std::min(rigid + 2, natural.size() - 1)];
  const double from =
      settings.from_hz.value_or(std::min(first / 5.0, settings.to_hz.value_or(INFINITY) / 5.0));
  const double to = settings.to_hz.value_or(std::max(1.2 * third, 5.0 * from));
  const double last = settings.points - 1;
  return VectorXd::NullaryExpr(settings.points, [&](Index i) {
    const double part = static_cast<double>(i) / last;
    if (part == 1.0) return to;
    return settings.logarithmic ? from * std::pow(to / from, part) : from + part * (to - from);
  });
}

class Solver {
 public:
  Solver(const Experiment& experiment, const fem::StructuralSystem& system,
         const fem::FrequencyResponseMethod& method)
      : damping_(experiment.damping),
        kind_(experiment.frequency_response.kind),
        system_(system),
        method_(method) {}

  Eigen::MatrixXcd operator()(const VectorXd& frequency_hz,
                              const std::vector<fem::InputOutput>& pairs) const {
    Eigen::MatrixXcd all = fem::receptances(system_, damping_, frequency_hz, pairs, method_);
    for (Index i = 0; i < all.cols(); ++i) {
      if (kind_ == ResponseKind::mobility) all.col(i) = fem::mobility(frequency_hz, all.col(i)).eval();
      if (kind_ == ResponseKind::accelerance) all.col(i) = fem::accelerance(frequency_hz, all.col(i)).eval();
    }
    return all;
  }

  // Between two frequencies, by closing in on the extremum among nine in between.
  Extremum refined(double from, double to, bool largest, const fem::InputOutput& pair) const {
    constexpr int rounds = 7, inside = 9;
    Extremum found;
    for (int round = 0; round < rounds; ++round) {
      const VectorXd frequency = VectorXd::LinSpaced(inside + 2, from, to).segment(1, inside);
      const VectorXcd response = (*this)(frequency, {pair}).col(0);
      Index at = 0;
      largest ? response.cwiseAbs().maxCoeff(&at) : response.cwiseAbs().minCoeff(&at);
      found.frequency_hz = frequency[at];
      found.response = response[at];
      const double step = (to - from) / (inside + 1);
      from = frequency[at] - step;
      to = frequency[at] + step;
    }
    if (!largest) found.kind = Extremum::Kind::minimum;
    return found;
  }

  /// Displacement per force, of any kind of response.
  std::complex<double> receptance(double frequency_hz, std::complex<double> response) const {
    const std::complex<double> rate(0.0, 2.0 * std::numbers::pi * frequency_hz);
    return kind_ == ResponseKind::receptance ? response
           : kind_ == ResponseKind::mobility ? response / rate
                                             : response / (rate * rate);
  }

 private:
  const fem::DampingLaw& damping_;
  ResponseKind kind_;
  const fem::StructuralSystem& system_;
  const fem::FrequencyResponseMethod& method_;
};

// Which minima are anti-resonances: those where the response has turned its sign by the next resonance. Below
// a resonance of residue r the receptance has the sign of r, at it -i r, above it -r.
void add_anti_resonances(const VectorXd& f, const VectorXcd& h, const Solver& solver,
                         std::vector<Extremum>& extrema) {
  const Index last = f.size() - 1;
  const auto residue = [&](const Extremum& e) {
    return -solver.receptance(e.frequency_hz, e.response).imag();
  };
  const auto in_phase = [&](Index i) { return solver.receptance(f[i], h[i]).real(); };
  for (std::size_t i = 0; i < extrema.size(); ++i) {
    if (extrema[i].kind != Extremum::Kind::minimum) continue;
    const double before = i > 0 ? -residue(extrema[i - 1]) : in_phase(0);
    const double after = i + 1 < extrema.size() ? residue(extrema[i + 1]) : in_phase(last);
    if (before * after < 0.0) extrema[i].kind = Extremum::Kind::anti_resonance;
  }
}

// The grid's frequencies and, about every natural one, others that close in on it: a resonance and the
// anti-resonance beside it may both lie between two of the grid's, and show at neither.
VectorXd closer_grid(const VectorXd& grid, const VectorXd& natural, bool damped) {
  std::set<double> frequencies(grid.begin(), grid.end());
  for (const double f : natural) {
    if (!(grid[0] < f && f < grid[grid.size() - 1])) continue;
    const auto above = std::upper_bound(grid.begin(), grid.end(), f);
    const double step = *above - *(above - 1);
    if (damped) frequencies.insert(f);
    for (const double part : {2.0, 8.0, 32.0, 128.0, 512.0})
      for (const double there : {f - step / part, f + step / part})
        if (grid[0] < there && there < grid[grid.size() - 1]) frequencies.insert(there);
  }
  VectorXd closer(static_cast<Index>(frequencies.size()));
  std::copy(frequencies.begin(), frequencies.end(), closer.begin());
  return closer;
}

// Of responses h at frequencies f, between which the extrema are searched for.
std::vector<Extremum> extrema(const VectorXd& f, const VectorXcd& h, const VectorXd& natural,
                              const Solver& solver, const fem::InputOutput& numbers, bool damped) {
  std::vector<Extremum> found;
  const VectorXd size = h.cwiseAbs();
  for (Index i = 1; i + 1 < size.size(); ++i) {
    const bool largest = size[i] > size[i - 1] && size[i] >= size[i + 1];
    const bool smallest = size[i] < size[i - 1] && size[i] <= size[i + 1];
    if (smallest || (largest && damped))
      found.push_back(solver.refined(f[i - 1], f[i + 1], largest, numbers));
    // Undamped, it is zero itself; its sign may turn back at a resonance before the next frequency.
    const bool turns =
        damped ? (h[i - 1] * std::conj(h[i + 1])).real() < 0.0
               : smallest && std::abs(found.back().response) < 1e-3 * std::min(size[i - 1], size[i + 1]);
    if (smallest && turns) found.back().kind = Extremum::Kind::anti_resonance;
    if (!largest || damped) continue;
    // The response is infinite at the natural frequency itself.
    for (const double one : natural)
      if (f[i - 1] <= one && one <= f[i + 1])
        found.push_back({Extremum::Kind::resonance, one, std::numeric_limits<double>::infinity()});
  }
  if (damped) add_anti_resonances(f, h, solver, found);
  return found;
}

// Resonances of which the grid's frequencies show less than half the height.
Index between_grid(const VectorXd& f, const PairResponse& pair) {
  Index count = 0;
  for (const Extremum& one : pair.extrema) {
    if (one.kind != Extremum::Kind::resonance || !std::isfinite(std::abs(one.response))) continue;
    const Index above = std::upper_bound(f.begin(), f.end(), one.frequency_hz) - f.begin();
    if (above == 0 || above == f.size()) continue;
    const double shown = std::max(std::abs(pair.response[above - 1]), std::abs(pair.response[above]));
    count += shown < 0.5 * std::abs(one.response) ? 1 : 0;
  }
  return count;
}

}  // namespace

const char* to_string(Extremum::Kind kind) {
  return kind == Extremum::Kind::resonance        ? "resonance"
         : kind == Extremum::Kind::anti_resonance ? "anti-resonance"
                                                  : "minimum";
}

FrequencyResponses respond_to_frequencies(const Experiment& experiment, const Progress& progress) {
  constexpr Index most_natural = 200;
  const FrequencyResponseSettings& settings = experiment.frequency_response;
  FrequencyResponses all;
  StructurePoints points(experiment.structure);
  std::vector<fem::InputOutput> numbers;
  for (const PointPair& pair : settings.pairs.empty() ? std::vector<PointPair>(1) : settings.pairs) {
    const Index input = points.add(pair.input, pair.input_place);
    numbers.push_back({input, points.add(pair.output, pair.output_place)});
  }
  progress("assembling");
  all.system = fem::assemble(experiment.structure, experiment.elements, points.all());
  progress("modes");
  fem::Modes modes = fem::modes(all.system, std::min<Index>(20, all.system.size()));
  const Index rigid = modes.rigid;
  if (rigid > 0 && settings.from_hz == 0.0 && experiment.file)
    throw InputError(experiment.file->table("frequency_response").value_place("from_hz"),
                     "frequency_response.from_hz is 0, where a structure without supports follows a force "
                     "without bound; expected a frequency above 0");
  all.frequency_hz = grid(settings, modes.frequency_hz(), rigid);
  const double end = all.frequency_hz[all.frequency_hz.size() - 1];
  if (modes.frequency_hz().maxCoeff() < end && modes.size() < std::min(most_natural, all.system.size()))
    modes = fem::modes(all.system, std::min(most_natural, all.system.size()));
  const VectorXd natural = modes.frequency_hz();
  all.natural_frequencies_hz = natural.head((natural.array() <= end).count());

  all.method = settings.method;
  if (all.method.name.empty()) all.method.name = method_for(experiment.damping);
  const Index size = all.system.size(),
              summed = all.method.modes > 0 ? all.method.modes : (size <= 200 ? size : Index{100});
  const Index in_band = all.natural_frequencies_hz.size();
  if (all.method.name == "modal" && in_band > summed)
    all.warnings.push_back(fmt::format(
        "{} modes are summed, and {} natural frequencies lie up to {:.6g} Hz: resonances of {} are "
        "missing; expected [frequency_response] modes = {} at least.",
        summed, in_band, end, in_band - summed, in_band));
  progress("frequency responses");
  const Solver solver(experiment, all.system, all.method);
  const Eigen::MatrixXcd responses = solver(all.frequency_hz, numbers);
  const bool damped = is_damped(experiment.damping, all.system, natural.tail(natural.size() - rigid));
  if (const std::string note = small_motion_note(experiment); !note.empty()) all.notes.push_back(note);
  if (!damped) all.notes.emplace_back("Without damping resonances are infinite, at the natural frequencies.");
  progress("resonances");
  const VectorXd closer = closer_grid(all.frequency_hz, all.natural_frequencies_hz, damped);
  const Eigen::MatrixXcd closer_responses = solver(closer, numbers);
  Index between = 0, resonances = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const fem::Point &input = points[numbers[i].input], &output = points[numbers[i].output];
    const auto column = static_cast<Index>(i);
    PairResponse pair{input, output,
                      input.name == output.name ? input.name : input.name + " to " + output.name,
                      responses.col(column),
                      extrema(closer, closer_responses.col(column), all.natural_frequencies_hz, solver,
                              numbers[i], damped)};
    between += between_grid(all.frequency_hz, pair);
    resonances += std::count_if(pair.extrema.begin(), pair.extrema.end(),
                                [](const Extremum& one) { return one.kind == Extremum::Kind::resonance; });
    all.pairs.push_back(std::move(pair));
  }
  if (between > 0)
    all.notes.push_back(fmt::format(
        "{} of {} resonances lie between two of the {} frequencies. The frequency grid shows less than half "
        "of these peaks. The table has their true height; frf.csv and the figure do not. A finer grid shows "
        "them.",
        between, resonances, all.frequency_hz.size()));
  return all;
}

namespace {

using Json = nlohmann::ordered_json;
constexpr double degrees_per_radian = 180.0 / std::numbers::pi;

Table resonance_table(const Experiment& experiment, const FrequencyResponses& found) {
  const auto kind = experiment.frequency_response.kind;
  Table table{"resonances", ""};
  table.column({"pair", "pair"})
      .column({"what", "what"})
      .column({"f [Hz]", "frequency_hz", "{:.8g}"})
      .column({fmt::format("magnitude [{}]", unit_of(kind)), std::string("magnitude_") + suffix_of(kind),
               "{:.6g}"})
      .column({"phase [deg]", "phase_deg", "{:.2f}"});
  for (const PairResponse& pair : found.pairs)
    for (const Extremum& extremum : pair.extrema) {
      const bool finite = std::isfinite(std::abs(extremum.response));
      table.row({pair.name, to_string(extremum.kind), extremum.frequency_hz,
                 finite ? std::abs(extremum.response) : std::nan(""),
                 finite ? degrees_per_radian * std::arg(extremum.response) : std::nan("")});
    }
  return table;
}

std::string column_name(const std::string& pair) {
  std::string name;
  for (const char letter : pair) {
    const bool plain = std::isalnum(static_cast<unsigned char>(letter)) != 0;
    if (plain)
      name += letter;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  return name;
}

// Every frequency and every pair: real and imaginary part, magnitude, phase.
Table response_table(const Experiment& experiment, const FrequencyResponses& found) {
  const std::string unit = suffix_of(experiment.frequency_response.kind);
  Table table{"frf", ""};
  const auto add = [&](const std::string& key, const VectorXd& frequency_response_values) {
    Column column{key, key};
    column.cells.assign(frequency_response_values.begin(), frequency_response_values.end());
    table.column(std::move(column));
  };
  add("frequency_hz", found.frequency_hz);
  for (const PairResponse& pair : found.pairs) {
    const std::string name = found.pairs.size() == 1 ? "" : column_name(pair.name) + "_";
    add(name + "real_" + unit, pair.response.real());
    add(name + "imaginary_" + unit, pair.response.imag());
    add(name + "magnitude_" + unit, pair.response.cwiseAbs());
    add(name + "phase_rad", pair.response.cwiseArg().real());
  }
  return table;
}

// "x0.55m to tip" as "0.55 m to tip".
std::string readable_pair(std::string pair) {
  for (std::size_t at = pair.find('x'); at != std::string::npos; at = pair.find('x', at + 1)) {
    const std::size_t end = pair.find_first_not_of("0123456789.", at + 1);
    if ((at > 0 && pair[at - 1] != ' ') || end == std::string::npos || end == at + 1 || pair[end] != 'm')
      continue;
    pair.insert(end, " ").erase(at, 1);
  }
  return pair;
}

Figure response_figure(const Experiment& experiment, const FrequencyResponses& found) {
  const auto& settings = experiment.frequency_response;
  const double from = found.frequency_hz[0], to = found.frequency_hz[found.frequency_hz.size() - 1];
  const Axis frequency{"frequency [Hz]", settings.logarithmic, std::pair{from, to}};
  Panel magnitude{
      "", frequency, {fmt::format("{} [{}]", to_string(settings.kind), unit_of(settings.kind)), true}};
  Panel phase{"", frequency, {"phase [deg]", false, std::pair{-185.0, 185.0}, 90.0}};
  magnitude.legend = Legend::none;
  if (found.pairs.size() == 1) phase.legend = Legend::none;
  for (const PairResponse& pair : found.pairs) {
    magnitude.line(readable_pair(pair.name), found.frequency_hz, pair.response.cwiseAbs());
    phase.line(readable_pair(pair.name), found.frequency_hz,
               degrees_per_radian * pair.response.cwiseArg().real());
  }
  Figure figure{"frf_plot", {magnitude, phase}, 2, 1};
  figure.caption = fmt::format("Magnitude and phase of the {}.", to_string(settings.kind));
  return figure;
}

Json frequency_response_values(const Experiment& experiment, const FrequencyResponses& found) {
  const std::string unit = std::string("_") + suffix_of(experiment.frequency_response.kind);
  Json json{{"kind", to_string(experiment.frequency_response.kind)},
            {"method", found.method.name},
            {"points", found.frequency_hz.size()},
            {"from_hz", found.frequency_hz[0]},
            {"to_hz", found.frequency_hz[found.frequency_hz.size() - 1]},
            {"elements", found.system.mesh.elements.size()},
            {"degrees_of_freedom", found.system.size()},
            {"natural_frequencies_hz",
             std::vector<double>(found.natural_frequencies_hz.begin(), found.natural_frequencies_hz.end())},
            {"pairs", Json::array()}};
  for (const PairResponse& pair : found.pairs) {
    Json one{
        {"name", pair.name},           {"input_m", pair.input.position},   {"output_m", pair.output.position},
        {"resonances", Json::array()}, {"anti_resonances", Json::array()}, {"minima", Json::array()}};
    for (const Extremum& extremum : pair.extrema) {
      const char* const list = extremum.kind == Extremum::Kind::resonance        ? "resonances"
                               : extremum.kind == Extremum::Kind::anti_resonance ? "anti_resonances"
                                                                                 : "minima";
      one[list].push_back(
          {{"frequency_hz", extremum.frequency_hz},
           {"magnitude" + unit, number_or_null(std::abs(extremum.response))},
           {"phase_rad", number_or_null(std::abs(extremum.response) < INFINITY ? std::arg(extremum.response)
                                                                               : std::nan(""))}});
    }
    json["pairs"].push_back(std::move(one));
  }
  return json;
}

}  // namespace

Results report(const Experiment& experiment, const FrequencyResponses& found) {
  const auto& settings = experiment.frequency_response;
  Results results;
  results.command = "frf";
  results.configuration = describe(experiment, {"frequency_response"});
  results.configuration["frequency_response"].update(
      {{"from_hz", found.frequency_hz[0]},
       {"to_hz", found.frequency_hz[found.frequency_hz.size() - 1]},
       {"method", found.method.name},
       {"modes", found.method.modes}});
  results.values = frequency_response_values(experiment, found);
  results.heading(experiment.title.empty() ? "Frequency response" : experiment.title);
  results.paragraph(structure_text(experiment, static_cast<Eigen::Index>(found.system.mesh.elements.size()),
                                   found.system.size()));
  results.paragraph(fmt::format("{} at {} frequencies from {:.6g} to {:.6g} Hz, {}. Damping: {}.",
                                to_string(settings.kind), settings.points, found.frequency_hz[0],
                                found.frequency_hz[found.frequency_hz.size() - 1], found.method.name,
                                damping_text(experiment.damping, found.system)));
  for (const std::string& warning : found.warnings) results.warning(warning);
  results.table(resonance_table(experiment, found));
  results.notes(found.notes);
  results.attachments.push_back(
      {{"frf.csv"}, [csv = to_csv(response_table(experiment, found))](const std::filesystem::path& folder) {
         write_file(folder / "frf.csv", csv);
       }});
  results.figures.push_back(response_figure(experiment, found));
  return results;
}

}  // namespace beamid::experiments
