// Methods of modal analysis: poles over model orders, found by name like every other method.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/modal/poles.hpp"
#include "experiments/text/objection.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

/// A pole that is no mode, and why.
struct RefusedPole {
  Pole pole;
  std::string reason;
};

/// What a method makes of a record.
struct PoleSearch {
  std::vector<OrderPoles> orders;   ///< by rising order
  Eigen::VectorXd singular_values;  ///< what the orders were cut from, falling
  /// (p x L) what the modes are to reproduce, first column at t = 0: the record itself where it is a free
  /// decay, else the autocorrelations of its channels, whose square roots are amplitudes.
  Eigen::MatrixXd decays;
  std::vector<RefusedPole> refused = {};  ///< of the contract mode_by_mode
  std::vector<std::string> remarks = {};  ///< sentences
  std::vector<Objection> objections = {};
};

/// One method, ready to run with its options.
class ModalMethod {
 public:
  virtual ~ModalMethod() = default;

  /// @param outputs (p x N), one column per instant, channels of about the same size
  /// @param largest_order of the models; orders are 2, 4, ... up to it, or as far as the record allows
  /// @throws std::invalid_argument when the record is too short or not finite.
  virtual PoleSearch search(const Eigen::MatrixXd& outputs, double interval, int largest_order) const = 0;

  /// The same of frequency responses (p x F) at s = i 2 pi f + shift, for the contracts
  /// frequency_response and measured_input.
  /// @throws std::invalid_argument from all other methods.
  virtual std::vector<OrderPoles> search_responses(const Eigen::VectorXd& frequency_hz,
                                                   const Eigen::MatrixXcd& responses, double shift,
                                                   int largest_order) const;
};

/// Contracts of methods.
namespace contract {
inline constexpr const char* free_decay = "free_decay";  ///< the record is one, and may be fitted as such
/// There are no orders to compare: the poles of the only one, 0, are the modes.
inline constexpr const char* mode_by_mode = "mode_by_mode";
inline constexpr const char* frequency_response = "frequency_response";  ///< a measured force is needed
inline constexpr const char* measured_input = "measured_input";          ///< that acts all the time is needed
}  // namespace contract

using ModalMethodRegistry = filters::Registry<ModalMethod>;
ModalMethodRegistry& modal_method_registry();

}  // namespace beamid::experiments
