#include "apps/command.hpp"

#include <iostream>

namespace beamid::apps {

std::vector<Command> commands() {
  std::vector<Command> all = study_commands();
  all.push_back(inspect_command());
  all.push_back(prepare_command());
  all.push_back(modal_command());
  all.push_back(identify_command());
  all.push_back(check_command());
  all.push_back(track_command());
  all.push_back(stream_command());
  all.push_back(compare_command());
  all.push_back(identifiability_command());
  all.push_back(efficiency_command());
  all.push_back(sweep_command());
  all.push_back(modes_command());
  all.push_back(frame_command());
  all.push_back(simulate_command());
  all.push_back(frf_command());
  all.push_back(reduce_command());
  all.push_back(report_command());
  all.push_back(new_command());
  all.push_back(validate_command());
  all.push_back(list_command());
  return all;
}

options::options_description output_options() {
  options::options_description described("Output");
  described.add_options()  //
      ("out", options::value<std::string>()->value_name("DIR"),
       "write results.json, tables, figures there")    //
      ("force", "replace the results that DIR holds")  //
      ("json", "print results.json instead of text")   //
      ("help", "show this help");
  return described;
}

namespace {

/// A word as a shell takes it.
std::string quoted(const std::string& word) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// What repeats the command. Where its results went is no part of it, nor what changes none of them: how many
/// worked on a sweep, and whether it was interrupted.
std::string command_line(const Command& command, const std::vector<std::string>& arguments) {
  std::string line = "beamid " + command.name;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    const bool sweeps = command.name == "sweep" &&
                        (word == "--threads" || word == "--resume" || word.starts_with("--threads="));
    if (word == "--out" || (sweeps && word == "--threads")) ++i;
    if (sweeps || word == "--out" || word == "--force" || word == "--json" || word.starts_with("--out="))
      continue;
    line += " " + quoted(word);
  }
  return line;
}

}  // namespace

bool parse(const Command& command, const std::vector<std::string>& arguments,
           const options::options_description& described, const std::vector<std::string>& positional,
           options::variables_map& values) {
  options::options_description all;
  all.add(described);
  options::positional_options_description order;
  for (std::string name : positional) {
    const bool several = name.ends_with("...");
    if (several) name.resize(name.size() - 3);
    if (several)
      all.add_options()(name.c_str(), options::value<std::vector<std::string>>());
    else
      all.add_options()(name.c_str(), options::value<std::string>());
    order.add(name.c_str(), several ? -1 : 1);
  }
  constexpr int no_guessing =
      options::command_line_style::unix_style & ~options::command_line_style::allow_guessing;
  try {
    options::store(
        options::command_line_parser(arguments).options(all).positional(order).style(no_guessing).run(),
        values);
  } catch (const options::too_many_positional_options_error&) {
    throw UsageError(command.name + ": too many words; expected: beamid " + command.name + " " +
                     command.arguments);
  } catch (const options::error& error) {
    throw UsageError(command.name + ": " + error.what());
  }
  values.insert({command_line_key, options::variable_value(command_line(command, arguments), false)});
  if (!values.count("help")) return true;
  std::cout << "beamid " << command.name << " " << command.arguments << "\n\n"
            << command.summary << "\n\n"
            << described << "\nExamples\n"
            << command.examples;
  return false;
}

}  // namespace beamid::apps
