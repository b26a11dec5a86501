#include "experiments/config/section_keys.hpp"

namespace beamid::experiments {

const Schema<GivenSection>& section_keys() {
  using S = GivenSection;
  static const Schema<S> keys =
      Schema<S>("a section")
          .key("width_m", &S::width, positive, "rectangle: across the direction of bending", "0.060")
          .replaces({"diameter_m", "end_diameter_m"})
          .key("height_m", &S::height, positive, "rectangle: along the direction of bending", "0.006")
          .replaces({"diameter_m", "end_diameter_m"})
          .key("diameter_m", &S::diameter, positive, "circle, instead of width and height", "0.02")
          .excludes({"width_m", "height_m"}, "a rectangle or a circle")
          .replaces({"end_width_m", "end_height_m"})
          .key("end_width_m", &S::end_width, not_negative, "width at the segment's end; linear in between",
               "0.030")
          .fallback("the same")
          .key("end_height_m", &S::end_height, not_negative, "height there; 0 is a sharp tip", "0.003")
          .fallback("the same")
          .key("end_diameter_m", &S::end_diameter, not_negative, "diameter there", "0.01")
          .fallback("the same")
          .key("youngs_modulus_pa", &S::youngs_modulus, positive, "Young's modulus", "2.12e11")
          .fallback("either this, with the section,")
          .key("bending_stiffness_n_m2", &S::bending_stiffness, positive, "E I", "228.96")
          .fallback("or this")
          .excludes({"end_width_m", "end_height_m", "end_diameter_m"}, "youngs_modulus_pa")
          .key("mass_kg", &S::mass, positive, "mass of the segment alone, spread as its area", "3.055")
          .fallback("either this,")
          .key("mass_per_length_kg_per_m", &S::mass_per_length, positive, "rho A, the same all along",
               "2.777")
          .fallback("or this,")
          .key("density_kg_per_m3", &S::density, positive, "rho", "7850")
          .fallback("or this, with the section")
          .choice<bool S::*, bool>("theory", &S::timoshenko,
                                   {{"euler_bernoulli", false}, {"timoshenko", true}},
                                   "without or with shear deformation", "\"timoshenko\"")
          .key("poissons_ratio", &S::poissons_ratio, {.least = -1.0, .most = 0.5, .above = true},
               "gives the shear modulus, E / (2 (1 + nu)), and the shear factor", "0.3")
          .key("shear_modulus_pa", &S::shear_modulus, positive, "G", "8e10")
          .fallback("from Poisson's ratio")
          .key("shear_factor", &S::shear_factor, positive, "kappa of kappa G A", "0.8667")
          .fallback("Cowper's [cowper1966]")
          .key("shear_stiffness_n", &S::shear_stiffness, positive, "kappa G A itself", "2.5e7")
          .fallback("from those")
          .excludes({"poissons_ratio", "shear_modulus_pa", "shear_factor"})
          .key("rotary_inertia", &S::with_rotary_inertia,
               "of the section: rho I from its mass and dimensions", "true")
          .fallback("true for Timoshenko, else false")
          .key("rotary_inertia_kg_m", &S::rotary_inertia, not_negative, "rho I itself", "8.3e-6")
          .fallback("from those")
          .excludes({"rotary_inertia"})
          .exactly_one("bending stiffness", {"youngs_modulus_pa", "bending_stiffness_n_m2"})
          .exactly_one("mass", {"mass_kg", "mass_per_length_kg_per_m", "density_kg_per_m3"});
  return keys;
}

}  // namespace beamid::experiments
