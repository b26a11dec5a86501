#include "experiments/results/page/figure_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

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

/// The step of equally spaced values.
std::optional<double> step_of(const VectorXd& values) {
  const Index last = values.size() - 1;
  if (last < 2 || !values.allFinite()) return std::nullopt;
  const double step = (values[last] - values[0]) / static_cast<double>(last);
  const double allowed = 1e-9 * std::abs(values[last] - values[0]);
  for (Index i = 0; i <= last; ++i)
    if (std::abs(values[i] - (values[0] + static_cast<double>(i) * step)) > allowed) return std::nullopt;
  return step;
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
  Json add(const VectorXd& values) {
    if (const auto step = step_of(values))
      return {{"n", values.size()}, {"from", values[0]}, {"step", *step}};
    std::string column;
    const bool small = values.size() > exact_values && fits_in_4_bytes(values);
    const std::size_t size = small ? 4 : 8;
    column.resize(size * static_cast<std::size_t>(values.size()));
    for (Index i = 0; i < values.size(); ++i) {
      char* const place = column.data() + size * static_cast<std::size_t>(i);
      const auto single = static_cast<float>(values[i]);
      small ? std::memcpy(place, &single, 4) : std::memcpy(place, &values[i], 8);
    }
    for (const auto& [at, length] : columns_)
      if (length == column.size() && bytes_.compare(at, length, column) == 0)
        return {{"n", values.size()}, {"at", at}, {"size", size}};
    columns_.emplace_back(bytes_.size(), column.size());
    bytes_ += column;
    return {{"n", values.size()}, {"at", columns_.back().first}, {"size", size}};
  }
  const std::string& bytes() const { return bytes_; }

 private:
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

Json curve_json(const Panel& panel, const Curve& curve, Index limit, PageColumns& columns, Index& longest) {
  const VectorXd& decisive = curve.style == CurveStyle::band ? curve.upper : curve.y;
  const bool thins = is_line(curve) && curve.x.size() > limit;
  if (thins) longest = std::max(longest, curve.x.size());
  const auto kept =
      thins ? envelope(curve.x, decisive, panel.x_axis.logarithmic, limit) : std::vector<Index>();
  const auto column = [&](const VectorXd& values) {
    return columns.add(thins ? VectorXd(values(kept)) : values);
  };
  Json json{{"label", clean_text(typeset(curve.label))},
            {"style", style_names[static_cast<std::size_t>(curve.style)]},
            {"x", column(curve.x)}};
  if (curve.style != CurveStyle::band) json["y"] = column(curve.y);
  if (curve.lower.size() > 0) json["lower"] = column(curve.lower), json["upper"] = column(curve.upper);
  return json;
}

PageFigure page_figure(const Figure& figure, Index limit) {
  PageFigure page;
  PageColumns columns;
  Index longest = 0;
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
    int filled = 0, open = 0;
    for (std::size_t k = 0; k < panel.curves.size(); ++k) {
      const Curve& curve = panel.curves[k];
      Json drawn = curve_json(panel, curve, limit, columns, longest);
      drawn["colour"] = colours[i][k];
      drawn["mark"] = curve.style == CurveStyle::points || curve.style == CurveStyle::intervals ? filled++
                      : curve.style == CurveStyle::open_points                                  ? open++
                                                                                                : 0;
      json["curves"].push_back(std::move(drawn));
    }
    page.json["panels"].push_back(std::move(json));
  }
  if (longest > 0)
    page.json["thinned"] =
        fmt::format("Curves of up to {} points are shown by {}: the lowest and the highest of each interval.",
                    longest, limit);
  page.bytes = columns.bytes();
  return page;
}

}  // namespace

std::vector<std::string> figure_attributes(const std::vector<Figure>& figures, std::size_t most) {
  constexpr Index least = 500;
  Index limit = 1;
  for (const Figure& figure : figures)
    for (const Panel& panel : figure.panels)
      for (const Curve& curve : panel.curves) limit = std::max(limit, curve.x.size());
  while (true) {
    std::vector<std::string> attributes;
    std::size_t bytes = 0;
    for (const Figure& figure : figures) {
      const PageFigure page = page_figure(figure, limit);
      attributes.push_back(" data-figure=\"" +
                           base64(page.json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) +
                           "\" data-values=\"" + base64(page.bytes) + "\"");
      bytes += attributes.back().size();
    }
    if (bytes <= most || limit <= least) return attributes;
    const auto fraction = 0.9 * static_cast<double>(most) / static_cast<double>(bytes);
    limit = std::max(least, static_cast<Index>(fraction * static_cast<double>(limit)));
  }
}

}  // namespace beamid::experiments
