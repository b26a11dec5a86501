#include "apps/method_options.hpp"

#include "experiments/config/failure_response.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/text/method_choice.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"
#include "filters/smoother.hpp"
#include "reduction/reduction.hpp"

namespace beamid::apps {
namespace {

constexpr const char* with_options = "NAME[:OPTION=VALUE,...]";

}  // namespace

Option filter_option(const std::string& help) {
  return text("filter", with_options, help).such_as(names_in(filters::filter_registry()));
}

Option reduction_option(const std::string& help) {
  return text("reduction", with_options, help).such_as(names_in(reduction::reduction_registry()));
}

Option modal_method_option(const std::string& help) {
  return text("method", with_options, help).such_as(names_in(experiments::modal_method_registry()));
}

Option discretisation_option(const std::string& help) {
  return text("discretisation", "NAME", help).such_as(names_in(filters::scheme_registry()));
}

Option smoother_option(const std::string& help) {
  return text("smoother", "NAME", help).one_of(names_in(filters::smoother_registry()));
}

Option model_option() {
  return text("model", "NAME", "what is asked: beamid list models")
      .by_default("beam")
      .such_as(names_in(experiments::model_registry()));
}

Option on_failure_option() {
  return text("on-failure", "WHAT",
              "when the filter fails: stop, inflate its covariance and go on, or report and go on")
      .by_default("stop")
      .one_of({"stop", "inflate", "report"});
}

void choose_model(const Values& values, experiments::Experiment& experiment) {
  experiments::Choice& model = experiment.model;
  if (values.has("model"))
    model = {values.text("model"), {}, {"--model"}};
  else if (model.place.line == 0)
    model.name = "beam";
  experiments::at_place(model.place, [&] {
    model.options = experiments::model_registry().completed(model.name, model.options);
  });
}

void choose_failure_response(const Values& values, experiments::Experiment& experiment) {
  if (values.has("on-failure"))
    experiment.on_failure = experiments::failure_response(values.text("on-failure"));
}

}  // namespace beamid::apps
