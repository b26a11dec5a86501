#include "experiments/config/read_damping.hpp"

#include "experiments/config/key_tables.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {
namespace {

struct DampingValues {
  std::optional<std::string> law;
  std::optional<double> ratio, loss_factor;
  std::optional<std::vector<double>> ratios;
};

const Schema<DampingValues>& damping_keys() {
  using D = DampingValues;
  static const Schema<D> keys =
      Schema<D>("damping")
          .selected_by("law")
          .key("law", &D::law,
               "ratios as such; through two anchors; through any number of them; hysteretic: eta in `frf`, "
               "eta/2 of viscous damping per mode in `simulate`",
               "\"rayleigh\"")
          .one_of({"none", "modal", "rayleigh", "caughey", "structural"})
          .fallback("`\"none\"`; `\"modal\"` where ratios are given")
          .key("ratio", &D::ratio, not_negative, "modal: of every mode", "0.002")
          .with({"modal"})
          .replaces({"law", "ratios", "anchors", "loss_factor"})
          .key("ratios", &D::ratios, not_negative, "modal: of mode 1, 2, ...; the last one of all above",
               "[0.002, 0.005]")
          .with({"modal"})
          .excludes({"ratio"})
          .replaces({"law", "anchors", "loss_factor"})
          .key("loss_factor", &D::loss_factor, not_negative, "structural: eta of K (1 + i eta)", "0.01")
          .needed_with({"structural"})
          .replaces({"ratio", "ratios", "anchors"})
          .other("anchors", Key::Type::tables)
          .required("an array of tables { frequency_hz, ratio }")
          .needed_with({"rayleigh", "caughey"});
  return keys;
}

const Schema<fem::DampingAnchor>& anchor_keys() {
  static const Schema<fem::DampingAnchor> keys =
      Schema<fem::DampingAnchor>("damping.anchors")
          .key("frequency_hz", &fem::DampingAnchor::frequency_hz, positive, "frequency", "3.5")
          .required()
          .key("ratio", &fem::DampingAnchor::ratio, not_negative, "damping ratio there", "0.002")
          .required();
  return keys;
}

const bool damping_keys_registered[] = {register_keys([]() -> const KeyTable& { return damping_keys(); }),
                                        register_keys([]() -> const KeyTable& { return anchor_keys(); })};

fem::DampingLaw law_of(const TomlTable& table, const DampingValues& given, const std::string& law) {
  if (law == "none") return {};
  if (law == "structural") return fem::StructuralDamping{*given.loss_factor};
  if (law == "modal") {
    if (!given.ratio && !given.ratios)
      table.miss("ratio", "the damping ratio of every mode, or ratios = [first, second, ...]");
    return fem::ModalDamping{given.ratios ? *given.ratios : std::vector{*given.ratio}};
  }
  std::vector<fem::DampingAnchor> anchors;
  for (const TomlTable& anchor : table.find_tables("anchors")) anchors.push_back(anchor_keys().read(anchor));
  if (law == "caughey") return fem::CaugheyDamping{anchors};
  if (anchors.size() != 2)
    table.refuse("anchors", "two of them, { frequency_hz, ratio }; more are for law = \"caughey\"");
  return fem::RayleighDamping{anchors[0], anchors[1]};
}

}  // namespace

fem::DampingLaw read_damping(const TomlTable& table) {
  const DampingValues given = damping_keys().read(table);
  const std::string law = given.law.value_or(given.ratio || given.ratios ? "modal" : "none");
  damping_keys().check_use(table, law);
  const fem::DampingLaw damping = law_of(table, given, law);
  at_place(table.value_place(table.contains("anchors") ? "anchors" : "law"),
           [&] { fem::damping_ratios(damping, {}); });  // what is impossible whatever the modes
  return damping;
}

}  // namespace beamid::experiments
