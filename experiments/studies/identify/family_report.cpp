#include "experiments/studies/identify/family_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/config/description.hpp"
#include "experiments/identify/joint_words.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Table parameter_table(const BeamFamily& family) {
  Table table{"parameters", "Together"};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"estimate", "estimate"})
      .column({"95 % from", "lower_95"})
      .column({"to", "upper_95"})
      .column({"asked about in", "files"});
  for (std::size_t j = 0; j < family.parameters.size(); ++j) {
    const Estimate& e = family.parameters[j];
    const double half = 0.5 * (e.upper_95 - e.lower_95);
    const auto shown = [&](double value) { return Rounded{value, half}; };
    table.row({e.name, e.unit, shown(e.value), shown(e.lower_95), shown(e.upper_95), family.shared_by[j]});
  }
  return table;
}

Table member_table(const BeamFamily& family) {
  Table table{"beams", "Each beam at these parameters"};
  table.column({"file", "file"})
      .column({"record", "record"})
      .column({"length [m]", "length_m", "{:.6g}"})
      .column({"f1 [Hz]", "frequency_hz", "{:.6g}"})
      .column({"response error [%]", "response_error_percent", "{:.3g}"});
  for (std::size_t r = 0; r < family.members.size(); ++r) {
    const ComparedRun& run = family.alone[r].runs[0];
    table.row({family.members[r].name, family.members[r].record_name,
               family.members[r].experiment.structure.extent(), run.frequency_hz.value_or(std::nan("")),
               run.response_error_percent});
  }
  return table;
}

std::string agreement(const BeamFamily& family) {
  const SharedEstimate& e = family.estimate;
  if (e.freedom == 0.0)
    return "The records determine no more than these parameters: whether they agree cannot be tested.";
  const std::string measured = fmt::format("chi-squared {:.3g}, {:g} degrees of freedom, probability {:.2g}",
                                           e.chi_squared, e.freedom, e.probability);
  if (e.scatter == 1.0)
    return fmt::format("The beams agree on what they share within their noise ({}).", measured);
  return fmt::format(
      "THE BEAMS DISAGREE by more than their noise ({}): a clamp that gives way, a length or a mass that is "
      "not as described, or motion that the models do not have. All intervals are widened by {:.3g} "
      "(Birge's ratio), which is itself known from few records only.",
      measured, e.scatter);
}

Json json_of(const Estimate& e) {
  return {{"unit", e.unit},
          {"estimate", e.value},
          {"standard_deviation", e.deviation},
          {"lower_95", e.lower_95},
          {"upper_95", e.upper_95}};
}

}  // namespace

Results report(const BeamFamily& family) {
  Results results;
  results.command = "identify";
  for (const FamilyMember& member : family.members) {
    Json one = describe(member.experiment);
    one["file"] = member.name;
    one["record"] = member.record_name;
    results.configuration["beams"].push_back(std::move(one));
  }
  results.values["status"] = family.settled ? "converged" : "not_settled";
  results.values["rounds"] = family.rounds;
  for (std::size_t j = 0; j < family.parameters.size(); ++j) {
    Json one = json_of(family.parameters[j]);
    one["files"] = family.shared_by[j];
    results.values["parameters"][family.parameters[j].name] = std::move(one);
  }
  results.values["agreement"] = {{"chi_squared", family.estimate.chi_squared},
                                 {"degrees_of_freedom", family.estimate.freedom},
                                 {"probability", family.estimate.probability},
                                 {"scatter", family.estimate.scatter}};
  for (std::size_t r = 0; r < family.members.size(); ++r) {
    const ComparedRun& run = family.alone[r].runs[0];
    Json one{{"file", family.members[r].name},
             {"record", family.members[r].record_name},
             {"response_error_percent", run.response_error_percent}};
    for (const ComparedParameter& p : run.parameters) one["alone"][p.estimate.name] = json_of(p.estimate);
    results.values["beams"].push_back(std::move(one));
  }
  results.heading(fmt::format("{} beams that share parameters", family.members.size()));
  if (!family.settled)
    results.warning(
        fmt::format("The parameters still moved in the last of {} rounds: these numbers are not to be used. "
                    "Nearer guesses help.",
                    family.rounds),
        true);
  results.paragraph(agreement(family));
  results.table(parameter_table(family));
  results.table(member_table(family));
  return results;
}

}  // namespace beamid::experiments
