// beamid list: what can be chosen by name.
#include <iostream>

#include "apps/command.hpp"
#include "apps/method_list.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/record_reader.hpp"
#include "experiments/studies/study.hpp"
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
      {"steps", [] { return methods_of(experiments::step_registry()); }},
      {"studies", [] { return methods_of(experiments::study_registry()); }}};
  return all;
}

void print_all() {
  for (const Kind& kind : kinds()) {
    std::cout << (&kind == &kinds().front() ? "" : "\n") << kind.name << "\n\n";
    print(std::cout, kind.list());
  }
}

int run(const Command& command, const std::vector<std::string>& arguments) {
  options::options_description described("Options");
  described.add_options()("help", "show this help");
  options::variables_map values;
  if (!parse(command, arguments, described, {"kind", "name"}, values)) return 0;
  if (!values.count("kind")) {
    print_all();
    return 0;
  }
  const std::string asked = values["kind"].as<std::string>();
  std::string known;
  for (const Kind& kind : kinds()) {
    known += (known.empty() ? "" : ", ") + kind.name;
    if (kind.name != asked) continue;
    if (values.count("name"))
      print(std::cout, kind.list().find(values["name"].as<std::string>()));
    else
      print(std::cout, kind.list());
    return 0;
  }
  throw UsageError("list: unknown kind '" + asked + "'; known: " + known);
}

}  // namespace

Command list_command() {
  return {"list",
          "[discretisations|filters|modal_methods|models|readers|reductions|responses|smoothers|steps|"
          "studies [NAME]]",
          "what can be chosen by name, and the options of each",
          "  beamid list\n  beamid list filters\n  beamid list filters ukf\n", run};
}

}  // namespace beamid::apps
