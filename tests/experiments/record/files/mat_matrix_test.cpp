// Matrices of MATLAB files. Oracle: what was written, by matio.
#include "experiments/record/read_apart.hpp"

#include <gmock/gmock.h>
#include <matio.h>

#include <Eigen/Dense>
#include <filesystem>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments::mat_matrix_test {
namespace {

using Eigen::Matrix3d;

const Matrix3d full = (Matrix3d() << 2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.5).finished();

std::filesystem::path written(mat_ft version) {
  const auto path = std::filesystem::temp_directory_path() / (version == MAT_FT_MAT5 ? "m5.mat" : "m73.mat");
  std::filesystem::remove(path);
  mat_t* const file = Mat_CreateVer(path.c_str(), nullptr, version);
  Matrix3d values = full;
  std::size_t size[] = {3, 3};
  matvar_t* const dense = Mat_VarCreate("K", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, values.data(), 0);
  Mat_VarWrite(file, dense, MAT_COMPRESSION_NONE);
  Mat_VarFree(dense);
  mat_uint32_t rows[] = {0, 1, 2}, columns[] = {0, 1, 2, 3};
  double entries[] = {10.0, 20.0, 30.0};
  mat_sparse_t sparse{};
  sparse.nzmax = sparse.nir = sparse.ndata = 3;
  sparse.ir = rows, sparse.jc = columns, sparse.njc = 4, sparse.data = entries;
  matvar_t* const lumped =
      Mat_VarCreate("M", MAT_C_SPARSE, MAT_T_DOUBLE, 2, size, &sparse, MAT_F_DONT_COPY_DATA);
  Mat_VarWrite(file, lumped, MAT_COMPRESSION_NONE);
  Mat_VarFree(lumped);
  Mat_Close(file);
  return path;
}

TEST(MatMatrix, IsWhatWasWrittenFullOrSparse) {
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    const auto path = written(version);
    EXPECT_EQ(Matrix3d(read_mat_matrix(path, "K")), full);
    EXPECT_EQ(Matrix3d(read_mat_matrix(path, "M")), Matrix3d(Eigen::Vector3d(10.0, 20.0, 30.0).asDiagonal()));
  }
}

TEST(MatMatrix, IsAskedForByNameWhereThereAreSeveral) {
  const auto path = written(MAT_FT_MAT5);
  EXPECT_THAT([&] { read_mat_matrix(path, ""); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("2 matrices; expected the name of one")));
  EXPECT_THAT([&] { read_mat_matrix(path, "C"); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("no real matrix 'C'")));
}

}  // namespace
}  // namespace beamid::experiments::mat_matrix_test
