#include "apps/python/module.hpp"

#include <charconv>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::python {
namespace {

namespace py = pybind11;
using experiments::Record;

void append_number(std::string& text, double value) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof(buffer), value).ptr);
}

/// Memory of the record's as an array that keeps the record alive and cannot be written to.
py::array view(std::vector<py::ssize_t> shape, const double* data, const py::capsule& owner) {
  py::array_t<double> array(std::move(shape), data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace

void write_columns(const std::string& file, const std::string& header,
                   const std::vector<py::array_t<double>>& columns) {
  std::vector<py::detail::unchecked_reference<double, 1>> values;
  for (const auto& column : columns) {
    values.push_back(column.unchecked<1>());
    if (values.back().shape(0) != values.front().shape(0))
      throw std::invalid_argument("columns of different lengths");
  }
  const py::gil_scoped_release release;
  std::string text = header + "\n";
  const py::ssize_t samples = values.empty() ? 0 : values.front().shape(0);
  for (py::ssize_t i = 0; i < samples; ++i)
    for (std::size_t k = 0; k < values.size(); ++k) {
      append_number(text, values[k](i));
      text += k + 1 < values.size() ? ',' : '\n';
    }
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error(file + ": cannot be written");
}

py::dict read_record(const std::string& file, const std::string& toml) {
  auto kept = std::make_unique<Record>();
  {
    const py::gil_scoped_release release;
    const experiments::TomlTable root = experiments::TomlTable::parse(toml, "record");
    experiments::refuse_unknown_keys(root);
    *kept = experiments::prepared_record(
        file, experiments::read_record_section(root.table("record"), nullptr).format);
  }
  const Record& record = *kept;
  const py::capsule owner(kept.release(), [](void* one) { delete static_cast<Record*>(one); });
  py::list channels;
  for (const experiments::Channel& channel : record.channels) {
    py::dict one;
    one["name"] = channel.name;
    one["quantity"] = experiments::to_string(channel.quantity);
    one["unit"] = experiments::si_unit(channel.quantity);
    one["position_m"] = channel.position ? py::cast(*channel.position) : py::none();
    channels.append(one);
  }
  py::dict found;
  found["time"] = view({record.size()}, record.time.data(), owner);
  found["samples"] = view({record.size(), record.samples.rows()}, record.samples.data(), owner);
  found["channels"] = channels;
  py::list remarks, warnings;
  for (const std::string& text : record.remarks) remarks.append(text);
  for (const experiments::Objection& one : record.objections) warnings.append(one.text);
  found["remarks"] = remarks;
  found["warnings"] = warnings;
  return found;
}

}  // namespace beamid::python
