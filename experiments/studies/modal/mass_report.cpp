#include "experiments/studies/modal/mass_report.hpp"

#include <fmt/format.h>

#include <utility>

#include "experiments/modal/study/hammer_mass.hpp"

namespace beamid::experiments {

void add_masses(const std::vector<std::string>& names, const std::vector<Record>& records,
                const std::vector<std::vector<std::complex<double>>>& rates, Results& results,
                bool coarse_reported) {
  Table table{"hammer_mass", "Mass from the hammer's impulse and the velocity step of the mode"};
  table.column({"record", "record"})
      .column({"mode", "mode", "{:.0f}"})
      .column({"f [Hz]", "frequency_hz", "{:.4g}"})
      .column({"impulse [N s]", "impulse_n_s", "{:.4g}"})
      .column({"velocity step [m/s]", "velocity_step_m_per_s", "{:.4g}"})
      .column({"mass [kg]", "mass_kg", "{:.4g}"})
      .column({"standard deviation", "mass_standard_deviation_kg", "{:.2g}"})
      .column({"remark", "remark"});
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  std::string rebounds, coarse, missing;
  std::size_t told = 0;  // record whose rebound is
  for (std::size_t r = 0; r < records.size(); ++r)
    for (std::size_t m = 0; m < rates[r].size(); ++m) {
      std::string reason;
      Pole pole{rates[r][m], {}};
      const auto found = hammer_mass(records[r], pole, rates[r], reason);
      if (!found) {
        missing += fmt::format(" Mode {} of {}: {}.", m + 1, names[r], reason);
        continue;
      }
      const bool rebounded = found->pulses_s.size() > 1;
      table.row({names[r], static_cast<double>(m + 1), pole.frequency_hz(), found->impulse,
                 found->velocity_step, found->mass, found->deviation,
                 std::string(rebounded                ? "hammer rebounded"
                             : !found->coarse.empty() ? "hit coarse"
                                                      : "")});
      json.push_back({{"record", names[r]},
                      {"mode", m + 1},
                      {"impulse_n_s", found->impulse},
                      {"velocity_step_m_per_s", found->velocity_step},
                      {"mass_kg", found->mass},
                      {"mass_standard_deviation_kg", found->deviation},
                      {"pulses_s", found->pulses_s}});
      if (coarse.empty() && !coarse_reported && !found->coarse.empty())
        coarse = names[r] + ": " + found->coarse;
      if (rebounded && std::exchange(told, r + 1) != r + 1)
        rebounds += fmt::format(
            "{}: the hammer rebounded, {} pulses within {:.3g} ms. All of them are in the impulse, but what "
            "it touches in between is no free beam: its masses are not to be trusted. ",
            names[r], found->pulses_s.size(), 1000 * (found->pulses_s.back() - found->pulses_s.front()));
    }
  if (table.rows() == 0) return;
  table.note =
      "The first motion counts, taken to be where the hammer hits. The deviation is that of the amplitude "
      "taken back to the hit and of the hit's sampling; calibration is not in it.";
  results.values["hammer_mass"] = std::move(json);
  results.table(std::move(table));
  if (!rebounds.empty()) results.paragraph(rebounds);
  if (!coarse.empty()) results.warning(coarse);
  if (!missing.empty()) results.paragraph("Without a mass:" + missing);
}

}  // namespace beamid::experiments
