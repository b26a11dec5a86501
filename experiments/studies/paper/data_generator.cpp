#include "experiments/studies/paper/data_generator.hpp"

#include <map>

#include "experiments/models/joint_model.hpp"
#include "experiments/models/one_coordinate.hpp"
#include "fem/free_decay.hpp"
#include "fem/response/response.hpp"
#include "filters/scheme.hpp"

namespace beamid::experiments::paper {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd exact_decay(const Oscillator& truth, double release, const VectorXd& time) {
  const auto one = [](double value) { return VectorXd::Constant(1, value); };
  const fem::Motion motion =
      fem::free_decay(one(release), one(truth.angular_frequency()), one(truth.damping_ratio()), time);
  MatrixXd history(2, time.size());
  history << motion.displacement.transpose(), motion.velocity.transpose();
  return history;
}

MatrixXd newmark_decay(double beta, const Oscillator& truth, double release, double interval, Index samples) {
  const fem::Response response =
      fem::respond(one_coordinate(truth), fem::Undamped{}, {VectorXd::Constant(1, release), {}, {}},
                   {interval, samples + 1}, {"newmark", {{"beta", beta}}});
  MatrixXd history(2, samples);
  history << response.displacement.rightCols(samples), response.velocity.rightCols(samples);
  return history;
}

MatrixXd stepped_decay(const std::string& scheme, const Oscillator& truth, double release, double interval,
                       Index samples) {
  const auto model =
      model_registry().make("sdof", {}, at_one_point(one_coordinate(truth), {Quantity::displacement}));
  const auto method = filters::scheme_registry().make(scheme, {});
  MatrixXd history(2, samples);
  VectorXd state = Eigen::Vector4d(release, 0.0, truth.stiffness, truth.damping), next;
  for (Index k = 0; k < samples; ++k) {
    method->step(*model->motion, state, {}, interval, next, nullptr);
    history.col(k) = next.head<2>();
    state.swap(next);
  }
  return history;
}

}  // namespace

const std::vector<std::string>& data_generators() {
  static const std::vector<std::string> generators{
      "exact",         "average_acceleration", "linear_acceleration", "central_difference",
      "forward_euler", "backward_euler",       "runge_kutta_2",       "runge_kutta_4"};
  return generators;
}

MatrixXd generate_decay(const std::string& generator, const Oscillator& truth, double release,
                        double interval, Index samples) {
  static const std::map<std::string, double> beta{
      {"average_acceleration", 0.25}, {"linear_acceleration", 1.0 / 6.0}, {"central_difference", 0.0}};
  if (generator == "exact")
    return exact_decay(truth, release,
                       VectorXd::LinSpaced(samples, 1.0, static_cast<double>(samples)) * interval);
  const auto newmark = beta.find(generator);
  return newmark != beta.end() ? newmark_decay(newmark->second, truth, release, interval, samples)
                               : stepped_decay(generator, truth, release, interval, samples);
}

}  // namespace beamid::experiments::paper
