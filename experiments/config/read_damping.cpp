#include "experiments/config/read_damping.hpp"

#include <fmt/format.h>

#include "experiments/config/useless_keys.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {
namespace {

constexpr const char* anchors_expected = "an array of tables { frequency_hz, ratio }";

std::vector<fem::DampingAnchor> read_anchors(const TomlTable& table) {
  std::vector<fem::DampingAnchor> anchors;
  for (const TomlTable& anchor : table.find_tables("anchors")) {
    const auto frequency = anchor.find_number("frequency_hz", Sign::positive);
    anchors.push_back({frequency.value_or(0.0), anchor.number("ratio", Sign::not_negative)});
    if (!frequency) anchor.miss("frequency_hz", "a positive number");
  }
  return anchors;
}

fem::DampingLaw modal(const TomlTable& table, const std::optional<double>& ratio,
                      const std::optional<std::vector<double>>& ratios) {
  refuse_all_but(table, {"law", "ratio", "ratios"}, "with law = \"modal\"");
  if (ratio && ratios) refuse_useless(table, {"ratio"}, "beside ratios", "one or the other");
  if (!ratio && !ratios)
    table.miss("ratio", "the damping ratio of every mode, or ratios = [first, second, ...]");
  return fem::ModalDamping{ratios ? *ratios : std::vector{*ratio}};
}

}  // namespace

fem::DampingLaw read_damping(const TomlTable& table) {
  const std::vector<std::string> laws{"none", "modal", "rayleigh", "caughey", "structural"};
  const auto given = table.find_text("law", laws);
  const auto ratio = table.find_number("ratio", Sign::not_negative);
  const auto ratios = table.find_numbers("ratios", Sign::not_negative);
  const auto loss_factor = table.find_number("loss_factor", Sign::not_negative);
  const std::vector<fem::DampingAnchor> anchors = read_anchors(table);
  const std::string law = given.value_or(ratio || ratios ? "modal" : "none");

  fem::DampingLaw damping;
  if (law == "none") {
    refuse_all_but(table, {"law"}, "with law = \"none\"");
  } else if (law == "modal") {
    damping = modal(table, ratio, ratios);
  } else if (law == "structural") {
    refuse_all_but(table, {"law", "loss_factor"}, "with law = \"structural\"");
    if (!loss_factor) table.miss("loss_factor", "zero or a positive number");
    damping = fem::StructuralDamping{*loss_factor};
  } else {
    refuse_all_but(table, {"law", "anchors"}, "with law = \"" + law + "\"");
    if (anchors.empty()) table.miss("anchors", anchors_expected);
    if (law == "rayleigh" && anchors.size() != 2)
      table.refuse("anchors", "two of them, { frequency_hz, ratio }; more are for law = \"caughey\"");
    if (law == "rayleigh")
      damping = fem::RayleighDamping{anchors[0], anchors[1]};
    else
      damping = fem::CaugheyDamping{anchors};
  }
  const std::string place = table.contains("anchors") ? "anchors" : "law";
  at_place(table.value_place(place),
           [&] { fem::damping_ratios(damping, {}); });  // what is impossible whatever the modes
  return damping;
}

}  // namespace beamid::experiments
