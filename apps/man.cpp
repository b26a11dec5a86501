// beamid man: manual pages, written from what the commands say of themselves. It is no part of the help: the
// build runs it.
#include <filesystem>
#include <iostream>
#include <sstream>

#include "apps/command.hpp"
#include "experiments/results/result_directory.hpp"

namespace beamid::apps {
namespace {

/// Text for troff: backslashes and dashes escaped, and no line that begins like a request.
std::string troff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if ((result.empty() || result.back() == '\n') && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result;
}

void begin(std::ostream& page, const std::string& name, const std::string& summary) {
  page << ".TH " << troff(upper_case(name)) << " 1 \"\" \"beamid " BEAMID_VERSION "\" \"beamid\"\n.SH NAME\n"
       << troff(name) << " \\- " << troff(summary) << "\n";
}

void add_item(std::ostream& page, const std::string& term, const std::string& text) {
  page << ".TP\n" << term << "\n" << troff(text) << "\n";
}

void add_option(std::ostream& page, const Option& option) {
  std::string term = option.letter ? std::string("\\fB\\-") + option.letter + "\\fR, " : "";
  term += R"(\fB\-\-)" + troff(option.name) + "\\fR";
  if (!option.value.empty()) term += " \\fI" + troff(option.value) + "\\fR";
  add_item(page, term, described(option));
}

std::string page_of(const Command& command) {
  std::ostringstream page;
  begin(page, "beamid-" + command.name, command.summary);
  page << ".SH SYNOPSIS\n.B beamid " << troff(command.name) << "\n" << troff(command.arguments) << "\n";
  if (!command.notes.empty()) page << ".SH DESCRIPTION\n" << troff(command.notes) << "\n";
  page << ".SH OPTIONS\n";
  for (const OptionGroup& group : command.options) {
    page << ".SS " << troff(group.title.substr(0, group.title.find(" ("))) << "\n";
    if (const std::size_t remark = group.title.find(" ("); remark != std::string::npos)
      page << troff(group.title.substr(remark + 1)) << "\n";
    for (const Option& option : group.options) add_option(page, option);
  }
  page << ".SS Of every command\n";
  for (const Option& option : common_options()) add_option(page, option);
  page << ".SH EXAMPLES\n.nf\n" << troff(command.examples) << ".fi\n.SH EXIT STATUS\n";
  std::istringstream codes(exit_codes(command));
  for (std::string line; std::getline(codes, line);)
    add_item(page, ".B " + line.substr(0, line.find(' ')),
             line.substr(line.find_first_not_of("0123456789 ")));
  page << ".SH SEE ALSO\n.BR beamid (1)\n";
  return page.str();
}

std::string overview() {
  std::ostringstream page;
  begin(page, "beamid", "stiffness, damping and modes of structures from vibration records");
  page << ".SH SYNOPSIS\n.B beamid\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH COMMANDS\n";
  for (const CommandGroup& group : command_groups()) {
    if (group.title.empty()) continue;
    page << ".SS " << group.title << "\n";
    for (const Command& command : group.commands)
      add_item(page, ".BR beamid\\-" + troff(command.name) + " (1)", command.summary);
  }
  page << ".SH ENVIRONMENT\n";
  add_item(page, ".B COLUMNS", "width of the text on a terminal, instead of the terminal's own");
  add_item(page, ".B NO_COLOR", "if not empty, verdicts on a terminal stand without colour");
  return page.str();
}

int run_man(const Values& values) {
  if (!values.has("all")) {
    std::cout << (values.has("command") ? page_of(find_command(values.texts("command")[0])) : overview());
    return 0;
  }
  const std::filesystem::path folder = values.text("all");
  std::filesystem::create_directories(folder);
  experiments::write_file(folder / "beamid.1", overview());
  for (const CommandGroup& group : command_groups())
    for (const Command& command : group.commands)
      if (!group.title.empty())
        experiments::write_file(folder / ("beamid-" + command.name + ".1"), page_of(command));
  return 0;
}

}  // namespace

Command man_command() {
  return {"man",
          "[COMMAND | --all DIR]",
          "the manual page of a command, for man",
          {{.name = "command"}},
          {{"Options", {text("all", "DIR", "write the pages of all commands there")}}},
          "  beamid man modes | man -l -\n",
          run_man};
}

}  // namespace beamid::apps
