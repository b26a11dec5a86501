// beamid list: what can be chosen by name.
#include <algorithm>
#include <iostream>

#include "apps/command.hpp"
#include "apps/key_list.hpp"
#include "apps/method_list.hpp"
#include "apps/terminal.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/springs/spring_law.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/record_reader.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/text/spelling.hpp"
#include "fem/response/response.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"
#include "filters/smoother.hpp"
#include "reduction/reduction.hpp"

namespace beamid::apps {
namespace {

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
  names.insert(std::lower_bound(names.begin(), names.end(), "keys"), "keys");
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
      "what can be chosen by name, and the options of each; the keys of an experiment file",
      {{.name = "kind", .choices = kind_names()}, {.name = "name"}},
      {},
      "  beamid list\n  beamid list filters\n  beamid list filters ukf\n  beamid list keys beam.springs\n",
      run_list,
      "KIND is one of " + experiments::joined(kind_names()) + "."};
}

}  // namespace beamid::apps
