#include "experiments/config/read_experiment.hpp"

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_acquisition.hpp"
#include "experiments/config/read_beam.hpp"
#include "experiments/config/read_chain.hpp"
#include "experiments/config/read_damping.hpp"
#include "experiments/config/read_frame.hpp"
#include "experiments/config/read_frequency_response.hpp"
#include "experiments/config/read_identifiability.hpp"
#include "experiments/config/read_methods.hpp"
#include "experiments/config/read_parameters.hpp"
#include "experiments/config/read_parts.hpp"
#include "experiments/config/read_prior.hpp"
#include "experiments/config/read_record_format.hpp"
#include "experiments/config/read_sensing.hpp"
#include "experiments/config/read_simulation.hpp"
#include "experiments/config/read_space_frame.hpp"
#include "experiments/config/read_system.hpp"

namespace beamid::experiments {
namespace {

const Schema<Experiment>& root_keys() {
  constexpr auto table = Key::Type::table, tables = Key::Type::tables;
  static const Schema<Experiment> keys =
      Schema<Experiment>("")
          .key("title", &Experiment::title, "printed on top of results and plots", "\"steel cantilever\"")
          .tables({"beam", "chain", "system", "damping", "excitation"}, table)
          .tables({"excitations", "sensors"}, tables)
          .tables({"acquisition", "simulation", "frequency_response", "record", "reduction"}, table)
          .tables({"reductions"}, tables)
          .tables({"model"}, table)
          .tables({"parameters", "substructures", "unknown_forces", "virtual_sensors"}, tables)
          .tables({"filter"}, table)
          .tables({"filters"}, tables)
          .tables(
              {"fatigue", "compare", "identifiability", "prior", "noise", "frame", "space_frame", "sweep"},
              table);
  return keys;
}

const bool root_keys_registered = register_keys([]() -> const KeyTable& { return root_keys(); });

/// The one structure that the file describes.
void read_structure(const TomlTable& root, Experiment& experiment) {
  const char* found = nullptr;
  for (const char* const kind : {"beam", "chain", "frame", "space_frame", "system"})
    if (root.contains(kind)) {
      if (found)
        throw InputError(root.key_place(kind),
                         fmt::format("{} beside {}; expected one structure", kind, found));
      found = kind;
    }
  if (const auto frame = root.find_table("frame")) {
    const FrameExperiment described = read_frame(*frame);
    experiment.structure = described.frame;
    experiment.elements = described.elements_per_member;
  } else if (const auto space = root.find_table("space_frame")) {
    const SpaceFrameExperiment described = read_space_frame(*space);
    experiment.structure = described.frame;
    experiment.elements = described.elements_per_member;
  } else if (const auto system = root.find_table("system")) {
    experiment.structure = read_system(*system);
    experiment.elements = 1;
  } else if (const auto chain = root.find_table("chain")) {
    experiment.structure = read_chain(*chain);
    experiment.elements = static_cast<int>(experiment.structure.beam().segments.size());
    experiment.storey_springs = read_storey_springs(*chain, experiment.structure.beam());
    check_places_on_chain(root, experiment.structure.beam());
  } else {
    const TomlTable beam = root.table("beam");
    experiment.structure = read_beam(beam);
    experiment.elements = read_elements(beam);
  }
}

/// What is done with the structure itself.
void read_continuum(const TomlTable& root, Experiment& experiment) {
  const fem::Structure& structure = experiment.structure;
  if (const auto damping = root.find_table("damping")) experiment.damping = read_damping(*damping);
  if (const auto excitation = root.find_table("excitation"))
    experiment.excitation = read_excitation(*excitation, structure);
  if (const auto several = read_simultaneous_excitations(root, structure); !several.empty()) {
    experiment.excitation = several.front();
    experiment.further_excitations.assign(several.begin() + 1, several.end());
  }
  experiment.sensors = read_sensors(root, structure);
  experiment.acquisition = read_acquisition(root);
  experiment.parameters = read_parameters(root, structure);
  experiment.parts = read_parts(root, structure);
  experiment.unknown_forces = read_unknown_forces(root, structure);
  experiment.virtual_sensors = read_virtual_sensors(root, structure);
  experiment.fatigue = read_fatigue(root);
  if (const auto simulation = root.find_table("simulation"))
    experiment.simulation = read_simulation(*simulation);
  if (const auto response = root.find_table("frequency_response"))
    experiment.frequency_response = read_frequency_response(*response, structure);
}

}  // namespace

Experiment read_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return read_experiment(TomlTable::read(file, overrides));
}

Experiment read_experiment(const TomlTable& root) {
  refuse_unknown_keys(root);
  check_values(root);
  Experiment experiment = root_keys().read(root);
  experiment.file = root;
  read_structure(root, experiment);
  experiment.format.irregular = true;  // as [record] has it unless it says otherwise
  if (const auto record = root.find_table("record")) {
    const RecordSection section = read_record_section(*record, &experiment.structure);
    experiment.record_file = section.file;
    experiment.format = section.format;
  }
  read_continuum(root, experiment);
  read_methods(root, experiment);
  if (const auto table = root.find_table("identifiability"))
    experiment.identifiability = identifiability_keys().read(*table);
  read_prior(root, experiment);
  check_tables_of_others(root);
  return experiment;
}

}  // namespace beamid::experiments
