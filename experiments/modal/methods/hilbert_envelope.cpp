// Envelope and phase of each mode's analytic signal [feldman2011].
#include "experiments/modal/mode_by_mode.hpp"

namespace beamid::experiments {
namespace {

/// log|z(t)| = const - damping rate t, arg z(t) = const + w_d t: lines weighted by |z|^2.
class HilbertEnvelope final : public ModeByModeMethod {
  ModeAnswer estimate(const IsolatedMode& mode) const override {
    return {mode.rate(), mode.line.deviation, mode.line.deviation};
  }
};

const bool hilbert_envelope_registered = modal_method_registry().add(
    {"hilbert_envelope",
     "lines through the logarithm of each mode's envelope and through its phase, for free decays",
     "[feldman2011]",
     {},
     {contract::free_decay, contract::mode_by_mode},
     [](const filters::Options&) { return std::make_unique<HilbertEnvelope>(); }});

}  // namespace
}  // namespace beamid::experiments
