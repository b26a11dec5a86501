#include "experiments/identify/stream/motion_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

// A mean m of variance P is predicted with P + R and moves by P / (P + R) of what it misses. An output's
// first reading is its mean's, and says nothing for either side: then neither counts.
void MotionEvidence::take_in(const VectorXd& output, const VectorXd& deviations,
                             const filters::Correction& correction, double mean_square) {
  if (seen_) return;
  if (mean_.size() == 0) mean_ = variance_ = VectorXd::Zero(output.size());
  // Of larger noise squares are divided by mean_square; what that does to determinants is the same for both.
  const double taken_back = mean_square > 1.0 ? 0.5 - 0.5 / mean_square : 0.0;
  double gain = correction.log_likelihood + taken_back * correction.normalised_square;
  bool known = correction.innovation.size() > 0;
  for (Index i = 0; i < output.size(); ++i) {
    if (!std::isfinite(output[i])) continue;
    const double noise = deviations[i] * deviations[i], error = output[i] - mean_[i];
    if (variance_[i] == 0.0) {
      known = false;
      mean_[i] = output[i], variance_[i] = noise;
      continue;
    }
    const double predicted = variance_[i] + noise, square = error * error / predicted;
    gain += 0.5 * (square + std::log(2.0 * std::numbers::pi * predicted)) - taken_back * square;
    mean_[i] += variance_[i] / predicted * error;
    variance_[i] *= noise / predicted;
  }
  if (known && std::isfinite(gain)) evidence_ += gain;
  seen_ = evidence_ > -std::log(unlikely);
}

nlohmann::ordered_json MotionEvidence::save() const {
  return {{"seen", seen_},
          {"evidence", evidence_},
          {"mean", std::vector<double>(mean_.begin(), mean_.end())},
          {"variance", std::vector<double>(variance_.begin(), variance_.end())}};
}

void MotionEvidence::resume(const nlohmann::json& saved, Index outputs) {
  MotionEvidence read;
  read.seen_ = saved.at("seen").get<bool>();
  read.evidence_ = saved.at("evidence").get<double>();
  const auto vector = [&](const char* key) {
    const auto values = saved.at(key).get<std::vector<double>>();
    if (!values.empty() && static_cast<Index>(values.size()) != outputs)
      throw std::invalid_argument(std::string("motion.") + key + " is not one number for every output");
    return VectorXd(Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size())));
  };
  read.mean_ = vector("mean");
  read.variance_ = vector("variance");
  if (read.mean_.size() != read.variance_.size() || (read.variance_.array() < 0.0).any())
    throw std::invalid_argument("motion.variance is none of motion.mean");
  *this = read;
}

}  // namespace beamid::experiments
