#include "experiments/results/gnuplot_layout.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/gnuplot_ticks.hpp"
#include "experiments/results/text.hpp"

namespace beamid::experiments {
namespace {

// [px] at the 13 px of the SVG's font.
constexpr double title_room = 40, no_title = 14, tick_room = 24, label_room = 24, key_row = 20, key_gap = 8;
constexpr double sample = 90, letter = 7.8;  // of an entry of a legend
constexpr double edge = 22;                  // right of a frame: half a tick's label

std::vector<std::string> legend_labels(const Panel& panel) {
  std::vector<std::string> labels;
  if (panel.legend == Legend::below)
    for (const Curve& curve : panel.curves)
      if (!curve.label.empty()) labels.push_back(curve.label);
  return labels;
}

int legend_columns(const std::vector<std::string>& labels, double width) {
  if (labels.empty()) return 0;
  std::size_t longest = 0;
  for (const std::string& label : labels) longest = std::max(longest, width_of(label));
  const int count = static_cast<int>(labels.size());
  const int fit =
      std::clamp(static_cast<int>(width / (sample + letter * static_cast<double>(longest))), 1, count);
  const int rows = (count + fit - 1) / fit;
  return (count + rows - 1) / rows;
}

double legend_height(const std::vector<std::string>& labels, int columns) {
  if (columns == 0) return 0;
  const int rows = (static_cast<int>(labels.size()) + columns - 1) / columns;
  return key_gap + key_row * rows;
}

/// The panel whose legend says all that the others' say: it is then said once, below the last row. -1: there
/// is none.
int common_legend(const Figure& figure) {
  std::vector<std::vector<std::string>> all;
  for (const Panel& panel : figure.panels) all.push_back(legend_labels(panel));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto holds = [&](const std::string& label) {
      return std::find(all[i].begin(), all[i].end(), label) != all[i].end();
    };
    if (!all[i].empty() && std::all_of(all.begin(), all.end(), [&](const auto& labels) {
          return std::all_of(labels.begin(), labels.end(), holds);
        }))
      return static_cast<int>(i);
  }
  return -1;
}

double remark_room(const Panel& panel) {
  return panel.remarks.empty() ? edge : 20 + named_ticks("y2", panel.remarks).widest;
}

double below_frame(const Panel& panel) {
  return tick_room + (panel.x_axis.label.empty() ? 0 : label_room);
}

}  // namespace

int picture_height(const Figure& figure) {
  return figure.height > 0 ? figure.height : figure.rows == 1 ? 460 : 330 * figure.rows;
}

std::vector<PanelPlace> panel_places(const Figure& figure, int height) {
  const auto count = static_cast<int>(figure.panels.size());
  const double cell = static_cast<double>(figure.width) / figure.columns;
  const int common = common_legend(figure);
  struct Row {
    double above = no_title, below = 0, key = 0;
  };
  std::vector<Row> rows(static_cast<std::size_t>((count + figure.columns - 1) / figure.columns));
  const auto row_of = [&](int i) -> Row& { return rows[static_cast<std::size_t>(i / figure.columns)]; };
  std::vector<PanelPlace> places(figure.panels.size());
  for (int i = 0; i < count; ++i) {
    const Panel& panel = figure.panels[static_cast<std::size_t>(i)];
    Row& row = row_of(i);
    if (!panel.title.empty()) row.above = title_room;
    row.below = std::max(row.below, below_frame(panel));
    if (common >= 0 && i != common) continue;
    const auto labels = legend_labels(panel);
    const int columns = legend_columns(labels, cell - 130);  // gnuplot makes it no wider than the frame
    places[static_cast<std::size_t>(i)].legend_columns = columns;
    double& key = (common >= 0 ? rows.back() : row).key;
    key = std::max(key, legend_height(labels, columns));
  }
  double taken = 0;
  for (const Row& row : rows) taken += row.above + row.below + row.key;
  constexpr double least_height = 40, last_margin = 4;
  const double frame =
      std::max(least_height, (height - taken - last_margin) / static_cast<double>(rows.size()));

  double top = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (int c = 0; c < figure.columns; ++c) {
      const std::size_t i = r * static_cast<std::size_t>(figure.columns) + static_cast<std::size_t>(c);
      if (i >= places.size()) break;
      places[i].top = top + rows[r].above;
      places[i].bottom = places[i].top + frame;
      places[i].legend_y = places[i].bottom + rows[r].below + key_gap;
    }
    top += rows[r].above + frame + rows[r].below + rows[r].key;
  }
  for (int c = 0; c < figure.columns; ++c) {
    double left = 0, right = edge;
    for (int i = c; i < count; i += figure.columns) {
      const Panel& panel = figure.panels[static_cast<std::size_t>(i)];
      left = std::max(left, drawn_y_axis(panel, frame).widest + (panel.y_axis.label.empty() ? 28 : 46));
      right = std::max(right, remark_room(panel));
    }
    for (int i = c; i < count; i += figure.columns) {
      PanelPlace& place = places[static_cast<std::size_t>(i)];
      place.left = c * cell + left;
      place.right = (c + 1) * cell - right;
      place.legend_x = common >= 0 ? 0.5 * figure.width : 0.5 * (place.left + place.right);
    }
  }
  if (common >= 0) places[static_cast<std::size_t>(common)].legend_y = top - rows.back().key + key_gap;
  return places;
}

}  // namespace beamid::experiments
