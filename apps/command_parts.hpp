// What several commands share: lists of methods, delivery of results, options that choose a method.
#pragma once

#include <functional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "apps/command.hpp"
#include "apps/values.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/identify/update/update_study.hpp"
#include "experiments/results/results.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/progress.hpp"
#include "filters/registry.hpp"

namespace beamid::apps {

// Methods of one kind, told to a reader.

// Sources in full words.

/// docs/references.md.
extern const char* const references_text;

/// "[julier2004], [hairer1996, ch. IV.3]" as "S. J. Julier, ...: Unscented filtering ..." and
/// "... Springer, Berlin 1996, ch. IV.3": each key as docs/references.md spells it out, without its emphasis.
/// A source that names no key known there, as a user's own, is kept as it is.
std::vector<std::string> full_references(const std::string& source);

/// What every registry knows of a method.
struct Method {
  std::string name;
  std::string summary;  ///< one line
  std::string source;   ///< keys in docs/references.md, or words
  std::vector<filters::OptionSpec> options;
  std::set<std::string> contracts;
};

/// All methods of a kind: what each is, and its options with their defaults.
struct MethodList {
  std::string kind;  ///< in messages: "filter"
  std::vector<Method> methods;

  /// @throws std::invalid_argument "unknown filter 'ufk'; known: ekf, ukf".
  const Method& find(const std::string& name) const;
};

/// A line or two for each method.
void print(std::ostream& stream, const MethodList& list, const experiments::Page& page);

/// All about one: what it is, its sources in full words, its options with defaults, units and meaning, and
/// the promises that the conformance tests hold it to.
void print(std::ostream& stream, const Method& method, const experiments::Page& page);

// What every command does with what it found.

// What surrounds a command in place of a terminal: a program that calls it, such as the Python module.

class Receiver {
 public:
  virtual ~Receiver() = default;

  /// What the command found, in place of printing it.
  virtual void take(experiments::Results results) = 0;

  /// Called, from any thread, whenever a command would show what it is doing; what it throws ends the
  /// command.
  virtual void progress(const std::string& what) = 0;
};

/// Checks --out before any work is done, runs `find`, prints its results (text, or results.json with --json)
/// and writes them to --out. Where a program receives them, nothing is printed.
/// @returns the exit code: 3 where a message of the report is a failure, so that there is nothing to rely on,
/// which is no error of the command's; else 0
int deliver(const Values& values, const std::function<experiments::Results()>& find);

// What `update` and `twins` have in common.

/// --config, --model-error, --shape-error, --starts.
OptionGroup update_options();
experiments::UpdateSettings update_settings(const Values& values);

/// Errors of the library become those of the experiment file.
experiments::UpdateStudy studied_update(const Values& values, const experiments::Experiment& experiment,
                                        const experiments::ModalData& data);

/// NAME[:OPTION=VALUE,...]
Option filter_option(const std::string& help);
Option reduction_option(const std::string& help);
Option modal_method_option(const std::string& help);
/// NAME
Option discretisation_option(const std::string& help);
Option smoother_option(const std::string& help);
/// --model, of the commands that ask about the beam itself without it.
Option model_option();
/// --on-failure
Option on_failure_option();

/// What --model says replaces what the file says; where neither does, it is model `beam`. Its options are
/// completed.
/// @throws InputError at "--model" or the file's place.
void choose_model(const Values& values, experiments::Experiment& experiment);

/// What --on-failure says replaces what the file says.
void choose_failure_response(const Values& values, experiments::Experiment& experiment);

}  // namespace beamid::apps
