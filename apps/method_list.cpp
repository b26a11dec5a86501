#include "apps/method_list.hpp"

#include <map>
#include <sstream>
#include <stdexcept>

#include "apps/reference.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/results/print.hpp"
#include "experiments/results/table.hpp"
#include "experiments/results/text.hpp"
#include "filters/filter.hpp"
#include "reduction/reduction.hpp"

namespace beamid::apps {
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
      {filter::robust, "outlying readings move its estimate by a few of its deviations at most"},
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

}  // namespace beamid::apps
