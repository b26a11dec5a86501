
#include "experiments/config/readers.hpp"

#include <algorithm>

#include "experiments/config/experiment.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/text/choice.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"
#include "filters/smoother.hpp"

namespace beamid::experiments {

using filters::OptionValue;

namespace {

Schema<Choice> make_reduction_keys(const char* table, const char* fallback) {
  Schema<Choice> keys(table);
  return keys.with_options()
      .other("method", Key::Type::text, "a name from `beamid list reductions`", "\"modal_truncation\"")
      .fallback(fallback)
      .key("shape_file", &Choice::shape_file,
           "with `shape = \"given\"`: a text file of two columns, `position_m` and `deflection`, positions "
           "increasing; relative to this file's folder",
           "\"shape.csv\"")
      .fallback("none");
}

const KeyTable& reduction_keys() {
  static const Schema<Choice> keys = make_reduction_keys(
      "reduction",
      "`\"rayleigh\"`; for the models `beam` and `modal` `\"modal_truncation\"`, one exact mode; with "
      "`[[chain.storeys]]` `\"none\"`");
  return keys;
}

const KeyTable& compared_reduction_keys() {
  static const Schema<Choice> keys = make_reduction_keys("reductions", "`\"rayleigh\"`");
  return keys;
}

const bool reduction_keys_registered[] = {register_keys(reduction_keys),
                                          register_keys(compared_reduction_keys)};

}  // namespace

bool takes_shape(const Choice& choice) {
  return std::any_of(choice.options.values().begin(), choice.options.values().end(),
                     [](const auto& option) { return option.second == OptionValue(std::string("given")); });
}

void read_shape_file(const TomlTable& table, Choice& choice) {
  choice.shape_file = table.find_text("shape_file").value_or("");
  if (table.contains("shape_file") && choice.shape_file.empty())
    table.refuse("shape_file", "the name of a file");
  if (!takes_shape(choice))
    refuse_useless(table, {"shape_file"}, "without shape = \"given\"", "shape = \"given\"");
}

Choice read_reduction(const TomlTable& table) {
  Choice choice =
      read_choice(table, "method", "rayleigh", reduction::reduction_registry(), reduction_keys().names());
  if (choice.place.line == 0) choice.place = table.place();
  read_shape_file(table, choice);
  return choice;
}

Choice parse_reduction(const std::string& text, const std::string& origin) {
  const auto& registry = reduction::reduction_registry();
  return at_place(Place{origin}, [&] {
    ChoiceWords words = split_choice(text);
    Choice choice{words.name, {}, {origin}};
    registry.find(choice.name);
    const auto shape = std::find_if(words.options.begin(), words.options.end(),
                                    [](const auto& word) { return word.first == "shape_file"; });
    if (shape != words.options.end()) {
      choice.shape_file = shape->second;
      words.options.erase(shape);
    }
    const filters::Options options = parse_options(words, registry);
    registry.make(choice.name, options);
    choice.options = registry.completed(choice.name, options);
    if (!choice.shape_file.empty() && !takes_shape(choice))
      throw std::invalid_argument("shape_file has no use with reduction '" + choice.name +
                                  "' as it is; expected shape=given");
    return choice;
  });
}

std::string to_text(const Choice& choice) {
  return choice_text(choice, reduction::reduction_registry().find(choice.name).options);
}

namespace {

using Type = Key::Type;

const Schema<Experiment>& model_keys() {
  static const Schema<Experiment> keys =
      Schema<Experiment>("model")
          .with_options()
          .other("name", Type::text, "a name from `beamid list models`", "\"sdof\"")
          .fallback("`\"sdof\"`; with `[[chain.storeys]]` `\"beam\"`");
  return keys;
}

const Schema<Experiment>& filter_keys() {
  using E = Experiment;
  using filters::OnFailure;
  static const Schema<E> keys =
      Schema<E>("filter")
          .with_options()
          .other("method", Type::text, "a name from `beamid list filters`", "\"ukf\"")
          .fallback("`\"ekf\"`")
          .key("discretisation", &E::discretisation, "a name from `beamid list discretisations`",
               "\"forward_euler\"")
          .choice("on_failure", &E::on_failure,
                  {std::pair{to_string(OnFailure::stop), OnFailure::stop},
                   {to_string(OnFailure::inflate), OnFailure::inflate},
                   {to_string(OnFailure::report), OnFailure::report}},
                  "when the filter fails: end there; go on from the last good estimate with standard "
                  "deviations ten "
                  "times as large, also where innovations diverge; or go on without the sample that it could "
                  "not take. All that happened is listed in `results.json` under `events`",
                  "\"inflate\"")
          .key("smoother", &E::smoother,
               "`beamid identify` also writes the estimates of each instant from the whole record: "
               "Rauch-Tung-Striebel smoother, linearised or unscented",
               "\"rts\"")
          .fallback("none")
          .values("`\"rts\"`, `\"urts\"`")
          .key("estimator", &E::estimator,
               "of `identify`: `\"both\"` puts the batch estimate (output-error maximum likelihood of the "
               "same model) beside it",
               "\"both\"")
          .one_of({"filter", "both"});
  return keys;
}

const Schema<Experiment>& compared_filter_keys() {
  static const Schema<Experiment> keys =
      Schema<Experiment>("filters")
          .with_options()
          .other("method", Type::text, "a name from `beamid list filters`", "\"ukf\"")
          .required("a name from `beamid list filters`");
  return keys;
}

const Schema<Experiment>& compare_keys() {
  using E = Experiment;
  constexpr int most_passes = 20;
  static const Schema<E> keys =
      Schema<E>("compare")
          .key("discretisations", &E::discretisations,
               "names from `beamid list discretisations`, each combined with every filter and reduction",
               "[\"exponential\", \"forward_euler\"]")
          .fallback("that of `[filter]`")
          .key("passes", &E::passes, {1, most_passes},
               "times the record is filtered; each starts from the parameters, and with the noise, of the "
               "one before",
               "2");
  return keys;
}

const bool method_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return model_keys(); }),
    register_keys([]() -> const KeyTable& { return filter_keys(); }),
    register_keys([]() -> const KeyTable& { return compared_filter_keys(); }),
    register_keys([]() -> const KeyTable& { return compare_keys(); })};

void read_filter(const TomlTable& table, Experiment& experiment) {
  filter_keys().read_onto(table, experiment);
  at_place(table.value_place("discretisation"),
           [&] { filters::scheme_registry().find(experiment.discretisation); });
  if (table.contains("smoother"))
    at_place(table.value_place("smoother"), [&] { filters::smoother_registry().find(experiment.smoother); });
}

void read_compared(const TomlTable& root, Experiment& experiment) {
  for (const TomlTable& table : root.find_tables("reductions"))
    experiment.reductions.push_back(read_reduction(table));
  for (const TomlTable& table : root.find_tables("filters")) {
    experiment.filters.push_back(read_choice(table, "method", "ekf", filters::filter_registry()));
    if (!table.contains("method")) table.miss("method", compared_filter_keys().find("method")->missing);
  }
  if (const auto table = root.find_table("compare")) {
    compare_keys().read_onto(*table, experiment);
    for (const std::string& name : experiment.discretisations)
      at_place(table->value_place("discretisations"), [&] { filters::scheme_registry().find(name); });
  }
}

}  // namespace

void read_methods(const TomlTable& root, Experiment& experiment) {
  const auto choose = [&](const char* name, const char* key, Choice& choice, const auto& registry) {
    if (const auto table = root.find_table(name))
      choice = read_choice(*table, key, choice.name, registry, find_key_table(name)->names());
    else
      choice = {choice.name, registry.completed(choice.name, choice.options), root.value_place(name)};
  };
  choose("reduction", "method", experiment.reduction, reduction::reduction_registry());
  experiment.reduction_is_stated = root.contains("reduction");
  if (const auto table = root.find_table("reduction")) read_shape_file(*table, experiment.reduction);
  const bool laws = !experiment.storey_springs.empty();  // of storeys: model beam in its own coordinates
  if (laws) experiment.model.name = "beam";
  choose("model", "name", experiment.model, model_registry());
  require_model_of_storeys(experiment);
  // Static shapes are K and M of one coordinate; of a model of modes they would be an error of its own.
  const std::string& model = experiment.model.name;
  const char* const natural = laws ? "none" : "modal_truncation";
  if (!root.contains("reduction") && (model == "beam" || model == "modal"))
    experiment.reduction = {natural, reduction::reduction_registry().completed(natural, {}),
                            root.value_place("reduction")};
  choose("filter", "method", experiment.filter, filters::filter_registry());
  if (const auto table = root.find_table("filter")) read_filter(*table, experiment);
  read_compared(root, experiment);
}

}  // namespace beamid::experiments
