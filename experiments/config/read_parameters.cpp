
#include "experiments/config/readers.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

const Schema<IdentifiabilitySettings>& identifiability_keys() {
  using I = IdentifiabilitySettings;
  constexpr int most_places = 400, most_sensors = 20;
  static const Schema<I> keys =
      Schema<I>("identifiability")
          .key("force_measured", &I::force_measured,
               "whether the record holds the exciting forces; without them it begins when the last has ended",
               "false")
          .key("places", &I::places, {1, most_places},
               "parts of the beam between the places to which a sensor is moved, nodes of the mesh at most",
               "20")
          .key("more_sensors", &I::more_sensors, {0, most_sensors},
               "further sensors, added one by one where they add most information", "2");
  return keys;
}

namespace {
const bool identifiability_keys_registered =
    register_keys([]() -> const KeyTable& { return identifiability_keys(); });
}

namespace {

const Schema<Prior>& prior_keys() {
  using P = Prior;
  static const Schema<P> keys =
      Schema<P>("prior")
          .key("stiffness_n_per_m", &P::stiffness, positive, "mean of the stiffness", "515.8")
          .fallback("worked out")
          .key("stiffness_deviation_n_per_m", &P::stiffness_deviation, positive, "its standard deviation",
               "100")
          .fallback("worked out")
          .key("damping_ratio", &P::damping_ratio, {.least = 0.0, .most = 1.0, .below = true},
               "mean of the damping ratio", "0.01")
          .fallback("worked out")
          .key("damping_ratio_deviation", &P::damping_ratio_deviation, positive, "its standard deviation",
               "0.01")
          .fallback("worked out");
  return keys;
}

struct NoiseValues {
  std::string method = "residual";
  std::optional<double> displacement, velocity, acceleration, strain, force, base, support, angular;
};

const Schema<NoiseValues>& noise_keys() {
  using N = NoiseValues;
  static const Schema<N> keys =
      Schema<N>("noise")
          .key("method", &N::method,
               "where the absent ones come from: the residual of the modal analysis, or of the nearest "
               "motion of the model; the level that makes the filter's innovations likeliest, given with "
               "its standard error; the quiet part of the file before the first hit, refused where there is "
               "none of 32 samples",
               "\"likelihood\"")
          .one_of({"residual", "likelihood", "before_event"})
          .key("displacement_m", &N::displacement, positive, "noise of displacement channels", "1e-6")
          .fallback("estimated")
          .key("velocity_m_per_s", &N::velocity, positive, "noise of velocity channels", "1e-5")
          .fallback("estimated")
          .key("acceleration_m_per_s2", &N::acceleration, positive, "noise of acceleration channels", "0.05")
          .fallback("estimated")
          .key("strain_m_per_m", &N::strain, positive, "noise of strain channels", "1e-7")
          .fallback("estimated")
          .key("force_n", &N::force, positive, "noise of measured forces", "0.5")
          .fallback("forces are exact")
          .key("base_acceleration_m_per_s2", &N::base, positive, "noise of the base's measured acceleration",
               "0.01")
          .fallback("it is exact")
          .key("support_acceleration_m_per_s2", &N::support, positive,
               "noise of the accelerations that are imposed at places", "0.01")
          .fallback("they are exact")
          .key("angular_acceleration_rad_per_s2", &N::angular, positive,
               "noise of channels of angular acceleration", "0.01")
          .fallback("estimated");
  return keys;
}

const bool prior_keys_registered[] = {register_keys([]() -> const KeyTable& { return prior_keys(); }),
                                      register_keys([]() -> const KeyTable& { return noise_keys(); })};

}  // namespace

void read_prior(const TomlTable& root, Experiment& experiment) {
  if (const auto table = root.find_table("prior")) experiment.prior = prior_keys().read(*table);
  const auto table = root.find_table("noise");
  if (!table) return;
  const NoiseValues noise = noise_keys().read(*table);
  const auto take = [&](Quantity quantity, const std::optional<double>& deviation) {
    if (deviation) experiment.noise[quantity] = *deviation;
  };
  take(Quantity::displacement, noise.displacement);
  take(Quantity::velocity, noise.velocity);
  take(Quantity::acceleration, noise.acceleration);
  take(Quantity::strain, noise.strain);
  take(Quantity::force, noise.force);
  take(Quantity::base_acceleration, noise.base);
  take(Quantity::support_acceleration, noise.support);
  take(Quantity::angular_acceleration, noise.angular);
  if (table->contains("method")) experiment.noise_method = {noise.method, {}, table->value_place("method")};
}

namespace {

constexpr int most_parameter_modes = 1000;

/// A parameter as a file describes it.
struct DescribedParameter : ParameterChoice {
  std::optional<double> from, to;
};

std::string with_suffix(const std::string& number, const std::string& suffix) {
  return suffix.empty() ? number : number + "_" + suffix;
}

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  for (const ParameterQuantity& quantity : parameter_quantities()) names.push_back(quantity.name);
  return names;
}

/// A number of the parameter in each unit: `guess` is guess_n_m2, guess_kg, ...
struct ParameterNumber {
  const char* name;
  std::optional<double> ParameterChoice::*member;
  Range range;
  const char *before, *after;  ///< of the quantities that have this unit, in the key's meaning
  const char* fallback;
  double share;  ///< of the example's guess
};

constexpr ParameterNumber parameter_numbers[] = {
    {"guess", &ParameterChoice::guess, any_number, "initial estimate of ", "",
     "as described, or as the model states", 1.0},
    {"deviation", &ParameterChoice::deviation, positive, "standard deviation of ",
     " before the record is seen", "`relative_deviation` of the guess", 0.3},
    {"lower", &ParameterChoice::lower, any_number, "`form = \"bounded\"`: ", " is above it", "none", 0.1},
    {"upper", &ParameterChoice::upper, any_number, "`form = \"bounded\"`: ", " is below it", "none", 10.0}};

/// A guess that a file might hold, for the examples.
double example_guess(const std::string& suffix) {
  static const std::map<std::string, double> guesses{
      {"n_m2", 228.96},     {"kg", 1.437}, {"kg_m2", 0.001},   {"n_m_per_rad", 4000},
      {"n_per_m", 300000},  {"n", 10},     {"", 0.004},        {"per_s", 0.05},
      {"s", 1e-5},          {"hz", 4.1},   {"n_s_per_m", 0.4}, {"n_per_m3", 20000},
      {"n_s2_per_m2", 0.6}, {"per_m", 4},  {"m", 0.02}};
  const auto known = guesses.find(suffix);
  return known == guesses.end() ? 1.0 : known->second;
}

void add_number_keys(Schema<DescribedParameter>& keys, const ParameterNumber& number) {
  for (const ParameterQuantity& quantity : parameter_quantities()) {
    const std::string key = with_suffix(number.name, quantity.suffix);
    if (keys.find(key) != nullptr) continue;
    std::string quantities;
    for (const ParameterQuantity& other : parameter_quantities())
      if (other.suffix == quantity.suffix)
        quantities += (quantities.empty() ? "`" : ", `") + other.name + "`";
    keys.key(key.c_str(), number.member, number.range, (number.before + quantities + number.after).c_str(),
             fmt::format("{:g}", number.share * example_guess(quantity.suffix)).c_str())
        .fallback(number.fallback);
    if (number.member == &ParameterChoice::deviation) keys.excludes({"relative_deviation"}, "one of them");
  }
}

Schema<DescribedParameter> make_parameter_keys() {
  using P = DescribedParameter;
  Schema<P> keys("parameters");
  keys.key("quantity", &P::quantity,
           "model `beam`: `\"bending_stiffness\"`, `\"tip_mass\"` (of `tip_mass_kg`, or of the first body at "
           "the tip: a sensor beside it keeps its own), `\"body_mass\"` (of the bodies between `from_m` and "
           "`to_m`, all of them without), `\"tip_rotary_inertia\"`, `\"root_rotational_stiffness\"`, "
           "`\"root_translational_stiffness\"`, `\"axial_load\"`, of a chain `\"storey_stiffness\"` and "
           "`\"storey_damping\"` (of its dashpots), of a frame or a system `\"factor\"` (of the group of "
           "members or the parameter that `name` names), `\"damping_ratio\"`, `\"mass_damping\"` and "
           "`\"stiffness_damping\"` (alpha and beta of C = alpha M + beta K); `modal`: `\"frequency\"`, "
           "`\"damping_ratio\"`; `sdof`: `\"stiffness\"`, `\"damping\"`, and `\"mass\"` where a force was "
           "measured; the same and, only where named here or no parameter is, `duffing`: "
           "`\"cubic_stiffness\"`; "
           "`damped`: `\"coulomb_friction\"`, `\"quadratic_damping\"` (and `\"cubic_stiffness\"`, only where "
           "named); `bouc_wen`: `\"post_yield_ratio\"` (alpha), `\"hysteresis_beta\"`, "
           "`\"hysteresis_gamma\"`; "
           "of storeys that follow laws, in model `beam`, the laws' (`beamid list springs`): these and "
           "`\"reference_drift\"`",
           "\"bending_stiffness\"")
      .one_of(quantity_names())
      .values("text")
      .required()
      .key("name", &P::name, "what results call it; of a factor, which one", "\"crack\"")
      .values("at most 100 small letters, digits, `_`")
      .fallback("the quantity, with its mode or number")
      .key("from_m", &P::from, on_beam,
           "`bending_stiffness`: begin of the region whose mean it is; `body_mass`: of the region whose "
           "bodies are meant; of a chain, of the storeys meant; with `to_m`",
           "0.3")
      .fallback("`0`")
      .key("to_m", &P::to, {.least = 0.0, .on_beam = true, .greater_than = "from_m"}, "end of the region",
           "0.5")
      .fallback("length")
      .key("mode", &P::mode, {1, most_parameter_modes},
           "`damping_ratio`, `frequency`: the mode it belongs to", "1")
      .fallback("all modes together")
      .choice(
          "form", &P::form,
          {std::pair{to_string(Form::linear), Form::linear},
           {to_string(Form::logarithmic), Form::logarithmic},
           {to_string(Form::bounded), Form::bounded}},
          "how the filter's state holds it: itself, its logarithm (positive always), or between its bounds",
          "\"logarithmic\"")
      .fallback("`\"linear\"`; `\"bounded\"` with bounds")
      .key("known", &P::known,
           "not requested but not known exactly either: its standard deviation is carried along into the "
           "others' intervals",
           "true")
      .key("relative_deviation", &P::relative_deviation, positive,
           "standard deviation beforehand, as a part of the guess", "0.02")
      .fallback("stiffnesses, axial load `0.3`, frequencies `0.15`, masses `0.1`, damping `1`");
  for (const ParameterNumber& number : parameter_numbers) add_number_keys(keys, number);
  return keys;
}

const Schema<DescribedParameter>& parameter_schema() {
  static const Schema<DescribedParameter> keys = make_parameter_keys();
  return keys;
}

const bool parameter_keys_registered = register_keys([]() -> const KeyTable& { return parameter_schema(); });

/// A number in the unit of another quantity.
void refuse_other_units(const TomlTable& table, const ParameterQuantity& quantity) {
  for (const ParameterNumber& number : parameter_numbers) {
    std::vector<std::string> others;
    for (const ParameterQuantity& other : parameter_quantities())
      if (other.suffix != quantity.suffix) others.push_back(with_suffix(number.name, other.suffix));
    refuse_useless(table, others, "for the quantity " + quantity.name,
                   with_suffix(number.name, quantity.suffix));
  }
}

/// A factor is asked for by its name; regions are those of a beam.
void check_structure(const TomlTable& table, const ParameterChoice& choice, const fem::Structure& structure) {
  if (!structure.has_positions())
    refuse_useless(table, {"from_m", "to_m"}, std::string("for a ") + structure.kind(),
                   "quantity = \"factor\" and a name");
  if (choice.quantity != "factor") return;
  const std::vector<std::string> names = fem::factor_names(structure);
  const std::string expected =
      names.empty() ? std::string("groups of a frame's members, or parameters of a system: this ") +
                          structure.kind() + " has none"
                    : "one of " + joined(names);
  if (!table.contains("name")) table.miss("name", expected);
  if (std::find(names.begin(), names.end(), choice.name) == names.end()) table.refuse("name", expected);
}

ParameterChoice read_parameter(const TomlTable& table, const fem::Structure& structure) {
  const double length = structure.extent();
  DescribedParameter choice = parameter_schema().read(table, length);
  refuse_other_units(table, parameter_quantity(choice.quantity));
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (table.contains("name") &&
      (choice.name.empty() || choice.name.size() > 100 ||  // which files are named after
       !std::all_of(choice.name.begin(), choice.name.end(), plain)))
    table.refuse("name", "at most 100 small letters, digits and underscores, as in a key");
  for (const char* const key : {"from_m", "to_m"})
    if (!table.contains(key) && (choice.from || choice.to))
      table.miss(key, parameter_schema().find(key)->expected(length));
  if (choice.from) choice.region = std::pair{*choice.from, *choice.to};
  check_structure(table, choice, structure);
  choice.place = table.place();
  return choice;
}

}  // namespace

std::vector<ParameterChoice> read_parameters(const TomlTable& root, const fem::Structure& structure) {
  std::vector<ParameterChoice> choices;
  for (const TomlTable& table : root.find_tables("parameters"))
    choices.push_back(read_parameter(table, structure));
  return choices;
}

}  // namespace beamid::experiments
