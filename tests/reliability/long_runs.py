#!/usr/bin/python3
"""Long runs of the release build: what grows in them that should not.

    tests/reliability/long_runs.py BEAMID [--samples 100_000_000] [--cases 1_000_000] [--commands 10_000] [RUN...]

RUN is any of stream, latency, sweep, soak; all without one. Each prints what it measured, and ends with exit code 1 where a
promise of docs/reliability.md does not hold: memory or files that grow, rows that are lost. One processor for each.
"""
import argparse
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
INTERVAL = 0.004  # [s], of the earlier record of tutorial 2, which the stream is like
DECAY = 6250  # samples from one release to the next


def releases():
    """Texts of the readings of one release [m/s2] with the noise of an accelerometer, for ever the same."""
    noise = random.Random(1)
    omega, xi = 2 * math.pi * 3.4555, 0.0045
    return [f"{-5.58 * math.exp(-xi * omega * k * INTERVAL) * math.cos(omega * k * INTERVAL) + noise.gauss(0, 0.05):.4f}"
            for k in range(DECAY)]


def stream_lines(first, count, readings):
    return "".join(f"{k * INTERVAL:.3f},{readings[k % DECAY]}\n" for k in range(first, first + count))


def resident(pid):
    """Memory that a process holds [kB]."""
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1])
    return 0


def start_stream(beamid, folder):
    shutil.copytree(SOURCE / "docs/tutorials/02_identify_a_record", folder, dirs_exist_ok=True)
    return subprocess.Popen([beamid, "stream", "--config", "cantilever.toml"], cwd=folder, stdin=subprocess.PIPE,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def drain(pipe, counted):
    """Counts lines until the end; tells the last of them."""
    last = b""
    while block := os.read(pipe.fileno(), 1 << 20):
        counted["lines"] += block.count(b"\n")
        last = (last + block)[-400:]
    counted["last"] = last.decode().splitlines()[-1] if last else ""


def stream(options, folder):
    """Memory of a stream is the same after ten thousand samples and at its end; every sample has a row."""
    process, readings = start_stream(options.beamid, folder), releases()
    counted, errors = {"lines": 0}, {"lines": 0}
    readers = [threading.Thread(target=drain, args=(process.stdout, counted)),
               threading.Thread(target=drain, args=(process.stderr, errors))]
    for reader in readers:
        reader.start()
    block, early, largest, begun = 10_000, 0, 0, time.monotonic()
    for first in range(0, options.samples, block):
        process.stdin.write(stream_lines(first, min(block, options.samples - first), readings).encode())
        if first == 10 * block:
            early = resident(process.pid)
        if first % (100 * block) == 0:
            largest = max(largest, resident(process.pid))
    process.stdin.close()
    for reader in readers:
        reader.join()
    used = os.wait4(process.pid, 0)
    seconds = time.monotonic() - begun
    print(f"stream: {options.samples:,} samples in {seconds:.0f} s ({used[2].ru_utime + used[2].ru_stime:.0f} s of processor time, "
          f"{1e6 * (used[2].ru_utime + used[2].ru_stime) / options.samples:.1f} us a sample), rows {counted['lines'] - 1:,}, memory {early} kB "
          f"early, {largest} kB at most, lines of news {errors['lines']:,}\n        last row: {counted['last']}")
    return used[1] == 0 and counted["lines"] == options.samples + 1 and largest < 1.02 * early + 256


def latency(options, folder):
    """From a sample written to its row read, one at a time."""
    process, readings = start_stream(options.beamid, folder), releases()
    process.stdout.readline()
    times = []
    for k in range(200_000):
        line = stream_lines(k, 1, readings).encode()
        begun = time.perf_counter()
        process.stdin.write(line)
        process.stdin.flush()
        process.stdout.readline()
        times.append(time.perf_counter() - begun)
    process.communicate()
    times.sort()
    at = {share: 1e6 * times[int(share * (len(times) - 1))] for share in (0.5, 0.95, 0.99, 0.999, 0.9999, 1.0)}
    print("latency: " + ", ".join(f"{100 * share:g} % {value:.0f} us" for share, value in at.items()))
    return process.returncode == 0


def size_of(file):
    """Of a file that may go away meanwhile [bytes]."""
    try:
        return file.stat().st_size
    except OSError:
        return 0


def sweep(options, folder):
    """The journal holds a row a case and nothing else; a run of 200 times as many cases takes no more memory for each."""
    shutil.copytree(SOURCE / "docs/tutorials/13_sweeps", folder, dirs_exist_ok=True)
    peaks = []
    for cases in (options.cases // 200, options.cases):
        command = [options.beamid, "sweep", "--config", "rig.toml", "--vary", "damping.ratio=0.01", "--seeds", str(cases), "--once",
                   "--threads", "1", "--out", "swept", "--force"]
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL)
        journal, final, largest, ended, begun = folder / "swept.partial/cases.csv", folder / "swept/cases.csv", 0, 0, time.monotonic()
        while not ended:
            time.sleep(0.05)
            largest = max(largest, size_of(journal))
            ended, status, used = os.wait4(process.pid, os.WNOHANG)
        peaks.append(used.ru_maxrss)
        with open(final, "rb") as file:
            rows = sum(1 for _ in file) - 1
        print(f"sweep: {cases:,} cases in {time.monotonic() - begun:.0f} s ({used.ru_utime + used.ru_stime:.0f} s of processor time), "
              f"rows {rows:,}, journal {largest:,} bytes at most, cases.csv {final.stat().st_size:,}, memory {peaks[-1]} kB")
        # One row for each parameter of each case.
        if status != 0 or rows == 0 or rows % cases != 0 or largest > 1.05 * final.stat().st_size:
            return False
    return True


def soak(options, folder):
    """Commands in a row leave no file behind and take as much memory at the end as at the beginning."""
    shutil.copytree(SOURCE / "docs/tutorials/02_identify_a_record", folder, dirs_exist_ok=True)
    temporary = folder / "temporary"
    temporary.mkdir()
    commands = [["modes", "--config", "cantilever.toml", "--json"], ["identify", "--config", "cantilever.toml"],
                ["inspect", "tip_acceleration.csv"], ["modal", "tip_acceleration.csv"], ["identify", "--config", "missing.toml"],
                ["identify", "--config", "cantilever.toml", "--out", "results", "--force"], ["list", "filters"]]
    environment = dict(os.environ, TMPDIR=str(temporary))
    before, peaks, begun = {}, [], time.monotonic()
    for number in range(options.commands):
        words = commands[number % len(commands)]
        process = subprocess.Popen([options.beamid, *words], cwd=folder, env=environment, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)
        peaks.append(used.ru_maxrss)
        expected = 2 if "missing.toml" in words else 0
        if os.waitstatus_to_exitcode(status) != expected:
            print(f"soak: command {number}, {' '.join(words)}: exit code {os.waitstatus_to_exitcode(status)}")
            return False
        if number + 1 in (len(commands), options.commands):
            before[number + 1] = sum(1 for _ in folder.rglob("*")), sum(1 for _ in temporary.rglob("*"))
    tenth = max(len(commands), options.commands // 10)
    early, late = max(peaks[:tenth]), max(peaks[-tenth:])
    files, first = before[options.commands], before[len(commands)]
    print(f"soak: {options.commands:,} commands in {time.monotonic() - begun:.0f} s, largest memory {early} kB in the first tenth, "
          f"{late} kB in the last, files {first[0]} and {files[0]}, temporary ones {files[1]}")
    return files == first and files[1] == 0 and late < 1.05 * early


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("beamid", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("run", nargs="*", help="stream, latency, sweep, soak")
    parser.add_argument("--samples", type=int, default=100_000_000)
    parser.add_argument("--cases", type=int, default=1_000_000)
    parser.add_argument("--commands", type=int, default=10_000)
    options = parser.parse_intermixed_args()
    runs = {"stream": stream, "latency": latency, "sweep": sweep, "soak": soak}
    kept = True
    for name in options.run or runs:
        with tempfile.TemporaryDirectory() as folder:
            if not runs[name](options, pathlib.Path(folder)):
                print(f"{name}: FAILED")
                kept = False
    sys.exit(0 if kept else 1)


if __name__ == "__main__":
    main()
