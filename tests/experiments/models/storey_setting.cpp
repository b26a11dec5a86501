#include "tests/experiments/models/storey_setting.hpp"

#include "experiments/models/springs/spring_law.hpp"
#include "fem/assembly.hpp"

namespace beamid::test {

using namespace experiments;
using Eigen::Index, Eigen::MatrixXd;

StoreySpring spring(int storey, const std::string& law, const filters::Options& options) {
  return {storey, {law, spring_law_registry().completed(law, options)}};
}

const filters::Options bouc_wen{
    {"post_yield_ratio", 0.3}, {"hysteresis_beta_per_m", 60.0}, {"hysteresis_gamma_per_m", 25.0}};

ModelSetting setting_of(const fem::Storeys& storeys, const std::vector<StoreySpring>& springs) {
  const fem::Beam chain = fem::shear_building(storeys);
  std::vector<fem::Point> points;
  double height = 0.0;
  for (const fem::Segment& segment : chain.segments) {
    height += segment.length;
    points.push_back({"floor", height});
  }
  const auto floors = static_cast<Index>(points.size());
  ModelSetting setting;
  setting.system = fem::assemble(chain, static_cast<int>(floors), points);
  const MatrixXd rows = setting.system.outputs;
  setting.system.outputs = rows.replicate(3, 1).sparseView();
  setting.system.output_names.resize(static_cast<std::size_t>(3 * floors));
  for (const Quantity quantity : {Quantity::displacement, Quantity::velocity, Quantity::acceleration})
    for (Index i = 0; i < floors; ++i) setting.observations.push_back({quantity});
  setting.forces = {floors - 1, setting.system.inputs.cols() - 1};
  setting.storey_springs = springs;
  setting.continuum = ModelSetting::Continuum{chain, static_cast<int>(floors), points};
  return setting;
}

const fem::Storeys three{{1000, 900, 800}, {4.0e5, 3.2e5, 2.4e5}, {800, 640, 480}, {3, 3, 3}};

ParameterChoice asked(const std::string& quantity, std::optional<std::pair<double, double>> region) {
  ParameterChoice choice{quantity};
  choice.region = region;
  return choice;
}

}  // namespace beamid::test
