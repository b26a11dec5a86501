#include "experiments/config/read_experiment.hpp"

#include "experiments/config/failure_response.hpp"
#include "experiments/config/read_acquisition.hpp"
#include "experiments/config/read_beam.hpp"
#include "experiments/config/read_comparison.hpp"
#include "experiments/config/read_damping.hpp"
#include "experiments/config/read_frequency_response.hpp"
#include "experiments/config/read_identifiability.hpp"
#include "experiments/config/read_parameters.hpp"
#include "experiments/config/read_record_format.hpp"
#include "experiments/config/read_reduction.hpp"
#include "experiments/config/read_simulation.hpp"
#include "experiments/config/read_sweep.hpp"
#include "experiments/config/vocabulary.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/method_choice.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"
#include "filters/smoother.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

PriorBelief read_prior(const TomlTable& table) {
  PriorBelief prior;
  prior.stiffness = table.find_number("stiffness_n_per_m", Sign::positive);
  prior.stiffness_deviation = table.find_number("stiffness_deviation_n_per_m", Sign::positive);
  prior.damping_ratio = table.find_number("damping_ratio", Sign::not_negative);
  prior.damping_ratio_deviation = table.find_number("damping_ratio_deviation", Sign::positive);
  if (prior.damping_ratio && *prior.damping_ratio >= 1)
    table.refuse("damping_ratio", "a number from 0 to below 1");
  return prior;
}

std::map<Quantity, double> read_noise(const TomlTable& table) {
  std::map<Quantity, double> noise;
  for (const Quantity quantity :
       {Quantity::displacement, Quantity::velocity, Quantity::acceleration, Quantity::strain}) {
    const std::string key = std::string(to_string(quantity)) + "_" + units(quantity).front().suffix;
    if (const auto deviation = table.find_number(key, Sign::positive)) noise[quantity] = *deviation;
  }
  return noise;
}

void read_noise_table(const TomlTable& table, Experiment& experiment) {
  experiment.noise = read_noise(table);
  const std::vector<std::string> methods{"residual", "likelihood", "before_event"};
  if (const auto method = table.find_text("method", methods))
    experiment.noise_method = {*method, {}, table.value_place("method")};
}

/// The methods; an absent table means the Experiment's own default.
void read_methods(const TomlTable& root, Experiment& experiment) {
  const auto choose = [&](const char* name, const char* key, Choice& choice, const auto& registry,
                          const std::vector<std::string>& others) {
    if (const auto table = root.find_table(name))
      choice = read_choice(*table, key, choice.name, registry, others);
    else
      choice = {choice.name, registry.completed(choice.name, choice.options), root.value_place(name)};
  };
  choose("reduction", "method", experiment.reduction, reduction::reduction_registry(), {"shape_file"});
  if (const auto table = root.find_table("reduction")) read_shape_file(*table, experiment.reduction);
  for (const TomlTable& table : root.find_tables("reductions"))
    experiment.reductions.push_back(read_reduction(table));
  read_comparison(root, experiment);
  choose("model", "name", experiment.model, model_registry(), {});
  // Static shapes are K and M of one coordinate; of a model of modes they would be an error of its own.
  const std::string& model = experiment.model.name;
  if (!root.contains("reduction") && (model == "beam" || model == "modal"))
    experiment.reduction = {"modal_truncation",
                            reduction::reduction_registry().completed("modal_truncation", {}),
                            root.value_place("reduction")};
  choose("filter", "method", experiment.filter, filters::filter_registry(),
         {"discretisation", "on_failure", "smoother", "estimator"});
  if (const auto table = root.find_table("filter")) {
    experiment.discretisation = table->find_text("discretisation").value_or(experiment.discretisation);
    at_place(table->value_place("discretisation"),
             [&] { filters::scheme_registry().find(experiment.discretisation); });
    if (const auto word = table->find_text("on_failure"))
      at_place(table->value_place("on_failure"), [&] { experiment.on_failure = failure_response(*word); });
    experiment.estimator = table->find_text("estimator", {"filter", "both"}).value_or("filter");
    experiment.smoother = table->find_text("smoother").value_or("");
    if (table->contains("smoother"))
      at_place(table->value_place("smoother"),
               [&] { filters::smoother_registry().find(experiment.smoother); });
  }
}

/// What is done with the beam itself.
void read_continuum(const TomlTable& root, Experiment& experiment) {
  const double length = experiment.beam.length();
  if (const auto damping = root.find_table("damping")) experiment.damping = read_damping(*damping);
  if (const auto excitation = root.find_table("excitation"))
    experiment.excitation = read_excitation(*excitation, length);
  experiment.sensors = read_sensors(root, experiment.beam);
  experiment.acquisition = read_acquisition(root);
  experiment.parameters = read_parameters(root, length);
  if (const auto simulation = root.find_table("simulation"))
    experiment.simulation = read_simulation(*simulation);
  if (const auto response = root.find_table("frequency_response"))
    experiment.frequency_response = read_frequency_response(*response, length);
}

}  // namespace

Experiment read_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return read_experiment(TomlTable::read(file, overrides));
}

Experiment read_experiment(const TomlTable& root) {
  refuse_unknown_keys(root);
  if (root.contains("frame"))
    throw InputError(root.key_place("frame"),
                     "frame describes a plane frame, which 'beamid frame' takes; expected a beam");
  Experiment experiment;
  experiment.title = root.find_text("title").value_or("");
  const TomlTable beam = root.table("beam");
  experiment.beam = read_beam(beam);
  experiment.elements = beam.find_whole_number("elements", 1, most_elements).value_or(experiment.elements);
  experiment.format.irregular = true;  // as [record] has it unless it says otherwise
  if (const auto record = root.find_table("record")) {
    experiment.record_file = record->find_text("file");
    if (experiment.record_file && experiment.record_file->empty())
      record->refuse("file", "the name of a file");
    experiment.format = read_record_format(*record, experiment.beam);
  }
  read_continuum(root, experiment);
  read_methods(root, experiment);
  if (const auto table = root.find_table("identifiability"))
    experiment.identifiability = read_identifiability(*table);
  if (const auto table = root.find_table("sweep")) experiment.sweep = read_sweep(*table);
  if (const auto prior = root.find_table("prior")) experiment.prior = read_prior(*prior);
  if (const auto noise = root.find_table("noise")) read_noise_table(*noise, experiment);
  return experiment;
}

}  // namespace beamid::experiments
