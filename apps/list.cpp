// beamid list: what can be chosen by name.
#include <iostream>

#include "apps/command.hpp"
#include "experiments/joint_model.hpp"
#include "experiments/output/table.hpp"
#include "experiments/study.hpp"
#include "fem/response/response.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"
#include "reduction/reduction.hpp"

namespace beamid::apps {
namespace {

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
  return std::get<std::string>(value);
}

experiments::Table option_table(const std::string& name) {
  experiments::Table table{name, ""};
  table.column({"option", "option"})
      .column({"default", "default"})
      .column({"unit", "unit"})
      .column({"meaning", "meaning"});
  return table;
}

template <class Registry>
void show(const Registry& registry) {
  experiments::Table table{registry.kind(), ""};
  table.column({"name", "name"}).column({"what it is", "summary"}).column({"source", "source"});
  for (const auto& [name, entry] : registry.entries()) table.row({name, entry.summary, entry.source});
  experiments::print(std::cout, table);
}

template <class Registry>
void show(const Registry& registry, const std::string& name) {
  const auto& entry = registry.find(name);
  std::cout << name << ": " << entry.summary << "\n";
  if (!entry.source.empty()) std::cout << "source: " << entry.source << "\n";
  if (entry.options.empty()) {
    std::cout << "no options\n";
    return;
  }
  experiments::Table table = option_table(name);
  for (const auto& option : entry.options)
    table.row(
        {option.name, to_text(option.fallback), option.unit.empty() ? "-" : option.unit, option.description});
  std::cout << "\n";
  experiments::print(std::cout, table);
}

template <class Registry>
void list(const Registry& registry, const options::variables_map& values) {
  if (values.count("name"))
    show(registry, values["name"].as<std::string>());
  else
    show(registry);
}

void show_option(experiments::Table& table, const fem::ResponseOption& option) {
  table.row(
      {option.name, to_text(option.fallback), option.unit.empty() ? "-" : option.unit, option.description});
}

// Methods of integration have no registry of the filters' kind.
void list_responses(const options::variables_map& values) {
  const auto methods = fem::response_methods();
  if (!values.count("name")) {
    experiments::Table table{"responses", ""};
    table.column({"name", "name"}).column({"what it is", "summary"}).column({"source", "source"});
    for (const auto& method : methods) table.row({method.name, method.summary, method.source});
    experiments::print(std::cout, table);
    return;
  }
  const std::string name = values["name"].as<std::string>();
  std::string known;
  for (const auto& method : methods) {
    known += (known.empty() ? "" : ", ") + method.name;
    if (method.name != name) continue;
    std::cout << name << ": " << method.summary << "\nsource: " << method.source << "\n";
    if (method.options.empty()) {
      std::cout << "no options\n";
      return;
    }
    experiments::Table table = option_table(name);
    for (const auto& option : method.options) show_option(table, option);
    std::cout << "\n";
    experiments::print(std::cout, table);
    return;
  }
  throw std::invalid_argument("unknown response method '" + name + "'; known: " + known);
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()("help", "show this help");
  options::variables_map values;
  if (!parse(command, arguments, described, {"kind", "name"}, values)) return 0;
  const std::string kind = values.count("kind") ? values["kind"].as<std::string>() : "";
  if (kind == "filters")
    list(filters::filter_registry(), values);
  else if (kind == "reductions")
    list(reduction::reduction_registry(), values);
  else if (kind == "discretisations")
    list(filters::scheme_registry(), values);
  else if (kind == "models")
    list(experiments::model_registry(), values);
  else if (kind == "studies")
    list(experiments::study_registry(), values);
  else if (kind == "responses")
    list_responses(values);
  else
    throw UsageError(kind.empty()
                         ? "list: what? filters, reductions, discretisations, models, studies or responses"
                         : "list: unknown kind '" + kind +
                               "'; known: discretisations, filters, models, reductions, responses, studies");
  return 0;
}

}  // namespace

Command list_command() {
  return {"list", "filters|reductions|discretisations|models|studies|responses [NAME]",
          "what can be chosen by name, and the options of each",
          "  beamid list filters\n  beamid list filters ukf\n  beamid list discretisations\n", run};
}

}  // namespace beamid::apps
