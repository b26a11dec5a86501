// A polynomial in time, fitted by least squares to each channel, subtracted.
#include <fmt/format.h>
#include <Eigen/QR>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "experiments/record/prepare/channel_step.hpp"

namespace beamid::experiments {
namespace {

/// Columns are the Chebyshev polynomials of degree 0 to n over the record, which keep the fit well posed.
Eigen::MatrixXd polynomials(const Eigen::VectorXd& time, int degree) {
  const double first = time[0], last = time[time.size() - 1];
  const Eigen::ArrayXd x = (2 * time.array() - first - last) / (last - first);
  Eigen::MatrixXd columns(time.size(), degree + 1);
  columns.col(0).setOnes();
  if (degree > 0) columns.col(1) = x;
  for (int n = 2; n <= degree; ++n)
    columns.col(n) = 2 * x * columns.col(n - 1).array() - columns.col(n - 2).array();
  return columns;
}

class Detrend final : public ChannelStep {
 public:
  explicit Detrend(const filters::Options& options)
      : ChannelStep(options), degree_(whole_option(options, "order", 0, 20)) {}

  static std::vector<filters::OptionSpec> options() {
    return {{"order", 1.0, "", "degree of the polynomial, 0 to 20"}, channels_option()};
  }

  std::string apply(Record& record) const override {
    if (record.size() <= Eigen::Index{2} * degree_)
      throw std::invalid_argument(
          fmt::format("{} samples; expected more than {} for a polynomial of order {}", record.size(),
                      2 * degree_, degree_));
    const Eigen::MatrixXd columns = polynomials(record.time, degree_);
    std::string text;
    for (const Eigen::Index row : rows(record)) {
      const Eigen::VectorXd signal = record.samples.row(row).transpose();
      std::vector<Eigen::Index> there;
      for (Eigen::Index k = 0; k < signal.size(); ++k)
        if (std::isfinite(signal[k])) there.push_back(k);
      const Eigen::HouseholderQR<Eigen::MatrixXd> fit(columns(there, Eigen::all));
      const Eigen::VectorXd trend = columns * fit.solve(signal(there));
      record.samples.row(row) = (signal - trend).transpose();
      text += fmt::format("{}up to {:.4g} {} from {}", text.empty() ? "" : ", ", trend.cwiseAbs().maxCoeff(),
                          si_unit(record.channels[row].quantity), words(record, {row}));
    }
    return fmt::format("Polynomial of order {} subtracted: {}.", degree_, text);
  }

  bool exact() const override { return false; }
  bool takes_any_record() const override { return true; }

 private:
  int degree_;
};

const bool detrend_registered =
    step_registry().add({"detrend",
                         "a polynomial in time, fitted by least squares, subtracted",
                         "",
                         Detrend::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Detrend>(o); }});

}  // namespace
}  // namespace beamid::experiments
