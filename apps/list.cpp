// beamid list: what can be chosen by name.
#include <algorithm>
#include <iostream>
#include <ostream>
#include <stdexcept>
#include <string>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "apps/values.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/springs/spring_law.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/results/results.hpp"
#include "experiments/results/table.hpp"
#include "experiments/results/text.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/text/objection.hpp"
#include "experiments/text/spelling.hpp"
#include "fem/response/response.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"
#include "filters/smoother.hpp"
#include "reduction/reduction.hpp"

namespace beamid::apps {
namespace {

// The keys of an experiment file, told to a reader.

/// Key, what it may be, unit, default and meaning of every key of a table.
/// @throws std::invalid_argument "unknown table 'beem' of an experiment file; did you mean 'beam'?"
void print_keys(std::ostream& stream, const std::string& table, const experiments::Page& page);

using experiments::Key;
using experiments::KeyTable;

/// Markdown marks words of a file by backticks; a terminal needs none.
std::string plain(std::string text) {
  std::erase(text, '`');
  return text;
}

std::string or_dash(const std::string& text) {
  return text.empty() ? "-" : text;
}

/// The tables of a file and how many keys each has.
void print_tables(std::ostream& stream, const experiments::Page& page) {
  experiments::Table table{"keys", ""};
  table.column({"table", "table"}).column({"keys", "keys"});
  for (const KeyTable* one : experiments::key_tables()) {
    std::vector<std::string> names;
    for (const Key& key : one->keys())
      if (!key.is_table()) names.push_back(key.name);
    constexpr std::size_t most = 30;  // [[parameters]] has a key for every unit
    const std::size_t more = names.size() > most ? names.size() - most : 0;
    names.resize(names.size() - more);
    table.row({experiments::heading_of(*one), experiments::joined(names) +
                                                  (more ? ", and " + std::to_string(more) + " more" : "") +
                                                  (one->has_options() ? ", options of the method" : "")});
  }
  experiments::print(stream, table, page);
}

void print_keys(std::ostream& stream, const std::string& name, const experiments::Page& page) {
  const KeyTable* const keys = experiments::find_key_table(name);
  if (keys == nullptr) {
    std::vector<std::string> known;
    for (const KeyTable* one : experiments::key_tables())
      if (!one->name().empty()) known.push_back(one->name());
    throw std::invalid_argument("unknown table '" + name + "' of an experiment file; " +
                                experiments::known_names(name, known));
  }
  experiments::Table table{"keys", ""};
  table.column({"key", "key"})
      .column({"value", "value"})
      .column({"unit", "unit"})
      .column({"default", "default"})
      .column({"meaning", "meaning"});
  for (const Key& key : keys->keys())
    if (!key.is_table())
      table.row({key.name, plain(experiments::values_text(key)), or_dash(experiments::unit_in_key(key.name)),
                 plain(key.fallback), plain(key.meaning)});
  stream << experiments::heading_of(*keys) << "\n\n";
  experiments::print(stream, table, page);
}

void print_objections() {
  experiments::Table table{"objections", ""};
  table.column({"name", "name"})
      .column({"of", "of"})
      .column({"statistic", "statistic and limit"})
      .column({"meaning", "meaning"});
  for (const experiments::ObjectionKind& kind : experiments::objection_kinds())
    table.row({kind.name, kind.of, kind.statistic, kind.meaning});
  experiments::print(std::cout, table, terminal_page());
}

template <class Registry>
MethodList methods_of(const Registry& registry) {
  MethodList list{registry.kind(), {}};
  for (const auto& [name, entry] : registry.entries())
    list.methods.push_back({name, entry.summary, entry.source, entry.options, entry.contracts});
  return list;
}

// Methods of integration have no registry of the filters' kind.
MethodList responses() {
  MethodList list{"response method", {}};
  for (const auto& known : fem::response_methods()) {
    Method method{known.name, known.summary, known.source, {}, {}};
    for (const auto& option : known.options)
      method.options.push_back({option.name, option.fallback, option.unit, option.description});
    list.methods.push_back(std::move(method));
  }
  return list;
}

struct Kind {
  std::string name;
  MethodList (*list)();
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"discretisations", [] { return methods_of(filters::scheme_registry()); }},
      {"filters", [] { return methods_of(filters::filter_registry()); }},
      {"modal_methods", [] { return methods_of(experiments::modal_method_registry()); }},
      {"models", [] { return methods_of(experiments::model_registry()); }},
      {"readers", [] { return methods_of(experiments::record_reader_registry()); }},
      {"reductions", [] { return methods_of(reduction::reduction_registry()); }},
      {"responses", responses},
      {"smoothers", [] { return methods_of(filters::smoother_registry()); }},
      {"springs", [] { return methods_of(experiments::spring_law_registry()); }},
      {"steps", [] { return methods_of(experiments::step_registry()); }},
      {"studies", [] { return methods_of(experiments::study_registry()); }}};
  return all;
}

Words kind_names() {
  Words names;
  for (const Kind& kind : kinds()) names.push_back(kind.name);
  for (const char* other : {"keys", "objections"})
    names.insert(std::lower_bound(names.begin(), names.end(), other), other);
  return names;
}

void print_all() {
  for (const Kind& kind : kinds()) {
    std::cout << (&kind == &kinds().front() ? "" : "\n") << kind.name << "\n\n";
    print(std::cout, kind.list(), terminal_page());
  }
}

int run_list(const Values& values) {
  if (!values.has("kind")) {
    print_all();
    return 0;
  }
  const std::string asked = values.texts("kind")[0];
  if (asked == "keys") {
    if (values.has("name"))
      print_keys(std::cout, values.texts("name")[0], terminal_page());
    else
      print_tables(std::cout, terminal_page());
    return 0;
  }
  if (asked == "objections") {
    print_objections();
    return 0;
  }
  for (const Kind& kind : kinds()) {
    if (kind.name != asked) continue;
    if (values.has("name"))
      print(std::cout, kind.list().find(values.texts("name")[0]), terminal_page());
    else
      print(std::cout, kind.list(), terminal_page());
    return 0;
  }
  throw UsageError("unknown kind '" + asked + "'; known: " + experiments::joined(kind_names()));
}

}  // namespace

Command list_command() {
  return {
      "list",
      "[KIND [NAME]]",
      "what can be chosen by name, and the options of each; the keys of an experiment file; the objections "
      "that a verdict may hold",
      {{.name = "kind", .choices = kind_names()}, {.name = "name"}},
      {},
      "  beamid list\n  beamid list filters\n  beamid list filters ukf\n  beamid list keys beam.springs\n",
      run_list,
      "KIND is one of " + experiments::joined(kind_names()) + "."};
}

}  // namespace beamid::apps
