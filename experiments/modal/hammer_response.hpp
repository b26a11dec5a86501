// Frequency responses of a hammer test, and the modes at their peaks.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/poles.hpp"
#include "experiments/record/record.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

// Modes at the peaks of frequency responses, each from the lines around it.

/// One pole at each peak of sum_o |H_o / s^(k-1)|^2, the mobility, that rises to 1.2 times the valley between
/// it and any larger one. Over the lines above half of the peak's power, five at least,
///
///     H_o / s^k = B_o + R_o / (s - p)    <=>    s H_o / s^k = p H_o / s^k + B_o s + (R_o - B_o p),
///
/// linear in p, B_o and the rest: least squares, exact where nothing else varies over them. Where the width
/// alone would take all of H for the mode's, B_o stands for its neighbours; and lines need not be so dense
/// that a half-power point is met. [ewins2000, ch. 4]
///
/// Noise has peaks as well: one whose lines, five at least, are left by the fit to more than a tenth of the
/// mode's own part is none.
/// @param frequency_hz (F), rising; @param responses (p x F) at s = i 2 pi f + shift
/// @param power k: 0, 1, 2 for displacement, velocity, acceleration per force
/// @param smallest peak, over the largest
std::vector<Pole> poles_at_peaks(const Eigen::VectorXd& frequency_hz, const Eigen::MatrixXcd& responses,
                                 double shift, int power, double smallest);

// Frequency response functions from hits of an instrumented hammer.

/// One hit: where it begins, what of the force is its own, and how many pulses it has.
struct Hit {
  Eigen::Index onset = 0;        ///< sample at which the force rises
  Eigen::Index end = 0;          ///< one past the last sample of the force window
  Eigen::VectorXd force;         ///< (N of the record) [N]: baseline off, zero outside the window
  double impulse = 0;            ///< integral of it [N s]
  double largest = 0;            ///< [N]
  std::vector<double> pulses_s;  ///< after the onset, of each maximum above a tenth of the largest [s]
};

/// Hits of a force (N). The force window is 1 from the onset to the last sample above a twentieth of the
/// largest within 0.1 s, then falls as half a cosine over a quarter more or eight samples: what a sensor with
/// alternating-current coupling droops afterwards is no force.
/// @throws std::invalid_argument when there is none.
std::vector<Hit> find_hits(const Eigen::VectorXd& force, double interval);

/// Responses of p channels to the force, averaged over hits.
struct HammerResponses {
  Eigen::VectorXd frequency_hz;       ///< (F)
  Eigen::MatrixXcd h1, h2;            ///< (p x F) [unit of the channel / N], at s = i 2 pi f + window_rate
  Eigen::MatrixXd coherence;          ///< (p x F); 1 where there is one average only
  Eigen::VectorXd force_spectrum;     ///< (F), root mean square of |F(f)| over the hits [N s]
  Eigen::VectorXcd force_mean;        ///< (F), of F(f) over the hits, for its phase
  Eigen::VectorXd force_noise;        ///< standard deviation of each sample in the force window [N]
  double unresolved = 0;              ///< what sampling leaves of the mean momentum (hit_sampling.hpp)
  std::string coarse;                 ///< what is said of it; empty where the momentum is well resolved
  bool masses_lost = false;           ///< no mass stands that
  double pulse_s = 0;                 ///< about how long the pulses last [s]
  double interval = 0;                ///< of the records [s]
  int averages = 0;                   ///< hits
  double duration = 0;                ///< of a block [s]
  double window_rate = 0;             ///< of the exponential window [1/s]
  std::vector<std::string> remarks;   ///< sentences
  std::vector<Objection> objections;  ///< to the masses
};

/// H1 = S_yf / S_ff, H2 = S_yy / S_fy, coherence = |S_yf|^2 / (S_ff S_yy) over the hits of all records
/// [bendat2010, ch. 6-7]: H1 is biased by noise in the force, H2 by noise in the response.
///
/// Each block reaches from a hit to the next one or the record's end, all as long as the shortest. An
/// exponential window e^(-a t) on force and response alike makes H(s) exactly H(s + a): a motion from rest is
/// x = h * f, and e^(-a t) x = (e^(-a t) h) * (e^(-a t) f). Poles move by -a, which is taken off again; no
/// leakage is left but e^(-a T) of the motion.
/// @param window_end e^(-a T), what the window leaves at the end of a block, in (0, 1]; 1: no window
/// @throws std::invalid_argument when the records hold no force or no motion, or differ in channels or
/// interval.
HammerResponses hammer_responses(const std::vector<Record>& records, double window_end);

}  // namespace beamid::experiments
