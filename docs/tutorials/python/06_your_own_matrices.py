# %% [markdown]
# # 6. Finite elements of your own
# M, C and K from any code, as a function of the parameters that are to be found. Here a row of ten bars between two walls, assembled in eight lines.

# %%
import beamid
import numpy as np

bars, length, density = 10, 0.1, 7850.0 * 1e-4


def rod(p):
    mass, stiffness = np.zeros((bars - 1, bars - 1)), np.zeros((bars - 1, bars - 1))
    for e in range(bars):
        k = (p.left if e < bars // 2 else p.right) * 1e6 / length
        for i in (e - 1, e):
            for j in (e - 1, e):
                if 0 <= i < bars - 1 and 0 <= j < bars - 1:
                    stiffness[i, j] += k if i == j else -k
                    mass[i, j] += density * length * (1 / 3 if i == j else 1 / 6)
    return mass, None, stiffness


system = beamid.System.of(rod, {"left": 21.0, "right": 21.0}, labels=[f"x{i}" for i in range(1, bars)])
modes = beamid.modes(system, modes=3).tables["modes"]["frequency_hz"]
exact = np.arange(1, 4) * np.sqrt(21e6 / density) / (2 * bars * length)
print("Hz:", modes.round(1), " continuum:", exact.round(1))
#> Hz: [2596.7 5257.6 8047.6]  continuum: [2586.1 5172.2 7758.3]

# %% [markdown]
# The stiffness of the right half has fallen by a tenth. Three measured frequencies say so, and that they cannot tell which half it is: the rod is the same seen from either end.

# %%
damaged = system.replace(parameters=[{**one, "value": 18.9} if one["name"] == "right" else one for one in system.parameters])
measured = beamid.modes(damaged, modes=3)
with open("modes.toml", "w") as file:
    for f in measured.tables["modes"]["frequency_hz"]:
        file.write(f"[[modes]]\nfrequency_hz = {f}\nfrequency_standard_deviation_hz = {1e-4 * f}\n")
asked = beamid.Experiment(system=system, parameters=[{"quantity": "factor", "name": name} for name in ("left", "right")])
found = beamid.update("modes.toml", asked)
print(found.report)
#> 2 sets of parameters meet these modes exactly and 1 more within their standard deviations, and the
#> modes cannot tell which is true: chi^2 = 1.32e-26 for 3 numbers measured and 2 parameters
#> determined; the 95 % limit is 3.84.
#>
#> Parameters
#> ==========
#>
#> parameter  unit  described  updated  95 % from      to  ratio  remark
#> ---------  ----  ---------  -------  ---------  ------  -----  ------
#> left                    21     18.9     14.759  23.041  0.900
#> right                   21       21     16.351  25.649  1.000
#>
#> Modes
#> =====
#>
#> mode  measured [Hz]  +- [Hz]  described [Hz]  updated [Hz]  difference [+-]
#> ----  -------------  -------  --------------  ------------  ---------------
#>    1      2530.1505       13       2596.7447     2530.1505            +0.00
#>    2      5115.6906       26       5257.6389     5115.6906            +0.00
#>    3      7842.0762       39       8047.6341     7842.0762            +0.00
#> +-: one standard deviation of the measurement, with 0.5 % of the frequency (--model-error).
#>
#> Other sets that fit as well
#> ===========================
#>
#> 151 of 300 starts reached the first set, 132 another one that fits as well, 17 ended at a worse one.
#>
#> Not proven complete, since the structure has 9 degrees of freedom, and 8 are the most for which all
#> solutions are computed: found by searches from 300 starts. The chance that one more start ends
#> elsewhere is about 0.33 % (sets that one start alone found).
#>
#> Sets of parameters
#> parameter          unit  set 1  set 2     set 3       set 4       set 5
#> -----------------  ----  -----  -----  --------  ----------  ----------
#> left                      18.9     21     19.92       4.973      228.94
#> right                       21   18.9     19.92      228.94       4.973
#> chi^2                        0      0  0.055711       13.97       13.97
#> likelihood / best            1      1   0.97253  0.00092549  0.00092549
#> starts                     151    131         1          10           7
#>
#> What would distinguish the sets
#> measurement                                                         kind         least distance [+-]
#> ------------------------------------------------------------------  -----------  -------------------
#> motion at x4 over that at x5 in mode 4: -6.63e+12 to 6.5            shape ratio                  3.6
#> the frequencies with 0.034 kg added at x6; mode 3: 7668 to 7737 Hz  added mass                   0.6
#> frequency of mode 5: 1.389e+04 to 1.39e+04 Hz                       frequency                    0.0
#> Of any two sets the smallest distance of the predictions, in standard deviations.
#>
