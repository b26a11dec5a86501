#include "experiments/record/prepare/prepared_record.hpp"

#include "experiments/record/prepare/known_inputs.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {

Record prepare(Record record, const std::vector<Choice>& steps,
               const std::optional<std::pair<double, double>>& within) {
  for (const Choice& choice : steps)
    at_place(choice.place, [&] {
      try {
        const auto step = step_registry().make(choice.name, choice.options);
        const std::string remark = apply(*step, record, within);
        record.remarks.push_back(remark);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("step '" + choice.name + "': " + error.what());
      }
    });
  return record;
}

void PreparedRecord::take(Record prepared, const RecordFormat& format, const std::filesystem::path& file) {
  record = std::move(prepared);
  if (format.window)
    record = at_place(format.window_place.file.empty() ? Place{file.string()} : format.window_place,
                      [&] { return record.window(format.window->first, format.window->second); });
  std::string stretch =
      at_place(Place{file.string()}, [&] { return take_known_inputs(record, format.missing_input); });
  record.warnings = raw.warnings;
  for (std::string& warning : warnings_of(defects, record)) record.warnings.push_back(std::move(warning));
  if (!stretch.empty()) record.warnings.push_back(std::move(stretch));
  refuse_mostly_missing(record, defects, file);
}

PreparedRecord read_and_prepare(const std::filesystem::path& file, const RecordFormat& format) {
  RecordFormat whole = format;
  whole.window.reset();
  PreparedRecord prepared{read_record(file, whole), {}};
  prepared.defects = mark_defects(prepared.raw, file);
  prepared.take(prepare(prepared.raw, format.preparation, format.window), format, file);
  return prepared;
}

Record prepared_record(const std::filesystem::path& file, const RecordFormat& format) {
  return read_and_prepare(file, format).record;
}

}  // namespace beamid::experiments
