// Whether a quantity of a decay follows its amplitude: laws weighed beside a constant.
#pragma once

#include <vector>

#include "experiments/identify/amplitude_law.hpp"
#include "experiments/identify/amplitude_sections.hpp"

namespace beamid::experiments {

/// Weighted line through the sections' values, a + b u.
struct SectionLine {
  double a = 0, b = 0, b_deviation = 0, u_mean = 0, squares = 0;
};

SectionLine section_line_through(const Eigen::VectorXd& u, const Eigen::VectorXd& v,
                                 const Eigen::VectorXd& deviation);

/// Frequency or damping of the sections.
struct SectionValues {
  Eigen::VectorXd value, deviation;
};

/// By how much they scatter about the nearest of the laws' lines: the probability of as much by noise, and
/// the standard deviation beyond it, by moments [dersimonian1986].
struct Scatter {
  double probability = 1, deviation = 0;
};

Scatter scatter_about_lines(const std::vector<Eigen::VectorXd>& shapes, const SectionValues& of,
                            double freedom);

/// Of a quantity by the laws: their probabilities beside that of a constant, and what it then is along the
/// decay.
/// @param usual standard deviation beforehand of the change over the decay, where there is one
SectionTrend trend_of(const std::vector<AmplitudeLaw>& laws, LawLine AmplitudeLaw::*line, double usual,
                      const Scatter& scatter);

}  // namespace beamid::experiments
