#include "experiments/results/results.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "experiments/results/report_page.hpp"
#include "experiments/results/text.hpp"
#include "experiments/results/vtk/drawing.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;
constexpr int schema_version = 4;

// Replaces what is not finite by null and says where.
void make_finite(Json& json, const std::string& place, Json& warnings) {
  if (json.is_number_float() && !std::isfinite(json.get<double>())) {
    warnings.push_back(fmt::format("{} is {}", place, json.get<double>()));
    json = nullptr;
  } else if (json.is_object()) {
    for (auto&& [key, value] : json.items())
      make_finite(value, place.empty() ? key : place + "." + key, warnings);
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i)
      make_finite(json[i], fmt::format("{}[{}]", place, i), warnings);
  }
}

// What a reader must heed, as the page and the terminal show it.
Json messages_of(const Results& results) {
  Json messages = Json::array();
  std::string heading;
  for (const auto& part : results.report) {
    if (const auto* title = std::get_if<Heading>(&part)) heading = title->text;
    if (const auto* said = std::get_if<Paragraph>(&part); said && said->severity != Severity::none)
      messages.push_back(
          {{"severity", to_string(said->severity)}, {"heading", heading}, {"text", said->text}});
  }
  return messages;
}

// The command's own status where it has one, else by the worst message; every objection in the report's
// order.
Json verdict_of(const Results& results) {
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  Json objections = Json::array(), limitations = Json::array();
  bool doubtful = false;
  for (const auto& part : results.report) {
    const auto* said = std::get_if<Paragraph>(&part);
    if (!said) continue;
    doubtful = doubtful || said->limits || said->severity == Severity::warning;
    if (said->limits) limitations.push_back(said->text);
    if (const auto& one = said->objection)
      objections.push_back({{"name", one->name},
                            {"statistic", number(one->statistic)},
                            {"limit", number(one->limit)},
                            {"sentence", said->text}});
  }
  const auto status = results.values.find("status");
  const char* const by_messages = results.has_failed() ? "failed"
                                  : doubtful           ? "with_reservations"
                                                       : "no_objections";
  Json verdict{
      {"status", status != results.values.end() && status->is_string() ? *status : Json(by_messages)}};
  if (const auto sentence = results.values.find("verdict"); sentence != results.values.end())
    verdict["sentence"] = *sentence;
  verdict["objections"] = objections;
  verdict["limitations"] = limitations;
  return verdict;
}

// Every table as its CSV has it: a row an object of the same keys, null where there is no number.
Json tables_of(const Results& results) {
  Json tables = Json::object();
  for (const auto& part : results.report) {
    const auto* table = std::get_if<Table>(&part);
    if (!table) continue;
    Json& rows = tables[table->name] = Json::array();
    for (std::size_t i = 0; i < table->rows(); ++i) {
      Json& row = rows.emplace_back(Json::object());
      for (const Column& column : table->columns) {
        const double* number = number_of(column.cells[i]);
        if (!number)
          row[column.key] = std::get<std::string>(column.cells[i]);
        else
          row[column.key] = std::isfinite(*number) ? Json(*number) : Json(nullptr);
      }
    }
  }
  return tables;
}

std::string text_of(const Json& json) {
  // Texts from outside, such as channel names, need not be UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::vector<std::string> result_files_of(const Results& results) {
  std::vector<std::string> files{"report.html", "results.json", "timing.json"};
  for (const auto& part : results.report)
    if (const auto* table = std::get_if<Table>(&part)) files.push_back(table->name + ".csv");
  for (const Figure& figure : results.figures)
    for (const std::string& file : files_of(figure)) files.push_back(file);
  for (const Attachment& attachment : results.attachments)
    files.insert(files.end(), attachment.files.begin(), attachment.files.end());
  std::sort(files.begin(), files.end());
  if (const auto twice = std::adjacent_find(files.begin(), files.end()); twice != files.end())
    throw std::invalid_argument("two of the results are to be written as '" + *twice + "'");
  return files;
}

// What gnuplot said to those it did not draw. One that is missing or hangs is not asked again.
std::vector<std::string> draw_all(const std::vector<Figure>& figures, const std::filesystem::path& folder) {
  std::vector<std::string> failures;
  for (const Figure& figure : figures) {
    try {
      draw(figure, folder);
    } catch (const NotDrawn& failure) {
      failures.emplace_back(failure.what());
      if (failure.hopeless()) break;
    }
  }
  return failures;
}

// Meshes too are pictures that may be missing.
void write_attachments(const Results& results, const std::filesystem::path& folder,
                       std::vector<std::string>& failures) {
  for (const Attachment& attachment : results.attachments) {
    try {
      attachment.write(folder);
    } catch (const NotDrawn& failure) {
      failures.emplace_back(failure.what());
    }
  }
}

// "files" names what is there, "warnings" why a picture is not.
void add_undrawn(Json& json, const std::vector<std::string>& failures, const std::filesystem::path& folder) {
  Json files = Json::array();
  for (const auto& file : json["files"]) {
    const std::filesystem::path path = file.get<std::string>();
    const std::string kind = path.extension();
    const bool picture = kind == ".svg" || kind == ".png" || kind == ".vtu" || kind == ".pvd";
    if (!picture || std::filesystem::exists(folder / path)) files.push_back(file);
  }
  json.erase("files");
  for (const std::string& failure : failures) json["warnings"].push_back(failure);
  json["files"] = files;
}

}  // namespace

bool Results::has_failed() const {
  return std::any_of(report.begin(), report.end(), [](const auto& part) {
    const auto* said = std::get_if<Paragraph>(&part);
    return said && said->severity == Severity::failure;
  });
}

const char* to_string(Severity severity) {
  switch (severity) {
    case Severity::failure:
      return "failure";
    case Severity::warning:
      return "warning";
    case Severity::note:
      return "note";
    case Severity::none:
      break;
  }
  return "";
}

Json json_rows(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    rows.push_back(std::vector<double>(matrix.row(i).begin(), matrix.row(i).end()));
  return rows;
}

Json to_json(const Results& results) {
  Json json;
  json["schema_version"] = schema_version;
  json["program"] = "beamid";
  json["version"] = BEAMID_VERSION;
  json["command"] = results.command;
  json["seed"] = results.seed ? Json(*results.seed) : Json(nullptr);
  json["configuration"] = results.configuration;
  for (const auto& [key, value] : results.values.items()) {
    if (key == "verdict") continue;  // its sentence
    if (json.contains(key) || key == "warnings" || key == "messages" || key == "tables" || key == "files")
      throw std::invalid_argument("result '" + key +
                                  "': every results.json has a key of this name; expected another");
    json[key] = value;
  }
  Json warnings = Json::array();
  make_finite(json, "", warnings);
  if (!warnings.empty()) json["warnings"] = warnings;
  json["messages"] = messages_of(results);
  json["verdict"] = verdict_of(results);
  json["tables"] = tables_of(results);
  json["files"] = result_files_of(results);
  return json;
}

void write(const Results& results, ResultDirectory& directory) {
  Json json = to_json(results);
  for (const auto& part : results.report)
    if (const auto* table = std::get_if<Table>(&part)) directory.write(table->name + ".csv", to_csv(*table));
  for (const Figure& figure : results.figures) write_data(figure, directory.path());
  std::vector<std::string> failures = draw_all(results.figures, directory.path());
  write_attachments(results, directory.path(), failures);
  if (!failures.empty()) add_undrawn(json, failures, directory.path());
  directory.write("results.json", text_of(json));
  directory.write("report.html", report_page({report_section(results, directory.path())}));
  Json timing;
  timing["schema_version"] = schema_version;
  for (const auto& [what, seconds] : results.timing) timing[what + "_s"] = seconds;
  for (const auto& [what, version] : library_versions()) timing["made_with"][what] = version;
  directory.write("timing.json", text_of(timing));
}

void print(std::ostream& terminal, const Results& results) {
  print(terminal, results, Page());
}

void print(std::ostream& terminal, const Results& results, const Page& page) {
  std::ostringstream stream;
  bool first = true;
  for (const auto& part : results.report) {
    if (!std::exchange(first, false)) stream << '\n';
    if (const auto* heading = std::get_if<Heading>(&part)) {
      for (const std::string& line : wrapped(heading->text, page.width)) stream << line << '\n';
      stream << std::string(std::min(width_of(heading->text), page.width), '=') << '\n';
    } else if (const auto* paragraph = std::get_if<Paragraph>(&part)) {
      for (const std::string& line : wrapped(paragraph->text, page.width)) stream << line << '\n';
    } else {
      print(stream, std::get<Table>(part), page);
    }
  }
  std::istringstream lines(clean_lines(stream.str()));  // names from files may not command a terminal
  for (std::string line; std::getline(lines, line);) terminal << emphasised(line, page) << '\n';
}

void print_json(std::ostream& stream, const Results& results) {
  stream << text_of(to_json(results));
}

}  // namespace beamid::experiments
