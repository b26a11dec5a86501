// What a command found: printed for a person, written as files for programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/results/figure.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/table.hpp"
#include "experiments/results/text.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

/// A line that opens a section on the terminal.
struct Heading {
  std::string text;
};

/// How much a reader must heed a paragraph; a page shows the last two in coloured boxes.
enum class Severity {
  none,     ///< part of the report, no message
  note,     ///< what was done, or found beside what was asked
  warning,  ///< what may make the results wrong
  failure   ///< there is no result, or it is not to be used
};
const char* to_string(Severity severity);

/// Text for the terminal, wrapped when printed.
struct Paragraph {
  std::string text;
  Severity severity = Severity::none;
  bool limits = false;  ///< part of the report, no message, but it states what limits the results
  std::optional<Objection> objection = {};  ///< what the message was made of
};

/// Files that none of the other parts describes, such as meshes.
struct Attachment {
  std::vector<std::string> files;                           ///< their names
  std::function<void(const std::filesystem::path&)> write;  ///< writes them into a folder
};

/// Numbers of a run for programs that have the results in memory; no file holds them.
struct Array {
  std::string run;         ///< as tables name it; empty where there is only one
  std::string name;        ///< "innovations", "reproduced", "time_s"
  Eigen::MatrixXd values;  ///< (p x N)
};

/// While one lives, results are for a terminal alone: no figures, no arrays. Of a million samples these take
/// as long as a pass of the filter, and more memory than all else.
class TerminalOnly {
 public:
  TerminalOnly() { ++living_; }
  ~TerminalOnly() { --living_; }
  TerminalOnly(const TerminalOnly&) = delete;
  TerminalOnly& operator=(const TerminalOnly&) = delete;

  static bool holds() { return living_ > 0; }

 private:
  static inline thread_local int living_ = 0;
};

/// All that a command found, for the terminal, the page and the files.
struct Results {
  std::string command;                ///< "paper", "identify"
  std::string command_line;           ///< what repeats it, "beamid identify ..."; empty: not known
  std::string experiment_file;        ///< its text, shown on the page; empty: there is none
  std::optional<std::uint64_t> seed;  ///< null where nothing is random
  nlohmann::ordered_json configuration = nlohmann::ordered_json::object();  ///< all of it, defaults included
  nlohmann::ordered_json values = nlohmann::ordered_json::object();  ///< SI units as suffixes of the keys
  std::vector<std::variant<Heading, Paragraph, Table>> report;       ///< in the terminal's order
  std::vector<Figure> figures;
  std::vector<Attachment> attachments;
  std::vector<Array> arrays;
  std::vector<std::pair<std::string, double>>
      timing;  ///< what took how long [s]; "filter" becomes "filter_s"

  void heading(std::string text) { report.emplace_back(Heading{std::move(text)}); }
  void paragraph(std::string text) { report.emplace_back(Paragraph{std::move(text)}); }
  /// What limits the results and is no message: innovations that are not white, records that differ.
  void limitation(std::string text) { report.emplace_back(Paragraph{std::move(text), Severity::none, true}); }
  void note(std::string text) { report.emplace_back(Paragraph{std::move(text), Severity::note}); }
  void notes(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) note(text);
  }
  /// What may make the results wrong, or has. @param failed there is no result, or it is not to be used
  void warning(std::string text, bool failed = false) {
    report.emplace_back(Paragraph{std::move(text), failed ? Severity::failure : Severity::warning});
  }
  /// What speaks against them, found by a test of its own. @param of what it was found in, "a.csv: "
  void object(const Objection& one, const std::string& of = {}, bool failed = false) {
    report.emplace_back(Paragraph{of + one.text, failed ? Severity::failure : Severity::warning, false, one});
  }
  /// Whether a message is a failure: exit code 3.
  bool has_failed() const;
  void table(Table table) { report.emplace_back(std::move(table)); }
  /// Figures that are made only where something will show them (TerminalOnly).
  template <class MakeFigures>
  void draw(const MakeFigures& make) {
    if (TerminalOnly::holds()) return;
    for (Figure& figure : make()) figures.push_back(std::move(figure));
  }
};

/// The contents of results.json: schema_version, program, version, command, seed, configuration, then the
/// values' keys, then "messages", the notes, warnings and failures of the report in its order, each with its
/// severity and the heading it stands below, "verdict", the status, the sentence in values["verdict"] where
/// there is one, and every objection with its name, its statistic and the limit of it (null where no one
/// number decided) and its sentences, and the limitations, "tables", every table as rows with the keys of its
/// CSV header, and "files", the names of all files that write() makes.
///
/// JSON knows no number that is not finite: one becomes null, and "warnings" then names its place and what it
/// was, "beams[0].frequency_hz is nan".
/// @throws std::invalid_argument when a value's key is one of those named here.
nlohmann::ordered_json to_json(const Results& results);

/// [[a, b], [c, d]] of a matrix.
nlohmann::ordered_json json_rows(const Eigen::MatrixXd& matrix);

/// Writes results.json, each table as NAME.csv, figures, attachments, report.html (report_page.hpp) and
/// timing.json, the only file that depends on the clock.
/// @throws std::invalid_argument when two files have the same name.
/// @throws std::runtime_error when a file cannot be written or a figure not drawn.
void write(const Results& results, ResultDirectory& directory);

/// Headings, paragraphs and tables in their order, at most page_width columns wide.
void print(std::ostream& terminal, const Results& results);

/// results.json as it would be written.
void print_json(std::ostream& stream, const Results& results);

// Results and tables for a terminal of any width.

/// Headings, paragraphs and tables in their order, at most as wide as the page.
void print(std::ostream& terminal, const Results& results, const Page& page);

/// A table as in table.hpp, on a page of any width.
void print(std::ostream& stream, const Table& table, const Page& paper);

// What this program was made with.

/// "beamid", the compiler and the libraries whose headers state it, with their versions.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace beamid::experiments
