#include "experiments/config/settings.hpp"

namespace beamid::experiments {

const char* to_string(Excitation::Kind kind) {
  switch (kind) {
    case Excitation::Kind::release:
      return "release";
    case Excitation::Kind::step:
      return "static";
    case Excitation::Kind::impulse:
      return "impulse";
    case Excitation::Kind::harmonic:
      return "harmonic";
    case Excitation::Kind::random:
      return "random";
    case Excitation::Kind::base:
      return "base";
    case Excitation::Kind::table:
      return "table";
    case Excitation::Kind::free:
      break;
  }
  return "none";
}

using Response = FrequencyResponseSettings::Kind;

const char* to_string(Response kind) {
  return kind == Response::receptance ? "receptance"
         : kind == Response::mobility ? "mobility"
                                      : "accelerance";
}

const char* unit_of(Response kind) {
  return kind == Response::receptance ? "m/N" : kind == Response::mobility ? "m/(N s)" : "1/kg";
}

const char* suffix_of(Response kind) {
  return kind == Response::receptance ? "m_per_n" : kind == Response::mobility ? "m_per_n_s" : "per_kg";
}

}  // namespace beamid::experiments
