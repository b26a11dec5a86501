#include "apps/command_parts.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "experiments/config/experiment.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/results/results.hpp"
#include "experiments/results/table.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"
#include "filters/smoother.hpp"
#include "reduction/reduction.hpp"

namespace beamid::apps {
namespace {

// What stands beside the key in its row, "| `key` | reference |"; empty when it has none.
std::string reference_of(const std::string& key) {
  const std::string text = references_text, start = "\n| `" + key + "` | ";
  const std::size_t row = text.find(start);
  if (row == std::string::npos) return "";
  const std::size_t first = row + start.size(), end = text.find(" |\n", first);
  static const std::regex emphasis(R"re(\*([^*]+)\*)re");
  return std::regex_replace(text.substr(first, end - first), emphasis, "$1");
}

}  // namespace

std::vector<std::string> full_references(const std::string& source) {
  static const std::regex citation(R"re(\[([a-z]+[0-9]{4}[a-z]?)((, [^\]]+)?)\])re");
  std::vector<std::string> found;
  for (std::sregex_iterator cited(source.begin(), source.end(), citation), end; cited != end; ++cited) {
    const std::string reference = reference_of((*cited)[1]);
    if (reference.empty()) return {source};
    found.push_back(reference + (*cited)[2].str());
  }
  if (found.empty() && !source.empty()) found.push_back(source);
  return found;
}

namespace {

using experiments::Page;

std::string to_text(const filters::OptionValue& value) {
  if (const double* number = std::get_if<double>(&value)) {
    std::ostringstream text;
    text << *number;
    return text.str();
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    std::ostringstream text;
    for (std::size_t i = 0; i < numbers->size(); ++i) text << (i ? ", " : "") << (*numbers)[i];
    return numbers->empty() ? "none" : text.str();
  }
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  const auto& text = std::get<std::string>(value);
  return text.empty() ? "none" : text;
}

// A contract in words; one of a user's own as its name says it.
std::string promise(std::string contract) {
  namespace filter = filters::contract;
  namespace reduced = reduction::contract;
  static const std::map<std::string, std::string> words{
      {filter::exact_on_linear_gaussian, "equals the Kalman filter on linear models, to 1e-10"},
      {filter::sampled_on_linear_gaussian,
       "agrees with the Kalman filter on linear models within the error of its own sampling"},
      {filter::consistent, "its covariance is that of its errors"},
      {filter::identifies, "finds stiffness and damping from a record without noise to six digits"},
      {filter::robust, "outlying readings move its estimate by a few of its standard deviations at most"},
      {filter::linear_models_only, "refuses models that are not linear"},
      {experiments::contract::free_decay, "takes the record for a free decay; its modes can be polished"},
      {reduced::static_exact, "exact deflection under a static tip force"},
      {reduced::modes_exact, "its r frequencies are the system's r lowest"},
      {reduced::complete, "no approximation at all"},
      {reduced::rigid_exact, "keeps the rigid-body motions of a free structure, where two points are known"},
      {reduced::grows, "grows by one coordinate at a time, up to the full system"}};
  if (const auto known = words.find(contract); known != words.end()) return known->second;
  for (char& letter : contract)
    if (letter == '_') letter = ' ';
  return contract;
}

void print_wrapped(std::ostream& stream, const std::string& text, const Page& page) {
  for (const std::string& line : experiments::wrapped(text, page.width)) stream << line << "\n";
}

}  // namespace

const Method& MethodList::find(const std::string& name) const {
  std::string known;
  for (const Method& method : methods) {
    if (method.name == name) return method;
    known += (known.empty() ? "" : ", ") + method.name;
  }
  throw std::invalid_argument("unknown " + kind + " '" + name + "'; known: " + known);
}

void print(std::ostream& stream, const MethodList& list, const Page& page) {
  experiments::Table table{list.kind, ""};
  table.column({"name", "name"}).column({"what it is", "summary"}).column({"options", "options"});
  for (const Method& method : list.methods) {
    std::string options;
    for (const auto& option : method.options) {
      const std::string value = to_text(option.fallback);
      options += (options.empty() ? "" : ", ") + option.name + " = " + value;
      if (!option.unit.empty() && value != "none") options += " " + option.unit;
    }
    table.row({method.name, method.summary, options.empty() ? "-" : options});
  }
  experiments::print(stream, table, page);
}

void print(std::ostream& stream, const Method& method, const Page& page) {
  print_wrapped(stream, method.name + ": " + method.summary, page);
  if (!method.source.empty()) print_wrapped(stream, "source: " + method.source, page);
  for (const std::string& reference : full_references(method.source))
    if (reference != method.source) print_wrapped(stream, "- " + reference, page);
  if (!method.contracts.empty()) stream << "\npromises, to which the tests hold it:\n";
  for (const std::string& contract : method.contracts) print_wrapped(stream, "- " + promise(contract), page);
  if (method.options.empty()) {
    stream << "\nno options\n";
    return;
  }
  experiments::Table table{method.name, ""};
  table.column({"option", "option"})
      .column({"default", "default"})
      .column({"unit", "unit"})
      .column({"meaning", "meaning"});
  for (const auto& option : method.options)
    table.row(
        {option.name, to_text(option.fallback), option.unit.empty() ? "-" : option.unit, option.description});
  stream << "\n";
  experiments::print(stream, table, page);
}

namespace {

/// To the first table and what stands above it.
void shorten(experiments::Results& results) {
  const auto is_table = [](const auto& part) { return std::holds_alternative<experiments::Table>(part); };
  const auto first = std::find_if(results.report.begin(), results.report.end(), is_table);
  if (first != results.report.end()) results.report.erase(first + 1, results.report.end());
}

void warn_of_undrawn(const experiments::Results& results, const std::filesystem::path& folder) {
  const auto undrawn =
      std::count_if(results.figures.begin(), results.figures.end(), [&](const experiments::Figure& figure) {
        return !std::filesystem::exists(folder / (figure.name + ".svg"));
      });
  if (undrawn > 0)
    std::cerr << "beamid: warning: " << undrawn << " of " << results.figures.size()
              << " figures are not drawn: gnuplot is missing, failed or did not end ('warnings' of "
                 "results.json states which; the Debian package gnuplot-nox has it). All else is written.\n";
  const auto is_missing = [&](const std::string& file) { return !std::filesystem::exists(folder / file); };
  const auto incomplete = [&](const experiments::Attachment& one) {
    return std::any_of(one.files.begin(), one.files.end(), is_missing);
  };
  if (std::any_of(results.attachments.begin(), results.attachments.end(), incomplete))
    std::cerr
        << "beamid: warning: meshes for ParaView are not written: libbeamid_vtk.so is missing or of another "
           "version (the Debian package beamid-paraview has it). All else is written.\n";
}

// What --config names, for the page: it repeats the run.
std::string experiment_text(const Values& values) {
  if (!values.has("config")) return "";
  const Words files = values.texts("config");
  std::string text;
  for (const std::string& file : files) {
    std::ifstream stream(file, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(stream), {}};
    if (files.size() > 1) text += (text.empty() ? "# " : "\n# ") + file + "\n";
    text += content;
  }
  return text;
}

}  // namespace

int deliver(const Values& values, const std::function<experiments::Results()>& find) {
  std::optional<experiments::ResultDirectory> directory;
  const bool writes = values.has("out"), quiet = values.has("quiet");
  if (writes) directory.emplace(values.text("out"), values.has("force"));

  std::optional<experiments::TerminalOnly> shown;
  if (!writes && !values.receiver() && !values.has("json")) shown.emplace();
  experiments::Results results = find();
  results.command_line = values.command_line();
  results.experiment_file = experiment_text(values);
  if (!quiet && !values.receiver() && !values.has("verbose") && !values.has("no-progress")) clear_progress();
  if (directory) {
    experiments::write(results, *directory);
    warn_of_undrawn(results, directory->path());
    directory->commit();
  }
  const int code = results.has_failed() ? 3 : 0;
  if (values.receiver() != nullptr) {
    values.receiver()->take(std::move(results));
    return code;
  }
  if (values.has("json")) {
    experiments::print_json(std::cout, results);
    return code;
  }
  if (quiet) shorten(results);
  experiments::print(std::cout, results, terminal_page());
  if (quiet) return code;
  const std::string last = writes ? "Written to " + experiments::clean_text(values.text("out"))
                                  : "A page with figures, CSV tables and results.json: add --out DIR";
  std::cout << "\n";
  for (const std::string& line : experiments::wrapped(last, terminal_page().width)) std::cout << line << "\n";
  return code;
}

OptionGroup update_options() {
  return {
      "Options",
      {config_option("experiment file: the structure, [[parameters]], [[sensors]] of the shapes").needed(),
       number("model-error", "PERCENT",
              "standard deviation of a predicted frequency: the error of the model [%]")
           .from(0)
           .up_to(20)
           .by_default("0.5"),
       number("shape-error", "PERCENT", "the same of a component of a shape, relative to the largest [%]")
           .from(0)
           .up_to(100)
           .by_default("3"),
       whole("starts", "N", 1, 100000,
             "searches from so many places; without it 300, fewer of large structures")}};
}

experiments::UpdateSettings update_settings(const Values& values) {
  experiments::UpdateSettings settings;
  settings.trust = {values.number("model-error") / 100.0, values.number("shape-error") / 100.0};
  if (values.has("starts")) settings.starts = values.whole("starts");
  return settings;
}

experiments::UpdateStudy studied_update(const Values& values, const experiments::Experiment& experiment,
                                        const experiments::ModalData& data) {
  for (const experiments::MeasuredMode& mode : data.modes) {
    if (!(mode.deviation_hz > 0.0) && !(values.number("model-error") > 0.0))
      throw UsageError(
          "--model-error is 0, and a mode has no standard deviation of its own; expected one of "
          "the two above zero");
    if (mode.shape.size() > 1 && !(mode.shape_deviation > 0.0) && !(values.number("shape-error") > 0.0))
      throw UsageError(
          "--shape-error is 0, and a shape has no standard deviation of its own; expected one of "
          "the two above zero");
  }
  try {
    return experiments::study_update(experiment, data, update_settings(values), show_progress(values));
  } catch (const std::invalid_argument& error) {
    throw experiments::InputError({values.text("config")}, error.what());
  }
}

namespace {

constexpr const char* with_options = "NAME[:OPTION=VALUE,...]";

}  // namespace

Option filter_option(const std::string& help) {
  return text("filter", with_options, help).such_as(names_in(filters::filter_registry()));
}

Option reduction_option(const std::string& help) {
  return text("reduction", with_options, help).such_as(names_in(reduction::reduction_registry()));
}

Option modal_method_option(const std::string& help) {
  return text("method", with_options, help).such_as(names_in(experiments::modal_method_registry()));
}

Option discretisation_option(const std::string& help) {
  return text("discretisation", "NAME", help).such_as(names_in(filters::scheme_registry()));
}

Option smoother_option(const std::string& help) {
  return text("smoother", "NAME", help).one_of(names_in(filters::smoother_registry()));
}

Option model_option() {
  return text("model", "NAME", "what is to be determined: beamid list models")
      .by_default("beam")
      .such_as(names_in(experiments::model_registry()));
}

Option on_failure_option() {
  return text("on-failure", "WHAT",
              "when the filter fails: stop, inflate its covariance and go on, or report and go on")
      .by_default("stop")
      .one_of({"stop", "inflate", "report"});
}

void choose_model(const Values& values, experiments::Experiment& experiment) {
  experiments::Choice& model = experiment.model;
  if (values.has("model"))
    model = {values.text("model"), {}, {"--model"}};
  else if (model.place.line == 0)
    model.name = "beam";
  experiments::at_place(model.place, [&] {
    model.options = experiments::model_registry().completed(model.name, model.options);
  });
}

void choose_failure_response(const Values& values, experiments::Experiment& experiment) {
  if (values.has("on-failure"))
    experiment.on_failure = experiments::failure_response(values.text("on-failure"));
}

}  // namespace beamid::apps
