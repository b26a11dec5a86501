#include "experiments/studies/efficiency/laboratory_records.hpp"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/engine/identification_request.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/record/record.hpp"
#include "experiments/studies/identify/report.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {
namespace {

namespace fs = std::filesystem;

/// A folder that is removed in the end.
class Folder {
 public:
  explicit Folder(int number)
      : path_(fs::temp_directory_path() / fmt::format("beamid_records_{}_{}", getpid(), number)) {
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

constexpr const char* record_name = "record.csv";

/// What a report says before its first table, but for the line that describes the record.
std::string first_lines(const Results& results) {
  const std::string description = std::string(record_name) + ": ";
  std::string text;
  for (const auto& part : results.report) {
    if (std::holds_alternative<Table>(part)) break;
    const auto* paragraph = std::get_if<Paragraph>(&part);
    if (!paragraph || paragraph->text.starts_with(description)) continue;
    text += (text.empty() ? "" : " ") + paragraph->text;
  }
  return text;
}

FoundValue found_value(const Results& results, const char* key) {
  const auto& value = results.values.at(key);
  const double estimate = value.at("estimate"), upper = value.at("upper_95");
  return {estimate, upper - estimate};
}

bool names_the_cause(const std::string& said, const LaboratoryTest& test) {
  std::string lower = said;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const LaboratoryKind kind : test.kinds)
    for (const std::string& word : cause_words(kind))
      if (lower.find(word) != std::string::npos) return true;
  return false;
}

LaboratoryOutcome outcome_of(const IdentifiedTest& one) {
  if (one.identified && right_frequency(one.frequency, one.test.frequency_hz) &&
      right_damping(one.ratio, one.least_damping, one.greatest_damping))
    return LaboratoryOutcome::right;
  if (one.said.empty()) return LaboratoryOutcome::wrong;
  return names_the_cause(one.said, one.test) ? LaboratoryOutcome::refused : LaboratoryOutcome::unexplained;
}

}  // namespace

const char* to_string(LaboratoryOutcome outcome) {
  switch (outcome) {
    case LaboratoryOutcome::right:
      return "right";
    case LaboratoryOutcome::refused:
      return "refused";
    case LaboratoryOutcome::unexplained:
      return "unexplained";
    default:
      return "wrong";
  }
}

bool right_frequency(const FoundValue& found, double truth) {
  constexpr double near = 0.005, deviations = 1.5, widest = 0.05;
  const double error = std::abs(found.estimate - truth);
  return error <= near * truth ||
         (found.half_width <= widest * truth && error <= deviations * found.half_width);
}

bool right_damping(const FoundValue& found, double least, double greatest) {
  constexpr double near = 0.15, deviations = 1.5;
  const double outside = std::max({0.0, least - found.estimate, found.estimate - greatest}),
               bound = found.estimate < least ? least : greatest;
  return outside <= near * bound ||
         (found.half_width <= found.estimate && outside <= deviations * found.half_width);
}

LaboratoryIdentification identify_laboratory_test(const LaboratoryTest& test) {
  LaboratoryIdentification result;
  result.found.test = test;
  result.record = simulate(test);
  const Folder folder(test.number);
  write_record(result.record.record, folder / record_name);
  IdentifiedTest& one = result.found;
  try {
    IdentificationRequest request{
        folder / record_name, read_experiment(TomlTable::parse(test.beam, "beam.toml")), {}, {}};
    request.prepared = read_and_prepare(request.file, request.experiment.format);
    cut_decay(request);
    keep_out_higher_modes(request);
    const Record& used = request.prepared.record;
    const RecordIdentification found = identify_record(request.experiment, used);
    result.results = report(request.experiment, used, record_name, found);
    if (!request.window.empty()) result.results.paragraph(request.window);
    one.said = first_lines(result.results);
    one.from = used.time[0], one.to = used.time[used.size() - 1];
    std::tie(one.least_damping, one.greatest_damping) =
        damping_between(test, result.record, one.from, one.to);
    one.identified = !found.identification.run.failure.has_value();
    if (one.identified) {
      one.frequency = found_value(result.results, "frequency_hz");
      one.ratio = found_value(result.results, "damping_ratio");
    }
  } catch (const std::exception& error) {
    one.said = error.what();
    if (const std::size_t at = one.said.find(record_name); at != std::string::npos) one.said.erase(0, at);
  }
  one.outcome = outcome_of(one);
  return result;
}

LaboratoryRecords laboratory_records(const LaboratorySettings& settings, const Progress& progress) {
  if (settings.records < 1)
    throw std::invalid_argument(fmt::format("records: {} of them; expected at least one", settings.records));
  LaboratoryRecords all{settings, {}};
  all.tests.resize(static_cast<std::size_t>(settings.records));
  Countdown countdown(progress, all.tests.size(), "records");
  countdown.begin("laboratory records");
  tbb::parallel_for(0, settings.records, [&](int number) {
    all.tests[static_cast<std::size_t>(number)] =
        identify_laboratory_test(laboratory_test(settings.seed, number)).found;
    countdown.count();
  });
  return all;
}

}  // namespace beamid::experiments
