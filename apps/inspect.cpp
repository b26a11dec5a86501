// beamid inspect: what is in a record's file, and what is wrong with it?
#include "experiments/record/inspect/inspection.hpp"
#include "experiments/studies/inspect/inspection_report.hpp"

#include <filesystem>
#include <iostream>

#include "experiments/results/result_directory.hpp"

#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"

namespace beamid::apps {
namespace {

OptionGroup inspect_options() {
  return {
      "Options",
      {text("write", "FILE.toml",
            "write an experiment file with all that was recognised or stated here; other commands then need "
            "only --config FILE.toml")
           .unrecorded()}};
}

void write_description(const RecordRequest& request, const std::filesystem::path& file) {
  using experiments::InputError;
  if (std::filesystem::exists(file))
    throw InputError({file.string()}, "exists; expected the name of a new file");
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw InputError({file.string()}, "no folder '" + folder.string() + "'");
  experiments::write_file(file, experiments::described_record(request.file, request.format, folder));
  std::cerr << "Written: " << file.string() << "\nNext: beamid modal --config " << file.string() << "\n";
}

int run_inspect(const Values& values) {
  const RecordRequest request = record_requests(values).front();
  if (values.has("write")) write_description(request, values.text("write"));
  return deliver(values,
                 [&] { return experiments::report(experiments::inspect(request.file, request.format)); });
}

}  // namespace

Command inspect_command() {
  return {
      "inspect",
      "RECORD [OPTIONS] [--write FILE.toml]",
      "what is in a record's file: channels, sampling, noise, clipping, drop-outs, events",
      {record_argument()},
      {inspect_options(), record_options(), output_options()},
      "  beamid inspect hammer_test.txt\n"
      "  beamid inspect impulse.lvm --rate 1651.6129 --out results\n"
      "  beamid inspect massa1.txt --time 1 --column 3 --quantity acceleration --unit g --window 0.2 1.2\n"
      "  beamid inspect phone.csv --write phone.toml\n"
      "  logger | beamid inspect -\n",
      run_inspect};
}

}  // namespace beamid::apps
