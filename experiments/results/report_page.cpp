#include "experiments/results/report_page.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/page/figure_data.hpp"

namespace beamid::experiments {
namespace {

// A section's borders in the file, by which pages are joined again.
constexpr std::string_view begin_mark = "<!-- beamid section -->\n";
constexpr std::string_view end_mark = "<!-- end of beamid section -->\n";

constexpr std::string_view command_mark = "<pre class=\"command\">";

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src )";

constexpr std::string_view head_end = R"(">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="beamid )" BEAMID_VERSION R"(">
)";

std::string description(const Figure& figure) {
  std::string text;
  for (const Panel& panel : figure.panels) {
    const std::string words =
        panel.title.empty() ? panel.y_axis.label + " over " + panel.x_axis.label : panel.title;
    if (text.find(words) == std::string::npos) text += (text.empty() ? "" : "; ") + words;
  }
  return text;
}

std::string paragraph_html(const Paragraph& paragraph) {
  const char* const box = paragraph.severity == Severity::failure   ? R"( class="failure" role="alert")"
                          : paragraph.severity == Severity::warning ? " class=\"warning\""
                                                                    : "";
  return "<p" + std::string(box) + ">" + typeset_html(paragraph.text) + "</p>\n";
}

bool is_warning(const Paragraph& paragraph) {
  return paragraph.severity == Severity::warning || paragraph.severity == Severity::failure;
}

/// The first line of a message; where it is longer than 240 characters, as many of its sentences as fit.
std::string beginning(std::string text) {
  constexpr std::size_t longest = 240;
  if (const std::size_t end = text.find('\n'); end != std::string::npos) text.resize(end);
  if (text.size() <= longest) return text;
  if (const std::size_t end = text.rfind(". ", longest); end != std::string::npos)
    return text.substr(0, end + 1);
  return text.substr(0, text.rfind(' ', longest)) + " ...";
}

/// The first thing to see after the title: a colour and a label, and what it stands on.
std::string verdict_html(const Results& results) {
  std::size_t warnings = 0;
  const Paragraph *first = nullptr, *limit = nullptr;
  for (const auto& part : results.report) {
    const auto* said = std::get_if<Paragraph>(&part);
    if (!said) continue;
    if (said->limits && !limit) limit = said;
    if (!is_warning(*said)) continue;
    ++warnings;
    if (!first || (said->severity == Severity::failure && first->severity != Severity::failure)) first = said;
  }
  const std::string status = results.values.contains("status") && results.values["status"].is_string()
                                 ? results.values["status"].get<std::string>()
                                 : "";
  const bool failed = first && first->severity == Severity::failure;
  const std::string label = failed  ? "Not to be used"
                            : first ? "With warnings"
                            : limit ? "With reservations"
                                    : "No warnings";
  const std::string text = first   ? beginning(first->text)
                           : limit ? beginning(limit->text)
                                   : "None of the messages is a warning or a failure.";
  const std::string kind = failed ? "bad" : first || limit ? "doubtful" : "good";
  return "<p class=\"verdict " + kind + "\"><b>" + label + ".</b> " + typeset_html(text) +
         (warnings > 1 ? " (" + std::to_string(warnings) + " messages, all below)" : "") +
         (status.empty() ? "" : " <span class=\"status\">status: " + escaped(status) + "</span>") + "</p>\n";
}

std::string folded(const std::string& heading, const std::string& html, bool open) {
  return "<details" + std::string(open ? " open" : "") + ">\n<summary><h2>" + heading + "</h2></summary>\n" +
         html + "</details>\n";
}

/// Bytes that the data of figures may take beside the static pictures and so many of models in a page of
/// 1.5 MB: 67 kB are its script and style, 55 kB its text.
std::size_t room_for_data(const std::vector<Figure>& figures, const std::filesystem::path& folder,
                          std::size_t models) {
  constexpr std::size_t page = 1'500'000 - 122'000, least = 100'000;
  std::size_t pictures = models;
  for (const Figure& figure : figures) {
    std::ifstream file(folder / (figure.name + ".svg"), std::ios::binary);
    const std::string svg{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    pictures += picture_address(svg).size();
  }
  return std::clamp(page - std::min(page, pictures), least, most_page_bytes);
}

/// Each figure as an element of the page.
std::vector<std::string> figures_html(const Results& results, const std::filesystem::path& folder,
                                      std::size_t models) {
  std::vector<std::string> all;
  const std::vector<std::string> attributes =
      figure_attributes(results.figures, room_for_data(results.figures, folder, models));
  for (std::size_t i = 0; i < results.figures.size(); ++i) {
    const Figure& figure = results.figures[i];
    const std::filesystem::path svg = folder / (figure.name + ".svg");
    std::string caption = figure.caption.empty() ? description(figure) : figure.caption;
    if (const std::string thinned = thinning_text(figure); !thinned.empty()) {
      if (!caption.ends_with('.')) caption += '.';
      caption += ' ' + thinned;
    }
    all.push_back(std::filesystem::exists(svg)
                      ? html_picture(svg, description(figure), caption, attributes[i])
                      : "<p class=\"note\">Figure " + escaped(figure.name) +
                            " is not drawn (results.json states why): " + escaped(figure.name) +
                            ".csv holds its data, `gnuplot " + escaped(figure.name) + ".gp` draws it.</p>\n");
  }
  return all;
}

/// Models that swing: glTF files among the attachments.
std::string models_html(const Results& results, const std::filesystem::path& folder) {
  std::string html;
  for (const Attachment& attachment : results.attachments)
    for (const std::string& name : attachment.files) {
      if (!name.ends_with(".glb")) continue;
      std::ifstream file(folder / name, std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
      if (bytes.empty()) continue;
      html +=
          "<figure class=\"motion\" data-name=\"" + escaped(name.substr(0, name.size() - 4)) +
          "\" data-model=\"" + base64(bytes) + "\">\n<figcaption>" + escaped(name) +
          (name.starts_with("motion") ? ", the simulated motion: glTF 2.0, one animation at its own speed."
                                      : ", which swings: glTF 2.0, one animation for each mode.") +
          "</figcaption></figure>\n";
    }
  return html;
}

constexpr std::string_view contents_mark = "<nav aria-label=\"contents\">\n", contents_end = "</nav>\n";

/// Where the contents of a page of one section stand: after its title and verdict. A wide screen has them at
/// the side, a narrow one here.
std::size_t end_of_verdict(std::string_view html) {
  constexpr std::string_view title_end = "</h1>\n", verdict = "<p class=\"verdict ", paragraph_end = "</p>\n";
  std::size_t at = html.find(title_end);
  if (at == std::string_view::npos) return 0;
  at += title_end.size();
  if (!html.substr(at).starts_with(verdict)) return at;
  const std::size_t end = html.find(paragraph_end, at);
  return end == std::string_view::npos ? at : end + paragraph_end.size();
}

std::string without_contents(std::string html) {
  const std::size_t at = html.find(contents_mark), end = html.find(contents_end, at);
  if (at != std::string::npos && end != std::string::npos) html.erase(at, end + contents_end.size() - at);
  return html;
}

constexpr std::string_view plain_heading = "<h2>", named_heading = "<h2 id=\"";

/// A section whose headings can be linked to, and links to them.
struct Headings {
  std::string html, list;
  std::size_t count = 0;
};

Headings with_anchors(std::string_view html, const std::string& section) {
  Headings found;
  while (true) {
    const std::size_t at = html.find(plain_heading), end = html.find("</h2>", at);
    if (at == std::string_view::npos || end == std::string_view::npos) break;
    const std::string id = section + "-" + std::to_string(++found.count);
    const std::string_view text = html.substr(at + plain_heading.size(), end - at - plain_heading.size());
    found.html.append(html.substr(0, at))
        .append(named_heading)
        .append(id + "\">")
        .append(text)
        .append("</h2>");
    found.list.append("<li><a href=\"#" + id + "\">").append(text).append("</a></li>\n");
    html.remove_prefix(end + 5);
  }
  found.html.append(html);
  return found;
}

// An anchor of this page's own holds no quote and no bracket.
std::string without_anchors(std::string html) {
  for (std::size_t at = html.find(named_heading); at != std::string::npos;
       at = html.find(named_heading, at + 1)) {
    const std::size_t end = html.find_first_of("\"<>", at + named_heading.size());
    if (end != std::string::npos && html.compare(end, 2, "\">") == 0)
      html.replace(at, end + 2 - at, plain_heading);
  }
  return html;
}

/// Whether the verdict above it states a warning already, and in full.
bool is_only_warning(const Results& results, const Paragraph& paragraph) {
  std::size_t warnings = 0;
  for (const auto& part : results.report)
    if (const auto* one = std::get_if<Paragraph>(&part)) warnings += is_warning(*one);
  return warnings == 1 && paragraph.severity == Severity::warning &&
         beginning(paragraph.text) == paragraph.text;
}

/// Of a page whose report begins without a heading: the experiment's title and the command.
std::string title_of(const Results& results) {
  const auto title = results.configuration.find("title");
  if (title == results.configuration.end() || !title->is_string() || *title == "")
    return "beamid " + results.command;
  return title->get<std::string>() + ": " + results.command;
}

}  // namespace

ReportSection report_section(const Results& results, const std::filesystem::path& folder) {
  ReportSection section{title_of(results), {}};
  struct Part {
    std::string heading, html;
    bool open = false;
  };
  std::vector<Part> parts(1);  // the answer, then a part below each further heading
  bool titled = !results.report.empty() && !std::holds_alternative<Heading>(results.report.front());
  bool answer_headed = titled;  // a verdict comes before all headings, the answer below the first one
  Part remarks{"Remarks", {}};  // plain text behind the answer's tables: the figures come before it
  for (const auto& piece : results.report) {
    const bool answering = parts.size() == 1, tabled = parts[0].html.find("<table") != std::string::npos;
    if (const auto* heading = std::get_if<Heading>(&piece)) {
      if (!std::exchange(titled, true))
        section.title = heading->text;
      else if (std::exchange(answer_headed, false) && !tabled)
        parts[0].html += "<h2>" + typeset_html(heading->text) + "</h2>\n";
      else
        parts.push_back({typeset_html(heading->text), {}});
    } else if (const auto* paragraph = std::get_if<Paragraph>(&piece)) {
      if (parts[0].html.empty() && is_only_warning(results, *paragraph)) continue;
      Part& part = answering && tabled && !is_warning(*paragraph) ? remarks : parts.back();
      part.html += paragraph_html(*paragraph);
      part.open |= is_warning(*paragraph) || paragraph->limits;
    } else {
      if (answering) parts[0].html += std::exchange(remarks.html, "");
      parts.back().html += html_table(std::get<Table>(piece));
    }
  }
  if (results.figures.empty()) parts[0].html += std::exchange(remarks.html, "");
  const bool few = parts.size() <= 2;  // what is short stays open: folding is for pages that are long
  if (!remarks.html.empty()) parts.insert(parts.begin() + 1, std::move(remarks));
  std::string body = parts[0].html;
  constexpr std::size_t shown = 2;  // figures; the others are folded
  const std::string models = models_html(results, folder);
  const std::vector<std::string> figures = figures_html(results, folder, models.size());
  if (!figures.empty() || !models.empty()) body += "<h2>Figures</h2>\n" + models;
  for (std::size_t i = 0; i < std::min(shown, figures.size()); ++i) body += figures[i];
  for (std::size_t i = 1; i < parts.size(); ++i)
    body += folded(parts[i].heading, parts[i].html, parts[i].open || few);
  if (figures.size() > shown) {
    std::string more;
    for (std::size_t i = shown; i < figures.size(); ++i) more += figures[i];
    body += folded("More figures", more, false);
  }
  body +=
      "<h2>How it was made</h2>\n<p>beamid " BEAMID_VERSION ", command " + escaped(results.command) + ". " +
      (results.seed ? "Seed " + std::to_string(*results.seed) + ": the same command gives the same numbers."
                    : "No input is random: the same command gives the same numbers.") +
      "</p>\n";
  if (!results.command_line.empty())
    body += std::string(command_mark) + escaped(results.command_line) + "</pre>\n";
  if (!results.experiment_file.empty())
    body += folded("The experiment file", "<pre>" + escaped(results.experiment_file) + "</pre>\n", false);
  section.html = "<h1>" + escaped(section.title) + "</h1>\n" + verdict_html(results) + body;
  return section;
}

std::string report_page(const std::vector<ReportSection>& sections) {
  const PageScript script = page_script();
  const bool alone = sections.size() == 1;
  std::string page = std::string(head).append(script.policy).append(head_end), contents, body;
  page.append("<style>\n").append(page_style()).append("</style>\n");
  page += "<title>" + escaped(alone ? sections[0].title : "beamid report") + "</title>\n</head>\n";
  std::size_t entries = 0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::string id = "section-" + std::to_string(i + 1);
    const Headings marked = with_anchors(sections[i].html, id);
    entries += marked.count;
    contents += alone ? marked.list
                      : "<li><a href=\"#" + id + "\">" + typeset_html(sections[i].title) + "</a>" +
                            (marked.count > 0 ? "<ol>\n" + marked.list + "</ol>" : "") + "</li>\n";
    body += "<section id=\"" + id + "\">\n";
    body.append(begin_mark).append(marked.html).append(end_mark).append("</section>\n");
  }
  const bool listed = !alone || entries > 2;
  page += listed ? "<body class=\"listed\">\n" : "<body>\n";
  if (listed) {
    contents = std::string(contents_mark) + "<p>Contents</p>\n<ol>\n" + contents + "</ol>\n" +
               std::string(contents_end);
    if (alone)
      body.insert(end_of_verdict(body), contents);
    else
      page += contents;
  }
  return page + "<main>\n" + body + "</main>\n" +
         "<footer>Made by beamid " BEAMID_VERSION
         ". Numbers, tables and figures of this page lie beside it as JSON, CSV and "
         "SVG.</footer>\n" +
         script.element + "</body>\n</html>\n";
}

std::vector<ReportSection> sections_of(const std::string& page) {
  std::vector<ReportSection> sections;
  for (std::size_t begin = page.find(begin_mark); begin != std::string::npos;
       begin = page.find(begin_mark, begin)) {
    begin += begin_mark.size();
    const std::size_t end = page.find(end_mark, begin);
    if (end == std::string::npos) break;
    ReportSection section{{}, without_anchors(without_contents(page.substr(begin, end - begin)))};
    const std::size_t title = section.html.find("<h1>"), after = section.html.find("</h1>");
    if (title != std::string::npos && after != std::string::npos)
      section.title = unescaped(std::string_view(section.html).substr(title + 4, after - title - 4));
    sections.push_back(std::move(section));
  }
  return sections;
}

std::string foreign_tag(std::string_view html) {
  static const std::set<std::string_view> own{"h1",         "h2",    "p",   "b",    "pre",     "figure",
                                              "figcaption", "table", "tr",  "th",   "td",      "img",
                                              "thead",      "tbody", "div", "span", "details", "summary"};
  for (std::size_t at = html.find('<'); at != std::string_view::npos; at = html.find('<', at + 1)) {
    const std::size_t begin = at + (html.substr(at).starts_with("</") ? 2 : 1);
    const std::string_view name = html.substr(begin, html.find_first_of(" \t\r\n/>", begin) - begin);
    if (!own.contains(name)) return std::string(name.empty() ? "..." : name.substr(0, 40));
  }
  return "";
}

std::string command_of(const ReportSection& section) {
  constexpr std::string_view after = "</pre>";
  const std::size_t begin = section.html.find(command_mark), end = section.html.find(after, begin);
  if (begin == std::string::npos || end == std::string::npos) return "";
  return unescaped(
      std::string_view(section.html).substr(begin + command_mark.size(), end - begin - command_mark.size()));
}

}  // namespace beamid::experiments
