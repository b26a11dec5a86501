"""Acceptance over many seeds of structures identified as a whole: table of docs/theory/frames.md.

    python3 tests/bench/seeds/structures.py CASE [--seeds 300] [--jobs 2] [--beamid build/release/bin/beamid]

CASE: building (stiffness and dashpot of each of twelve storeys, sensors on all floors), middle (the same, sensors on
floors 4 to 9), portal (columns, girder and damping of a plane frame on a shaking ground). Initial estimates are half
or half as much again of the truth; every seed has noise, forces and initial estimates of its own.
"""
import json, math, pathlib, random, tempfile

from three_systems import ROOT, asked_storeys, of_every_seed, options, record_of, rms_noise, run, summary, twelve_storeys

MODEL = '[model]\nname = "beam"\nsensor_bias = false\n'


def building(random_numbers, seed, noise, floors=range(1, 13)):
    asked, truth = asked_storeys(random_numbers, range(12))
    text = twelve_storeys(seed, noise, floors) + asked
    text += MODEL + '[filter]\ndiscretisation = "pade"\n[reduction]\nmethod = "none"\n'
    return text + record_of([(i, noise[i - 1]) for i in floors], [6, 12], "a{:g}"), truth


def middle(random_numbers, seed, noise):
    return building(random_numbers, seed, noise, range(4, 10))


def portal(random_numbers, seed, noise):
    joints = (("foot_a", 0, 0), ("foot_b", 5, 0), ("a1", 0, 3.2), ("b1", 5, 3.2), ("a2", 0, 6.4), ("b2", 5, 6.4))
    text = "[frame]\nelements_per_member = 4\njoints = [\n"
    for name, x, y in joints:
        text += f'  {{ name = "{name}", x_m = {x}, y_m = {y} }},\n'
    text += ']\nsupports = [{ joint = 1, kind = "clamped" }, { joint = 2, kind = "clamped" }]\nbodies = [\n'
    for joint, mass in ((3, 1500), (4, 1500), (5, 1200), (6, 1200)):
        text += f"  {{ joint = {joint}, mass_kg = {mass} }},\n"
    text += "]\n"
    for first, second in ((1, 3), (2, 4), (3, 5), (4, 6), (3, 4), (5, 6)):
        group, height = ("columns", 0.1) if second - first == 2 else ("girders", 0.12)
        text += (f'[[frame.members]]\nfirst = {first}\nsecond = {second}\ngroup = "{group}"\nwidth_m = 0.1\nheight_m = {height}\n'
                 "youngs_modulus_pa = 2.1e11\ndensity_kg_per_m3 = 7850\n")
    ground = ROOT / "docs/tutorials/15_shear_building/ground.csv"
    text += f'[damping]\nratio = 0.015\n[excitation]\nkind = "base"\nfile = "{ground}"\n'
    text += f"[simulation]\nduration_s = 20\nsampling_rate_hz = 100\nsteps_per_sample = 4\nseed = {seed}\n"
    for place, one in zip(("a1.x", "a2.x"), noise):
        text += f'[[sensors]]\nat = "{place}"\nnoise_m_per_s2 = {one!r}\n'
    truth = {"columns": 1.0, "girders": 1.0, "damping_ratio": 0.015}
    for name in ("columns", "girders"):
        text += (f'[[parameters]]\nquantity = "factor"\nname = "{name}"\nform = "logarithmic"\nrelative_deviation = 0.5\n'
                 f"guess = {random_numbers.choice((0.5, 1.5))}\n")
    text += '[[parameters]]\nquantity = "damping_ratio"\n'
    return text + MODEL + '[reduction]\nmethod = "modal_truncation"\nmodes = 6\n[compare]\npasses = 8\n', truth


CASES = {"building": (building, 12), "middle": (middle, 12), "portal": (portal, 2)}


def one_seed(arguments):
    beamid, case, seed, noise = arguments
    with tempfile.TemporaryDirectory() as folder:
        text, truth = CASES[case][0](random.Random(seed), seed, noise)
        pathlib.Path(folder, "case.toml").write_text(text)
        run(beamid, folder, "simulate", "--config", "case.toml", "--out", "shaken")
        found = json.loads(run(beamid, folder, "identify", "shaken/record.csv", "--config", "case.toml", "--json"))["runs"][0]
    return seed, found["status"], [
        (name, one["estimate"] - truth[name], one["standard_deviation"], one["bound"], truth[name])
        for name, one in found["parameters"].items() if name in truth and one["bound"]]


def main():
    given = options(__doc__, CASES)
    make, channels = CASES[given.case]
    noise = rms_noise(given.beamid, building if channels == 12 else make, channels, 0.05)
    done = of_every_seed(given, one_seed, noise)
    rows = [row for _, status, row in done if status == "converged"]
    lost = [seed for seed, status, _ in done if status != "converged"]
    summary(given.case, rows)
    squares = [(one[1] / one[3]) ** 2 for row in rows for one in row]
    inside = [abs(one[1]) < 1.96 * one[2] for row in rows for one in row]
    print(f"all: rms/bound {math.sqrt(sum(squares) / len(squares)):.3f}, inside 95 %: {100 * sum(inside) / len(inside):.1f} %; "
          f"{len(rows)} runs, not converged: {lost}")


if __name__ == "__main__":
    main()
