# %% [markdown]
# # 4. One record, several reductions
# The beam of the study, released, its tip's displacement read: what do one, two and four coordinates of different reductions find in the same record?

# %%
import beamid

beam = beamid.Beam(length_m=1.1, width_m=0.06, height_m=0.006, youngs_modulus_pa=2.12e11, mass_kg=3.055, tip_mass_kg=0.36)
record = beamid.read("docs/tutorials/02_identify_a_record/tip_acceleration.csv")
compared = beamid.compare(record, beam, window_s=(2, 6), model="beam", reduction=["rayleigh", "modal_truncation:modes=1", "craig_bampton:modes=1"])
print(compared.frame("runs")[["reduction", "coordinates", "status"]].to_string(index=False))
#>        reduction  coordinates    status
#>         rayleigh          1.0 converged
#> modal_truncation          1.0 converged
#>    craig_bampton          3.0 converged

# %% [markdown]
# All describe the record; they differ in the stiffness that they need for it. The table of each parameter has all.

# %%
table = compared.frame("parameter_bending_stiffness")
print(table[["run", "estimate", "deviation_percent"]].round(4).to_string(index=False))
#>              run  estimate  deviation_percent
#>         rayleigh  225.8847             0.0051
#> modal_truncation  228.8456             0.0051
#>    craig_bampton  228.7724             0.0048

# %% [markdown]
# The frequency is the record's, whatever the shape; a shape that is too stiff makes up for it with less E I. The study tells by how much:
# docs/study.md.
