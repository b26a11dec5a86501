// beamid._testing: the conformance suite of filters, on a filter that is a class of Python. A module of its
// own, so that nobody loads GoogleTest who does not test.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <stdexcept>

#include "apps/python/filters.hpp"
#include "beamid/testing/filter_contracts.hpp"

namespace beamid::test {
INSTANTIATE_TEST_SUITE_P(Python, EveryFilter, testing::Values("in_python"), by_name);
}  // namespace beamid::test

namespace beamid::python {
namespace {

namespace py = pybind11;

/// (test, "passed", "skipped" or "failed", what was said) of every test that ran.
class Collector final : public testing::EmptyTestEventListener {
 public:
  explicit Collector(py::list& found) : found_(found) {}
  void OnTestEnd(const testing::TestInfo& test) override {
    const testing::TestResult& result = *test.result();
    std::string said;
    constexpr int shown = 5;
    const int parts = result.total_part_count();
    for (int i = 0; i < std::min(parts, shown); ++i)
      said += (i ? "\n" : "") + std::string(result.GetTestPartResult(i).message());
    if (parts > shown) said += fmt::format("\n... and {} more of the kind", parts - shown);
    const char* const how = result.Failed() ? "failed" : result.Skipped() ? "skipped" : "passed";
    const std::string name = test.name();
    found_.append(py::make_tuple(name.substr(0, name.find('/')), how, said));
  }

 private:
  py::list& found_;
};

/// Once in a process: GoogleTest and the registry remember.
py::list check_filter(const std::vector<std::tuple<std::string, filters::OptionValue>>& options,
                      const std::set<std::string>& contracts, const py::object& make) {
  std::vector<filters::OptionSpec> specs;
  for (const auto& [option, fallback] : options)
    specs.push_back({option, fallback, "", "of a filter in Python"});
  filters::filter_registry().add(
      entry_of("in_python", "a filter in Python", "no source stated", std::move(specs), contracts, make));
  testing::InitGoogleTest();
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  delete listeners.Release(listeners.default_result_printer());
  py::list found;
  listeners.Append(new Collector(found));
  if (RUN_ALL_TESTS() != 0 && found.empty()) throw std::runtime_error("the suite did not run");
  return found;
}

}  // namespace

PYBIND11_MODULE(_testing, module) {
  add_model(module);
  module.def("check_filter", &check_filter);
}

}  // namespace beamid::python
