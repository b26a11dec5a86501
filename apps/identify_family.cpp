#include "apps/identify_family.hpp"

#include <fmt/format.h>

#include <string>

#include "apps/deliver.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/family/beam_family.hpp"
#include "experiments/identify/plausibility.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/studies/identify/family_report.hpp"

namespace beamid::apps {

namespace fs = std::filesystem;
using namespace experiments;

Results identify_family(const options::variables_map& values, const std::vector<fs::path>& configs) {
  for (const char* other : {"damping-law", "smoother", "estimator", "window"})
    if (values.count(other)) throw UsageError(fmt::format("identify: several --config take no --{}", other));
  std::vector<std::string> records;
  if (values.count("record")) records = values["record"].as<std::vector<std::string>>();
  if (!records.empty() && records.size() != configs.size())
    throw UsageError(
        fmt::format("identify: {} records and {} --config; expected one record for each, in their order",
                    records.size(), configs.size()));
  std::vector<FamilyMember> members;
  for (std::size_t k = 0; k < configs.size(); ++k) {
    FamilyMember member{
        configs[k].filename().string(), read_experiment(configs[k]), configs[k].parent_path(), {}, {}};
    if (records.empty() && !member.experiment.record_file)
      throw UsageError("identify: no RECORD on the command line, and no 'file' under [record] in " +
                       configs[k].string());
    const fs::path file =
        records.empty() ? member.folder / *member.experiment.record_file : fs::path(records[k]);
    member.record_name = file.filename().string();
    member.record = prepared_record(file, member.experiment.format);
    members.push_back(std::move(member));
  }
  const BeamFamily family = experiments::identify_family(std::move(members), show_progress());
  Results results = report(family);
  for (const FamilyMember& member : family.members) warn(results, member.experiment);
  return results;
}

}  // namespace beamid::apps
