#!/usr/bin/python3
"""Size and power of the objections, on records made without beamid:  objection_sizes.py BEAMID [FIRST [COUNT [KIND ...]]]

Healthy records, COUNT each (default 20): free decays of cantilevers with a tip mass by finite elements of NumPy (`free`),
shear buildings under a measured motion or force (`driven`, driven_faults.py), and chains under random forces (`ambient`). Sick
ones, COUNT of each kind: the same with one thing wrong, named as the objection that must find it. KINDs choose among them.
Prints a line a record and a table a kind: how often its own objection came, how often another, how often none with a right
answer, and how often SILENT: exit code 0, no objection, and a frequency, damping ratio or stiffness more than five standard
deviations and 0.1 % (frequency), 5 % (damping) or 1 % (stiffness) off, or a mode that is none. Of healthy records every
objection is false. Half a second to ten a record; docs/verification.md has the table of `objection_sizes.py
build/release/bin/beamid 100 12`.
"""
import json
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import driven_faults
import numpy as np


class Cantilever:
    """Euler-Bernoulli cantilever with a tip mass: 16 cubic elements, consistent mass; SI units."""

    def __init__(self, random):
        self.length, self.width = random.uniform(0.3, 1.5), random.uniform(0.02, 0.06)
        self.height = self.length / random.uniform(100, 200)
        self.youngs, self.density = random.choice([7e10, 2.1e11]), 0.0
        self.density = 2700.0 if self.youngs < 1e11 else 7850.0
        self.mass = self.density * self.length * self.width * self.height
        self.tip = self.mass * random.choice([0.0, random.uniform(0.1, 2.0)])
        stiffness, mass = self.matrices(16)
        factor = np.linalg.inv(np.linalg.cholesky(mass))
        squares, shapes = np.linalg.eigh(factor @ stiffness @ factor.T)
        self.frequency, self.shapes = np.sqrt(squares) / (2 * np.pi), factor.T @ shapes
        load = np.zeros(len(mass))
        load[-2] = 1.0
        self.released = self.shapes.T @ mass @ np.linalg.solve(stiffness, load)  # modal coordinates of the pulled tip

    def matrices(self, n):
        h = self.length / n
        bending = self.youngs * self.width * self.height**3 / 12 / h**3
        k = bending * np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                                [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]])
        m = self.mass / n / 420 * np.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                                            [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]])
        stiffness, mass = np.zeros((2 * n + 2, 2 * n + 2)), np.zeros((2 * n + 2, 2 * n + 2))
        for e in range(n):
            stiffness[2 * e:2 * e + 4, 2 * e:2 * e + 4] += k
            mass[2 * e:2 * e + 4, 2 * e:2 * e + 4] += m
        mass[-2, -2] += self.tip
        return stiffness[2:, 2:], mass[2:, 2:]


class Decay:
    """Accelerations (channels, N) of a cantilever released from a pulled tip, read at some of its nodes."""

    def __init__(self, random, channels=0, rate_per_period=0.0):
        self.random, self.beam = random, Cantilever(random)
        first = self.beam.frequency[0]
        self.rate = float(np.round(first * (rate_per_period or random.uniform(30, 80)), 1))
        self.ratios = 10 ** random.uniform(-3, -2) * np.append(1.0, random.uniform(0.5, 3, 2))
        periods = np.clip(random.uniform(1.5, 4) / (2 * np.pi * self.ratios[0]), 15, 250)
        self.time = np.arange(int(periods / first * self.rate)) / self.rate
        others = random.choice(np.arange(7, 15), size=(channels or int(random.integers(1, 4))) - 1, replace=False)
        self.nodes = [16, *sorted((int(i) for i in others), reverse=True)]
        self.release = 10 ** random.uniform(-3, -2) * self.beam.length
        self.noise = 10 ** random.uniform(-3, -1.5)

    def motion(self, time, channel):
        """Without noise; in m/s2."""
        total, row = np.zeros(len(time)), 2 * (self.nodes[channel] - 1)
        pulled = self.release / (self.beam.shapes[-2] @ self.beam.released)
        for mode, ratio in enumerate(self.ratios):
            w = 2 * np.pi * self.beam.frequency[mode]
            if w > 0.8 * np.pi * self.rate:  # an anti-aliasing filter of the recorder
                continue
            pole = w * complex(-ratio, np.sqrt(1 - ratio**2))
            amplitude = pulled * self.beam.released[mode] * self.beam.shapes[row, mode]
            total += np.real(pole**2 * amplitude * (1 - 1j * ratio) * np.exp(pole * time))
        return total

    def read(self):
        clean = np.array([self.motion(self.time, i) for i in range(len(self.nodes))])
        return clean + self.noise * np.std(clean) * self.random.normal(0, 1, clean.shape)

    def write(self, folder, values, time=None):
        names = ",".join(f"acceleration_{i + 1}_m_per_s2" for i in range(len(values)))
        np.savetxt(folder / "decay.csv", np.column_stack([self.time if time is None else time, *values]), fmt="%.9g",
                   delimiter=",", header=f"time_s,{names}", comments="")
        return folder / "decay.csv"

    def describe(self, folder, extra=""):
        """Experiment file of the record that write() made."""
        b, places = self.beam, [self.beam.length * n / 16 for n in self.nodes]
        channels = ", ".join(f'{{column = {i + 2}, quantity = "acceleration", unit = "m/s2", position_m = {p}}}'
                             for i, p in enumerate(places))
        (folder / "decay.toml").write_text(
            f"[beam]\nlength_m = {b.length}\nwidth_m = {b.width}\nheight_m = {b.height}\nyoungs_modulus_pa = {b.youngs}\n"
            f"mass_kg = {b.mass}\ntip_mass_kg = {b.tip}\n{extra}"
            f'[record]\nfile = "decay.csv"\ntime = {{column = 1, unit = "s"}}\nchannels = [{channels}]\n', encoding="utf-8")
        return folder / "decay.toml"


def far_off(estimate, deviation, truth, share):
    return abs(estimate - truth) > max(5 * deviation, share * abs(truth))


def modal(decay, file):
    """The command, and what is wrong with its results: modes that are none, or first ones that are not the truth."""
    def wrong(found):
        modes = found["records"][0]["modes"]
        for mode in modes:
            nearest = np.argmin(np.abs(decay.beam.frequency / mode["frequency_hz"] - 1))
            f, ratio = decay.beam.frequency[nearest], mode["damping_ratio"]
            if far_off(mode["frequency_hz"], mode["frequency_standard_deviation_hz"], f, 1e-3):
                return f"{mode['frequency_hz']:.5g} Hz for {f:.5g}"
            if nearest < 3 and far_off(ratio, mode["damping_ratio_standard_deviation"], decay.ratios[nearest], 0.05):
                return f"mode {nearest + 1}: {100 * ratio:.4g} % for {100 * decay.ratios[nearest]:.4g}"
        return "" if modes else "no mode"
    return [(["modal", str(file)], wrong)]


def identify(file, decay):
    def wrong(found):
        for key, truth, share in (("frequency_hz", decay.beam.frequency[0], 1e-3), ("damping_ratio", decay.ratios[0], 0.05)):
            if far_off(found[key]["estimate"], found[key]["standard_deviation"], truth, share):
                return f"{key} {found[key]['estimate']:.6g} for {truth:.6g}"
        return ""
    return [(["identify", "--config", str(file)], wrong)]


def free(random, folder):
    decay = Decay(random)
    return modal(decay, decay.write(folder, decay.read())) + identify(decay.describe(folder), decay)


def driven(random, folder, fault="none"):
    number = int(random.integers(10_000)) * len(driven_faults.FAULTS) + list(driven_faults.FAULTS).index(fault)
    _, _, truth, file = driven_faults.make(number, folder)

    def wrong(found):
        values = list(found["runs"][0]["parameters"].values())
        for one, true in zip(values, truth[:-1]):
            if far_off(one["estimate"], one["standard_deviation"], true, 0.01):
                return f"{one['estimate']:.5g} for {true:.5g}"
        return ""
    return [(["identify", "--config", str(file)], wrong)]


def ambient(random, folder, loud=None):
    """Chain of 3 to 6 masses under a random force on each, for 300 of its longest periods or more: spectra of exact response."""
    n = int(random.integers(3, 7))
    building = driven_faults.Building(np.ones(n), random.uniform(0.6, 1.6, n) * 800, 1.0)
    ratios, rate = 10 ** random.uniform(-2.3, -1.5, n), 20.0
    count = int(rate * 2 * np.pi / building.w[0] * random.uniform(300, 500))
    w = 2 * np.pi * np.fft.rfftfreq(count, 1 / rate)
    force = random.normal(0, 1, (n, len(w))) + 1j * random.normal(0, 1, (n, len(w)))
    moved = np.zeros((n, len(w)), complex)
    for mode in range(n):
        shape, own = building.shapes[:, mode], building.w[mode]
        moved += np.outer(shape, -(w**2) * (shape @ force) / (own**2 - w**2 + 2j * ratios[mode] * own * w))
    read = np.fft.irfft(moved, count)
    read /= np.std(read)
    if loud is not None:
        read[:, count // 2:] *= loud
    read += 10 ** random.uniform(-2.5, -1.3) * random.normal(0, 1, read.shape)
    names = ",".join(f"acceleration_{i + 1}_m_per_s2" for i in range(n))
    np.savetxt(folder / "ambient.csv", np.column_stack([np.arange(count) / rate, *read]), fmt="%.6g", delimiter=",",
               header=f"time_s,{names}", comments="")

    def wrong(found):
        for mode in found["records"][0]["modes"]:
            nearest = np.argmin(np.abs(building.w / (2 * np.pi * mode["frequency_hz"]) - 1))
            f = building.w[nearest] / (2 * np.pi)
            if far_off(mode["frequency_hz"], mode["frequency_standard_deviation_hz"], f, 1e-3):
                return f"{mode['frequency_hz']:.5g} Hz for {f:.5g}"
            if far_off(mode["damping_ratio"], mode["damping_ratio_standard_deviation"], ratios[nearest], 0.05):
                return f"{mode['damping_ratio']:.4g} for {ratios[nearest]:.4g}"
        return ""
    return [(["modal", str(folder / "ambient.csv"), "--method", "ssi_cov"], wrong)]


HEALTHY = {"free": free, "driven": driven, "ambient": ambient}


def clipped(random, folder):
    decay = Decay(random)
    values = decay.read()
    limit = random.uniform(0.6, 0.9) * np.max(np.abs(values[0]))
    return modal(decay, decay.write(folder, np.clip(values, -limit, limit)))


def at_random(values, random, share, change):
    """values (channels, N) with change(values, i) at a share of the samples i, all but the first and last."""
    for i in sorted(random.choice(np.arange(2, values.shape[1] - 2), size=max(8, int(share * values.shape[1])), replace=False)):
        change(values, i)
    return values


def dropped(random, folder):
    decay = Decay(random)

    def zero(values, i):
        values[:, i] = 0.0
    return modal(decay, decay.write(folder, at_random(decay.read(), random, 0.02, zero)))


def repeated(random, folder):
    decay = Decay(random)

    def hold(values, i):
        values[:, i] = values[:, i - 1]
    return modal(decay, decay.write(folder, at_random(decay.read(), random, 0.05, hold)))


def spikes(random, folder):
    decay = Decay(random)
    values = decay.read()
    top = np.max(np.abs(values))

    def strike(them, i):
        them[0, i] = random.choice([-1, 1]) * random.uniform(2, 5) * top
    return modal(decay, decay.write(folder, at_random(values, random, 0.0, strike)))


def gaps(random, folder):
    decay = Decay(random)
    values, kept = decay.read(), np.ones(len(decay.time), bool)
    for start in random.choice(np.arange(20, len(kept) - 60), size=3, replace=False):
        kept[start:start + int(random.integers(10, 40))] = False
    return modal(decay, decay.write(folder, values[:, kept], decay.time[kept]))


def rattle(random, folder):
    decay = Decay(random)
    values = decay.read()
    loud = np.abs(decay.motion(decay.time, 0)) > 0.5 * np.max(np.abs(decay.motion(decay.time, 0)))
    values += 0.3 * np.std(values) * loud * random.normal(0, 1, values.shape)
    return identify_record(decay, folder, values)


def identify_record(decay, folder, values, extra=""):
    decay.write(folder, values)
    return identify(decay.describe(folder, extra), decay)


def channel_clocks(random, folder):
    decay = Decay(random, channels=2)
    clean = np.array([decay.motion(decay.time, 0), decay.motion(decay.time * (1 + random.choice([-1, 1]) * 0.003), 1)])
    return identify_record(decay, folder, clean + 0.002 * np.std(clean) * random.normal(0, 1, clean.shape))


def channel_amplitudes(random, folder):
    decay = Decay(random, channels=2)
    values = decay.read()
    values[1] *= random.choice([0.1, 9.80665, 1 / 9.80665])
    return identify_record(decay, folder, values)


def jump(random, folder):
    decay = Decay(random)
    values, half = decay.read(), int(len(decay.time) * random.uniform(0.3, 0.6))
    values[:, half:] *= random.uniform(1.3, 2)
    return identify_record(decay, folder, values)


def overtone(random, folder):
    decay = Decay(random, channels=1)
    values = decay.read()
    return identify_record(decay, folder, values + 0.3 * values**3 / np.max(np.abs(values))**2)


def undetermined_damping(random, folder):
    decay = Decay(random, channels=1)
    decay.noise, decay.time = 0.4, decay.time[:int(6 * decay.rate / decay.beam.frequency[0])]
    return identify_record(decay, folder, decay.read())


def aliased(random, folder):
    decay = Decay(random, channels=1, rate_per_period=random.uniform(1.2, 1.8))
    first, ratio = decay.beam.frequency[0], decay.ratios[0]
    decay.time = np.arange(400) / decay.rate
    wave = np.exp(-2 * np.pi * ratio * first * decay.time) * np.cos(2 * np.pi * first * decay.time)
    return identify_record(decay, folder, (wave + 0.005 * random.normal(0, 1, len(wave)))[None, :])


def unexplained_decay(random, folder):
    """No decay of modes at all: a chirp of the same length."""
    decay = Decay(random, channels=1)
    first, t = decay.beam.frequency[0], decay.time
    wave = np.sin(2 * np.pi * (0.5 * first * t + 0.5 * first / t[-1] * t**2))
    return identify_record(decay, folder, (wave + 0.01 * random.normal(0, 1, len(t)))[None, :])


def step_bias(random, folder):
    decay = Decay(random, channels=1)
    decay.noise = 0.002
    return identify_record(decay, folder, decay.read(), '[filter]\ndiscretisation = "forward_euler"\n')


def steady_line(random, folder):
    decay = Decay(random)
    values = decay.read()
    line = 0.3 * np.std(values) * np.sin(2 * np.pi * decay.beam.frequency[0] * random.uniform(2.2, 3.5) * decay.time)
    return modal(decay, decay.write(folder, values + line))


def no_decay(random, folder):
    _, wrong = ambient(random, folder)[0]
    return [(["modal", str(folder / "ambient.csv"), "--method", "era"], wrong)]


def phase_wander(random, folder):
    decay = Decay(random)
    knots = np.linspace(0, decay.time[-1], 8)
    wander = np.interp(decay.time, knots, np.cumsum(random.normal(0, 0.08, 8))) / decay.beam.frequency[0]
    clean = np.array([decay.motion(decay.time + wander, i) for i in range(len(decay.nodes))])
    return modal(decay, decay.write(folder, clean + 0.003 * np.std(clean) * random.normal(0, 1, clean.shape)))


def overtone_mode(random, folder):
    decay = Decay(random, channels=1)
    values = decay.read()
    return modal(decay, decay.write(folder, values + 0.15 * values**2 / np.max(np.abs(values))))


def own_clock(random, folder):
    decay = Decay(random, channels=3)
    clean = np.array([decay.motion(decay.time, i) for i in range(3)])
    clean[2] = decay.motion(decay.time - random.uniform(0.05, 0.2) / decay.beam.frequency[0], 2)
    return modal(decay, decay.write(folder, clean + 0.002 * np.std(clean) * random.normal(0, 1, clean.shape)))


def unsteady(random, folder):
    return ambient(random, folder, loud=random.uniform(15, 40))


def implausible_response(random, folder):
    found = driven(random, folder)
    file = Path(found[0][0][2])
    text = file.read_text(encoding="utf-8")
    swapped = text.replace('"acceleration", unit = "m/s2"', '"acceleration", unit = "g"')
    file.write_text(swapped, encoding="utf-8")
    return found


def of_driven(fault):
    return lambda random, folder: driven(random, folder, fault)


SICK = {  # objections that name it: how a record gets it
    "clipped": clipped, "dropped": dropped, "repeated": repeated, "spikes": spikes, "gaps": gaps, "rattle": rattle,
    "channel_clocks": channel_clocks, "channel_amplitudes": channel_amplitudes, "jump": jump, "overtone": overtone,
    "undetermined_damping": undetermined_damping, "aliased": aliased, "modal_disagreement|unexplained|no_modal_analysis": unexplained_decay,
    "step_bias": step_bias, "steady_line": steady_line, "no_decay": no_decay, "phase_wander|own_clock": phase_wander,
    "overtone_mode|overtone": overtone_mode, "own_clock": own_clock, "unsteady": unsteady,
    "implausible_response|description": implausible_response, "description": of_driven("mass"),
    "description|channel_amplitudes": of_driven("gain"), "description|input_clock": of_driven("lag"),
    "input_noise": of_driven("input noise"), "part_law|description": of_driven("damping per mode"),
}


def verdict(beamid, command, wrong):
    """(exit code, names of the objections, their first sentence, what is wrong)"""
    try:
        run = subprocess.run([beamid, *command, "--json"], capture_output=True, text=True, timeout=120, check=False)
    except subprocess.TimeoutExpired:
        return 2, [], "not ended after 120 s", ""
    if run.returncode not in (0, 3):
        return run.returncode, [], (run.stderr.strip().splitlines() or ["?"])[0], ""
    found = json.loads(run.stdout)
    objections = found["verdict"]["objections"]
    error = wrong(found) if run.returncode == 0 else ""
    return run.returncode, [one["name"] for one in objections], (objections or [{"sentence": ""}])[0]["sentence"], error


def main():
    beamid, (first, count), chosen = sys.argv[1], ([int(x) for x in sys.argv[2:4]] + [0, 20][len(sys.argv[2:4]):]), sys.argv[4:]
    rows, false = [], Counter()
    for name, make in {**HEALTHY, **SICK}.items():
        if chosen and name not in chosen:
            continue
        own, tally = set(name.split("|")), Counter()
        for number in range(first, first + count):
            with tempfile.TemporaryDirectory() as folder:
                for command, wrong in make(np.random.default_rng([number, *name.encode()]), Path(folder)):
                    code, found, sentence, error = verdict(beamid, command, wrong)
                    outcome = ("refused" if code not in (0, 3) else "own" if own & set(found) else "other" if found
                               else "SILENT" if error else "none")
                    tally[outcome] += 1
                    if name in HEALTHY:
                        false.update(f"{name}: {one}" for one in found)
                    print(f"{name} {number} {command[0]} {code} {outcome} {','.join(found)}  {error}  {sentence[:110]}", flush=True)
        rows.append((name, tally))
    print(f"\n{'record':52s}{'own':>6s}{'other':>7s}{'none':>6s}{'SILENT':>8s}{'refused':>9s}")
    for name, tally in rows:
        print(f"{name:52s}{tally['own']:6d}{tally['other']:7d}{tally['none']:6d}{tally['SILENT']:8d}{tally['refused']:9d}")
    print("\nobjections to healthy records: " + (", ".join(f"{k} {n}" for k, n in sorted(false.items())) or "none"))


if __name__ == "__main__":
    main()
