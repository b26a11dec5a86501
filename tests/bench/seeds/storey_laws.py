"""Acceptance over many seeds of storeys that follow laws: table of docs/theory/nonlinear_oscillators.md.

    python3 tests/bench/seeds/storey_laws.py LAW [--seeds 300] [--jobs 2] [--beamid build/release/bin/beamid]

LAW: duffing, bouc_wen or hyperbolic, of the lowest of three storeys under the ground's motion of tutorial 15. Every seed
has noise and initial estimates of its own, each estimate 30 % off, up or down. Needs Python's standard library only.
"""
import json, math, pathlib, random, tempfile
from three_systems import ROOT, of_every_seed, options, run, summary

STIFFNESSES, DASHPOT, NOISE = [4.0e5, 3.2e5, 2.4e5], 700.0, 0.02  # N/m, N s/m in every storey, m/s2
LAWS = {  # key of [[chain.storeys]], quantity, unit, truth
    "duffing": [("cubic_stiffness_n_per_m3", "cubic_stiffness", "n_per_m3", 5.0e8)],
    "bouc_wen": [("post_yield_ratio", "post_yield_ratio", None, 0.3), ("hysteresis_beta_per_m", "hysteresis_beta", "per_m", 60.0),
                 ("hysteresis_gamma_per_m", "hysteresis_gamma", "per_m", 40.0)],
    "hyperbolic": [("reference_drift_m", "reference_drift", "m", 0.02)]}


def building(law, stiffnesses, dashpot, values):
    text = f"[chain]\nmasses_kg = [1000, 1000, 800]\nstiffnesses_n_per_m = {stiffnesses}\ndashpots_n_s_per_m = {[dashpot] * 3}\n"
    text += f'[[chain.storeys]]\nstorey = 1\nlaw = "{law}"\n'
    return text + "".join(f"{key} = {value!r}\n" for (key, _, _, _), value in zip(LAWS[law], values))


def one_seed(arguments):
    """The seed, and of every parameter its name, error, standard deviation, bound and truth; None where lost."""
    beamid, law, seed, noise = arguments
    numbers = random.Random(seed)
    truth = [one[3] for one in LAWS[law]]
    made = building(law, STIFFNESSES, DASHPOT, truth)
    made += f'[excitation]\nkind = "base"\nfile = "{ROOT / "docs/tutorials/15_shear_building/ground.csv"}"\n'
    made += f"[simulation]\nduration_s = 20\nsampling_rate_hz = 50\nseed = {seed}\n"
    made += "".join(f'[[sensors]]\nquantity = "acceleration"\nposition_m = {i}\nnoise_m_per_s2 = {noise}\n' for i in (1, 2, 3))
    off = lambda value: value * numbers.choice((0.7, 1.3))
    asked = building(law, [off(one) for one in STIFFNESSES], off(DASHPOT), [off(one) for one in truth])
    expected = {}
    for i, stiffness in enumerate(STIFFNESSES):
        asked += f'[[parameters]]\nname = "k{i + 1}"\nquantity = "storey_stiffness"\nfrom_m = {i}\nto_m = {i + 1}\n'
        expected[f"k{i + 1}"] = stiffness
    asked += '[[parameters]]\nname = "c"\nquantity = "storey_damping"\n'
    expected["c"] = DASHPOT
    for _, quantity, _, value in LAWS[law]:
        asked += f'[[parameters]]\nname = "{quantity}"\nquantity = "{quantity}"\n'
        expected[quantity] = value
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "made.toml").write_text(made)
        pathlib.Path(folder, "asked.toml").write_text(asked)
        run(beamid, folder, "simulate", "--config", "made.toml", "--out", "shaken")
        try:
            found = json.loads(run(beamid, folder, "identify", "shaken/record.csv", "--config", "asked.toml", "--json"))
        except RuntimeError:
            return seed, None
    parameters = found["runs"][0].get("parameters", {})
    rows = [(name, parameters[name]["estimate"] - value, parameters[name]["standard_deviation"], parameters[name]["bound"], value)
            for name, value in expected.items() if name in parameters and parameters[name]["bound"]]
    return seed, rows if len(rows) == len(expected) else None


def main():
    given = options(__doc__, LAWS)
    found = [rows for _, rows in of_every_seed(given, one_seed, NOISE)]
    kept = [rows for rows in found if rows]
    summary(given.case, kept)
    each = [one for rows in kept for one in rows]
    together = math.sqrt(sum((one[1] / one[3]) ** 2 for one in each) / len(each))
    within = sum(abs(one[1]) < 1.96 * one[2] for one in each) / len(each)
    print(f"{len(kept)} records, {len(found) - len(kept)} lost; rms / bound of all {together:.3f}; 95 % intervals that hold {100 * within:.1f} %")


if __name__ == "__main__":
    main()
