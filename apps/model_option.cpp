#include "apps/model_option.hpp"

#include "experiments/models/joint_model.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::apps {

void choose_model(const options::variables_map& values, experiments::Experiment& experiment) {
  experiments::Choice& model = experiment.model;
  if (values.count("model"))
    model = {values["model"].as<std::string>(), {}, {"--model"}};
  else if (model.place.line == 0)
    model.name = "beam";
  experiments::at_place(model.place, [&] {
    model.options = experiments::model_registry().completed(model.name, model.options);
  });
}

}  // namespace beamid::apps
