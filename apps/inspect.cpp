// beamid inspect: what is in a record's file, and what is wrong with it?
#include "experiments/record/inspect/inspection.hpp"
#include "experiments/studies/inspect/inspection_report.hpp"

#include "apps/command_parts.hpp"
#include "apps/record_options.hpp"

namespace beamid::apps {
namespace {

int run_inspect(const Values& values) {
  const RecordRequest request = record_requests(values).front();
  return deliver(values,
                 [&] { return experiments::report(experiments::inspect(request.file, request.format)); });
}

}  // namespace

Command inspect_command() {
  return {
      "inspect",
      "RECORD [OPTIONS]",
      "what is in a record's file: channels, sampling, noise, clipping, drop-outs, events",
      {record_argument()},
      {record_options(), output_options()},
      "  beamid inspect hammer_test.txt\n"
      "  beamid inspect impulse.lvm --rate 1651.6129 --out results\n"
      "  beamid inspect massa1.txt --time 1 --column 3 --quantity acceleration --unit g --window 0.2 1.2\n"
      "  logger | beamid inspect -\n",
      run_inspect};
}

}  // namespace beamid::apps
