#include "experiments/results/report_page.hpp"

#include <set>

#include "experiments/results/html.hpp"
#include "experiments/results/report_style.hpp"

namespace beamid::experiments {
namespace {

// A section's borders in the file, by which pages are joined again.
constexpr std::string_view begin_mark = "<!-- beamid section -->\n";
constexpr std::string_view end_mark = "<!-- end of beamid section -->\n";

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
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

}  // namespace

ReportSection report_section(const Results& results, const std::filesystem::path& folder) {
  ReportSection section{"beamid " + results.command, {}};
  bool titled = false;
  std::string body;
  for (const auto& part : results.report) {
    if (const auto* heading = std::get_if<Heading>(&part)) {
      if (std::exchange(titled, true))
        body += "<h2>" + typeset_html(heading->text) + "</h2>\n";
      else
        section.title = heading->text;
    } else if (const auto* paragraph = std::get_if<Paragraph>(&part)) {
      body += paragraph_html(*paragraph);
    } else {
      body += html_table(std::get<Table>(part));
    }
  }
  if (!results.figures.empty()) body += "<h2>Figures</h2>\n";
  for (const Figure& figure : results.figures) {
    const std::filesystem::path svg = folder / (figure.name + ".svg");
    body += std::filesystem::exists(svg)
                ? html_picture(svg, description(figure),
                               figure.caption.empty() ? description(figure) : figure.caption)
                : "<p class=\"note\">Figure " + escaped(figure.name) +
                      " is not drawn (results.json says why): " + escaped(figure.name) +
                      ".csv holds its data, `gnuplot " + escaped(figure.name) + ".gp` draws it.</p>\n";
  }
  body +=
      "<h2>How it was made</h2>\n<p>beamid " BEAMID_VERSION ", command " + escaped(results.command) + ". " +
      (results.seed ? "Seed " + std::to_string(*results.seed) + ": the same command gives the same numbers."
                    : "Nothing is random: the same command gives the same numbers.") +
      "</p>\n";
  if (!results.experiment_file.empty())
    body += "<h2>The experiment file</h2>\n<pre>" + escaped(results.experiment_file) + "</pre>\n";
  section.html = "<h1>" + escaped(section.title) + "</h1>\n";
  if (!results.command_line.empty()) section.html += "<pre>" + escaped(results.command_line) + "</pre>\n";
  section.html += body;
  return section;
}

std::string report_page(const std::vector<ReportSection>& sections) {
  std::string page(head), contents, body;
  page.append("<style>\n").append(report_style).append("</style>\n");
  page += "<title>" + escaped(sections.size() == 1 ? sections[0].title : "beamid report") +
          "</title>\n</head>\n<body>\n";
  std::size_t entries = 0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::string id = "section-" + std::to_string(i + 1);
    const Headings marked = with_anchors(sections[i].html, id);
    entries += marked.count;
    contents += sections.size() > 1
                    ? "<li><a href=\"#" + id + "\">" + typeset_html(sections[i].title) + "</a>" +
                          (marked.count > 0 ? "<ol>\n" + marked.list + "</ol>" : "") + "</li>\n"
                    : marked.list;
    body += "<section id=\"" + id + "\">\n";
    body.append(begin_mark).append(marked.html).append(end_mark).append("</section>\n");
  }
  if (sections.size() > 1 || entries > 2)
    page += "<nav aria-label=\"contents\">\n<p>Contents</p>\n<ol>\n" + contents + "</ol>\n</nav>\n";
  return page + body +
         "<footer>Made by beamid " BEAMID_VERSION
         ". Numbers, tables and figures of this page lie beside it as JSON, CSV and "
         "SVG.</footer>\n</body>\n</html>\n";
}

std::vector<ReportSection> sections_of(const std::string& page) {
  std::vector<ReportSection> sections;
  for (std::size_t begin = page.find(begin_mark); begin != std::string::npos;
       begin = page.find(begin_mark, begin)) {
    begin += begin_mark.size();
    const std::size_t end = page.find(end_mark, begin);
    if (end == std::string::npos) break;
    ReportSection section{{}, without_anchors(page.substr(begin, end - begin))};
    const std::size_t title = section.html.find("<h1>"), after = section.html.find("</h1>");
    if (title != std::string::npos && after != std::string::npos)
      section.title = unescaped(std::string_view(section.html).substr(title + 4, after - title - 4));
    sections.push_back(std::move(section));
  }
  return sections;
}

std::string foreign_tag(std::string_view html) {
  static const std::set<std::string_view> own{"h1",         "h2",    "p",   "b",   "pre", "figure",
                                              "figcaption", "table", "tr",  "th",  "td",  "img",
                                              "thead",      "tbody", "div", "span"};
  for (std::size_t at = html.find('<'); at != std::string_view::npos; at = html.find('<', at + 1)) {
    const std::size_t begin = at + (html.substr(at).starts_with("</") ? 2 : 1);
    const std::string_view name = html.substr(begin, html.find_first_of(" \t\r\n/>", begin) - begin);
    if (!own.contains(name)) return std::string(name.empty() ? "..." : name.substr(0, 40));
  }
  return "";
}

std::string command_of(const ReportSection& section) {
  constexpr std::string_view before = "</h1>\n<pre>", after = "</pre>";
  const std::size_t begin = section.html.find(before), end = section.html.find(after, begin);
  if (begin == std::string::npos || end == std::string::npos) return "";
  return unescaped(std::string_view(section.html).substr(begin + before.size(), end - begin - before.size()));
}

}  // namespace beamid::experiments
