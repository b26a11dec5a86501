// The beam of `modes`, `simulate` and `frf`: an experiment file, the options for its common numbers, or both.
#pragma once

#include <filesystem>
#include <functional>

#include "apps/command.hpp"
#include "apps/values.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::apps {

/// --config, --length, --width, ... Each option takes the place of one quantity of the file, however the file
/// gives it; the rest of the file stays. Without a file they change the study's steel beam.
OptionGroup beam_options();

/// An option that sets one key of the experiment file, in the place of those that give the same quantity.
struct KeyOption {
  Option option;
  const char* table;
  const char* key;
};

/// Those options alone, with `more`.
OptionGroup key_options(const std::vector<KeyOption>& keys, std::vector<Option> more = {});

/// --surface, of commands that write meshes.
Option surface_option();
/// --duration and --sampling-rate: the keys of [simulation].
std::vector<KeyOption> record_length_keys();

struct BeamSource {
  experiments::Experiment experiment;
  std::filesystem::path config;  ///< empty without --config
};

/// @param more options of the command's own.
/// @throws UsageError, and InputError with the option in the place of the file.
BeamSource read_beam(const Values& values, const std::vector<KeyOption>& more = {});

/// Runs `find`; its results begin with what is implausible about the beam. What a library finds wrong with
/// the experiment becomes an InputError of its file, if there is one.
experiments::Results blame_config(const BeamSource& source,
                                  const std::function<experiments::Results()>& find);

}  // namespace beamid::apps
