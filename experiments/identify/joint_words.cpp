#include "experiments/identify/joint_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace beamid::experiments {

std::string agreement_words(const JointEstimate& estimate, const std::vector<std::string>& names) {
  if (estimate.freedom == 0) return "One record is left: nothing to agree with.";
  const std::string measured =
      fmt::format("chi-squared {:.3g} about the joint estimate, {:g} degrees of freedom, probability {:.2g}",
                  estimate.chi_squared, estimate.freedom, estimate.probability);
  if (estimate.agree())
    return fmt::format("The records agree within their noise ({}): what they tell adds up.", measured);
  std::string widened;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const double ratio = estimate.scatter[static_cast<Eigen::Index>(i)]; ratio > 1)
      widened += fmt::format("{}{} by {:.3g}", widened.empty() ? "" : ", ", names[i], ratio);
  return fmt::format(
      "THE RECORDS DISAGREE by more than their noise ({}). What they share is then no constant: damping and "
      "frequency that depend on amplitude, a clamp that moved, or motion that the model does not have. The "
      "joint intervals are widened by the scatter of the records, {} (Birge's ratio), which is itself known "
      "from so few records only.",
      measured, widened);
}

nlohmann::ordered_json agreement_values(const JointEstimate& estimate,
                                        const std::vector<std::string>& names) {
  nlohmann::ordered_json json{{"chi_squared", estimate.chi_squared},
                              {"degrees_of_freedom", estimate.freedom},
                              {"probability", estimate.probability},
                              {"agree", estimate.agree()}};
  for (std::size_t i = 0; i < names.size(); ++i)
    json["scatter"][names[i]] = estimate.scatter[static_cast<Eigen::Index>(i)];
  return json;
}

}  // namespace beamid::experiments
