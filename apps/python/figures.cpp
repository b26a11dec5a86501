#include "apps/python/module.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "experiments/results/gnuplot.hpp"

namespace beamid::python {
namespace {

namespace py = pybind11;
using experiments::Curve, experiments::CurveStyle;

const char* style_name(CurveStyle style) {
  switch (style) {
    case CurveStyle::line:
      return "line";
    case CurveStyle::dashed:
      return "dashed";
    case CurveStyle::dotted:
      return "dotted";
    case CurveStyle::thin:
      return "thin";
    case CurveStyle::points:
      return "points";
    case CurveStyle::open_points:
      return "open_points";
    case CurveStyle::stems:
      return "stems";
    case CurveStyle::intervals:
      return "intervals";
    case CurveStyle::arrows:
      return "arrows";
    default:
      return "band";
  }
}

py::object shared(const Eigen::VectorXd& values, const py::object& owner) {
  if (values.size() == 0) return py::none();
  py::array_t<double> array(values.size(), values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::dict curve_dict(const Curve& curve, const std::string& colour, const py::object& owner) {
  py::dict one;
  one["label"] = curve.label;
  one["style"] = style_name(curve.style);
  one["colour"] = colour;
  one["x"] = shared(curve.x, owner);
  one["y"] = shared(curve.y, owner);
  one["lower"] = shared(curve.lower, owner);
  one["upper"] = shared(curve.upper, owner);
  return one;
}

void add_axis(const experiments::Axis& axis, const std::string& name, py::dict& panel) {
  panel[py::str(name + "_label")] = axis.label;
  panel[py::str(name + "_logarithmic")] = axis.logarithmic;
  panel[py::str(name + "_range")] = axis.range;
  panel[py::str(name + "_names")] = axis.names;
}

}  // namespace

py::dict figures(const Outcome& outcome, const py::object& owner) {
  py::dict all;
  if (!outcome.results) return all;
  for (const experiments::Figure& figure : outcome.results->figures) {
    py::list panels;
    const std::vector<std::vector<std::string>> colours = colours_of(figure);
    for (std::size_t k = 0; k < figure.panels.size(); ++k) {
      const experiments::Panel& panel = figure.panels[k];
      py::list curves;
      for (std::size_t i = 0; i < panel.curves.size(); ++i)
        curves.append(curve_dict(panel.curves[i], colours[k][i], owner));
      py::dict one;
      one["title"] = panel.title;
      add_axis(panel.x_axis, "x", one);
      add_axis(panel.y_axis, "y", one);
      one["curves"] = curves;
      panels.append(one);
    }
    py::dict one;
    one["caption"] = figure.caption;
    one["rows"] = figure.rows;
    one["columns"] = figure.columns;
    one["width"] = figure.width;
    one["panels"] = panels;
    all[py::str(figure.name)] = one;
  }
  return all;
}

py::dict arrays(const Outcome& outcome, const py::object& owner) {
  py::dict all;
  if (!outcome.results) return all;
  for (const experiments::Array& one : outcome.results->arrays) {
    const py::ssize_t rows = one.values.rows(), columns = one.values.cols(), size = sizeof(double);
    py::array_t<double> array({columns, rows}, {rows * size, size}, one.values.data(), owner);
    array.attr("setflags")(py::arg("write") = false);
    all[py::make_tuple(one.run, one.name)] = array;
  }
  return all;
}

}  // namespace beamid::python
