#include "experiments/results/report_page.hpp"

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/process.hpp"

namespace beamid::experiments {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> browsers{"chromium", "chromium-browser", "google-chrome",
                                        "google-chrome-stable"};

bool is_pdf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(4, ' ');
  return stream.read(head.data(), 4) && head == "%PDF";
}

/// A file's address [rfc3986]: all but plain letters and slashes by their codes, as "#" ends a path.
std::string address_of(const fs::path& file) {
  std::string address = "file://";
  for (const char letter : fs::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                       (letter >= '0' && letter <= '9') ||
                       std::string_view("/-._~").find(letter) != std::string_view::npos;
    address += plain ? std::string(1, letter) : fmt::format("%{:02X}", byte);
  }
  return address;
}

/// The browser's own files, which it would leave in the user's home.
class Profile {
 public:
  Profile() {
    std::string name = (fs::temp_directory_path() / "beamid_browser_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder can be made in " + name);
    folder_ = name;
  }
  ~Profile() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Profile(const Profile&) = delete;
  Profile& operator=(const Profile&) = delete;
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

}  // namespace

std::string browser_for_pdf() {
  const char* const path = std::getenv("PATH");
  for (const std::string& name : browsers) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (!folder.empty() && access((fs::path(folder) / name).c_str(), X_OK) == 0) return name;
  }
  throw std::invalid_argument(
      "a PDF is printed by a browser, and neither chromium nor google-chrome is installed; expected one of "
      "them (Debian: chromium), or --out FILE.html alone, to be printed from any other");
}

void print_pdf(const fs::path& page, const fs::path& pdf) {
  const std::string browser = browser_for_pdf();
  const Profile profile;
  const fs::path printed = profile.folder() / "page.pdf";
  std::vector<std::string> words{"timeout",  // coreutils: a browser that waits for something waits for ever
                                 "120",
                                 browser,
                                 "--headless",
                                 "--disable-gpu",
                                 "--no-first-run",
                                 "--disable-dev-shm-usage",
                                 "--user-data-dir=" + profile.folder().string(),
                                 "--no-pdf-header-footer",
                                 "--print-to-pdf=" + printed.string()};
  if (geteuid() == 0) words.insert(words.begin() + 3, "--no-sandbox");  // it starts as root only without
  words.push_back(address_of(page));
  const ProcessResult result = run_process(words, profile.folder());
  if (result.exit_code != 0 || !is_pdf(printed))
    throw std::runtime_error(
        fmt::format("{} has printed nothing (exit code {}): {}", browser, result.exit_code, result.output));
  const fs::path beside = pdf.string() + ".partial-" + std::to_string(getpid());
  fs::copy_file(printed, beside, fs::copy_options::overwrite_existing);
  fs::rename(beside, pdf);
}

namespace {

// How a page looks: on a screen, bright or dark, wide or narrow, and on paper.

inline constexpr std::string_view report_style = R"css(
:root { --ink: #222; --ground: #fff; --soft: #f3f5f7; --stripe: rgba(0, 40, 80, .045); --line: #999; --note: #444;
  --link: #005a91; --warning: #8a5a00; --warning-ground: #fff6e0; --failure: #a32000; --failure-ground: #ffe9e3 }
@media screen and (prefers-color-scheme: dark) {
  :root { color-scheme: dark; --ink: #ddd; --ground: #1a1a1a; --soft: #262a2e; --stripe: rgba(255, 255, 255, .05);
    --line: #777; --note: #aaa; --link: #6cb8ee; --warning: #f0b849; --warning-ground: #33290f; --failure: #ff8a66;
    --failure-ground: #3d1a10 }
  .plot img { filter: invert(.9) hue-rotate(180deg) }
}
body { font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; color: var(--ink); background: var(--ground); max-width: 60rem;
  margin: 2rem auto; padding: 0 1rem; counter-reset: plot }
a { color: var(--link) }
h1 { font-size: 1.5rem; line-height: 1.25; border-bottom: 2px solid #0072b2; padding-bottom: .3rem }
h2 { font-size: 1.15rem; margin-top: 2rem }
pre { background: var(--soft); padding: .6rem .8rem; white-space: pre-wrap; overflow-wrap: anywhere; font-size: .85rem }
p { white-space: pre-line; overflow-wrap: break-word }
nav { background: var(--soft); padding: .2rem 1rem; font-size: .9rem }
nav p { font-weight: bold; margin: .5rem 0 0 }
nav ol { margin: .3rem 0 .6rem; padding-left: 1.6rem }
.warning, .failure { border-left: 5px solid var(--warning); background: var(--warning-ground); padding: .6rem .9rem }
.failure { border-color: var(--failure); background: var(--failure-ground); font-weight: bold }
figure { margin: 1.5rem 0 }
.scroll { overflow-x: auto }
figcaption { font-weight: bold; margin-bottom: .3rem }
.plot figcaption { font-weight: normal; font-size: .9rem; margin-top: .3rem }
.plot figcaption::before { counter-increment: plot; content: "Figure " counter(plot) ". "; font-weight: bold }
img { max-width: 100%; min-width: 36rem; height: auto; display: block; margin: auto }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums }
th { text-align: left; vertical-align: bottom; border-bottom: 1px solid var(--ink) }
th, td { padding: .15rem .8rem .15rem 0 }
th:first-child, td:first-child { position: sticky; left: 0; background: var(--ground) }
tbody tr:nth-child(odd) td { background-image: linear-gradient(var(--stripe), var(--stripe)) }
.number { text-align: right; white-space: nowrap }
.note { font-size: .85rem; color: var(--note); margin-top: .3rem }
footer { margin-top: 3rem; border-top: 1px solid var(--line); font-size: .8rem; color: var(--note) }
@media screen and (max-width: 40rem) {
  body { font-size: 15px; margin: 1rem auto }
  .scroll { padding-bottom: .2rem; border-right: 2px dotted var(--line) }
  .plot figcaption::after { content: " (scrolls sideways)"; color: var(--note) }
  td:not(.number):not(:first-child) { min-width: 8rem }
  .table .scroll::after { content: "a wide table scrolls sideways"; display: block; position: sticky; left: 0;
    width: max-content; font-size: .75rem; color: var(--note) }
}
@media print {
  body { max-width: none; margin: 0; font-size: 10pt }
  .scroll { overflow: visible }
  img { min-width: 0 }
  table { font-size: 7.5pt }
  th, td { padding: .1rem .5rem .1rem 0 }
  .number { white-space: normal }
  .table { break-inside: auto }
  .plot, tr, p { break-inside: avoid }
  h1, h2, .table > figcaption { break-after: avoid }
  .warning, .failure, pre, nav { print-color-adjust: exact; -webkit-print-color-adjust: exact }
}
)css";

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
