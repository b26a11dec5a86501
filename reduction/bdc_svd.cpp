#include "reduction/bdc_svd.hpp"

template class Eigen::BDCSVD<Eigen::MatrixXd>;
