// Singular values by divide and conquer, compiled once: a unit that does it anew takes 28 s more.
#pragma once

#include <Eigen/SVD>

extern template class Eigen::BDCSVD<Eigen::MatrixXd>;
