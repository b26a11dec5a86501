#include "experiments/results/page/figure_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "experiments/results/gnuplot.hpp"
#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Index, Eigen::VectorXd;

static_assert(std::endian::native == std::endian::little, "columns of a page are little-endian");

constexpr Index exact_values = 1000;  // of a column that keeps its 8 bytes
constexpr const char* style_names[] = {"line",        "dashed", "dotted",    "thin",   "points",
                                       "open_points", "stems",  "intervals", "arrows", "band"};

/// How values lie on a grid of equal steps, to 1e-9 of their span: each so many steps after the one before.
struct Grid {
  double step = 0.0;
  std::vector<unsigned> counts;  ///< the first is 0
  unsigned most = 0;
};

std::optional<Grid> grid_of(const VectorXd& values) {
  const Index last = values.size() - 1;
  if (last < 2 || !values.allFinite()) return std::nullopt;
  const double span = values[last] - values[0], allowed = 1e-9 * std::abs(span);
  const VectorXd gaps = values.tail(last) - values.head(last);
  // Of equal gaps their mean is the step; else the least is, where samples were left out of a grid.
  const double equal = span / static_cast<double>(last);
  const bool even = ((gaps.array() - equal).abs() <= allowed).all();
  const double intervals = even ? static_cast<double>(last) : std::round(span / gaps.minCoeff());
  if (!(intervals >= 1 && intervals < 1e9) || (!even && !(gaps.minCoeff() > 0))) return std::nullopt;
  Grid grid{span / intervals, {}, 0};
  double before = 0;
  for (const double value : values) {
    const double place = std::round((value - values[0]) / grid.step);
    if (!(std::abs(value - (values[0] + place * grid.step)) <= allowed)) return std::nullopt;
    grid.counts.push_back(static_cast<unsigned>(place - before));
    grid.most = std::max(grid.most, grid.counts.back());
    before = place;
  }
  return grid;
}

/// What a column keeps of its values.
enum class Coding {
  numbers,     ///< all digits of 8 or 4 bytes
  even,        ///< 2 bytes: one of 65 535 equal steps of the range
  logarithmic  ///< the same of the logarithm
};
constexpr unsigned no_code = 65535, most_code = 65534;  // of what is not finite; of the highest value

template <class Number>
void append(std::string& bytes, Number number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

bool fits_in_4_bytes(const VectorXd& values) {
  return std::all_of(values.begin(), values.end(), [](double value) {
    const double size = std::abs(value);
    return !std::isfinite(value) || size == 0 || (size > 1e-35 && size < 1e35);
  });
}

/// The bytes of a figure; a column that several curves have in common stands there once.
class PageColumns {
 public:
  Json add(const VectorXd& values, Coding coding = Coding::numbers) {
    if (const auto grid = grid_of(values)) {
      Json json{{"n", values.size()}, {"from", values[0]}, {"step", grid->step}};
      if (grid->most <= 1) return json;
      if (values.size() > exact_values && grid->most < no_code) return counted(*grid, std::move(json));
    }
    if (coding != Coding::numbers && values.size() > exact_values)
      if (const auto json = coded(values, coding)) return *json;
    std::string column;
    const bool small = values.size() > exact_values && fits_in_4_bytes(values);
    for (const double value : values)
      small ? append(column, static_cast<float>(value)) : append(column, value);
    return keep(column, small ? 4 : 8, {{"n", values.size()}});
  }
  const std::string& bytes() const { return bytes_; }

 private:
  Json keep(const std::string& column, int size, Json json) {
    json["size"] = size;
    for (const auto& [at, length] : columns_)
      if (length == column.size() && bytes_.compare(at, length, column) == 0) {
        json["at"] = at;
        return json;
      }
    json["at"] = bytes_.size();
    columns_.emplace_back(bytes_.size(), column.size());
    bytes_ += column;
    return json;
  }

  Json counted(const Grid& grid, Json json) {
    std::string column;
    const bool byte = grid.most < 256;
    for (const unsigned count : grid.counts)
      byte ? append(column, static_cast<std::uint8_t>(count))
           : append(column, static_cast<std::uint16_t>(count));
    json["counts"] = true;
    return keep(column, byte ? 1 : 2, std::move(json));
  }

  /// Absent where the values have no range, or no logarithm.
  std::optional<Json> coded(const VectorXd& values, Coding coding) {
    const bool logarithmic = coding == Coding::logarithmic;
    VectorXd drawn = values;
    if (logarithmic) drawn = values.array().log();
    double low = 1e300, high = -1e300;
    for (Index i = 0; i < drawn.size(); ++i) {
      if (std::isfinite(drawn[i])) low = std::min(low, drawn[i]), high = std::max(high, drawn[i]);
      if (std::isfinite(values[i]) && !std::isfinite(drawn[i])) return std::nullopt;
    }
    if (!(high > low)) return std::nullopt;
    const double step = (high - low) / most_code;
    std::string column;
    for (const double value : drawn)
      append(column, static_cast<std::uint16_t>(std::isfinite(value) ? std::lround((value - low) / step)
                                                                     : long{no_code}));
    Json json{{"n", values.size()}, {"low", low}, {"step", step}};
    if (logarithmic) json["log"] = true;
    return keep(column, 2, std::move(json));
  }

  std::string bytes_;
  std::vector<std::pair<std::size_t, std::size_t>> columns_;
};

Json axis_json(const Axis& axis, const DrawnAxis& drawn) {
  Json json{{"label", clean_text(typeset(axis.label))},
            {"log", axis.logarithmic && axis.names.empty()},
            {"range", {drawn.range.first, drawn.range.second}}};
  for (const std::string& name : axis.names) json["names"].push_back(clean_text(name));
  return json;
}

struct PageFigure {
  Json json;
  std::string bytes;
};

Json detail_json(const PointDetail& detail) {
  Json json{{"title", clean_text(detail.title)}, {"rows", Json::array()}};
  for (const std::vector<std::string>& row : detail.rows) {
    Json cells = Json::array();
    for (const std::string& cell : row) cells.push_back(clean_text(cell));
    json["rows"].push_back(std::move(cells));
  }
  for (const auto& [key, text] : {std::pair("note", &detail.note), std::pair("command", &detail.command),
                                  std::pair("mode", &detail.mode)})
    if (!text->empty()) json[key] = clean_text(*text);
  return json;
}

/// Of many poles by many channels the shapes would fill the page: curves beyond are without.
constexpr Index most_shape_values = 20'000;

/// What a click shows. Equal details of several curves stand once, in `all`.
void add_answers(const Curve& curve, PageColumns& columns, Index& shape_values, Json& all, Json& json) {
  for (const PointFact& fact : curve.facts)
    json["facts"].push_back(
        {{"label", clean_text(typeset(fact.label))}, {"values", columns.add(fact.values)}});
  const Index size = curve.shapes.size();
  if (size > 0 && shape_values + size <= most_shape_values) {
    shape_values += size;
    const Eigen::MatrixXcd scaled =
        curve.shapes *
        curve.shapes.cwiseAbs().colwise().maxCoeff().cwiseMax(1e-300).cwiseInverse().asDiagonal();
    const Eigen::MatrixXd real = scaled.real(), imaginary = scaled.imag();
    json["shapes"] = {columns.add(real.reshaped(), Coding::even),
                      columns.add(imaginary.reshaped(), Coding::even)};
  }
  for (const PointDetail& detail : curve.details) {
    Json one = detail_json(detail);
    const auto found = std::find(all.begin(), all.end(), one);
    json["details"].push_back(found - all.begin());
    if (found == all.end()) all.push_back(std::move(one));
  }
}

/// Which points of a line a page holds: an envelope of the whole, and of what the panel shows at first all,
/// or where that is much an envelope of its own.
std::vector<Index> kept_points(const Panel& panel, const Curve& curve, Index limit) {
  const VectorXd& decisive = curve.style == CurveStyle::band ? curve.upper : curve.y;
  const bool logarithmic = panel.x_axis.logarithmic;
  std::vector<Index> whole = envelope(curve.x, decisive, logarithmic, limit);
  if (!panel.x_axis.range || !curve.x.allFinite() || !std::is_sorted(curve.x.begin(), curve.x.end()))
    return whole;
  const auto [from, to] = *panel.x_axis.range;
  const Index begin = std::lower_bound(curve.x.begin(), curve.x.end(), from) - curve.x.begin();
  const Index count = std::upper_bound(curve.x.begin(), curve.x.end(), to) - curve.x.begin() - begin;
  if (count < 1 || 2 * count > curve.x.size()) return whole;
  std::vector<Index> shown =
      envelope(curve.x.segment(begin, count), decisive.segment(begin, count), logarithmic, limit);
  for (Index& i : shown) i += begin;
  std::vector<Index> both;
  std::set_union(whole.begin(), whole.end(), shown.begin(), shown.end(), std::back_inserter(both));
  return both;
}

/// How much of curves a page holds: lines of more points than `limit` are thinned, and where a page is full
/// its long columns are coded.
struct Detail {
  Index limit = 1;
  bool coded = false;
};

Json curve_json(const Panel& panel, const Curve& curve, const Detail& detail, PageColumns& columns,
                Index& longest) {
  const Index limit = detail.limit;
  const bool thins = is_line(curve) && curve.x.size() > limit;
  if (thins || curve.points > curve.x.size() || (detail.coded && curve.x.size() > exact_values))
    longest = std::max({longest, curve.x.size(), curve.points});
  const auto kept = thins ? kept_points(panel, curve, limit) : std::vector<Index>();
  const auto column = [&](const VectorXd& values, const Axis& axis) {
    const Coding coding = !detail.coded || !is_line(curve) ? Coding::numbers
                          : axis.logarithmic               ? Coding::logarithmic
                                                           : Coding::even;
    return columns.add(thins ? VectorXd(values(kept)) : values, coding);
  };
  const Axis& y_axis = panel.y_axis;
  Json json{{"label", clean_text(typeset(curve.label))},
            {"style", style_names[static_cast<std::size_t>(curve.style)]},
            {"x", columns.add(thins ? VectorXd(curve.x(kept)) : curve.x)}};
  if (curve.style != CurveStyle::band) json["y"] = column(curve.y, y_axis);
  if (curve.lower.size() > 0)
    json["lower"] = column(curve.lower, y_axis), json["upper"] = column(curve.upper, y_axis);
  return json;
}

/// What a page shows of curves of up to `longest` points, in a sentence. @param held most points of a curve
/// in it
std::string detail_text(const Detail& detail, Index longest, Index held) {
  const std::string rounded = detail.coded ? "rounded to 1/65 534 of their range" : "";
  if (longest > held)
    return fmt::format(
        "Curves of up to {} points are shown by {}: the lowest and the highest of each interval{}.", longest,
        held, rounded.empty() ? "" : ", " + rounded);
  return fmt::format("All {} points of the longest curve are here, {}.", longest, rounded);
}

PageFigure page_figure(const Figure& figure, const Detail& detail) {
  PageFigure page;
  PageColumns columns;
  Index longest = 0, held = 0, shape_values = 0;
  Json details = Json::array();
  const int height = picture_height(figure);
  const auto colours = colours_of(figure);
  const auto places = panel_places(figure, height);
  page.json = {{"name", figure.name},
               {"columns", figure.columns},
               {"row_height", std::max(200, height / figure.rows)}};
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    const PanelPlace& place = places[i];
    Json json{{"title", clean_text(typeset(panel.title))},
              {"x", axis_json(panel.x_axis, drawn_x_axis(panel, place.right - place.left))},
              {"y", axis_json(panel.y_axis, drawn_y_axis(panel, place.bottom - place.top))},
              {"curves", Json::array()}};
    for (const std::string& remark : panel.remarks) json["remarks"].push_back(clean_text(remark));
    for (const std::string& name : panel.channels) json["channels"].push_back(clean_text(name));
    for (const double at : panel.places) json["places"].push_back(at);
    // The last curves lie in front, stable poles among them: their shapes are kept first.
    std::vector<Json> answers(panel.curves.size(), Json::object());
    for (std::size_t k = panel.curves.size(); k-- > 0;)
      add_answers(panel.curves[k], columns, shape_values, details, answers[k]);
    int filled = 0, open = 0;
    for (std::size_t k = 0; k < panel.curves.size(); ++k) {
      const Curve& curve = panel.curves[k];
      Json drawn = curve_json(panel, curve, detail, columns, longest);
      held = std::max(held, drawn["x"]["n"].get<Index>());
      drawn["colour"] = colours[i][k];
      drawn["mark"] = curve.style == CurveStyle::points || curve.style == CurveStyle::intervals ? filled++
                      : curve.style == CurveStyle::open_points                                  ? open++
                                                                                                : 0;
      drawn.update(answers[k]);
      json["curves"].push_back(std::move(drawn));
    }
    page.json["panels"].push_back(std::move(json));
  }
  if (!details.empty()) page.json["details"] = std::move(details);
  if (longest > 0) page.json["thinned"] = detail_text(detail, longest, held);
  page.bytes = columns.bytes();
  return page;
}

}  // namespace

namespace {

/// Tenths as the shortest decimal number, with a blank before it unless its sign parts it from what is
/// before.
void append_tenths(std::string& path, long tenths, bool parted) {
  if (tenths < 0)
    path += '-';
  else if (parted)
    path += ' ';
  const long size = std::abs(tenths);
  if (size >= 10 || size == 0) path += std::to_string(size / 10);
  if (size % 10 != 0) (path += '.') += static_cast<char>('0' + size % 10);
}

/// "M79.20,375.01 L79.25,333.86 ..." with relative lines; anything else as it is.
std::string shorter_path(std::string_view path) {
  constexpr std::string_view blanks = " \t\r\n";
  std::string result;
  long before[2] = {0, 0};
  for (std::size_t at = path.find_first_not_of(blanks); at != std::string_view::npos;
       at = path.find_first_not_of(blanks, at)) {
    const char step = path[at++];
    if (step == 'Z' || step == 'z') {
      result += 'z';
      continue;
    }
    if (step != 'M' && (step != 'L' || result.empty() || result.back() == 'z')) return std::string(path);
    result += step == 'M' ? 'M' : 'l';
    for (const int axis : {0, 1}) {
      double place = 0;
      const auto [end, error] = std::from_chars(path.data() + at, path.data() + path.size(), place);
      if (error != std::errc() || !(std::abs(place) < 1e6)) return std::string(path);
      at = static_cast<std::size_t>(end - path.data());
      if (axis == 0 && (at == path.size() || path[at++] != ',')) return std::string(path);
      const long tenths = std::lround(10 * place);
      append_tenths(result, step == 'M' ? tenths : tenths - before[axis], axis == 1);
      before[axis] = tenths;
    }
  }
  return result;
}

}  // namespace

std::string picture_address(std::string_view svg) {
  constexpr std::string_view path_begin = " d='";
  std::string drawn;
  while (true) {
    const std::size_t begin = svg.find(path_begin), end = svg.find('\'', begin + path_begin.size());
    if (begin == std::string_view::npos || end == std::string_view::npos) break;
    drawn += svg.substr(0, begin + path_begin.size());
    drawn += shorter_path(svg.substr(begin + path_begin.size(), end - begin - path_begin.size()));
    svg.remove_prefix(end);
  }
  drawn += svg;
  std::string address = "data:image/svg+xml,";
  for (const char letter : drawn) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter == ' ' || letter == '\t' || letter == '\n' || letter == '\r') {
      if (!address.ends_with(' ')) address += ' ';
    } else if (byte < 0x20 || std::string_view("%#<>\"&:").find(letter) != std::string_view::npos) {
      address += fmt::format("%{:02X}", byte);
    } else {
      address += letter;
    }
  }
  return address;
}

std::vector<std::string> figure_attributes(const std::vector<Figure>& figures, std::size_t most) {
  constexpr Index least = 500;
  Detail detail;
  for (const Figure& figure : figures)
    for (const Panel& panel : figure.panels)
      for (const Curve& curve : panel.curves) detail.limit = std::max(detail.limit, curve.x.size());
  const Index longest = detail.limit;
  while (true) {
    std::vector<std::string> attributes;
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < figures.size(); ++i) {
      // Where points are omitted, what is folded at first, behind two figures, has a quarter of them.
      const bool quarter = i >= 2 && detail.limit < longest;
      const Index limit = quarter ? std::max(least, detail.limit / 4) : detail.limit;
      const PageFigure page = page_figure(figures[i], {limit, detail.coded});
      attributes.push_back(" data-figure=\"" +
                           base64(page.json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) +
                           "\" data-values=\"" + base64(page.bytes) + "\"");
      bytes += attributes.back().size();
    }
    if (bytes <= most || (detail.coded && detail.limit <= least)) return attributes;
    if (!std::exchange(detail.coded, true)) continue;
    const auto fraction = 0.95 * static_cast<double>(most) / static_cast<double>(bytes);
    detail.limit = std::max(least, static_cast<Index>(fraction * static_cast<double>(detail.limit)));
  }
}

}  // namespace beamid::experiments
