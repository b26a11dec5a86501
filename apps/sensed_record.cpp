#include "apps/sensed_record.hpp"

#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/studies/sensing/report.hpp"

namespace beamid::apps {

using namespace experiments;

Results sensed_record(const Experiment& experiment, const PreparedRecord& prepared,
                      const std::filesystem::path& file, const std::filesystem::path& config,
                      const Progress& progress, const std::optional<Choice>& filter) {
  constexpr Eigen::Index fewest = 100;  // of innovations, for their test
  if (prepared.record.size() < fewest)
    throw InputError({file.string()}, std::to_string(prepared.record.size()) +
                                          " samples; expected at least " + std::to_string(fewest));
  const SensingRecord record = sensing_record(experiment, prepared.record, {config.string()});
  const Choice reduction = sensing_reduction(experiment, record.record.interval());
  Results results = sensing_report(
      experiment, study_sensing(experiment, record, reduction, config.parent_path(), progress, filter),
      file.filename().string());
  add_preparation(results, prepared, experiment.format);
  return results;
}

}  // namespace beamid::apps
