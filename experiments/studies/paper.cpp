// The 2009 steel-beam study [inverse2009]: reproduced, explained and put right.
#include <chrono>
#include <cmath>

#include "experiments/studies/paper/report.hpp"
#include "experiments/studies/study.hpp"

namespace beamid::experiments {
namespace {

class PaperStudy final : public Study {
 public:
  PaperStudy(double seed, double trials) {
    if (!(seed >= 0.0 && seed == std::floor(seed) && seed < 0x1p53))
      throw std::invalid_argument("seed must be a whole number from 0");
    if (!(trials >= 2.0 && trials == std::floor(trials) && trials <= 1e6))
      throw std::invalid_argument("trials must be a whole number from 2 to 1000000");
    seed_ = static_cast<std::uint64_t>(seed);
    trials_ = static_cast<int>(trials);
  }

  Results run(const Progress& progress) const override {
    const auto begin = std::chrono::steady_clock::now();
    const paper::Outcome outcome = paper::investigate(seed_, trials_, progress);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    Results results;
    results.command = "paper";
    results.seed = seed_;
    results.configuration = paper::configuration(outcome);
    results.values = paper::values(outcome);
    paper::add_finding(outcome, results);
    results.figures = paper::figures(outcome);
    results.attachments = {paper::mode_shapes(outcome)};
    results.timing = {{"identification", taken.count()}};
    return results;
  }

 private:
  std::uint64_t seed_ = 0;
  int trials_ = 0;
};

const bool paper_registered = study_registry().add(
    {"paper",
     "the 2009 steel-beam study: reproduced, explained and corrected",
     "[inverse2009]",
     {{"seed", 2009.0, "", "seed of the sensor noise; the same seed gives the same bytes"},
      {"trials", 100.0, "", "seeded repetitions per beam against the Cramer-Rao bound"}},
     {},
     [](const filters::Options& options) {
       return std::make_unique<PaperStudy>(options.number("seed"), options.number("trials"));
     }});

}  // namespace
}  // namespace beamid::experiments
