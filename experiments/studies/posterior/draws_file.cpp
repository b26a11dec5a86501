#include <hdf5.h>

#include <memory>
#include <numeric>
#include <stdexcept>

#include "experiments/record/files/hdf5/handle.hpp"
#include "experiments/studies/posterior/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

void require_written(herr_t result) {
  if (result < 0) throw std::runtime_error("cannot write the draws");
}

void put_text_attribute(hid_t object, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  require_written(H5Tset_size(type, text.size() + 1));
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require_written(H5Awrite(attribute, type, text.c_str()));
}

/// Datasets of one group over the dimensions chain and draw, dimension scales as netCDF 4 has them.
class DrawGroup {
 public:
  DrawGroup(hid_t file, const char* name, hsize_t chains, hsize_t draws)
      : size_{chains, draws},
        group_(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose) {
    const char* const names[] = {"chain", "draw"};
    for (int d = 0; d < 2; ++d) {
      std::vector<std::int64_t> places(size_[d]);
      std::iota(places.begin(), places.end(), 0);
      const Handle space(H5Screate_simple(1, &size_[d], nullptr), H5Sclose);
      const Handle set = dataset(names[d], H5T_STD_I64LE, space);
      require_written(H5Dwrite(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, places.data()));
      put_text_attribute(set, "CLASS", "DIMENSION_SCALE");
      put_text_attribute(set, "NAME", names[d]);
      require_written(H5Rcreate(&scale_[d], group_, names[d], H5R_OBJECT, -1));
    }
  }
  void text(const char* name, const std::string& text) const { put_text_attribute(group_, name, text); }

  /// @param values (draws x chains): column by column, which is (chain x draw) row by row.
  void add(const std::string& name, const std::string& unit, const Eigen::MatrixXd& values) const {
    const Handle space(H5Screate_simple(2, size_, nullptr), H5Sclose);
    const Handle set = dataset(name.c_str(), H5T_IEEE_F64LE, space);
    require_written(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    if (!unit.empty()) put_text_attribute(set, "units", unit);
    const Handle type(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose);
    const hsize_t two = 2;
    const Handle list(H5Screate_simple(1, &two, nullptr), H5Sclose);
    const Handle attribute(H5Acreate2(set, "DIMENSION_LIST", type, list, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    hobj_ref_t scale[] = {scale_[0], scale_[1]};
    const hvl_t references[] = {{1, &scale[0]}, {1, &scale[1]}};
    require_written(H5Awrite(attribute, type, references));
  }

 private:
  hsize_t size_[2];
  Handle group_;
  hobj_ref_t scale_[2] = {};

  Handle dataset(const char* name, hid_t type, hid_t space) const {
    const Handle timeless(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    require_written(H5Pset_obj_track_times(timeless, false));
    return {H5Dcreate2(group_, name, type, space, H5P_DEFAULT, timeless, H5P_DEFAULT), H5Dclose};
  }
};

}  // namespace

void write_draws(const PosteriorStudy& study, const std::filesystem::path& file) {
  const Posterior& posterior = study.posterior;
  const auto chains = static_cast<Index>(posterior.chains.size()),
             draws = posterior.chains.front().draws.cols();
  const Quiet quiet;
  const Handle out(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  const DrawGroup group(out, "posterior", static_cast<hsize_t>(chains), static_cast<hsize_t>(draws));
  group.text("inference_library", "beamid");
  for (std::size_t j = 0; j < study.unknowns().size(); ++j)
    group.add(study.unknowns()[j].name, study.unknowns()[j].unit, study.draws(j));
  Eigen::MatrixXd log(draws, chains), hump(draws, chains);
  for (Index c = 0; c < chains; ++c) {
    log.col(c) = posterior.chains[static_cast<std::size_t>(c)].log_posterior;
    for (Index k = 0; k < draws; ++k)
      hump(k, c) = static_cast<double>(
          posterior.hump_of[static_cast<std::size_t>(c)][static_cast<std::size_t>(k)] + 1);
  }
  const DrawGroup statistics(out, "sample_stats", static_cast<hsize_t>(chains), static_cast<hsize_t>(draws));
  statistics.text("inference_library", "beamid");
  statistics.add("lp", "", log);
  statistics.add("hump", "", hump);
}

}  // namespace beamid::experiments
