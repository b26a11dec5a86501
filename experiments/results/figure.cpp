#include "experiments/results/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "experiments/results/envelope.hpp"
#include "experiments/results/file.hpp"
#include "experiments/results/gnuplot.hpp"
#include "experiments/results/process.hpp"
#include "experiments/results/thinned_panel.hpp"
#include "experiments/results/vtk/drawing.hpp"
#include "experiments/text/clean_text.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

using Fields = std::vector<std::string>;  // of a column: header, then values

void check_curve(const std::string& place, const Curve& curve) {
  const bool band = curve.style == CurveStyle::band;
  const auto check_figure = [&](const char* what, const Eigen::VectorXd& values, bool optional) {
    if (values.size() != curve.x.size() && !(optional && values.size() == 0))
      throw std::invalid_argument(fmt::format("{}, curve '{}': {} has {} values; expected {} as in x", place,
                                              curve.label, what, values.size(), curve.x.size()));
  };
  check_figure("y", curve.y, band);
  check_figure("lower", curve.lower, !band);
  check_figure("upper", curve.upper, !band);
  if (curve.lower.size() != curve.upper.size())
    throw std::invalid_argument(
        fmt::format("{}, curve '{}': lower has {} values and upper {}; expected as many", place, curve.label,
                    curve.lower.size(), curve.upper.size()));
}

void check_figure(const Figure& figure) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (figure.name.empty() || figure.name.front() == '.' || figure.name.front() == '-' ||
      !std::all_of(figure.name.begin(), figure.name.end(), plain))
    throw std::invalid_argument("figure name '" + figure.name +
                                "'; expected letters, digits, '_', '-' and '.', a letter or digit first");
  const int places = figure.rows * figure.columns, panels = static_cast<int>(figure.panels.size());
  if (panels < 1 || panels > places)
    throw std::invalid_argument(fmt::format("figure '{}' has {} panels on {} x {} places; expected 1 to {}",
                                            figure.name, panels, figure.rows, figure.columns, places));
  for (std::size_t i = 0; i < figure.panels.size(); ++i)
    for (const Curve& curve : figure.panels[i].curves)
      check_curve(fmt::format("figure '{}', panel {}", figure.name, i + 1), curve);
}

// "ξ√M_{eq}" is written "ξ√M_eq" where nothing is typeset.
std::string plain_text(std::string label) {
  label.erase(std::remove_if(label.begin(), label.end(), [](char c) { return c == '{' || c == '}'; }),
              label.end());
  return label;
}

Fields column(const std::string& header, const Eigen::VectorXd& values,
              const std::vector<Eigen::Index>& kept) {
  Fields fields{header};
  // A gap is written "NaN": gnuplot draws straight on over an empty field.
  for (const Eigen::Index i : kept) fields.push_back(std::isfinite(values[i]) ? csv_field(values[i]) : "NaN");
  return fields;
}

void add_columns(const Panel& panel, const Curve& curve, std::vector<Fields>& columns) {
  const bool bounds = curve.lower.size() > 0, band = curve.style == CurveStyle::band;
  const Eigen::VectorXd& thinned = band ? curve.upper : curve.y;
  // Points are never so many that they need thinning, and each of them counts.
  const auto kept =
      envelope(curve.x, thinned, panel.x_axis.logarithmic, is_line(curve) ? 4000 : curve.x.size());
  const auto header = [&](const std::string& axis, const char* bound) {
    std::string text;
    for (const std::string& part : {panel.title, curve.label + bound})
      if (!part.empty()) text += plain_text(part) + " | ";
    return csv_field(clean_text(text + plain_text(axis)));  // one line: the script skips one
  };
  columns.push_back(column(header(panel.x_axis.label, ""), curve.x, kept));
  if (!band) columns.push_back(column(header(panel.y_axis.label, ""), curve.y, kept));
  if (!bounds) return;
  columns.push_back(column(header(panel.y_axis.label, " lower"), curve.lower, kept));
  columns.push_back(column(header(panel.y_axis.label, " upper"), curve.upper, kept));
}

std::string data_of(const Figure& figure) {
  std::vector<Fields> columns;
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves) {
      const bool ascending = curve.x.allFinite() && std::is_sorted(curve.x.begin(), curve.x.end());
      const bool cut = panel.x_axis.range && ascending;
      add_columns(panel, cut ? visible_part(curve, *panel.x_axis.range) : curve, columns);
    }
  std::size_t rows = 0;
  for (const Fields& fields : columns) rows = std::max(rows, fields.size());
  std::string csv;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) csv += ',';
      if (row < columns[i].size()) csv += columns[i][row];
    }
    csv += '\n';
  }
  return csv;
}

}  // namespace

std::vector<std::string> files_of(const Figure& figure) {
  return {figure.name + ".csv", figure.name + ".gp", figure.name + ".svg", figure.name + ".png"};
}

void write(const Figure& figure, const std::filesystem::path& folder) {
  write_data(figure, folder);
  draw(figure, folder);
}

void write_data(const Figure& figure, const std::filesystem::path& folder) {
  check_figure(figure);
  write_file(folder / (figure.name + ".csv"), data_of(figure));
  write_file(folder / (figure.name + ".gp"), gnuplot_script(figure));
}

namespace {

/// Whether a picture is there to its end: a full disk cuts it off, and gnuplot does not always say so.
bool is_whole(const std::filesystem::path& picture) {
  const std::string_view end = picture.extension() == ".svg" ? "</svg>" : "IEND";
  std::ifstream stream(picture, std::ios::binary | std::ios::ate);
  std::string last(16, '\0');
  stream.seekg(-static_cast<std::streamoff>(last.size()), std::ios::end).read(last.data(), 16);
  return stream && last.find(end) != std::string::npos;
}

}  // namespace

void draw(const Figure& figure, const std::filesystem::path& folder) {
  constexpr double longest = 120;  // [s]
  const auto fail = [&](const std::string& why, bool hopeless) {
    std::error_code ignored;
    for (const char* ending : {".svg", ".png"})
      std::filesystem::remove(folder / (figure.name + ending), ignored);
    throw NotDrawn("figure '" + figure.name + "' is not drawn: " + why, hopeless);
  };
  ProcessResult gnuplot;
  try {
    // "-d" leaves the user's own settings out, which would change the picture.
    gnuplot = run_process({"gnuplot", "-d", figure.name + ".gp"}, folder, longest);
  } catch (const std::runtime_error& error) {
    fail(std::string(error.what()) + "; the Debian package gnuplot-nox has it", true);
  }
  if (!gnuplot.ended) fail(fmt::format("gnuplot has not ended after {:g} s", longest), true);
  if (gnuplot.exit_code != 0)
    fail(fmt::format("gnuplot failed (exit code {}): {}", gnuplot.exit_code, gnuplot.output), false);
  for (const char* ending : {".svg", ".png"}) {
    const auto picture = folder / (figure.name + ending);
    if (!is_whole(picture))
      throw std::runtime_error("figure '" + figure.name + "': gnuplot left no whole " +
                               picture.filename().string() + "; is the disk full? " + gnuplot.output);
  }
}

}  // namespace beamid::experiments
