# %% [markdown]
# # 5. A filter and a model of your own, in Python
# A filter is a class with `reset`, `predict`, `correct`, `mean` and `covariance`. Here an extended Kalman filter whose covariance is inflated a
# little at every step, which forgets the past.

# %%
import beamid
import numpy as np


def symmetric(covariance):
    return (covariance + covariance.T) / 2  # rounding leaves it less than that


class FadingFilter:
    def __init__(self, model, memory):
        self.model, self.memory = model, memory

    def reset(self, mean, covariance):
        self.mean, self.covariance = mean, covariance

    def predict(self, u):
        a = self.model.transition_jacobian(self.mean, u)
        self.mean = self.model.transition(self.mean, u)
        self.covariance = symmetric(a @ self.covariance @ a.T * np.exp(self.model.interval / self.memory))

    def correct(self, y, u):
        h, r = self.model.output_jacobian(self.mean, u), self.model.output_noise
        innovation, s = y - self.model.output(self.mean, u), h @ self.covariance @ h.T + r
        gain = np.linalg.solve(s, h @ self.covariance).T
        self.mean = self.mean + gain @ innovation
        self.covariance = symmetric((np.eye(len(self.mean)) - gain @ h) @ self.covariance)
        return innovation, s


beamid.register_filter("fading", FadingFilter, summary="forgets with a time constant", options={"memory": 1000.0})

# %% [markdown]
# Is it a filter? The suite that beamid's own filters must pass says so, or which of its tests failed and by how much.

# %%
import beamid.testing

found = beamid.testing.check_filter(FadingFilter, options={"memory": 1000.0})
print(sum(how == "passed" for how in found.values()), "tests passed,", sum(how == "skipped" for how in found.values()), "skipped: not promised")
#> 11 tests passed, 12 skipped: not promised

# %% [markdown]
# From there on it is a filter like the others: `identify`, `compare`, passes, noise from the record, intervals, verdict.

# %%
beam = beamid.Beam(length_m=1.1, width_m=0.06, height_m=0.006, youngs_modulus_pa=2.12e11, mass_kg=3.055, tip_mass_kg=0.36)
record = beamid.read("docs/tutorials/02_identify_a_record/tip_acceleration.csv")
compared = beamid.compare(record, beam, window_s=(2, 6), filter=["ekf", "fading"])
print(compared.frame("parameter_bending_stiffness")[["run", "estimate", "deviation_percent"]].round(4).to_string(index=False))
#>                              run  estimate  deviation_percent
#>               none, low_rank_ekf  228.8449             0.0049
#>                     none, fading  228.8450             0.0049
#>                    rayleigh, ekf  225.8847             0.0051
#>                 rayleigh, fading  225.8847             0.0051
#>            modal_truncation, ekf  228.8456             0.0051
#>         modal_truncation, fading  228.8456             0.0051
#>    modal_truncation:modes=3, ekf  228.8454             0.0048
#> modal_truncation:modes=3, fading  228.8454             0.0048

# %% [markdown]
# A model needs no structure at all. `run_filter` takes any object with `transition` and `output`; Jacobians are differences where it has none.

# %%
class Pendulum:
    interval = 0.01
    process_noise, output_noise = np.diag([0.0, 1e-6, 0.0]), np.array([[1e-4]])

    def transition(self, z, u):                      # angle, its rate, g / l
        rate = z[1] - self.interval * z[2] * np.sin(z[0])
        return np.array([z[0] + self.interval * rate, rate, z[2]])

    def output(self, z, u):
        return z[:1]


pendulum, state, angles = Pendulum(), np.array([1.2, 0.0, 9.81 / 0.7]), []
random = np.random.default_rng(1)
for _ in range(1000):
    angles.append(state[0] + 0.01 * random.normal())
    state = pendulum.transition(state, [])
for name in ("ekf", "ukf"):
    run = beamid.run_filter(name, pendulum, angles, mean=[1.0, 0.0, 12.0], covariance=[0.3, 0.3, 3.0])
    length = 9.81 / run.mean[2]
    print(f"{name}: a length of {length:.4f} +- {length * run.covariance[2, 2]**0.5 / run.mean[2]:.4f} m")
#> ekf: a length of 0.7000 +- 0.0003 m
#> ukf: a length of 0.7000 +- 0.0003 m
