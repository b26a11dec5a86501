"""Errors of E I and of the first damping ratio by a Krylov reduction of the lightest beam: table of docs/theory/comparison.md.

    python3 tests/bench/seeds/reduction_path.py MOMENTS [--from 0] [--modes 7] [--held PERCENT] [--seeds 20] [--beamid build/release/bin/beamid]

Records of 10 s at 1 kHz hold damped sines at the exact frequencies of S(0.65), 7.9 m/s2 each with phases of their own,
ratios of 0.2 % for the first and 0.5 % for the others, and noise of 0.05 m/s2. --held: E I is no unknown, and so many
per cent off. Needs Python's standard library only.
"""
import argparse, json, math, pathlib, random, statistics, subprocess, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
MODULUS, RATIO, OTHERS, AMPLITUDE, NOISE, RATE, SAMPLES = 2.12e11, 0.002, 0.005, 7.9, 0.05, 1000.0, 10_000
BENDING = MODULUS * 0.06 * 0.006**3 / 12


def config(moments, first, held):
    text = f"""[beam]
length_m = 1.1
width_m = 0.06
height_m = 0.006
youngs_modulus_pa = {MODULUS * (1 + 0.01 * held)!r}
mass_kg = 3.055
tip_mass_kg = 0.0198575
elements = 30
[damping]
ratios = [{RATIO}, {OTHERS}]
[[sensors]]
quantity = "acceleration"
noise_m_per_s2 = {NOISE}
[record]
window_s = [{first}, {(SAMPLES - 100) / RATE}]
[model]
name = "beam"
[[parameters]]
quantity = "damping_ratio"
mode = 1
guess = {RATIO}
deviation = {RATIO}
[reduction]
method = "krylov"
moments = {moments}
"""
    return text if held else text + '[[parameters]]\nquantity = "bending_stiffness"\nrelative_deviation = 0.3\n'


def decay(frequencies, seed):
    numbers = random.Random(seed)
    sines = []
    for k, frequency in enumerate(frequencies):
        omega, ratio = 2 * math.pi * frequency, OTHERS if k else RATIO
        sines.append((ratio * omega, omega * math.sqrt(1 - ratio * ratio), numbers.uniform(0, 2 * math.pi)))
    lines = ["time_s,acceleration_tip_m_per_s2"]
    for i in range(SAMPLES):
        t = i / RATE
        value = sum(AMPLITUDE * math.exp(-fall * t) * math.cos(turn * t + phase) for fall, turn, phase in sines)
        lines.append(f"{t:.3f},{value + numbers.gauss(0, NOISE):.9g}")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("moments", type=int)
    parser.add_argument("--from", dest="first", type=float, default=0.0)
    parser.add_argument("--modes", type=int, default=7)
    parser.add_argument("--held", type=float, default=0.0)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--beamid", default=str(ROOT / "build/release/bin/beamid"))
    given = parser.parse_args()
    errors = {"bending_stiffness": [], "damping_ratio_1": []}
    truth = {"bending_stiffness": BENDING, "damping_ratio_1": RATIO}
    with tempfile.TemporaryDirectory() as folder:

        def run(*arguments):
            done = subprocess.run([given.beamid, *arguments, "--json"], cwd=folder, capture_output=True, text=True)
            if done.returncode not in (0, 3):
                raise RuntimeError(done.stderr)
            return json.loads(done.stdout)

        pathlib.Path(folder, "exact.toml").write_text(config(given.moments, given.first, 0.0))
        pathlib.Path(folder, "case.toml").write_text(config(given.moments, given.first, given.held))
        modes = run("modes", "--config", "exact.toml", "--modes", str(given.modes))["modes"]
        for seed in range(1, given.seeds + 1):
            pathlib.Path(folder, "decay.csv").write_text(decay([one["frequency_hz"] for one in modes], seed))
            for name, one in run("identify", "decay.csv", "--config", "case.toml")["runs"][0]["parameters"].items():
                name = name if name in errors else "damping_ratio_1"
                errors[name].append(100 * (one["estimate"] / truth[name] - 1))
    for name, values in errors.items():
        if len(values) > 1:
            rms = math.sqrt(sum(value * value for value in values) / len(values))
            print(f"{name}: mean {statistics.mean(values):+.4f} +- {statistics.stdev(values) / math.sqrt(len(values)):.4f} %, rms {rms:.4f} %")


if __name__ == "__main__":
    main()
