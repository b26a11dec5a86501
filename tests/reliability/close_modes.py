#!/usr/bin/python3
"""Two close modes, separated or not, on records made without beamid:  close_modes.py BEAMID [FIRST [COUNT [KIND ...]]]

Modes at 5 Hz and 5 (1 + d) Hz. Free decays (`free`) of 20 s at 200 Hz: damping ratios of 0.318 %, or 0.318 and 1.272 %; the
second mode 1, 0.3 or 0.1 of the first; one to three channels; white noise 20, 40 and 60 dB below the first amplitude. Hammer
tests (`hammer`) of the same structures: three hits of 40 ms, noise in the responses. Random vibration (`ambient`) of 600 s at
50 Hz: damping ratios of 1 %, or 1 and 4 %. COUNT seeds a cell (default 20), from FIRST on. The kinds `identify` and `track` are the
free decays under these commands, which follow one mode: the last plateau of `track` counts.

Of what is listed within 3 % of the pair, `inside` is the share of frequencies and damping ratios in their 95 % intervals, and
`wrong` the records in which one is more than four standard deviations off with exit code 0. `bound` is the difference of the
frequencies over the standard deviation of the Cramer-Rao bound, all parameters but the noise unknown; of random vibration it
is not computed. docs/verification.md has the table of `close_modes.py build/release/bin/beamid 100 4 free`.
"""
import itertools
import json
import subprocess
import sys
import tempfile
from collections import defaultdict
from multiprocessing import Pool
from pathlib import Path

import numpy as np

FIRST_HZ, RATIO = 5.0, 0.00318
DISTANCES = (0.003, 0.005, 0.01, 0.02, 0.03, 0.05, 0.1)
SIGNS = np.array([[1.0, 1.0], [1.0, -0.7], [0.6, 1.0]])  # of the two modes in three channels


class Pair:
    def __init__(self, distance, uneven, amplitude, ratio=RATIO):
        self.frequency = FIRST_HZ * np.array([1.0, 1.0 + distance])
        self.ratios = ratio * np.array([1.0, 4.0 if uneven else 1.0])
        self.amplitude = np.array([1.0, amplitude])
        w = 2 * np.pi * self.frequency
        self.rates = w * (-self.ratios + 1j * np.sqrt(1 - self.ratios**2))

    def shapes(self, channels):
        return SIGNS[:channels] * self.amplitude


def free(pair, channels, noise, random):
    time = np.arange(4000) / 200
    phases = random.uniform(0, 2 * np.pi, 2)
    amplitudes = pair.shapes(channels) * np.exp(1j * phases)
    clean = np.array([sum((a * np.exp(r * time)).real for a, r in zip(row, pair.rates)) for row in amplitudes])
    return time, clean + noise * random.normal(size=clean.shape), amplitudes


def hammer(pair, channels, noise, random):
    pause, hits, fine = 12000, 3, 50  # samples behind a hit; hits; steps of a sample within the pulse
    time = np.arange(hits * pause + 200) / 200
    pulse = np.sin(np.pi * (np.arange(8 * fine) + 0.5) / (8 * fine)) ** 2
    force, clean = np.zeros(len(time)), np.zeros((channels, len(time)))
    for hit in range(hits):
        start, size = 100 + hit * pause, random.uniform(0.7, 1.3)
        within = np.arange(9) / 200
        force[start:start + 9] += size * np.sin(np.pi * within / 0.04) ** 2
        for row, shape in enumerate(pair.shapes(channels)):
            for gain, rate in zip(shape, pair.rates):
                inner = (np.arange(8 * fine) + 0.5) / (200 * fine)
                gathered = np.cumsum(pulse * np.exp(-rate * inner)) / (200 * fine)
                total = np.concatenate([[0], gathered[fine - 1::fine], np.full(len(time) - start - 9, gathered[-1])])
                motion = total * np.exp(rate * (time[start:] - time[start]))
                clean[row, start:] += size * gain * (rate * motion).real  # an acceleration: s w of a mobility
    top = np.max(np.abs(clean))
    return time, np.vstack([force, clean / top + noise * random.normal(size=clean.shape)]), None


def ambient(pair, channels, noise, random):
    time = np.arange(30000) / 50
    line = 2j * np.pi * np.fft.rfftfreq(len(time), 1 / 50)
    modes = []
    for rate in pair.rates:
        force = np.fft.rfft(random.normal(size=len(time)))
        w, d = abs(rate), -rate.real
        motion = np.fft.irfft(force * line**2 / (line**2 + 2 * d * line + w * w) * (abs(line) < 2 * np.pi * 20), len(time))
        modes.append(motion / np.std(motion))
    clean = pair.shapes(channels) @ np.array(modes)
    return time, clean + noise * random.normal(size=clean.shape), None


def bound(pair, amplitudes, noise):
    """f2 - f1 over its standard deviation, of a free decay."""
    time = np.arange(4000) / 200
    information = 0.0
    waves = np.exp(np.outer(time, pair.rates))
    basis = np.column_stack([waves.real, waves.imag, np.ones(len(time))])
    range_, _ = np.linalg.qr(basis)
    for row in amplitudes:
        motion = row * waves
        slopes = np.column_stack([-time[:, None] * motion.imag, -time[:, None] * motion.real])  # w1, w2, d1, d2
        slopes -= range_ @ (range_.T @ slopes)
        information = information + slopes.T @ slopes / noise**2
    inverse = np.linalg.inv(information)
    deviation = np.sqrt(inverse[0, 0] + inverse[1, 1] - 2 * inverse[0, 1])
    return 2 * np.pi * (pair.frequency[1] - pair.frequency[0]) / deviation


def judge(pair, listed, code):
    """(outcome, errors in standard deviations)"""
    low, high = pair.frequency[0] * 0.97, pair.frequency[1] * 1.03
    near = sorted((m for m in listed if low < m["frequency_hz"] < high), key=lambda m: m["frequency_hz"])

    if any(m["frequency_standard_deviation_hz"] is None or m["damping_ratio_standard_deviation"] is None for m in near):
        return ("no interval", [])

    def errors(mode, k):
        return [(mode["frequency_hz"] - pair.frequency[k]) / mode["frequency_standard_deviation_hz"],
                (mode["damping_ratio"] - pair.ratios[k]) / mode["damping_ratio_standard_deviation"]]
    if len(near) == 2:
        all_errors = min((errors(near[0], k) + errors(near[1], 1 - k) for k in (0, 1)), key=lambda e: max(map(abs, e)))
        outcome = "both"
    elif len(near) == 1:
        all_errors = min((errors(near[0], k) for k in (0, 1)), key=lambda e: max(map(abs, e)))
        outcome = "one"
    else:
        return ("none" if not near else "more"), []
    if code != 0:
        return "objected", []
    return ("wrong" if max(map(abs, all_errors)) > 4 else outcome), all_errors


def modes_of(found):
    """What a command lists, as `modal` does."""
    if found["command"] == "modal":
        return found["modes"] if "modes" in found else found["records"][0]["modes"]
    one = found["plateaus"][-1] if found["command"] == "track" else found
    return [{"frequency_hz": one["frequency_hz"]["estimate"],
             "frequency_standard_deviation_hz": one["frequency_hz"]["standard_deviation"],
             "damping_ratio": one["damping_ratio"]["estimate"],
             "damping_ratio_standard_deviation": one["damping_ratio"]["standard_deviation"]}]


def run(job):
    kind, distance, channels, decibels, uneven, amplitude, seed = job
    random = np.random.default_rng([seed, int(1e4 * distance), channels, decibels, uneven, int(10 * amplitude)])
    pair = Pair(distance, uneven, amplitude, 0.01 if kind == "ambient" else RATIO)
    noise = 10 ** (-decibels / 20)
    command = kind if kind in ("identify", "track") else "modal"
    make = free if command != "modal" else globals()[kind]
    time, values, amplitudes = make(pair, channels, noise, random)
    names = ["force_n"] * (kind == "hammer") + [f"acceleration_{i}_m_per_s2" for i in range(channels)]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "pair.csv"
        np.savetxt(file, np.column_stack([time, *values]), fmt="%.9g", delimiter=",", comments="",
                   header=",".join(["time_s", *names]))
        ended = subprocess.run([BEAMID, command, str(file), "--json"], capture_output=True, text=True)
    try:
        listed = modes_of(json.loads(ended.stdout))
    except (ValueError, KeyError, IndexError):
        return job, ("no result", []), 0.0
    separable = bound(pair, amplitudes, noise) if amplitudes is not None else float("nan")
    return job, judge(pair, listed, ended.returncode), separable


def main():
    first, count = (int(a) for a in (sys.argv[2:4] + ["0", "20"][len(sys.argv[2:4]):]))
    kinds = sys.argv[4:] or ["free", "hammer", "ambient"]
    jobs = []
    for kind in kinds:
        levels = (20, 40) if kind == "ambient" else (20, 40, 60)
        jobs += [(kind, d, p, db, uneven, a, first + k) for d, p, db, uneven, a, k in itertools.product(
            DISTANCES, (1, 2, 3), levels, (False, True), (1.0, 0.3, 0.1), range(count))]
    cells = defaultdict(list)
    with Pool() as pool:
        for job, (outcome, errors), separable in pool.imap_unordered(run, jobs, chunksize=4):
            kind, distance, _, decibels, uneven, amplitude, _ = job
            if outcome in ("wrong", "no result"):
                print(outcome, *job, "" if not errors else np.round(errors, 1), flush=True)
            cells[kind, distance, decibels].append((outcome, errors, separable))
    words = ("both", "one", "objected", "none", "more", "wrong", "no result", "no interval")
    print(f"{'kind':8}{'d %':>5}{'dB':>4}{'bound':>9}" + "".join(f"{w:>12}" for w in words) + f"{'inside %':>10}")
    for (kind, distance, decibels), found in sorted(cells.items()):
        errors = np.array([e for _, es, _ in found for e in es])
        share = [100 * sum(o == w for o, _, _ in found) / len(found) for w in words]
        inside = 100 * np.mean(np.abs(errors) < 1.96) if len(errors) else float("nan")
        print(f"{kind:8}{100 * distance:5.3g}{decibels:4}{np.median([s for _, _, s in found]):9.3g}" +
              "".join(f"{s:12.1f}" for s in share) + f"{inside:10.1f}")


if __name__ == "__main__":
    BEAMID = sys.argv[1]
    main()
