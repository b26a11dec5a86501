// A structure under forces that nobody measured, as a family of linear models.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/config/experiment.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/text/progress.hpp"
#include "filters/innovation_likelihood.hpp"
#include "filters/latent_inputs.hpp"

namespace beamid::experiments {

// What of a record is read, and what of it serves as a check, where forces are taken for unknown.

struct SensingRecord {
  /// Measured outputs first, then the virtual sensors as channels that were never read (NaN), then measured
  /// inputs, then the unknown forces (zeros).
  Record record;
  Eigen::Index measured = 0;  ///< outputs that were read
  /// What the virtual sensors would have read, and the forces were, where that is known: of a simulated
  /// record, or a force that was measured and is taken for unknown. Empty: not known.
  std::vector<Eigen::VectorXd> sensors, forces;
};

/// @throws InputError where no output is left.
SensingRecord sensing_record(const Experiment& experiment, const Record& record, const Place& place);

/// The experiment's own test, simulated, with what the virtual sensors would read without noise.
SensingRecord simulated_sensing(const Experiment& experiment, const std::filesystem::path& folder,
                                const Place& place, const Progress& progress);

/// One entry of theta: a parameter of the structure, or ln of a number of the forces or of the sensors.
struct SensingConstant {
  enum class Kind { parameter, force_deviation, correlation_time, sensor_noise };
  Kind kind = Kind::parameter;
  std::string name, unit;
  std::size_t index = 0;                    ///< of the unknown, the force, the quantity
  std::vector<Eigen::Index> channels = {};  ///< that share the noise
};

/// The model at one theta, for any filter and as matrices.
struct SensingForm {
  std::shared_ptr<const filters::LatentInputs> latent;
  std::unique_ptr<filters::DiscreteModel> model;  ///< of z = [x; p; parameters]
  filters::Gaussian start;                        ///< of z, the parameters known
  std::vector<Eigen::Index> moving;               ///< entries of z but the parameters
  filters::LinearGaussian matrices;               ///< of those
  /// Output, and place of its sensor's offset in those: it depends on how many states the forces have.
  std::vector<std::pair<Eigen::Index, Eigen::Index>> offsets = {};

  Eigen::MatrixXd force_rows() const;  ///< that read the unknown forces of those (f x n)
  /// What output i reads of those, but for its sensor's own offset (1 x n).
  Eigen::MatrixXd row_without_offset(Eigen::Index i) const;
};

class SensingModel {
 public:
  /// @throws std::invalid_argument where the structure cannot be identified as described.
  SensingModel(const Experiment& experiment, const SensingRecord& record, const Choice& reduction,
               const std::filesystem::path& folder);

  /// Takes what another model of the same parameters, guessed elsewhere, knew of them beforehand.
  void take_prior(const SensingModel& other);

  const std::vector<SensingConstant>& constants() const { return constants_; }  ///< theta (q)
  const filters::Measurements& record() const { return *record_; }
  double interval() const { return record_->interval(); }
  Eigen::Index measured() const { return measured_; }  ///< outputs that were read, the first ones
  Eigen::Index outputs() const { return record_->outputs.rows(); }
  std::size_t forces() const { return forces_.size(); }
  Eigen::Index coordinates() const { return model_.motion_size(); }

  /// The model at theta; its outputs: measured, then virtual ones.
  filters::LinearGaussian at(const Eigen::VectorXd& theta) const { return form_at(theta).matrices; }
  SensingForm form_at(const Eigen::VectorXd& theta) const { return form(theta, forces_at(theta)); }
  /// Whether what is asked turns the shapes of the modes, so that at() is exact at the guess alone: a basis
  /// of reduced modes and the damping of modes are those of the guess.
  bool turns_shapes() const { return turns_shapes_; }
  /// The same model with the modes of the structure at theta; the scale of the start, forces, noise and prior
  /// stay. @throws as the constructor, std::runtime_error where there is no such structure
  SensingModel with_shapes_at(const Eigen::VectorXd& theta) const;
  /// With random walks in their place that change by as much from sample to sample: for filters that take
  /// nothing else for known of the forces.
  SensingForm form_of_walks(const Eigen::VectorXd& theta) const;
  bool has_offset(Eigen::Index i) const;
  /// theta of [[parameters]] as known beforehand, of the rest within a factor of about 20 of the guess.
  filters::Gaussian prior() const { return prior_; }
  filters::InnovationProblem problem(const filters::Measurements& record) const;
  /// With noise that the file states taken for `factor` times that: far from the truth all structures are
  /// infinitely unlikely, and the likelihood full of maxima.
  filters::InnovationProblem wider_problem(const filters::Measurements& record, double factor) const;

  /// How far forces and noise that are not stated may be from the guess, one deviation of ln: a factor of 20.
  static constexpr double known_within = 3.0;
  const Unknown& unknown(std::size_t parameter) const { return model_.unknowns[parameter]; }
  /// What theta stands for, in physical units, its theta, and by how much it changes with theta.
  double value(std::size_t constant, double theta) const;
  double place(std::size_t constant, double value) const;
  double slope(std::size_t constant, double theta) const;
  /// Standard deviations that forces and noise are taken to have at theta.
  std::vector<filters::LatentInput> forces_at(const Eigen::VectorXd& theta) const;
  Eigen::VectorXd noise_at(const Eigen::VectorXd& theta) const;  ///< (p)

  /// Combinations of constant forces that no sensor which was read can tell from rest.
  int unseen_constant_forces(const Eigen::VectorXd& theta) const;
  /// Outputs that were read without which more such combinations could not be told: what is constant rests on
  /// the zero of each alone.
  std::vector<Eigen::Index> sole_zeros(const Eigen::VectorXd& theta) const;

 private:
  void add_constants(const Experiment& experiment);
  void make_structure();
  void make_start();
  void make_prior();
  void guess_forces();
  Eigen::VectorXd parameters_at(const Eigen::VectorXd& theta) const;
  Eigen::MatrixXd constant_forces_read(const Eigen::VectorXd& theta) const;
  SensingForm form(const Eigen::VectorXd& theta, const std::vector<filters::LatentInput>& forces) const;

  ModelSetting setting_;
  filters::Options options_;  // of the model
  JointModel model_;
  std::shared_ptr<const filters::LinearMotion> motion_;
  bool turns_shapes_ = false;
  std::shared_ptr<const filters::Measurements> record_;
  Eigen::Index measured_ = 0;
  std::vector<filters::LatentInput> forces_;  // as stated; deviations and times guessed where not
  Eigen::VectorXd noise_;                     // likewise (p)
  std::vector<Eigen::Index> stated_;          // outputs whose noise the file states
  std::vector<SensingConstant> constants_;
  StartScale scale_;         // of the motion at the guess
  filters::Gaussian start_;  // of the motion's own state
  filters::Gaussian prior_;
};

/// Standard deviations that rows of a model's state have under its noise for ever, or where they grow without
/// end, after about as many samples from rest (c).
Eigen::VectorXd unread_deviations(const filters::LinearGaussian& model, const Eigen::MatrixXd& rows,
                                  Eigen::Index samples);

}  // namespace beamid::experiments
