#include "experiments/preparation/prepared_record.hpp"

#include "experiments/input/method_choice.hpp"
#include "experiments/input/read_record.hpp"
#include "experiments/preparation/preparation_step.hpp"

namespace beamid::experiments {

Record prepare(Record record, const std::vector<Choice>& steps) {
  for (const Choice& choice : steps)
    at_place(choice.place, [&] {
      try {
        const std::string remark = step_registry().make(choice.name, choice.options)->apply(record);
        record.remarks.push_back(remark);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("step '" + choice.name + "': " + error.what());
      }
    });
  return record;
}

Record cut(Record record, const RecordFormat& format, const std::filesystem::path& file) {
  if (!format.window) return record;
  return at_place(format.window_place.file.empty() ? Place{file.string()} : format.window_place,
                  [&] { return record.window(format.window->first, format.window->second); });
}

PreparedRecord read_and_prepare(const std::filesystem::path& file, const RecordFormat& format) {
  RecordFormat whole = format;
  whole.window.reset();
  PreparedRecord prepared{read_record(file, whole), {}};
  prepared.record = cut(prepare(prepared.raw, format.preparation), format, file);
  return prepared;
}

Record prepared_record(const std::filesystem::path& file, const RecordFormat& format) {
  if (format.preparation.empty()) return read_record(file, format);
  return read_and_prepare(file, format).record;
}

}  // namespace beamid::experiments
