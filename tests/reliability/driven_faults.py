#!/usr/bin/python3
"""Driven records with one thing described wrongly, made without beamid:  driven_faults.py BEAMID [FIRST [COUNT [NOISE]]]

Shear buildings of 2 to 6 storeys under a band-limited motion of the ground, or a force on the roof, that has gone on
for ever: a sum of 160 sines, whose response is exact. Some floors carry an accelerometer with white noise of 0.1 to 5 %
of the motion's standard deviation; NOISE is that of every measured input, as a share of its own, 0 where it is not
given. Record s has the fault number s modulo 13 of the list below, by 3, 10 or 30 %. A small mass is 2 to 7 % of one
floor's in a building of 0.1 to 0.5 % of damping; dashpots sit in the storeys, where one ratio, or one a mode, is asked;
other forces are white, on all floors, and move these by 5 or 10 % of what the measured input does. Prints a line a record and a table
a fault; exit code 1 where an estimate with exit code 0 is more than four standard deviations off. One to ten seconds of
processor time a record, of six storeys with a reversed sign minutes. docs/verification.md has the table of
`driven_faults.py build/release/bin/beamid 0 260`.
"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

FAULTS = {  # name: what the sentence of the verdict calls it
    "none": None,
    "mass": "mass",
    "gain": "gain",
    "input gain": "gain",
    "sign": "sign",
    "lag": "late|ahead|behind|clock|delay",
    "place": "place|sits|at height|position",
    "input noise": "noise in",
    "damping per mode": "not one of all modes",
    "coloured noise": None,
    "small mass": "mass",
    "dashpots": "not one of all modes|dashpots",
    "other forces": None,
}
NAMES_A_CAUSE = ("description", "input_clock", "input_noise")
RATE, SINES, STOREY = 100.0, 160, 3.0


class Building:
    """Masses m (n) [kg] on springs k (n) [N/m] with dampers c (n) [N s/m], or one damping ratio, or one a mode."""

    def __init__(self, m, k, ratio=None, dashpots=None):
        self.m, self.stiffness = m, self.storeys(k)
        root = np.diag(m**-0.5)
        squares, shapes = np.linalg.eigh(root @ self.stiffness @ root)
        self.w = np.sqrt(squares)
        if dashpots is not None:
            self.damping = self.storeys(dashpots)
        else:
            back = np.diag(m**0.5) @ shapes
            self.damping = back @ np.diag(2.0 * ratio * self.w * np.ones(len(m))) @ back.T

    @staticmethod
    def storeys(k):
        return np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)

    def compliance(self, frequency):
        """(L, n, n) [m/N]"""
        w = 2 * np.pi * frequency[:, None, None]
        return np.linalg.inv(self.stiffness + 1j * w * self.damping - w**2 * np.diag(self.m))

    def accelerations(self, frequency, lines, time, on_roof):
        """Absolute accelerations (n, N) under a ground acceleration or a force on the roof of these lines."""
        push = np.eye(len(self.m))[-1] if on_roof else -self.m
        w = 2 * np.pi * frequency[:, None]
        amplitude = -(w**2) * (self.compliance(frequency) @ push) * lines[:, None] + (0 if on_roof else lines[:, None])
        return np.real(amplitude.T @ np.exp(1j * np.outer(w[:, 0], time)))

    def ambient_accelerations(self, random, samples):
        """Those (n, N) under white forces on all floors, up to 0.8 of half the rate; periodic in four records."""
        frequency = np.fft.rfftfreq(4 * samples, 1 / RATE)
        band = (frequency > 0.05) & (frequency < 0.4 * RATE)
        forces = random.normal(0, 1, (band.sum(), len(self.m), 2)) @ [1, 1j]
        spectrum = np.zeros((len(frequency), len(self.m)), complex)
        spectrum[band] = np.einsum("lij,lj->li", self.compliance(frequency[band]), forces)
        spectrum[band] *= -((2 * np.pi * frequency[band]) ** 2)[:, None]
        return np.fft.irfft(spectrum, axis=0)[:samples].T


def make(number, folder, input_noise):
    """Writes record and experiment file; returns (fault, what, truth (n + 1), file)."""
    fault = list(FAULTS)[number % len(FAULTS)]
    random = np.random.default_rng(30_000 + number)
    n = int(random.integers(2, 7))
    m, k = random.uniform(800, 1500, n), random.uniform(0.8e6, 3e6, n)
    ratio, on_roof = random.uniform(0.005, 0.05), bool(random.integers(2))
    if fault == "small mass":
        ratio /= 10.0
    time = np.arange(int(random.uniform(15, 40) * RATE)) / RATE
    frequency = np.sort(random.uniform(0.2, 20, SINES))
    lines = random.normal(0, 1, SINES) * np.exp(-((np.log(frequency / 3)) ** 2) / 2)
    lines = lines * np.exp(2j * np.pi * random.uniform(0, 1, SINES)) * (1000.0 if on_roof else 1.0)
    force = np.real(lines @ np.exp(2j * np.pi * np.outer(frequency, time)))
    ratios = ratio * np.exp(random.normal(0, 0.6, n)) if fault == "damping per mode" else ratio
    building = Building(m, k, ratios)
    if fault == "dashpots":
        building = Building(m, k, dashpots=2 * ratio / building.w[0] * k * np.exp(random.normal(0, 0.6, n)))
    moved = building.accelerations(frequency, lines, time, on_roof)
    floors = sorted(random.choice(n, size=max(2, (n + 1) // 2), replace=False))
    noise = random.normal(0, 1, (len(floors), len(time)))
    if fault == "coloured noise":
        for j in range(1, len(time)):
            noise[:, j] = 0.9 * noise[:, j - 1] + 0.436 * noise[:, j]
    read = moved[floors] + 10 ** random.uniform(-3, -1.3) * np.std(moved) * noise
    described, places = m.copy(), list(floors)
    size = random.choice([0.03, 0.1, 0.3]) * random.choice([-1, 1])
    channel, floor = int(random.integers(len(floors))), int(random.integers(n))
    what = f" {100 * size:+.0f} %"
    if fault == "small mass":
        size = random.uniform(0.02, 0.07) * random.choice([-1, 1])
        what = f" {100 * size:+.1f} %"
    if fault in ("mass", "small mass"):
        described[floor] *= 1 + size
    elif fault == "gain":
        read[channel] *= 1 + size
    elif fault == "input gain":
        force *= 1 + size
    elif fault == "sign":
        read[channel] *= -1
        what = ""
    elif fault == "lag":
        late, what = abs(size) * 0.1, f" {100 * abs(size):.0f} ms"
        turned = lines * np.exp(-2j * np.pi * frequency * late)
        read[channel] += (building.accelerations(frequency, turned, time, on_roof) - moved)[floors[channel]]
    elif fault == "place":
        free = [i for i in range(n) if i not in floors]
        if free:
            places[channel] = min(free, key=lambda i: abs(i - floors[channel]))
        else:
            places[0], places[1] = places[1], places[0]
        what = ""
    elif fault == "other forces":
        ambient = building.ambient_accelerations(random, len(time))[floors]
        share = random.choice([0.05, 0.1])
        read, what = read + share * np.std(moved) / np.std(ambient) * ambient, f" {100 * share:.0f} %"
    elif fault == "input noise":
        force = force + abs(size) * np.std(force) * random.normal(0, 1, len(time))
    else:
        what = ""
    if input_noise > 0:
        force = force + input_noise * np.std(force) * random.normal(0, 1, len(time))
    stem = Path(folder) / f"s{number}"
    quantity, key, unit = ("force", "n", "N") if on_roof else ("base_acceleration", "m_per_s2", "m/s2")
    names = ",".join(f"acceleration_f{i + 1}_m_per_s2" for i in floors)
    np.savetxt(f"{stem}.csv", np.column_stack([time, force, *read]), fmt="%.9g", delimiter=",",
               header=f"time_s,{quantity}_{key},{names}", comments="")
    modes = n if fault == "dashpots" and random.integers(2) else 0  # with ratios of their own
    guess = k * random.uniform(0.65, 1.5, n)
    at = f", position_m = {STOREY * n}" if on_roof else ""
    channels = [f'{{column = 2, quantity = "{quantity}", unit = "{unit}"{at}}}']
    channels += [f'{{column = {j + 3}, quantity = "acceleration", unit = "m/s2", position_m = {STOREY * (i + 1)}}}'
                 for j, i in enumerate(places)]
    storeys = "".join(f'[[parameters]]\nquantity = "storey_stiffness"\nfrom_m = {STOREY * i}\nto_m = {STOREY * (i + 1)}\n'
                      for i in range(n))
    ratio_asked = '[[parameters]]\nquantity = "damping_ratio"\n'
    ratios_asked = "".join(f"{ratio_asked}mode = {i + 1}\n" for i in range(modes)) or ratio_asked
    Path(f"{stem}.toml").write_text(
        f"[chain]\nmasses_kg = {[float(x) for x in described]}\nstiffnesses_n_per_m = {[float(x) for x in guess]}\n"
        f'heights_m = {[STOREY] * n}\n[damping]\nlaw = "modal"\nratio = 0.02\n[model]\nname = "beam"\n'
        f'[reduction]\nmethod = "none"\n{storeys}{ratios_asked}'
        f'[record]\nfile = "s{number}.csv"\ntime = {{column = 1, unit = "s"}}\nchannels = [{", ".join(channels)}]\n',
        encoding="utf-8")
    return fault, f"{fault}{what}, {'force' if on_roof else 'base'}", [*k, *[ratio] * max(1, modes)], f"{stem}.toml"


def judged(beamid, fault, truth, file):
    """(outcome, largest distance in standard deviations, inside (q) or none, first sentence)"""
    try:
        run = subprocess.run([beamid, "identify", "--config", file, "--json"],
                             capture_output=True, text=True, timeout=600, check=False)
    except subprocess.TimeoutExpired:
        return "refused", np.nan, [], "not ended after 600 s"
    if run.returncode not in (0, 3):
        return "refused", np.nan, [], (run.stderr.strip().splitlines() or ["?"])[-1]
    found = json.loads(run.stdout)
    sentences = [one["sentence"] for one in found["verdict"]["objections"]] or [""]
    parameters = list(found["runs"][0]["parameters"].values())
    causes = [one["sentence"] for one in found["verdict"]["objections"] if one["name"] in NAMES_A_CAUSE]
    named = FAULTS[fault] and any(re.search(FAULTS[fault], one) for one in causes[:2])
    if len(parameters) != len(truth):
        return "named" if named else "no estimate", np.nan, [], sentences[0]
    if fault in ("damping per mode", "dashpots"):  # ratios have no true value
        parameters, truth = zip(*[(p, x) for p, x in zip(parameters, truth) if x > 1.0])
    far = max(abs(p["estimate"] - x) / ((p["upper_95"] - p["lower_95"]) / 3.92) for p, x in zip(parameters, truth))
    inside = [p["lower_95"] <= x <= p["upper_95"] for p, x in zip(parameters, truth)]
    if run.returncode == 0:
        return "WRONG AND SURE" if far > 4 else "answered", far, inside, sentences[0]
    return "named" if named else "contradicted", far, inside, sentences[0]


def main():
    numbers = [int(x) for x in sys.argv[2:4]] + [0, 40][len(sys.argv[2:4]):]
    noise = float(sys.argv[4]) if len(sys.argv) > 4 else 0.0
    outcomes, held = {fault: {} for fault in FAULTS}, {fault: [] for fault in FAULTS}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(numbers[0], numbers[0] + numbers[1]):
            fault, what, truth, file = make(number, folder, noise)
            outcome, far, inside, sentence = judged(sys.argv[1], fault, truth, file)
            outcomes[fault][outcome] = outcomes[fault].get(outcome, 0) + 1
            if outcome == "answered":
                held[fault] += inside
            print(f"{number:4d} {what:26s} {outcome:14s} {far:7.1f}  {sentence[:120]}", flush=True)
    columns = ["named", "contradicted", "answered", "no estimate", "refused", "WRONG AND SURE"]
    print(f"\n{'fault':16s}" + "".join(f"{c:>16s}" for c in columns) + f"{'inside':>12s}")
    for fault, found in outcomes.items():
        print(f"{fault:16s}" + "".join(f"{found.get(c, 0):16d}" for c in columns) + f"{sum(held[fault]):8d}/{len(held[fault])}")
    return int(any("WRONG AND SURE" in found for found in outcomes.values()))


if __name__ == "__main__":
    sys.exit(main())
