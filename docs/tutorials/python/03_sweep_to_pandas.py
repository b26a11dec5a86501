# %% [markdown]
# # 3. A test that is still to come, and a sweep to pandas
# A virtual test: a beam is released, a sensor records it, and the record is identified. How well does that work for which damping?

# %%
import beamid

beam = beamid.Beam(length_m=1.1, width_m=0.06, height_m=0.006, youngs_modulus_pa=2.12e11, mass_kg=3.055, tip_mass_kg=0.36, elements=20)
rig = beamid.Experiment(
    beam=beam,
    damping={"ratio": 0.01},
    sensors=[{"quantity": "displacement", "noise_m": 0.0003}],
    simulation={"duration_s": 4, "sampling_rate_hz": 40},
    reduction="modal_truncation",
    noise={"displacement_m": 0.0003},
    compare={"passes": 1})

# %% [markdown]
# What the test can tell at best, before anything is built: the Cramer-Rao bound.

# %%
best = beamid.identifiability(rig)
print(best.frame("parameters")[["parameter", "bound_percent", "verdict"]].round(3).to_string(index=False))
#>         parameter  bound_percent    verdict
#> bending_stiffness          0.035 determined
#>     damping_ratio          1.747 determined

# %% [markdown]
# The same test 40 times with other noise, for two damping ratios: bias, rms error, bound and coverage as a table.

# %%
swept = beamid.sweep(rig, vary="damping.ratio=0.002,0.02", seeds=40)
columns = ["damping.ratio", "bias_percent", "bias_standard_error_percent", "rms_over_bound", "coverage_percent"]
print(swept.frame("summary_damping")[columns].round(3).to_string(index=False))
#>  damping.ratio  bias_percent  bias_standard_error_percent  rms_over_bound  coverage_percent
#>          0.002         0.946                        1.019           1.049              97.5
#>          0.020        -0.176                        0.259           1.192              95.0

# %% [markdown]
# No bias beyond its standard error, an rms error as large as the bound, and intervals of 95 % that hold the truth as often as they say: the filter
# is as good as a filter can be, where the model is right. `swept.write("swept")` writes every case as a row of cases.csv.
