#include "experiments/config/read_frequency_response.hpp"

#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_place.hpp"
#include "experiments/config/useless_keys.hpp"

namespace beamid::experiments {
namespace {

const Schema<FrequencyResponseSettings>& frequency_response_keys() {
  using F = FrequencyResponseSettings;
  using Kind = F::Kind;
  constexpr int most_points = 1000000, most_modes = 1000;
  static const Schema<F> keys =
      Schema<F>("frequency_response")
          .key("from_hz", &F::from_hz, not_negative, "first frequency", "1")
          .values("number > 0 (0 with linear spacing)")
          .fallback("a fifth of the first natural frequency")
          .key("to_hz", &F::to_hz, {.least = 0.0, .above = true, .greater_than = "from_hz"}, "last frequency",
               "200")
          .fallback("1.2 times the third")
          .key("points", &F::points, {2, most_points}, "how many", "1000")
          .choice("spacing", &F::logarithmic, {std::pair{"linear", false}, {"logarithmic", true}},
                  "between them", "\"linear\"")
          .choice("kind", &F::kind,
                  {std::pair{to_string(Kind::receptance), Kind::receptance},
                   {to_string(Kind::mobility), Kind::mobility},
                   {to_string(Kind::accelerance), Kind::accelerance}},
                  "displacement, velocity or acceleration per force", "\"accelerance\"")
          .key(
              "method", [](F& f) -> std::string& { return f.method.name; },
              "solved at every frequency, or a sum over modes", "\"modal\"")
          .one_of({"direct", "modal"})
          .fallback("direct; modal for ratios and for Caughey with more than two anchors")
          .key(
              "modes", [](F& f) -> Eigen::Index& { return f.method.modes; }, {1, most_modes},
              "modal: how many", "20")
          .fallback("all, at most 200")
          .key(
              "residual_modes", [](F& f) -> bool& { return f.method.residual_modes; },
              "modal: the static deflection of the modes left out is added", "false")
          .fallback("`true`")
          .tables({"pairs"});
  return keys;
}

const Schema<PointPair>& pair_keys() {
  static const Schema<PointPair> keys =
      Schema<PointPair>("frequency_response.pairs")
          .key("input_m", &PointPair::input, on_beam, "where the force acts", "1.1")
          .fallback("the tip, or midspan where the tip is held")
          .key("output_m", &PointPair::output, on_beam, "where motion is observed", "0.55")
          .fallback("likewise")
          .key("input_at", &PointPair::input_place, "in place of `input_m`, of a frame or a system",
               "\"ridge.x\"")
          .key("output_at", &PointPair::output_place, "likewise", "\"eaves.y\"");
  return keys;
}

const bool frequency_response_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return frequency_response_keys(); }),
    register_keys([]() -> const KeyTable& { return pair_keys(); })};

}  // namespace

FrequencyResponseSettings read_frequency_response(const TomlTable& table, const fem::Structure& structure) {
  FrequencyResponseSettings settings = frequency_response_keys().read(table);
  if (settings.logarithmic) table.find_number("from_hz", Sign::positive);
  for (const TomlTable& pair : table.find_tables("pairs")) {
    settings.pairs.push_back(pair_keys().read(pair, structure.extent()));
    settings.pairs.back().input_place = read_place(pair, structure, true, "input_at", "input_m");
    settings.pairs.back().output_place = read_place(pair, structure, true, "output_at", "output_m");
  }
  if (settings.method.name == "direct")
    refuse_useless(table, {"modes", "residual_modes"}, "with method = \"direct\"", "method = \"modal\"");
  return settings;
}

}  // namespace beamid::experiments
