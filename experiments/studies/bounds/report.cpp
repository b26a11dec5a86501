#include "experiments/studies/bounds/report.hpp"

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/studies/update/report.hpp"
#include "experiments/text/spelling.hpp"
#include "fem/assembly.hpp"

namespace beamid::experiments {
namespace {

const char* words_of(Excitation::Kind kind) {
  switch (kind) {
    case Excitation::Kind::release:
      return "after a release";
    case Excitation::Kind::step:
      return "under a constant force";
    case Excitation::Kind::impulse:
      return "after an impulse";
    case Excitation::Kind::harmonic:
      return "under a harmonic force";
    case Excitation::Kind::random:
      return "under a random force";
    case Excitation::Kind::base:
      return "under a motion of the base";
    case Excitation::Kind::table:
      return "under a force from a table";
    case Excitation::Kind::free:
      return "after a given start";
  }
  return "";
}

/// "after a release, under a random force and under a motion of the base".
std::string words_of_all(const Experiment& experiment) {
  std::vector<std::string> all{words_of(experiment.excitation.kind)};
  for (const Excitation& further : experiment.further_excitations) {
    const std::string one = words_of(further.kind);
    const std::string place =
        further.kind == Excitation::Kind::base ? "" : at_place_text(further.position, further.at);
    all.push_back(one + place);
  }
  return joined(all);
}

std::string test_text(const Experiment& experiment, const Identifiability& found) {
  const auto& frequencies = found.frequencies_hz;
  const bool several = !experiment.further_excitations.empty();
  std::string text = fmt::format(
      "Model {}, reduction {}: {} coordinate{}, {:.4g} Hz{}. A record of {:g} s at {:g} Hz {}{}.",
      found.model, found.reduction, found.coordinates, found.coordinates == 1 ? "" : "s", frequencies.front(),
      frequencies.size() > 1 ? fmt::format(" to {:.4g} Hz", frequencies.back()) : "", found.duration,
      found.sampling_rate, words_of_all(experiment),
      found.force_measured ? (several ? ", all of which are measured" : ", which is measured")
      : found.begin > 0.0
          ? fmt::format(", from {:g} s on, when {} ended", found.begin, several ? "all have" : "that has")
          : "");
  text += " Sensors:";
  for (std::size_t i = 0; i < found.sensors.size(); ++i) {
    const Sensor& sensor = found.sensors[i].sensor;
    text +=
        fmt::format("{} {} ({}{}, noise {:.3g} {}{})", i ? "," : "", sensor.name, to_string(sensor.quantity),
                    at_place_text(sensor.position.value_or(0.0), sensor.place), sensor.noise,
                    si_unit(sensor.quantity), found.sensors[i].assumed ? ", assumed" : "");
  }
  if (found.inputs) text += ". " + words(*found.inputs);
  return text + (found.inputs ? "" : ".") +
         " The start is unknown, the parameters requested have no prior, the noise is white.";
}

Attachment place_file(const Identifiability& found) {
  const Table table = sweep_table(found, found.places, "sensor_places", "", {"at [m]", "position_m"});
  return {{"sensor_places.csv"}, [csv = to_csv(table)](const std::filesystem::path& folder) {
            write_file(folder / "sensor_places.csv", csv);
          }};
}

}  // namespace

Results report(const Experiment& experiment, const Identifiability& found) {
  Results results;
  results.command = "identifiability";
  results.configuration = describe(experiment, {"excitation", "identifiability", "model", "reduction"});
  results.values = values(found);

  results.heading(experiment.title.empty() ? "What can be known" : experiment.title);
  if (const std::string text = twins_warning(experiment); !text.empty()) results.warning(text);
  results.paragraph(structure_text(experiment, experiment.elements,
                                   fem::assemble(experiment.structure, experiment.elements).size()));
  results.paragraph(test_text(experiment, found));
  results.table(bound_table(found));
  if (found.parameters.size() > 1) {
    results.table(combination_table(found));
    results.table(correlation_table(found));
  }
  results.table(sweep_table(found, found.lengths, "record_lengths", "Bounds over the length of the record",
                            {"duration [s]", "duration_s", "{:.4g}"}));
  results.table(sweep_table(
      found, found.rates, "sampling_rates", "Bounds over the sampling rate, the noise of a sample the same",
      {"rate [Hz]", "sampling_rate_hz", "{:.5g}"}, {"modes below half", "modes_below_half", "{:.0f}"}));
  if (!found.places.empty()) {
    results.table(place_table(found));
    results.table(sweep_table(found, found.numbers, "sensor_numbers",
                              "Bounds with further sensors like the first, each where it helps most",
                              {"sensors", "sensors", "{:.0f}"}, {"the last at [m]", "added_at_m", "{:.4g}"}));
    results.attachments.push_back(place_file(found));
  }
  for (const std::string& paragraph : words(found)) results.paragraph(paragraph);
  results.notes(found.notes);
  results.figures = figures(found);
  return results;
}

}  // namespace beamid::experiments
