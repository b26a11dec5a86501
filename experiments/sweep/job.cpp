#include "experiments/sweep/job.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace beamid::experiments {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string job_text(const SweepSource& source, const Json& manifest) {
  const auto place = [](const fs::path& file) { return fs::absolute(file).string(); };
  Json job{{"manifest", manifest}, {"config", place(source.config.file)}};
  if (source.truth) job["truth"] = place(source.truth->file);
  if (source.record) job["record"] = place(*source.record);
  return job.dump(-1, ' ', false, Json::error_handler_t::replace);
}

SweepJob read_job(const std::string& text) {
  const Json given = Json::parse(text), &manifest = given.at("manifest");
  SweepJob job;
  job.source.config = {given.at("config").get<std::string>(), manifest.at("experiment").get<std::string>()};
  if (given.contains("truth"))
    job.source.truth = {given.at("truth").get<std::string>(), manifest.at("truth").get<std::string>()};
  if (given.contains("record")) job.source.record = given.at("record").get<std::string>();
  job.plan = plan_of(manifest, "manifest.json");
  const std::string here = manifest_of(job.source, job.plan, {})["hash"], there = manifest.at("hash");
  if (here != there)
    throw std::runtime_error(
        fmt::format("the sweep has the hash {} here; expected {}, with the same version of beamid and the "
                    "same contents of the files that the experiment names",
                    here, there));
  return job;
}

}  // namespace beamid::experiments
