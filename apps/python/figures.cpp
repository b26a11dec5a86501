#include "apps/python/figures.hpp"

#include <pybind11/numpy.h>

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

py::dict curve_dict(const Curve& curve, const py::object& owner) {
  py::dict one;
  one["label"] = curve.label;
  one["style"] = style_name(curve.style);
  one["x"] = shared(curve.x, owner);
  one["y"] = shared(curve.y, owner);
  one["lower"] = shared(curve.lower, owner);
  one["upper"] = shared(curve.upper, owner);
  return one;
}

}  // namespace

py::dict figures(const Outcome& outcome, const py::object& owner) {
  py::dict all;
  if (!outcome.results) return all;
  for (const experiments::Figure& figure : outcome.results->figures) {
    py::list panels;
    for (const experiments::Panel& panel : figure.panels) {
      py::list curves;
      for (const Curve& curve : panel.curves) curves.append(curve_dict(curve, owner));
      py::dict one;
      one["title"] = panel.title;
      one["x_label"] = panel.x_axis.label;
      one["y_label"] = panel.y_axis.label;
      one["curves"] = curves;
      panels.append(one);
    }
    py::dict one;
    one["caption"] = figure.caption;
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
