// Which reductions are compared when nobody says, and how they are called.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "experiments/config/experiment.hpp"
#include "experiments/results/page/swing_model.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"
#include "fem/assembly.hpp"
#include "fem/free_decay.hpp"
#include "fem/modes.hpp"
#include "fem/structural_system.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {

// The study's test, a release from a static deflection, as a record of it shows it.

/// A record of ten periods of the first mode. It holds the modes below half its sampling rate and no others,
/// for full and reduced models alike, as the anti-aliasing filter of an instrument leaves them: without that
/// limit the acceleration of a release depends on how many modes the mesh has, which is no property of the
/// beam.
struct ReleaseTest {
  fem::Point point;           ///< where it is pulled and let go
  double deflection = 0.012;  ///< there [m]
  double sampling_rate_hz = 0.0;
  Eigen::Index samples = 0;  ///< none: the beam can move without strain and has no static deflection
  Eigen::VectorXd initial;   ///< q(0) on the mesh (n)
  fem::DampingLaw damping;   ///< in time: a hysteretic law stands here as the ratios it shows

  double limit_hz() const { return 0.5 * sampling_rate_hz; }
  Eigen::VectorXd time() const;  ///< (N) [s]
};

/// @param damping in force. @param input that of the point, by its number in the system.
/// @param first_hz frequency of the first mode with strain. @param notes what a reader should know.
ReleaseTest plan_release(const Experiment& experiment, const fem::DampingLaw& damping,
                         const fem::StructuralSystem& system, Eigen::Index input, const fem::Point& point,
                         double first_hz, std::vector<std::string>& notes);

/// The motion of output 0 by exact modal superposition, after the mesh's deflection at the release was
/// projected on the model's modes, z_i = psi_i^T M q(0): every mode keeps the amplitude that the shapes leave
/// it.
/// @param system full or reduced, @param modes its lowest. @param shapes psi, the same on the mesh (n x k).
/// @param mass of the mesh (n x n).
fem::Motion decay(const ReleaseTest& test, const fem::StructuralSystem& system, const fem::Modes& modes,
                  const Eigen::MatrixXd& shapes, const fem::SparseMatrix& mass);

/// Every registered reduction but `none`, each with about three coordinates: three modes, or three masters
/// evenly along the beam; Rayleigh's has one, with each shape that the supports allow. Their places are
/// empty.
std::vector<Choice> default_reductions(const fem::Structure& structure);

/// Short and all different: the name; where it is there more than once, with the options that are not at
/// their defaults, "modal_truncation 3"; where that does not tell them apart, with a number, "guyan #2".
std::vector<std::string> labels(const std::vector<Choice>& choices);

// How well the modes of one model are those of another [allemang2003], [lieven1988].

/// MAC weighted with the mass, (phi_i^T M psi_j)^2 / (phi_i^T M phi_i  psi_j^T M psi_j) (k x l), of shapes
/// phi (n x k) and psi (n x l).
///
/// Modes are orthogonal in M: it is 0 for different modes of one model, and its rows and columns sum to at
/// most 1. The plain MAC of deflections has neither, and changes with the spacing of the nodes.
Eigen::MatrixXd mac(const Eigen::MatrixXd& phi, const Eigen::MatrixXd& psi, const fem::SparseMatrix& mass);

/// The plain MAC, without a weight, of deflections (p x k) and (p x l) at any points: (k x l).
Eigen::MatrixXd mac(const Eigen::MatrixXd& phi, const Eigen::MatrixXd& psi);

/// For each row of a mass-weighted MAC the column above 1/2, of which there is one at most, and no other row
/// has it: the mode that stands for this one. -1: none does.
std::vector<Eigen::Index> partners(const Eigen::MatrixXd& mac);

/// Co-ordinate MAC of k pairs of modes at each of p points,
///
///     (sum_i |phi_pi psi_pi|)^2 / (sum_i phi_pi^2  sum_i psi_pi^2)      (p)
///
/// @param phi, psi deflections (p x k), column i of one standing for column i of the other, each scaled to
/// unit modal mass. NaN where no mode of one of them moves the point, and everywhere for less than two pairs:
/// one pair alone gives 1 whatever its shapes are.
Eigen::VectorXd comac(const Eigen::MatrixXd& phi, const Eigen::MatrixXd& psi);

/// The point where modes agree least; NaN and -1 where there is no number, no point where all is 1 to 1e-9.
struct LowestComac {
  double value = 0.0;
  Eigen::Index point = -1;
};
LowestComac lowest_comac(const Eigen::VectorXd& comac);

// What an identification with a reduction gets wrong, by the order of the reduction.

struct RunContext;
struct ComparedRun;

/// Errors predicted for each parameter and order (errors_by_order()) as a table and as "orders" in the
/// values, and a sentence with the order for which they are least; neither where no order is to be chosen.
void add_orders(const RunContext& context, const ComparedRun& run, Results& results);

// What `beamid reduce` prints and writes.

// Frequency responses of two models, sampled so that no resonance of either is missed.

/// Frequencies from `from` to `to` [Hz], even on a logarithmic scale, and about each resonance closer
/// together the nearer to it: a step at the peak is a fortieth of its half-power width.
/// @param angular_frequency of the modes of every model [rad/s], zeros left aside.
Eigen::VectorXd response_grid(double from, double to, const std::vector<Eigen::VectorXd>& angular_frequency,
                              const fem::DampingLaw& damping);

struct ResponseDifference {
  double relative = 0.0;  ///< sqrt(integral (|H_r| - |H|)^2 df / integral |H|^2 df)
  double worst_db = 0.0;  ///< 20 log10 |H_r / H|, where its magnitude is largest
  double worst_hz = 0.0;  ///< NaN where nothing differs
};

/// @param full, reduced magnitudes at the frequencies, ascending (N).
ResponseDifference compare_magnitudes(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& full,
                                      const Eigen::VectorXd& reduced);

// Reductions of one beam against its mesh: what each of them keeps.

// What a model of a beam does, full or reduced: the numbers in which models are compared.

/// Its modes, and those on the mesh.
struct ModelModes {
  fem::Modes modes;        ///< the lowest k of the model
  Eigen::MatrixXd shapes;  ///< psi = Phi z (n x k), psi^T M psi = 1

  Eigen::Index elastic() const { return modes.size() - modes.rigid; }  ///< modes with strain
};

/// The lowest modes, at least so many and all below a frequency, as far as the model has them; 200 at most.
fem::Modes lowest_modes(const fem::StructuralSystem& system, Eigen::Index at_least, double below_hz);

/// The same, lifted to the mesh.
ModelModes lowest_modes(const reduction::ReducedModel& model, Eigen::Index at_least, double below_hz);

/// Seen at output 0; NaN where the model can move without strain, or its mode does not move the point.
struct ModelBehaviour {
  double static_stiffness = 0.0;  ///< K, a force at input 0 per deflection there [N/m]
  double modal_mass = 0.0;        ///< M of its first mode with strain, scaled to 1 there [kg]
  Eigen::VectorXd receptance;     ///< magnitude at the frequencies asked for [m/N]
  fem::Motion decay;              ///< after the release
  double decay_seconds = 0.0;     ///< that it took, by the clock [s]
};

/// @param frequency_hz of the receptance, from input 0 to output 0.
/// @param damping of the receptance; that of the decay is the test's.
ModelBehaviour behaviour_of(const fem::StructuralSystem& system, const ModelModes& modes,
                            const fem::SparseMatrix& mass, const fem::DampingLaw& damping,
                            const Eigen::VectorXd& frequency_hz, const ReleaseTest& test);

struct ReductionComparisonSettings {
  int modes = 5;       ///< compared, the lowest with strain
  double band = 20.0;  ///< frequency responses are compared from a fifth of the first frequency to this many
};

/// One reduction against the mesh. Errors are relative: 0.01 is a per cent, positive where the reduced model
/// has more. NaN: there is no such number.
struct ComparedReduction {
  Choice choice;
  std::string label;      ///< its name, and what tells it from others of that name
  Eigen::Index size = 0;  ///< r
  bool identity = false;  ///< nothing was reduced: there are no shapes to store

  std::vector<Eigen::Index> partner;  ///< of each mode compared: number of the model's mode; -1: none
  Eigen::VectorXd frequency_hz;       ///< of that (K)
  Eigen::VectorXd frequency_error;    ///< (K)
  Eigen::VectorXd mac;  ///< weighted with the mass (K); the best there is where there is no partner
  Eigen::VectorXd deflection_mac;  ///< plain, of deflections at the nodes (K)
  Eigen::VectorXd comac;           ///< of the modes that have a partner, at the nodes

  ModelBehaviour behaviour;
  double static_stiffness_error = 0.0;
  double modal_mass_error = 0.0;
  double response_error = 0.0;      ///< || |H_r| - |H| || / || |H| || over the band, L2
  double worst_response = 0.0;      ///< largest | log10 |H_r / H| |, in decibels
  double worst_response_hz = 0.0;   ///< where
  double displacement_error = 0.0;  ///< ||x_r - x|| / ||x|| over the record
  double acceleration_error = 0.0;

  Eigen::VectorXd significance;  ///< Bases::significance
  std::string significance_name;
  ModelModes modes;             ///< for pictures, not more than were compared
  double reduce_seconds = 0.0;  ///< that it took to reduce, by the clock [s]
};

struct ReductionComparison {
  ReductionComparisonSettings settings;
  fem::StructuralSystem system;  ///< of the mesh
  fem::Point observed;           ///< output 0 and input 0
  fem::DampingLaw damping;
  bool damping_assumed = false;  ///< the experiment describes none
  ModelModes modes;              ///< of the mesh: those compared begin after the rigid ones
  ModelBehaviour behaviour;
  ReleaseTest release;
  Eigen::VectorXd frequency_hz;  ///< of the frequency responses
  std::vector<ComparedReduction> reductions;
  std::vector<std::string> notes;

  Eigen::Index compared() const;  ///< K
  /// Frequency of compared mode i, from 0 [Hz].
  double mode_hz(Eigen::Index i) const { return modes.modes.frequency_hz()[modes.modes.rigid + i]; }
};

/// @param choices in their order. Those without a place were not asked for: one that cannot reduce the beam
/// is left out with a note.
/// @param folder in which shape files are looked for.
/// @throws InputError at the place of a choice that cannot reduce the beam, and as read_shape();
/// std::invalid_argument when the beam or its damping is impossible.
ReductionComparison compare_reductions(const Experiment& experiment, const std::vector<Choice>& choices,
                                       const ReductionComparisonSettings& settings,
                                       const std::filesystem::path& folder, const Progress& progress);

/// Tables reductions, equivalents, frequency_errors, mac, and significance where a method has one; comac.csv;
/// results.json with reductions[]; figures; a mesh for ParaView of the modes of each model.
Results report(const Experiment& experiment, const std::shared_ptr<const ReductionComparison>& comparison);

/// Its parts.
Table reduction_table(const ReductionComparison& all);
Table equivalent_table(const ReductionComparison& all);
/// The lowest modes of the mesh, and behind each its partners of the reductions, with their MAC, as one
/// model: so many as twelve shapes allow. The system needs a mesh.
SwingModel paired_modes(const fem::Structure& structure, const ReductionComparison& all);
Table frequency_table(const ReductionComparison& all);
Table mac_table(const ReductionComparison& all);
Table comac_table(const ReductionComparison& all);                        ///< a row for each node
std::optional<Table> significance_table(const ReductionComparison& all);  ///< absent: no method has any
nlohmann::ordered_json values(const ReductionComparison& all);
std::vector<Figure> figures(const ReductionComparison& all);

/// A label in the names of columns and files: letters, digits and '_'.
std::string key_of(const std::string& label);

}  // namespace beamid::experiments
