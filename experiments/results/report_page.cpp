#include "experiments/results/report_page.hpp"

#include <set>

#include "experiments/results/html.hpp"

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
<style>
body { font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; color: #222; max-width: 60rem; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.5rem; line-height: 1.25; border-bottom: 2px solid #0072b2; padding-bottom: .3rem }
h2 { font-size: 1.15rem; margin-top: 2rem }
pre { background: #f3f5f7; padding: .6rem .8rem; white-space: pre-wrap; overflow-wrap: anywhere; font-size: .85rem }
p { white-space: pre-line }
figure { margin: 1.5rem 0; overflow-x: auto }
figcaption { font-weight: bold; margin-bottom: .3rem }
img { max-width: 100%; height: auto; display: block; margin: auto }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums }
th { text-align: left; vertical-align: bottom; border-bottom: 1px solid #222 }
th, td { padding: .15rem .8rem .15rem 0 }
tr:nth-child(odd) td { background: #f7f8fa }
.number { text-align: right; white-space: nowrap }
.note { font-size: .85rem; color: #444; margin-top: .3rem }
footer { margin-top: 3rem; border-top: 1px solid #bbb; font-size: .8rem; color: #555 }
@media print {
  body { max-width: none; margin: 0; font-size: 10pt }
  figure, tr { break-inside: avoid }
  h1, h2, figcaption { break-after: avoid }
  section + section { break-before: page }
}
</style>
)";

std::string description(const Figure& figure) {
  std::string text;
  for (const Panel& panel : figure.panels) {
    const std::string words =
        panel.title.empty() ? panel.y_axis.label + " over " + panel.x_axis.label : panel.title;
    text += (text.empty() ? "" : "; ") + words;
  }
  return text;
}

}  // namespace

ReportSection report_section(const Results& results, const std::filesystem::path& folder) {
  ReportSection section{"beamid " + results.command, {}};
  bool titled = false;
  std::string body;
  for (const auto& part : results.report) {
    if (const auto* heading = std::get_if<Heading>(&part)) {
      if (std::exchange(titled, true))
        body += "<h2>" + escaped(heading->text) + "</h2>\n";
      else
        section.title = heading->text;
    } else if (const auto* paragraph = std::get_if<Paragraph>(&part)) {
      body += "<p>" + escaped(paragraph->text) + "</p>\n";
    } else {
      body += html_table(std::get<Table>(part));
    }
  }
  for (const Figure& figure : results.figures) {
    const std::filesystem::path svg = folder / (figure.name + ".svg");
    body += std::filesystem::exists(svg)
                ? html_picture(svg, description(figure))
                : "<p class=\"note\">Figure " + escaped(figure.name) +
                      " is not drawn (results.json says why): " + escaped(figure.name) +
                      ".csv holds its data, `gnuplot " + escaped(figure.name) + ".gp` draws it.</p>\n";
  }
  section.html = "<h1>" + escaped(section.title) + "</h1>\n";
  if (!results.command_line.empty()) section.html += "<pre>" + escaped(results.command_line) + "</pre>\n";
  section.html += body;
  return section;
}

std::string report_page(const std::vector<ReportSection>& sections) {
  std::string page(head), contents;
  page += "<title>" + escaped(sections.size() == 1 ? sections[0].title : "beamid report") +
          "</title>\n</head>\n<body>\n";
  for (std::size_t i = 0; i < sections.size(); ++i)
    contents += "<li><a href=\"#section-" + std::to_string(i + 1) + "\">" + escaped(sections[i].title) +
                "</a></li>\n";
  if (sections.size() > 1) page += "<nav><ol>\n" + contents + "</ol></nav>\n";
  for (std::size_t i = 0; i < sections.size(); ++i) {
    page += "<section id=\"section-" + std::to_string(i + 1) + "\">\n";
    page.append(begin_mark).append(sections[i].html).append(end_mark).append("</section>\n");
  }
  return page + "<footer>Made by beamid " BEAMID_VERSION
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
    ReportSection section{{}, page.substr(begin, end - begin)};
    const std::size_t title = section.html.find("<h1>"), after = section.html.find("</h1>");
    if (title != std::string::npos && after != std::string::npos)
      section.title = unescaped(std::string_view(section.html).substr(title + 4, after - title - 4));
    sections.push_back(std::move(section));
  }
  return sections;
}

std::string foreign_tag(std::string_view html) {
  static const std::set<std::string_view> own{"h1",         "h2",    "p",  "b",  "pre", "figure",
                                              "figcaption", "table", "tr", "th", "td",  "img"};
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
