// beamid validate: is an experiment file, and the record it is for, understood as it was meant?
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <utility>

#include "apps/command.hpp"
#include "apps/values.hpp"
#include "experiments/config/description.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/fields.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "reduction/reduction.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

std::string columns_text(const RecordFormat& format) {
  std::string text;
  for (const ColumnDescription& channel : format.channels)
    text += fmt::format("{}{} from column {} (1 is {:g} {})", text.empty() ? "" : ", ",
                        to_string(channel.quantity),
                        channel.name.empty() ? std::to_string(channel.number) : "'" + channel.name + "'",
                        channel.factor, si_unit(channel.quantity));
  return text.empty() ? "columns by the names in the record's header" : text;
}

std::string readings_text(const Record& record) {
  std::string text;
  for (Eigen::Index i = 0; i < record.samples.rows(); ++i)
    text += fmt::format("{}{} up to {:.4g} {}", i ? ", " : "", channel_text(record.channels[i]),
                        record.samples.row(i).cwiseAbs().maxCoeff(), si_unit(record.channels[i].quantity));
  return text;
}

std::string record_text(const fs::path& file, const Record& record) {
  return fmt::format("{}: {} samples from {:.6g} to {:.6g} s at {:.6g} Hz; {}", file.filename().string(),
                     record.size(), record.time[0], record.time[record.size() - 1], 1.0 / record.interval(),
                     readings_text(record));
}

std::string value_text(const std::string& name, std::optional<double> value, std::optional<double> deviation,
                       const std::string& unit) {
  std::string text = name;
  if (value) text += fmt::format(" {:.6g}", *value);
  if (value && deviation) text += fmt::format(" +- {:.3g}", *deviation);
  return text + (value && !unit.empty() ? " " + unit : "");
}

// Model sdof starts from [prior] and, for what that leaves open, from the record.
std::string prior_text(const Prior& prior) {
  return value_text("stiffness", prior.stiffness, prior.stiffness_deviation, "N/m") + ", " +
         value_text("damping ratio", prior.damping_ratio, prior.damping_ratio_deviation, "") +
         (prior.stiffness || prior.damping_ratio ? " (initial estimates; the others from the record)"
                                                 : " (initial estimates from the record)");
}

// What the experiment file says; the model fills in the rest when it has a record.
std::string parameters_text(const Experiment& experiment) {
  if (experiment.model.name == "sdof" && experiment.parameters.empty()) return prior_text(experiment.prior);
  std::string text;
  for (const ParameterChoice& choice : experiment.parameters)
    text += (text.empty() ? "" : ", ") + value_text(choice.name.empty() ? choice.quantity : choice.name,
                                                    choice.guess, choice.deviation,
                                                    parameter_quantity(choice.quantity).unit);
  return text.empty() ? "what model " + experiment.model.name + " determines by itself" : text;
}

// What the model says of the record's channels, and what it asks about, shows only when it is made.
std::string parameters_text(const Experiment& experiment, const fs::path& folder, const Record& record) {
  const ModelSetting setting = model_setting(experiment, record, experiment.reduction, folder);
  const auto model = at_place(experiment.model.place, [&] {
    return model_registry().make(experiment.model.name, experiment.model.options, setting);
  });
  if (experiment.model.name == "sdof" && experiment.parameters.empty()) return prior_text(experiment.prior);
  std::string text;
  for (const Unknown& unknown : model->unknowns)
    text +=
        (text.empty() ? "" : ", ") + value_text(unknown.name, unknown.guess, unknown.deviation, unknown.unit);
  return text + " (initial estimates)";
}

std::string sensors_text(const Experiment& experiment) {
  std::string text;
  for (const Sensor& sensor : experiment.sensors) {
    text += (text.empty() ? "" : ", ") + sensor.name + (sensor.name.empty() ? "" : ": ") +
            to_string(sensor.quantity);
    text += at_place_text(sensor.position, sensor.place);
  }
  return text;
}

/// "  record   ...", what is behind it broken to the terminal's width and indented.
void print_line(const std::string& label, const std::string& text) {
  const std::string indent(11, ' ');
  const std::size_t width = terminal_page().width - indent.size();
  std::string before = fmt::format("  {:<8} ", label);
  for (const std::string& line : wrapped(clean_text(text), width))
    std::cout << std::exchange(before, indent) << line << "\n";
}

bool is_one_beam(const fem::Structure& structure) {
  return structure.is_beam() && !structure.is_chain();
}

std::string structure_words(const Experiment& experiment, const fem::StructuralSystem& system) {
  const fem::Structure& structure = experiment.structure;
  const std::string first = fmt::format("irst mode predicted at {:.4f} Hz", fem::lowest_frequency_hz(system));
  if (!is_one_beam(structure))
    return structure_text(experiment, experiment.elements, system.size()) + " F" + first + ".";
  const fem::Beam& beam = structure.beam();
  return fmt::format("{:g} m, EI = {} N m2, {:.6g} kg with {:.6g} kg at its tip; f{}", beam.length(),
                     bending_stiffness_text(beam), beam.mass(), beam.tip_mass(), first);
}

int run_validate(const Values& values) {
  const fs::path file = values.texts("file")[0];
  const TomlTable root = TomlTable::read(file);
  const Experiment experiment = read_experiment(root);
  const fem::StructuralSystem system =
      at_place({file.string()}, [&] { return fem::assemble(experiment.structure, experiment.elements); });
  std::string record_line = "none named; " + columns_text(experiment.format);
  std::string parameters = parameters_text(experiment);
  fs::path record_file;
  if (values.has("record"))
    record_file = values.text("record");
  else if (experiment.record_file)
    record_file = file.parent_path() / *experiment.record_file;
  if (values.has("record") || (!record_file.empty() && fs::exists(record_file))) {
    const Record read = prepared_record(record_file, experiment.format);
    const Record record = at_place({file.string()}, [&] { return with_places(read, experiment); });
    parameters = parameters_text(experiment, file.parent_path(), record);
    record_line = record_text(record_file, record);
  } else if (!record_file.empty()) {
    record_line = fmt::format("'{}' is not there and was not checked; {}", record_file.string(),
                              columns_text(experiment.format));
  }

  std::cout << clean_text(file.string()) << ": valid\n";
  for (const std::string& sentence : implausible(experiment)) print_line("check", sentence);
  const fem::Structure& structure = experiment.structure;
  print_line(is_one_beam(structure) ? "beam" : structure.kind(), structure_words(experiment, system));
  if (!experiment.sensors.empty()) print_line("sensors", sensors_text(experiment));
  print_line("record", record_line);
  print_line("methods",
             fmt::format("reduction {}, model {}, filter {}, discretisation {}", experiment.reduction.name,
                         experiment.model.name, experiment.filter.name, experiment.discretisation));
  print_line("unknowns", parameters);
  return 0;
}

}  // namespace

Command validate_command() {
  return {
      "validate",
      "FILE [--record RECORD]",
      "check an experiment file and its record, and show each value in force",
      {{.name = "file", .required = true}},
      {{"Options", {text("record", "RECORD", "read this record too, instead of the one the file names")}}},
      "  beamid validate cantilever.toml\n"
      "  beamid validate cantilever.toml --record tip_acceleration.csv\n",
      run_validate};
}

}  // namespace beamid::apps
