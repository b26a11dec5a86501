#include "fem/elements/chord.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd;

void add_chord(const Eigen::VectorXd& across, Index second, double softening, MatrixXd& strain,
               MatrixXd& rigidity, MatrixXd& flexibility) {
  const Index last = strain.rows();
  for (MatrixXd* const factor : {&rigidity, &flexibility})
    factor->conservativeResizeLike(MatrixXd::Zero(last + 1, last + 1));
  strain.conservativeResizeLike(MatrixXd::Zero(last + 1, strain.cols()));
  strain.row(last).head(across.size()) = -across.transpose();
  strain.row(last).segment(second, across.size()) = across.transpose();
  rigidity(last, last) = -softening;
  flexibility(last, last) = -1.0 / softening;
}

}  // namespace beamid::fem
