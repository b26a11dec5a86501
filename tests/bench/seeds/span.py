"""Acceptance of a span of a beam between two measured sections over many seeds: docs/theory/parts_of_structures.md.

    python3 tests/bench/seeds/span.py [--seeds 100] [--jobs 2] [--rotations both|left|none] [--wrong CASE]

A simply supported girder of 30 m, 400 kg/m, E I 2.1 GN m2, its motion by its exact modes (80 of them, no elements):
random forces at 3 and 27 m that repeat after 2048 samples, from 1 Hz to --highest, in steady state; the record is
the first 1000 samples at 125 Hz. The span lies between 8 and 22 m. Noise 5 % of every channel, forces, noise and
initial estimates anew in each seed. Nothing but Python's standard library is needed.
"""
import argparse, cmath, concurrent.futures, json, math, pathlib, random, subprocess, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
LENGTH, MASS, STIFFNESS, BETA = 30.0, 400.0, 2.1e9, 2e-4  # m, kg/m, N m2, s (C = beta K)
RATE, PERIOD, SAMPLES, NOISE, MODES = 125.0, 2048, 1000, 0.05, 80
SECTIONS, FORCES = (8.0, 22.0), (3.0, 27.0)
CHANNELS = [("acceleration", 8.0), ("acceleration", 11.5), ("acceleration", 15.0), ("acceleration", 18.5),
            ("acceleration", 22.0), ("angular_acceleration", 8.0), ("angular_acceleration", 22.0)]


def responses(lines):
    """Acceleration of every channel for a unit force at every place, line by line."""
    def shape(n, quantity, x):
        wave = n * math.pi / LENGTH
        return wave * math.cos(wave * x) if quantity.startswith("angular") else math.sin(wave * x)
    modes = range(1, MODES + 1)
    omegas = [(n * math.pi / LENGTH) ** 2 * math.sqrt(STIFFNESS / MASS) for n in modes]
    factors = [[[2.0 / (MASS * LENGTH) * shape(n, *channel) * shape(n, "w", force) for n in modes] for force in FORCES] for channel in CHANNELS]
    found = []
    for line in lines:
        w = 2 * math.pi * RATE / PERIOD * line
        parts = [-w * w / (o * o - w * w + 1j * w * BETA * o * o) for o in omegas]
        found.append([[sum(a * b for a, b in zip(one, parts)) for one in channel] for channel in factors])
    return found


def transform(values):
    """sum_k X_k e^(2 pi i k t / M), M a power of 2."""
    n = len(values)
    if n == 1:
        return values
    even, odd = transform(values[::2]), transform(values[1::2])
    turned = [cmath.exp(2j * math.pi * k / n) * odd[k] for k in range(n // 2)]
    return [a + b for a, b in zip(even, turned)] + [a - b for a, b in zip(even, turned)]


def motion(numbers, lines, table):
    spectra = [[0j] * PERIOD for _ in CHANNELS]
    for line, responses_there in zip(lines, table):
        forces = [complex(numbers.gauss(0, 100), numbers.gauss(0, 100)) for _ in FORCES]
        for spectrum, channel in zip(spectra, responses_there):
            spectrum[line] = sum(a * b for a, b in zip(channel, forces))
    return [[value.real for value in transform(spectrum)[:SAMPLES]] for spectrum in spectra]


def config(numbers, deviations, given):
    text = f'[beam]\nlength_m = {LENGTH}\nmass_per_length_kg_per_m = {MASS}\nbending_stiffness_n_m2 = {STIFFNESS}\nsupport = "pinned-pinned"\nelements = 30\n'
    text += '[model]\nname = "beam"\n[reduction]\nmethod = "none"\n'
    for name, unit, value, deviation in (("bending_stiffness", "n_m2", STIFFNESS, 0.5), ("stiffness_damping", "s", BETA, 1.0)):
        guess = value * numbers.choice((0.5, 1.5))
        text += f'[[parameters]]\nquantity = "{name}"\nform = "logarithmic"\nguess_{unit} = {guess!r}\nrelative_deviation = {deviation}\n'
    text += f'[[substructures]]\nname = "span"\nfrom_m = {SECTIONS[0]}\nto_m = {SECTIONS[1]}\nhighest_hz = {given.highest}\n'
    text += '[record.time]\ncolumn = "time_s"\nunit = "s"\n'
    for i, ((quantity, place), deviation) in enumerate(zip(CHANNELS, deviations)):
        if quantity.startswith("angular") and (given.rotations == "none" or (given.rotations == "left" and place > 15)):
            continue
        unit = "rad/s2" if quantity.startswith("angular") else "m/s2"
        if given.wrong == "place" and place == 11.5:
            place = 12.5
        text += f'[[record.channels]]\ncolumn = "c{i}"\nquantity = "{quantity}"\nunit = "{unit}"\nposition_m = {place}\nnoise = {deviation!r}\n'
    return text


def one_seed(arguments):
    seed, lines, table, given = arguments
    numbers = random.Random(seed)
    clean = motion(numbers, lines, table)
    deviations = [NOISE * math.sqrt(sum(x * x for x in channel) / SAMPLES) for channel in clean]
    read = [[x + numbers.gauss(0, deviation) for x in channel] for channel, deviation in zip(clean, deviations)]
    if given.wrong == "sign":
        read[6] = [-x for x in read[6]]
    with tempfile.TemporaryDirectory() as folder:
        rows = ["time_s," + ",".join(f"c{i}" for i in range(len(CHANNELS)))]
        rows += [f"{k / RATE:.6f}," + ",".join(repr(channel[k]) for channel in read) for k in range(SAMPLES)]
        pathlib.Path(folder, "record.csv").write_text("\n".join(rows) + "\n")
        pathlib.Path(folder, "span.toml").write_text(config(numbers, deviations, given))
        done = subprocess.run([given.beamid, "substructures", "record.csv", "--config", "span.toml", "--json", "--no-whole"],
                              cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 3):
        raise RuntimeError(done.stderr)
    return seed, done.returncode, json.loads(done.stdout)["parts"][0]


def summary(title, runs, key):
    truth = {"bending_stiffness": STIFFNESS, "stiffness_damping": BETA}
    print(f"\n{title}\n{'':18} {'bias/bound':>10} {'rms/bound':>10} {'rms/deviation':>13} {'worst [%]':>9} {'bound [%]':>9}")
    kept = [part for part in runs if part[key]["parameters"] and part["sections_noisy"]["parameters"]]
    n = len(kept)
    squares = 0.0
    for j, (name, value) in enumerate(truth.items()):
        errors = [part[key]["parameters"][j]["value"] - value for part in kept]
        bounds = [part["sections_noisy"]["parameters"][j]["bound"] for part in kept]
        own = [part[key]["parameters"][j]["own_deviation"] for part in kept]
        print(f"{name:18} {sum(e / b for e, b in zip(errors, bounds)) / n:10.2f} "
              f"{math.sqrt(sum((e / b) ** 2 for e, b in zip(errors, bounds)) / n):10.3f} "
              f"{math.sqrt(sum((e / d) ** 2 for e, d in zip(errors, own)) / n):13.3f} "
              f"{100 * max(map(abs, errors)) / value:9.3f} {100 * sum(bounds) / n / value:9.3f}")
    for part in kept:
        a, b = [(one["value"] - value) / one["own_deviation"] for one, value in zip(part[key]["parameters"], truth.values())]
        r = part[key]["correlations"][0][1]
        squares += (a * a - 2 * r * a * b + b * b) / (1 - r * r)
    width = 1.96 * math.sqrt(2 * 2 / n)
    print(f"NEES {squares / n:.2f} (95 % band {2 - width:.2f} to {2 + width:.2f}), {n} runs")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--highest", type=float, default=37.5, help="Hz, of the forces and of the lines used")
    parser.add_argument("--rotations", choices=("both", "left", "none"), default="both", help="that are measured")
    parser.add_argument("--wrong", choices=("sign", "place"), help="the rotation at 22 m with the wrong sign; the sensor at 11.5 m said to be at 12.5 m")
    parser.add_argument("--beamid", default=str(ROOT / "build/release/bin/beamid"))
    given = parser.parse_args()
    lines = range(math.ceil(PERIOD / RATE), int(given.highest * PERIOD / RATE))
    table = responses(lines)
    with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
        done = list(pool.map(one_seed, [(seed, lines, table, given) for seed in range(1, given.seeds + 1)]))
    states = [part["sections_noisy"]["status"] for _, _, part in done]
    print({state: states.count(state) for state in set(states)}, "exit codes", sorted({code for _, code, _ in done}))
    good = [part for _, _, part in done if part["sections_noisy"]["status"] == "converged"]
    if good:
        summary("sections with their noise", good, "sections_noisy")
        summary("sections taken for exact", good, "sections_exact")


if __name__ == "__main__":
    main()
