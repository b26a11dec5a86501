#include "experiments/results/figure.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/results/gnuplot.hpp"
#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/process.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/vtk/drawing.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {

std::vector<Eigen::Index> envelope(const Eigen::VectorXd& x, const Eigen::VectorXd& y, bool logarithmic,
                                   Eigen::Index limit) {
  const Eigen::Index size = x.size();
  std::vector<Eigen::Index> kept(static_cast<std::size_t>(size));
  std::iota(kept.begin(), kept.end(), Eigen::Index{0});
  if (size <= limit) return kept;

  const Eigen::Index intervals = std::max<Eigen::Index>(1, limit / 2);
  const auto drawn = [&](Eigen::Index i) { return logarithmic ? std::log(x[i]) : x[i]; };
  Eigen::Index first = 0;
  while (first < size - 1 && !std::isfinite(drawn(first))) ++first;
  const double start = drawn(first), width = drawn(size - 1) - start;
  const bool ascending = x.allFinite() && std::is_sorted(x.begin(), x.end()) && width > 0;
  const auto interval = [&](Eigen::Index i) {
    const double place =
        ascending ? (drawn(i) - start) / width : static_cast<double>(i) / static_cast<double>(size - 1);
    return std::clamp(static_cast<Eigen::Index>(std::max(place, 0.0) * static_cast<double>(intervals)),
                      Eigen::Index{0}, intervals - 1);
  };

  kept = {0};
  for (Eigen::Index begin = 0, end; begin < size; begin = end) {
    Eigen::Index low = begin, high = begin, gap = -1;
    for (end = begin; end < size && interval(end) == interval(begin); ++end) {
      if (!std::isfinite(y[end])) gap = end;
      if (!(y[low] <= y[end])) low = std::isfinite(y[end]) ? end : low;
      if (!(y[high] >= y[end])) high = std::isfinite(y[end]) ? end : high;
    }
    Eigen::Index chosen[] = {low, high, gap};
    std::sort(std::begin(chosen), std::end(chosen));
    for (const Eigen::Index i : chosen)
      if (i > kept.back()) kept.push_back(i);
  }
  if (kept.back() != size - 1) kept.push_back(size - 1);
  return kept;
}

namespace {

// The curve inside the horizontal range, with one point more on each side for the line to enter by.
Curve visible_part(const Curve& curve, const std::pair<double, double>& range) {
  const auto first = std::lower_bound(curve.x.begin(), curve.x.end(), range.first);
  const auto last = std::upper_bound(curve.x.begin(), curve.x.end(), range.second);
  const Eigen::Index begin = std::max<Eigen::Index>(first - curve.x.begin() - 1, 0),
                     end = std::min<Eigen::Index>(last - curve.x.begin() + 1, curve.x.size());
  const auto cut = [&](const Eigen::VectorXd& values) {
    return values.size() > 0 ? values.segment(begin, end - begin).eval() : Eigen::VectorXd();
  };
  Curve part = curve;
  for (Eigen::VectorXd* values : {&part.x, &part.y, &part.lower, &part.upper}) *values = cut(*values);
  return part;
}

void keep_points(Curve& curve, const std::vector<Eigen::Index>& kept) {
  for (Eigen::VectorXd* values : {&curve.x, &curve.y, &curve.lower, &curve.upper})
    if (values->size() > 0) *values = (*values)(kept).eval();
}

Curve thinned_curve(const Curve& curve, const Axis& x_axis) {
  const bool ascending = curve.x.allFinite() && std::is_sorted(curve.x.begin(), curve.x.end());
  Curve part = x_axis.range && ascending ? visible_part(curve, *x_axis.range) : curve;
  part.points = part.x.size();
  if (is_line(part))
    keep_points(part, envelope(part.x, part.style == CurveStyle::band ? part.upper : part.y,
                               x_axis.logarithmic, most_kept_points));
  return part;
}

Extent height(const Curve& curve, bool positive) {
  Extent extent;
  for (const Eigen::VectorXd* values : {&curve.y, &curve.lower, &curve.upper}) extent.add(*values, positive);
  return extent;
}

bool is_as_high(const Curve& part, const Curve& whole, const Axis& y_axis) {
  const Extent of_part = height(part, y_axis.logarithmic), of_whole = height(whole, y_axis.logarithmic);
  if (y_axis.range) return of_part.empty() == of_whole.empty();
  return of_part.low == of_whole.low && of_part.high == of_whole.high;
}

}  // namespace

Panel thinned(Panel panel) {
  if (!panel.x_axis.range) return panel;
  for (Curve& curve : panel.curves) {
    if (curve.x.size() <= most_kept_points || !is_line(curve)) continue;
    Curve part = thinned_curve(curve, panel.x_axis);
    if (is_as_high(part, curve, panel.y_axis)) curve = std::move(part);
  }
  return panel;
}

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
  const auto kept = envelope(curve.x, thinned, panel.x_axis.logarithmic,
                             is_line(curve) ? most_drawn_points : curve.x.size());
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

// What the frame can show of a curve.
Curve shown(const Panel& panel, const Curve& curve) {
  const bool ascending = curve.x.allFinite() && std::is_sorted(curve.x.begin(), curve.x.end());
  return panel.x_axis.range && ascending ? visible_part(curve, *panel.x_axis.range) : curve;
}

std::string data_of(const Figure& figure) {
  std::vector<Fields> columns;
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves) add_columns(panel, shown(panel, curve), columns);
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

bool is_line(const Curve& curve) {
  return curve.style == CurveStyle::line || curve.style == CurveStyle::dashed ||
         curve.style == CurveStyle::dotted || curve.style == CurveStyle::thin ||
         curve.style == CurveStyle::band;
}

std::string thinning_text(const Figure& figure) {
  Eigen::Index longest = 0;
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves)
      if (is_line(curve)) longest = std::max({longest, curve.points, shown(panel, curve).x.size()});
  if (longest <= most_drawn_points) return "";
  return fmt::format(
      "The static picture and {}.csv show curves of up to {} points by {}: the lowest and the highest of "
      "each interval.",
      figure.name, longest, most_drawn_points);
}

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
      throw std::runtime_error("figure '" + figure.name + "': gnuplot wrote no whole " +
                               picture.filename().string() + "; is the disk full? " + gnuplot.output);
  }
}

std::optional<Panel> spectrum_panel(const std::vector<DrawnSignal>& signals, double interval,
                                    const std::string& label, double decades) {
  Panel panel{"", {"frequency [Hz]"}, {"amplitude of " + label, true}};
  double highest = 0, last = 0;
  for (const DrawnSignal& signal : signals) {
    const AmplitudeSpectrum spectrum = amplitude_spectrum(bridged_straight(signal.samples), interval);
    const Eigen::Index lines = spectrum.frequency_hz.size() - 1;  // without 0: the mean is taken off
    if (lines < 1) continue;
    highest = std::max(highest, spectrum.amplitude.tail(lines).maxCoeff());
    last = std::max(last, spectrum.frequency_hz[lines]);
    panel.line(signal.label, spectrum.frequency_hz.tail(lines), spectrum.amplitude.tail(lines),
               signal.colour);
  }
  if (!(highest > 0)) return std::nullopt;
  if (signals.size() == 1) panel.legend = Legend::none;
  return panel.across(0, last).up(std::pow(10.0, -decades) * highest, 2 * highest);
}

Panel reproduction_panel(const std::string& title, const Eigen::VectorXd& time,
                         const Eigen::VectorXd& measured, const std::vector<DrawnSignal>& reproduced,
                         const std::string& label) {
  Panel panel{title, {"time [s]"}, {label}};
  for (const DrawnSignal& one : reproduced) panel.line(one.label, time, one.samples, one.colour);
  return panel.thin("measured", time, measured, Colour::black).across(time[0], time[time.size() - 1]);
}

namespace {

double size_of(const Eigen::VectorXd& values) {
  return values.size() > 0 ? values.array().isFinite().select(values.array().abs(), 0.0).maxCoeff() : 0.0;
}

/// The next of ..., 1, 2, 5, 10, ... that is not below a size; 1 of zero.
double round_size(double most) {
  if (!(most > 0)) return 1;
  const double decade = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {1.0, 2.0, 5.0})
    if (most <= step * decade) return step * decade;
  return 10 * decade;
}

}  // namespace

Panel residual_panel(const std::string& title, const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                     const std::string& label, double largest) {
  const double most = round_size(largest > 0.0 ? largest : size_of(residual));
  Panel panel = Panel{title, {"time [s]"}, {"residual, " + label}}
                    .thin("", time, residual, Colour::black)
                    .across(time[0], time[time.size() - 1])
                    .up(-most, most)
                    .key(Legend::none);
  panel.y_axis.tick = most;
  return panel;
}

}  // namespace beamid::experiments
