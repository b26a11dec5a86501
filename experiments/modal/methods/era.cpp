// Eigensystem realisation of a free decay [juang1985].
#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "filters/whole_number.hpp"

namespace beamid::experiments {
namespace {

class EigensystemMethod final : public ModalMethod {
 public:
  explicit EigensystemMethod(Eigen::Index rows) { settings_.rows = rows; }

  PoleSearch search(const Eigen::MatrixXd& outputs, double interval, int largest_order) const override {
    PoleSearch found;
    found.decays = outputs;
    for (const EigensystemRealisation& realised :
         eigensystem_realisations(outputs, interval, largest_order, settings_)) {
      OrderPoles at{realised.order, {}};
      for (const IdentifiedMode& mode : realised.modes)
        if (mode.frequency_hz > 0) at.poles.push_back({mode.rate, mode.shape});
      found.orders.push_back(std::move(at));
      found.singular_values = realised.singular_values;
    }
    return found;
  }

 private:
  EigensystemSettings settings_;
};

const bool era_registered = modal_method_registry().add(
    {"era",
     "eigensystem realisation, for free decays",
     "[juang1985]",
     {{"rows", 0.0, "", "block rows of the Hankel matrix; 0: a third of the samples, at most 200 in all"}},
     {contract::free_decay},
     [](const filters::Options& options) {
       return std::make_unique<EigensystemMethod>(
           filters::whole_number(options.number("rows"), 0, "era", "rows"));
     }});

}  // namespace
}  // namespace beamid::experiments
