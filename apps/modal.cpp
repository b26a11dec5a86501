// beamid modal: modes from vibration records, without a beam.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"
#include "experiments/modal/study/driven_study.hpp"
#include "experiments/modal/study/hammer_study.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/studies/modal/report.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::apps {
namespace {

using namespace experiments;

OptionGroup modal_options() {
  return {
      "Options",
      {modal_method_option(
           "era for free decays, ssi_cov for random vibration, bayoma for one mode of it, frf_lscf for "
           "hammer hits with a measured force, output_error for a moving base or a shaker; at the peaks of "
           "the spectrum: damped_sine, hilbert_envelope, logarithmic_decrement, half_power, frf_half_power "
           "(beamid list modal_methods); without it the record decides between the first two, frf_lscf and "
           "output_error"),
       band_option("frequencies to look at [Hz]; else all where the spectrum shows something"),
       whole("order", "N", 4, 80, "largest model order").by_default("30"),
       whole("modes", "N", 1, 1000, "the N strongest modes only"),
       flag("amplitude", "frequency and damping ratio of every mode against its amplitude along the decay"),
       flag("events",
            "of earthquakes: f1 and damping of every record's response to its base, over its peak "
            "acceleration; needs base_acceleration (the borehole) and acceleration (the surface)"),
       flag("polish",
            "refine a free decay's modes by least squares, all together (without the option for era only)"),
       flag("no-polish", "take them as the method finds them")}};
}

ModalStudySettings modal_settings_of(const Values& values) {
  ModalStudySettings settings;
  if (values.has("method"))
    settings.method = parse_choice(values.text("method"), "--method", modal_method_registry());
  settings.band_hz = values.from_to("band");
  settings.largest_order = values.whole("order");
  if (values.has("modes")) settings.modes = values.whole("modes");
  if (values.has("polish") && values.has("no-polish"))
    throw UsageError("--polish and --no-polish exclude each other");
  if (values.has("polish")) settings.polish = true;
  if (values.has("no-polish")) settings.polish = false;
  return settings;
}

void check_same_channels(const std::vector<Record>& records, const std::vector<RecordRequest>& requests) {
  for (std::size_t r = 1; r < records.size(); ++r) {
    bool same = records[r].channels.size() == records[0].channels.size();
    for (std::size_t i = 0; same && i < records[0].channels.size(); ++i)
      same = records[r].channels[i].quantity == records[0].channels[i].quantity;
    if (!same)
      throw InputError(
          {requests[r].file.string()},
          fmt::format("{} channels of other number or quantity than the {} of {}; expected the same, "
                      "in the same order, to merge the records",
                      records[r].channels.size(), records[0].channels.size(), requests[0].file.string()));
  }
}

/// Modes of the frequency responses of all hits together.
Results hammer_results(const std::vector<std::string>& names, const std::vector<Record>& records,
                       const ModalStudySettings& settings) {
  const HammerStudy study = study_hits(names, records, settings);
  Results results = report(settings, study);
  std::vector<std::complex<double>> rates;
  for (const HammerMode& mode : study.modes) rates.push_back(mode.pole.rate);
  add_masses(names, records, std::vector(records.size(), rates), results, true);
  return results;
}

std::vector<RecordModes> modes_without_input(const std::vector<RecordRequest>& requests,
                                             const std::vector<std::string>& names,
                                             const std::vector<Record>& records,
                                             const ModalStudySettings& settings) {
  std::vector<RecordModes> found;
  for (std::size_t r = 0; r < records.size(); ++r) {
    try {
      found.push_back(find_modes(names[r], records[r], requests[r].format.window.has_value(), settings));
    } catch (const std::invalid_argument& error) {
      throw InputError({requests[r].file.string()}, error.what());
    }
  }
  return found;
}

/// Modes of each record from its measured inputs.
/// @param decaying set to the modes of the records as free decays, where the record decides and has any
/// @returns absent where the record decides, and a free decay explains it better
std::optional<Results> driven_results(const std::vector<RecordRequest>& requests,
                                      const std::vector<std::string>& names,
                                      const std::vector<Record>& records, const ModalStudySettings& settings,
                                      bool decides, std::vector<RecordModes>& decaying) {
  std::vector<DrivenStudy> found;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (decides) {
      DrivenOrDecaying one =
          driven_or_decaying(names[r], records[r], requests[r].format.window.has_value(), settings);
      if (one.decaying) decaying.push_back(*std::move(one.decaying));
      if (one.driven) found.push_back(*std::move(one.driven));
      continue;
    }
    try {
      found.push_back(study_driven(names[r], records[r], settings));
    } catch (const std::invalid_argument& error) {
      throw InputError({requests[r].file.string()}, error.what());
    }
  }
  if (found.size() < records.size()) {
    if (decaying.size() < records.size()) decaying.clear();  // computed anew
    return {};
  }
  return report(settings, found);
}

/// Modes of each record, and those of all.
/// @param found of the settings' method, where it was asked already; else empty
/// @param decides whether records that do not decay are taken for random vibration
Results decay_results(const std::vector<RecordRequest>& requests, const std::vector<std::string>& names,
                      const std::vector<Record>& records, ModalStudySettings settings, bool amplitude,
                      bool decides, std::vector<RecordModes> found) {
  if (found.empty()) found = modes_without_input(requests, names, records, settings);
  if (decides && std::ranges::none_of(found, &RecordModes::decays)) {
    ModalStudySettings random = settings;
    random.method = {"ssi_cov", {}};
    std::vector<RecordModes> shaken;
    try {
      shaken = modes_without_input(requests, names, records, random);
    } catch (const InputError&) {  // too short for it
    }
    const auto answers = [](const RecordModes& one) {  // modes, or what the motion is instead
      return one.steady && (!one.modes.empty() || one.is_steady_sine());
    };
    if (!shaken.empty() && std::ranges::all_of(shaken, answers)) {
      found = std::move(shaken);
      settings = random;
      for (RecordModes& one : found)
        one.remarks.emplace_back(
            "The record does not decay: method ssi_cov takes it as random vibration (--method overrides).");
    }
  }
  Results results = report(settings, found);
  std::vector<std::vector<std::complex<double>>> rates;
  for (const RecordModes& one : found) {
    rates.emplace_back();
    for (const ModeEstimate& mode : one.modes) rates.back().push_back(mode.pole.rate);
  }
  if (found[0].free_decay) add_masses(names, records, rates, results);
  try {
    if (amplitude) add_amplitude(found, merge_modes(found), results);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return results;
}

int run_modal(const Values& values) {
  ModalStudySettings settings = modal_settings_of(values);
  const std::vector<RecordRequest> requests = record_requests(values);
  const auto has_contract = [&](const char* contract) {
    return modal_method_registry().find(settings.method.name).contracts.contains(contract);
  };
  if (values.has("amplitude") &&
      (has_contract(contract::frequency_response) || has_contract(contract::measured_input)))
    throw UsageError("--amplitude follows a free decay; take --method era for it");
  const bool decides =
      !values.has("method") && !values.has("amplitude") && !values.has("polish") && !values.has("events");
  if (values.has("events"))
    for (const char* const other : {"amplitude", "modes", "polish", "no-polish"})
      if (values.has(other)) throw UsageError(std::string("--events takes no --") + other);
  return deliver(values, [&] {
    std::vector<PreparedRecord> prepared;
    std::vector<Record> records;
    std::vector<std::string> names;
    for (const RecordRequest& request : requests) {
      prepared.push_back(read_and_prepare(request.file, request.format));
      Record& record = prepared.back().record;
      if (!record.own_clock.empty())
        record.objections.emplace_back(
            "own_clock",
            "Channels with a clock of their own (own_clock) are taken as stamped: frequencies and damping do "
            "not depend on a lag, shapes do.");
      records.push_back(made_analysable(prepared.back().record));
      if (request.format.preparation.empty())  // a report then takes its sentences alone: samples once
        for (Record* one : {&prepared.back().raw, &record})
          one->time.resize(0), one->samples.resize(one->samples.rows(), 0);
      names.push_back(request.file.filename().string());
    }
    if (!values.has("events")) check_same_channels(records, requests);
    if (decides && std::ranges::all_of(records, is_struck))
      settings.method = {"frf_lscf", {}};
    else if (decides && std::ranges::all_of(records, is_driven))
      settings.method = {"output_error", {}};
    Results results;
    try {
      std::optional<Results> driven;
      std::vector<RecordModes> decaying;
      if (has_contract(contract::measured_input)) {
        driven = driven_results(requests, names, records, settings, decides, decaying);
        if (!driven) settings.method = ModalStudySettings().method;
      }
      results = driven                 ? *driven
                : values.has("events") ? event_report(names, records, settings.band_hz)
                : has_contract(contract::frequency_response)
                    ? hammer_results(names, records, settings)
                    : decay_results(requests, names, records, settings, values.has("amplitude"), decides,
                                    std::move(decaying));
    } catch (const std::invalid_argument& error) {
      throw InputError({requests[0].file.string()}, error.what());
    }
    for (std::size_t r = 0; r < records.size(); ++r)
      add_cost(results, names[r], prepared[r], requests[r].format);
    return results;
  });
}

}  // namespace

Command modal_command() {
  return {"modal",
          "RECORD... [--window FROM TO] [--band FROM TO] [--method NAME] [--out DIR]",
          "frequencies, damping ratios and shapes of all modes in vibration records",
          {record_argument(true)},
          {modal_options(), record_options(), output_options()},
          "  beamid modal tip_acceleration.csv\n"
          "  beamid modal run1.csv run2.csv --window 0.5 4 --band 2 60 --out results\n"
          "  beamid modal export.txt --column 3 --quantity acceleration --unit g --rate 1651.6129\n"
          "  beamid modal wind.csv --order 40 --out results\n"
          "  beamid modal tip_acceleration.csv --amplitude --out results\n"
          "  beamid modal --config cantilever.toml --method half_power --out results\n"
          "  beamid modal event1.NS1 event2.NS1 event3.NS1 --events --out column\n"
          "  beamid modal hits.csv more_hits.csv --band 5 200 --out results\n"
          "  beamid modal shaken_frame.csv --out results\n",
          run_modal,
          "",
          "3  no mode, no decay, or motion that the modes do not explain; one mode that may be two. Of "
          "--events: a sign, the order or the clocks of base and response are not as described; the first "
          "lines state which. Of frf_lscf and frf_half_power: hits of so few samples that no mass stands.\n"};
}

}  // namespace beamid::apps
