// What an axial load does to the chord of an element.
#pragma once

#include <Eigen/Core>

namespace beamid::fem {

/// Appends to an element's strains the drift of its nodes against each other along `across`, e = across .
/// (d_2
/// - d_1) [m], of the rigidity -softening, softening = P/h [N/m] under a compression P (element.hpp). The
/// displacements of node 1 are the first coordinates, those of node 2 begin at `second`.
void add_chord(const Eigen::VectorXd& across, Eigen::Index second, double softening, Eigen::MatrixXd& strain,
               Eigen::MatrixXd& rigidity, Eigen::MatrixXd& flexibility);

}  // namespace beamid::fem
