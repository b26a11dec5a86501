// beamid completion: what a shell needs to complete commands, options and names.
#include <iostream>
#include <sstream>

#include "apps/command.hpp"

namespace beamid::apps {
namespace {

std::string words_of(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

Words command_names() {
  Words names;
  for (const CommandGroup& group : command_groups())
    for (const Command& command : group.commands)
      if (!group.title.empty()) names.push_back(command.name);
  return names;
}

/// `case` patterns of "COMMAND:OPTION": what may stand behind it; options with any value, files among them,
/// are left to the shell.
std::string bash_script() {
  std::ostringstream options, values, words;
  for (const CommandGroup& group : command_groups())
    for (const Command& command : group.commands) {
      if (group.title.empty()) continue;
      Words names, files;
      for (const Option& option : command.all_options()) {
        names.push_back("--" + option.name);
        std::string pattern = command.name + ":--" + option.name;
        if (option.letter)
          (names.emplace_back("-") += option.letter, pattern += "|" + command.name + ":-" + option.letter);
        if (!option.choices.empty())
          values << "    " << pattern << ") values='" << words_of(option.choices) << "' ;;\n";
        else if (option.values != 0)
          files.push_back(pattern);
      }
      for (const std::string& pattern : files) values << "    " << pattern << ") return ;;\n";
      options << "    " << command.name << ") options='" << words_of(names) << "' ;;\n";
      const bool names_commands = !command.words.empty() && command.words[0].name == "command";
      if (names_commands)
        words << "    " << command.name << ") values=$commands ;;\n";
      else if (!command.words.empty() && !command.words[0].choices.empty())
        words << "    " << command.name << ") values='" << words_of(command.words[0].choices) << "' ;;\n";
    }
  return R"(# bash completion of beamid, written by `beamid completion bash`
_beamid() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
  local commands=')" +
         words_of(command_names()) + R"('
  local options= values=
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "$commands --help --version" -- "$current"))
    return
  fi
  [[ $current == '=' ]] && current=
  [[ $before == '=' ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
  case $command:$before in
)" + values.str() +
         R"(  esac
  if [[ -z $values ]]; then
    case $command in
)" + words.str() +
         R"(    esac
  else
    COMPREPLY=($(compgen -W "$values" -- "$current"))
    return
  fi
  case $command in
)" + options.str() +
         R"(  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  elif [[ -n $values ]]; then
    COMPREPLY=($(compgen -W "$values" -- "$current"))
  fi
}
complete -o default -F _beamid beamid
)";
}

int run_completion(const Values& values) {
  const std::string shell = values.texts("shell")[0];
  if (shell != "bash") throw UsageError("unknown shell '" + shell + "'; known: bash");
  std::cout << bash_script();
  return 0;
}

}  // namespace

Command completion_command() {
  return {"completion",
          "SHELL",
          "completion of commands, options and names for a shell: bash",
          {{.name = "shell", .required = true, .hint = "Expected bash", .choices = {"bash"}}},
          {},
          "  beamid completion bash >> ~/.bash_completion\n  source <(beamid completion bash)\n",
          run_completion};
}

}  // namespace beamid::apps
