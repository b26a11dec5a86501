"""Acceptance over many seeds of the three systems of docs/study.md: tables of docs/theory/parts_of_structures.md.

    python3 tests/bench/seeds/three_systems.py CASE [--seeds 300] [--jobs 2] [--beamid build/release/bin/beamid]

CASE: building (floors 5 to 8 of twelve between measured floors), soil (three layers, all levels: joint and split).
Every seed has noise, forces and initial estimates of its own; nothing but Python's standard library is needed.
"""
import argparse, concurrent.futures, json, math, pathlib, random, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]


def parameter(name, quantity, unit, guess, deviation, region=None):
    text = f'[[parameters]]\nname = "{name}"\nquantity = "{quantity}"\nform = "logarithmic"\nrelative_deviation = {deviation}\n'
    if guess is not None:
        text += f"guess_{unit} = {guess!r}\n"
    if region:
        text += f"from_m = {region[0]}\nto_m = {region[1]}\n"
    return text


STIFFNESSES = [2.0e6] * 4 + [1.6e6] * 4 + [1.2e6] * 4
DASHPOTS = [0.006 / (2 * math.pi * 0.8387) * one for one in STIFFNESSES]


def twelve_storeys(seed, noise, floors):
    """Forces on floors 6 and 12, sensors on `floors`."""
    text = f"[chain]\nmasses_kg = {[1000.0] * 12}\nstiffnesses_n_per_m = {STIFFNESSES}\ndashpots_n_s_per_m = {DASHPOTS}\n"
    for floor in (6, 12):
        text += f'[[excitations]]\nkind = "random"\namplitude_n = 500\nfrequency_hz = 100\nposition_m = {floor}\n'
    text += f"[simulation]\nduration_s = 20\nsampling_rate_hz = 200\nsteps_per_sample = 1\nseed = {seed}\n"
    for i in floors:
        text += f'[[sensors]]\nname = "a{i}"\nposition_m = {i}\nnoise_m_per_s2 = {noise[i - 1]!r}\n'
    return text


def asked_storeys(random_numbers, storeys):
    """Stiffness and dashpot of each, half or half as much again guessed; and the truth."""
    text, truth = "", {}
    for i in storeys:
        for letter, quantity, unit, value in (("k", "storey_stiffness", "n_per_m", STIFFNESSES[i]), ("c", "storey_damping", "n_s_per_m", DASHPOTS[i])):
            truth[f"{letter}{i + 1}"] = value
            guess = value * random_numbers.choice((0.5, 1.5))
            text += parameter(f"{letter}{i + 1}", quantity, unit, guess, 0.5 if letter == "k" else 1.0, (i, i + 1))
    return text, truth


def building(random_numbers, seed, noise):
    asked, truth = asked_storeys(random_numbers, range(4, 9))
    text = twelve_storeys(seed, noise, range(1, 13)) + asked
    text += '[filter]\ndiscretisation = "pade"\n'
    text += '[[substructures]]\nname = "floors 5 to 8"\nfrom_m = 4\nto_m = 9\n'
    text += record_of([(i + 1, noise[i]) for i in range(12)], [6, 12], "a{:g}")
    return text, truth


def record_of(sensors, forces, name):
    text = '[record.time]\ncolumn = "time_s"\nunit = "s"\n'
    for place, noise in sensors:
        column = "acceleration_" + name.format(place).replace(".", "_") + "_m_per_s2"
        text += f'[[record.channels]]\ncolumn = "{column}"\nquantity = "acceleration"\nunit = "m/s2"\nposition_m = {place}\nnoise = {noise!r}\n'
    for place in forces:
        tip = "tip" if place == 12 else f"x{place:g}m".replace(".", "_")
        text += f'[[record.channels]]\ncolumn = "force_{tip}_n"\nquantity = "force"\nunit = "N"\nposition_m = {place}\n'
    return text


def soil(random_numbers, seed, noise, joint=True):
    k, c = [11.432e6, 9.728e6, 4.560e6], [72.6e3, 61.8e3, 29.0e3]
    k = [1900 * v * v / h for v, h in ((190, 6), (160, 5), (120, 6))]
    text = f"[chain]\ndashpots_n_s_per_m = {c}\n"
    for v, h in ((190, 6), (160, 5), (120, 6)):
        text += f"[[chain.layers]]\nthickness_m = {h}\ndensity_kg_per_m3 = 1900\nshear_wave_velocity_m_per_s = {v}\n"
    ground = ROOT / "docs/tutorials/21_soil_column/ground.csv"
    text += f'[excitation]\nkind = "base"\nfile = "{ground}"\n[acquisition]\nbase_noise_m_per_s2 = {noise[3]}\n'
    text += f"[simulation]\nduration_s = 30\nsampling_rate_hz = 100\nsteps_per_sample = 4\nseed = {seed}\n"
    heights, truth = (0, 6, 11, 17), {}
    for i in range(3):
        text += f'[[sensors]]\nname = "a{heights[i + 1]}"\nposition_m = {heights[i + 1]}\nnoise_m_per_s2 = {noise[i]}\n'
    for i in range(3):
        for letter, quantity, unit, value in (("k", "storey_stiffness", "n_per_m", k[i]), ("c", "storey_damping", "n_s_per_m", c[i])):
            truth[f"{letter}{3 - i}"] = value
            guess = value * math.exp(random_numbers.uniform(math.log(0.5), math.log(2)))
            text += parameter(f"{letter}{3 - i}", quantity, unit, guess, 0.7 if letter == "k" else 1.0, heights[i:i + 2])
    for name, section in (("upper", "from_m = 11"), ("middle", "from_m = 6\nto_m = 17"), ("lower", "to_m = 11")):
        text += f'[[substructures]]\nname = "{name}"\n{section}\n'
    text += '[model]\nname = "beam"\nsensor_bias = false\n[reduction]\nmethod = "none"\n[record]\ninput = "linear"\n'
    text += record_of([(heights[i + 1], noise[i]) for i in range(3)], [], "a{:g}")
    text += ('[[record.channels]]\ncolumn = "base_acceleration_m_per_s2"\nquantity = "base_acceleration"\nunit = "m/s2"\n'
             f"noise = {noise[3]}\n")
    return text, truth


def run(beamid, folder, *arguments):
    done = subprocess.run([beamid, *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 3):
        raise RuntimeError(f"{arguments}: {done.stderr}")
    return done.stdout


def rms_noise(beamid, make, channels, share):
    """Standard deviations that are `share` of each channel's root mean square."""
    with tempfile.TemporaryDirectory() as folder:
        text, _ = make(random.Random(0), 1, [1e-9] * channels)
        pathlib.Path(folder, "clean.toml").write_text(text)
        run(beamid, folder, "simulate", "--config", "clean.toml", "--out", "clean")
        lines = [line for line in pathlib.Path(folder, "clean/record.csv").read_text().splitlines() if not line.startswith("#")]
        names, rows = lines[0].split(","), [[float(x) for x in line.split(",")] for line in lines[1:]]
        columns = [i for i, name in enumerate(names) if name.startswith("acceleration")]
        return [share * math.sqrt(sum(row[i] ** 2 for row in rows) / len(rows)) for i in columns]


def solve(matrix, right):
    """Gauss."""
    n = len(right)
    rows = [list(matrix[i]) + [right[i]] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(i + 1, n):
            factor = rows[r][i] / rows[i][i]
            rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][j] * x[j] for j in range(i + 1, n))) / rows[i][i]
    return x


def one_seed(arguments):
    beamid, case, seed, noise = arguments
    make = CASES[case][0]
    with tempfile.TemporaryDirectory() as folder:
        text, truth = make(random.Random(seed), seed, noise)
        pathlib.Path(folder, "case.toml").write_text(text)
        run(beamid, folder, "simulate", "--config", "case.toml", "--out", "shaken")
        output = run(beamid, folder, "substructures", "shaken/record.csv", "--config", "case.toml", "--json", "--no-whole")
        joint = {}
        if case == "soil":
            joint = json.loads(run(beamid, folder, "identify", "shaken/record.csv", "--config", "case.toml", "--json"))
    values = json.loads(output)
    return seed, truth, {"parts": values["parts"]}, joint


def nees_of(part, truth, key):
    names = [one["name"] for one in part["parameters"]]
    if not all(name in truth for name in names):
        keep = [i for i, name in enumerate(names) if name in truth]
    else:
        keep = list(range(len(names)))
    white = [(part["parameters"][i]["value"] - truth[names[i]]) / part["parameters"][i][key] for i in keep]
    correlations = [[part["correlations"][i][j] for j in keep] for i in keep]
    return sum(a * b for a, b in zip(white, solve(correlations, white))), len(keep)


CASES = {"building": (building, 12), "soil": (soil, 4)}


def summary(title, rows):
    """rows: of every seed a list of (name, error, deviation, bound)."""
    print(f"\n{title}\n{'':8} {'bias/bound':>10} {'rms/bound':>10} {'rms/deviation':>13} {'worst [%]':>9} {'bound [%]':>9}")
    names = [one[0] for one in rows[0]]
    for i, name in enumerate(names):
        errors = [row[i] for row in rows]
        n = len(errors)
        bounds = [one[3] for one in errors]
        bias = sum(one[1] / one[3] for one in errors) / n
        rms = math.sqrt(sum((one[1] / one[3]) ** 2 for one in errors) / n)
        own = math.sqrt(sum((one[1] / one[2]) ** 2 for one in errors) / n)
        worst = max(100 * abs(one[1]) / one[4] for one in errors)
        print(f"{name:8} {bias:10.2f} {rms:10.3f} {own:13.3f} {worst:9.3f} {sum(100 * b / one[4] for b, one in zip(bounds, errors)) / n:9.3f}")


def options(doc, cases):
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", choices=cases)
    parser.add_argument("--seeds", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--beamid", default=str(ROOT / "build/release/bin/beamid"))
    parser.add_argument("--keep", help="file of the seeds that are done: what is there is not done again")
    return parser.parse_args()


def of_every_seed(given, one_seed, noise):
    """What one_seed((beamid, case, seed, noise)) returns, the seed its first entry, by seed."""
    keep = pathlib.Path(given.keep) if given.keep else None
    done = {one[0]: one for one in map(json.loads, keep.read_text().splitlines())} if keep and keep.exists() else {}
    tasks = [(given.beamid, given.case, seed, noise) for seed in range(1, given.seeds + 1) if seed not in done]
    with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
        for one in pool.map(one_seed, tasks):
            done[one[0]] = one
            if keep:
                with keep.open("a") as file:
                    file.write(json.dumps(one) + "\n")
    return [done[seed] for seed in sorted(done)]


def main():
    given = options(__doc__, CASES)
    make, channels = CASES[given.case]
    noise = [0.021, 0.036, 0.051, 0.01] if given.case == "soil" else rms_noise(given.beamid, make, channels, 0.05)
    collected = {"sections with their noise": {}, "sections taken for exact": {}}
    nees, lost, joint_rows, joint_lost = {key: {} for key in collected}, {key: 0 for key in collected}, [], 0
    for _, truth, values, joint in of_every_seed(given, one_seed, noise):
        for part in values["parts"]:
            for title, key, own in (("sections with their noise", "sections_noisy", "deviation"),
                                    ("sections taken for exact", "sections_exact", "own_deviation")):
                found = part[key]
                if found["status"] != "converged" and not (key == "sections_exact" and found["parameters"]):
                    lost[title] += 1
                    continue
                bounds = {one["name"]: one["bound"] for one in part["sections_noisy"]["parameters"]}
                rows = [(one["name"], one["value"] - truth[one["name"]], one[own], bounds[one["name"]], truth[one["name"]])
                        for one in found["parameters"] if one["name"] in truth and bounds.get(one["name"])]
                collected[title].setdefault(part["name"], []).append(rows)
                nees[title].setdefault(part["name"], []).append(nees_of(found, truth, own))
        if joint:
            runs = joint["runs"] if "runs" in joint else [joint]
            rows = []
            for name, one in runs[0].get("parameters", {}).items():
                if name in truth and one["bound"]:
                    rows.append((name, one["estimate"] - truth[name], one["standard_deviation"], one["bound"], truth[name]))
            if len(rows) == 6 and all(abs(row[1]) < 0.2 * row[4] for row in rows):
                joint_rows.append(rows)
            else:
                joint_lost += 1
    for title, parts in collected.items():
        for name, rows in parts.items():
            summary(f"{name}: {title}", rows)
            values = nees[title][name]
            freedom, n = values[0][1], len(values)
            width = 1.96 * math.sqrt(2 * freedom / n)
            print(f"NEES {sum(value for value, _ in values) / n:.2f} (95 % band {freedom - width:.2f} to {freedom + width:.2f}), {n} runs")
        print(f"{title}: {lost[title]} lost")
    if joint_rows:
        summary("joint", joint_rows)
    if given.case == "soil":
        print(f"joint: {joint_lost} of {given.seeds} lost")


if __name__ == "__main__":
    main()
