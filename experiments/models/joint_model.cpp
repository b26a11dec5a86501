#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

ModelRegistry& model_registry() {
  static ModelRegistry registry("model");
  return registry;
}

ModelSetting at_one_point(const fem::StructuralSystem& system, const std::vector<Quantity>& observed) {
  ModelSetting setting;
  setting.system = system;
  const Eigen::MatrixXd row = Eigen::MatrixXd(system.outputs).row(0);
  setting.system.outputs = row.replicate(static_cast<Eigen::Index>(observed.size()), 1).sparseView();
  setting.system.output_names.assign(observed.size(),
                                     system.output_names.empty() ? "" : system.output_names[0]);
  for (const Quantity quantity : observed) setting.observations.push_back({quantity});
  return setting;
}

void require_no_supports(const std::string& model, const ModelSetting& setting) {
  if (!setting.supports.empty())
    throw std::invalid_argument("model '" + model +
                                "' has no place for support_acceleration; expected [model] name = \"beam\"");
}

reduction::ReducedModel reduced(const ModelSetting& setting) {
  if (setting.reduction) return reduce(setting.system, *setting.reduction, setting.training);
  const auto none = reduction::reduction_registry().make("none", {});
  return reduce(setting.system, *none);
}

}  // namespace beamid::experiments
