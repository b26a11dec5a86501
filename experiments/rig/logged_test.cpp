#include "experiments/rig/logged_test.hpp"

#include <fmt/format.h>

#include "experiments/record/prepare/prepared_record.hpp"

namespace beamid::experiments {
namespace {

void leave_out_before(Record& record, double event) {
  constexpr double rounding = 1e-9;
  const auto before = (record.time.array() < event - rounding).count();
  record.time = record.time.tail(record.time.size() - before).eval();
  record.samples = record.samples.rightCols(record.time.size()).eval();
}

}  // namespace

SimulatedTest logged_test(const Experiment& experiment, const std::filesystem::path& folder,
                          const std::string& name, const Progress& progress) {
  SimulatedTest test = simulate(experiment, folder, 0, progress, experiment.acquisition);
  if (experiment.acquisition.perfect()) return test;
  Record& record = test.record;
  const std::vector<Objection> own = record.objections;
  const std::vector<RecordDefect> defects = mark_defects(record, name);
  if (test.event > 0.0) {
    leave_out_before(record, test.event);
    test.notes.push_back(fmt::format("The {:g} s recorded before the excitation are omitted.", test.event));
  }
  record.objections = objections_of(defects, record);
  record.objections.insert(record.objections.begin(), own.begin(), own.end());
  refuse_mostly_missing(record, defects, name);
  return test;
}

}  // namespace beamid::experiments
