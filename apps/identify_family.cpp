#include "apps/identify_family.hpp"
#include "experiments/config/storey_laws.hpp"

#include <fmt/format.h>

#include <string>

#include "apps/deliver.hpp"
#include "apps/record_options.hpp"
#include "apps/terminal.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/family/beam_family.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/studies/identify/family_report.hpp"

namespace beamid::apps {

namespace fs = std::filesystem;
using namespace experiments;

Results identify_family(const Values& values, const std::vector<fs::path>& configs) {
  for (const char* other : {"damping-law", "smoother", "estimator", "window"})
    if (values.has(other)) throw UsageError(fmt::format("several --config take no --{}", other));
  const Words records = values.texts("record");
  if (!records.empty() && records.size() != configs.size())
    throw UsageError(fmt::format("{} records and {} --config; expected one record for each, in their order",
                                 records.size(), configs.size()));
  std::vector<FamilyMember> members;
  for (std::size_t k = 0; k < configs.size(); ++k) {
    FamilyMember member{
        configs[k].filename().string(), read_experiment(configs[k]), configs[k].parent_path(), {}, {}};
    require_linear_storeys(member.experiment, "a family of beams");
    const fs::path file = require_record_files(values, configs[k], member.experiment.record_file,
                                               member.experiment.format)[records.empty() ? 0 : k];
    member.record_name = file.filename().string();
    member.record = prepared_record(file, member.experiment.format);
    members.push_back(std::move(member));
  }
  const BeamFamily family = experiments::identify_family(std::move(members), show_progress(values));
  Results results = report(family);
  for (const FamilyMember& member : family.members) warn(results, member.experiment);
  return results;
}

}  // namespace beamid::apps
