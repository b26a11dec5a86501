#include "experiments/studies/continuum/acquisition_text.hpp"

#include <fmt/format.h>

#include <vector>

namespace beamid::experiments {
namespace {

std::string sentence(const std::string& subject, const std::vector<std::string>& parts) {
  if (parts.empty()) return "";
  std::string text = subject + ": ";
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? ", " : "") + parts[i];
  return text + ". ";
}

std::vector<std::string> parts_of(const Acquisition& a) {
  std::vector<std::string> parts;
  if (a.pretrigger > 0) parts.push_back(fmt::format("{:g} s before the excitation", a.pretrigger));
  if (a.jitter > 0) parts.push_back(fmt::format("intervals with a jitter of {:g} %", 100 * a.jitter));
  if (a.median_shortfall > 0)
    parts.push_back(fmt::format("their median {:g} % below their mean", 100 * a.median_shortfall));
  if (a.gaps > 0)
    parts.push_back(
        fmt::format("{} gap{} of {:g} to {:g} s", a.gaps, a.gaps == 1 ? "" : "s", a.gap.first, a.gap.second));
  if (a.repeated > 0) parts.push_back(fmt::format("{:g} % of the samples repeated", 100 * a.repeated));
  if (!a.force) parts.emplace_back("the force not measured");
  return parts;
}

std::vector<std::string> parts_of(const SensorDefects& s) {
  if (s.dead) return {"dead"};
  std::vector<std::string> parts;
  if (s.clipping > 0) parts.push_back(fmt::format("clipped at {:g}", s.clipping));
  if (s.resolution > 0) parts.push_back(fmt::format("in steps of {:g}", s.resolution));
  if (s.offset != 0) parts.push_back(fmt::format("offset {:g}", s.offset));
  if (s.drift != 0) parts.push_back(fmt::format("drifting by {:g}", s.drift));
  if (s.startup != 0)
    parts.push_back(fmt::format("start-up of {:g} fading in {:g} s", s.startup, s.startup_time));
  if (s.rattle > 0) parts.push_back(fmt::format("rattle of {:g} above {:g}", s.rattle, s.rattle_above));
  return parts;
}

}  // namespace

std::string acquisition_text(const SimulatedTest& test) {
  std::string text = sentence("Logger", parts_of(test.acquisition));
  for (std::size_t i = 0; i < test.sensors.size(); ++i)
    text += sentence("Sensor " + test.sensors[i].name + ", in shares of its largest true reading",
                     parts_of(test.acquisition.of(i)));
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace beamid::experiments
