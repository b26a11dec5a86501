#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>

#include <hdf5.h>

#include "experiments/config/description.hpp"
#include "experiments/record/files/hdf5/handle.hpp"
#include "experiments/studies/posterior/report.hpp"
#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json draw_values(const DrawSummary& summary) {
  return {{"mean", summary.mean},
          {"median", summary.median},
          {"standard_deviation", summary.deviation},
          {"lower_95", summary.lower_95},
          {"upper_95", summary.upper_95}};
}

Json parameter_values(const PosteriorStudy& study, std::size_t j) {
  const PosteriorParameter& one = study.parameters[j];
  Json json{{"name", study.unknowns()[j].name}, {"unit", study.unknowns()[j].unit}};
  json.update(draw_values(one.all));
  json["laplace_standard_deviation"] = one.laplace.front();
  json["r_hat"] = one.convergence.r_hat;
  json["effective_draws"] = one.convergence.effective_draws;
  json["prior"] = study.likelihood->priors()[j].text();
  json["prior_assumed"] = study.likelihood->priors()[j].assumed();
  json["width_over_prior"] = one.share_of_prior;
  json["piles_up_at_bound"] = one.cut_at ? Json(*one.cut_at) : Json(nullptr);
  json["in_tail_of_prior"] = one.in_tail;
  return json;
}

Json hump_values(const PosteriorStudy& study, std::size_t h) {
  Json json{{"probability", study.posterior.share[h]}, {"share_of_draws", study.posterior.chain_share[h]}};
  const Eigen::VectorXd top = study.likelihood->physical(study.posterior.humps[h].top);
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const DrawSummary& hump = study.parameters[j].humps[h];
    json["parameters"].push_back(
        {{"name", study.unknowns()[j].name},
         {"top", top[static_cast<Eigen::Index>(j)]},
         {"laplace_standard_deviation", study.parameters[j].laplace[h]},
         {"mean", hump.deviation > 0.0 ? Json(hump.mean) : Json(nullptr)},
         {"standard_deviation", hump.deviation > 0.0 ? Json(hump.deviation) : Json(nullptr)}});
  }
  return json;
}

}  // namespace

Json posterior_values(const PosteriorStudy& study) {
  const Posterior& posterior = study.posterior;
  Json json;
  json["verdict"] = posterior_verdict(study);
  json["status"] = !posterior.complaints().empty() ? "not converged"
                   : !study.explains()             ? "not explained"
                   : posterior.notable_humps() > 1 ? "several humps"
                                                   : "one hump";
  json["converged"] = posterior.complaints().empty();
  json["disagrees"] = posterior.disagrees();
  json["contradicted"] = study.contradicted();
  json["reasons"] = posterior.complaints();
  json["log_evidence"] = posterior.log_evidence();
  json["log_evidence_standard_error"] =
      number_or_null(posterior.importance.poor() ? std::nan("") : posterior.importance.standard_error);
  json["log_evidence_tempering"] = posterior.tempered.log_evidence;
  json["importance_effective_share"] = posterior.importance.effective_share;
  json["r_hat"] = posterior.worst_r_hat();
  json["effective_draws"] = posterior.fewest_effective();
  json["divergences"] = posterior.divergences();
  json["log_evidence_temperings_apart"] = posterior.tempered_apart;
  json["tempering_stages"] = posterior.tempered.stages;
  json["likelihood_evaluations"] = posterior.evaluations;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j)
    json["parameters"].push_back(parameter_values(study, j));
  for (std::size_t h = 0; h < posterior.humps.size(); ++h) json["humps"].push_back(hump_values(study, h));
  for (std::size_t i = 0; i < study.predicted.size(); ++i) {
    Json mode{{"measured_hz", study.update->data().modes[i].frequency_hz},
              {"standard_deviation_hz", study.update->residual->frequency_deviation(i)}};
    mode["predicted_hz"] = draw_values(study.predicted[i].drawn);
    mode["mac"] = number_or_null(study.predicted[i].mac);
    json["modes"].push_back(mode);
  }
  json["deciding_measurements"] = Json::array();
  if (posterior.humps.size() > 1 && study.update)
    for (const DecidingMeasurement& one : study.update->deciding)
      json["deciding_measurements"].push_back(
          {{"measurement", deciding_text(one)}, {"least_distance_standard_deviations", one.separation}});
  return json;
}

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
