"""How commands run within Python: threads, Ctrl-C, `python3 -m beamid`. Oracle: the executable."""
import concurrent.futures
import os
import signal
import subprocess
import sys
import time
import unittest

import beamid
from support import STEEL, TUTORIAL, beamid as command

LONG = """
import signal, sys, beamid
signal.signal(signal.SIGINT, signal.default_int_handler)
print("running", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", flush=True)
    print(beamid.modes(modes=1).code, flush=True)   # all goes on as before
"""


class Running(unittest.TestCase):
    def interrupted(self, call):
        with subprocess.Popen([sys.executable, "-c", LONG.format(call=call)], stdout=subprocess.PIPE, text=True) as process:
            self.assertEqual(process.stdout.readline(), "running\n")
            time.sleep(1.0)
            process.send_signal(signal.SIGINT)
            try:
                return process.communicate(timeout=60)[0]
            finally:
                process.kill()

    def test_ctrl_c_ends_a_sweep_and_python_goes_on(self):
        rig = TUTORIAL.parent / "13_sweeps/rig.toml"
        self.assertEqual(self.interrupted(f"beamid.sweep(config={str(rig)!r}, seeds=100000)"), "interrupted\n0\n")

    def test_ctrl_c_ends_a_filter_between_two_samples(self):
        call = ("beamid.simulate; import numpy as np; t = np.arange(2_000_000) / 1000.; "
                "beamid.identify(beamid.Record(t, acceleration_m_per_s2=np.exp(-.01*t)*np.sin(21.7*t)), "
                f"beamid.Beam(**{STEEL}), window_s=(0, 1999), filter='particle')")
        self.assertEqual(self.interrupted(call), "interrupted\n0\n")

    def test_runs_in_threads_find_what_they_find_alone(self):
        def run(tip_mass):
            return beamid.identify(TUTORIAL / "tip_acceleration.csv", beamid.Beam(**{**STEEL, "tip_mass_kg": tip_mass}),
                                   window_s=(2, 6)).json

        masses = [0.30, 0.32, 0.34, 0.36]
        alone = [run(mass) for mass in masses]
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            self.assertEqual(list(pool.map(run, masses)), alone)

    def test_commands_that_print_do_not_mix_in_threads(self):
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            lists = list(pool.map(beamid.list, ["filters", "steps", "models"] * 8))
        for kind, text in zip(["filters", "steps", "models"] * 8, lists):
            self.assertEqual(text, command("list", kind).stdout.decode())

    def test_other_threads_run_while_a_command_does(self):
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            future = pool.submit(beamid.sweep, config=TUTORIAL.parent / "13_sweeps/rig.toml", seeds=40)
            turns = 0
            while not future.done():
                turns += 1
                time.sleep(0.001)
        self.assertGreater(turns, 10)
        self.assertEqual(future.result().code, 0)

    def test_the_module_is_the_command(self):
        for words in (["modes", "--modes", "2"], ["modes", "--mods", "2"], ["--version"], ["identify", "nowhere.csv"]):
            mine = subprocess.run([sys.executable, "-m", "beamid", *words], capture_output=True, check=False)
            theirs = command(*words)
            self.assertEqual((mine.returncode, mine.stdout, mine.stderr), (theirs.returncode, theirs.stdout, theirs.stderr))

    def test_a_version_is_that_of_the_command(self):
        self.assertEqual(command("--version").stdout.decode().split()[1], beamid.__version__)

    def test_importing_does_not_load_pandas_or_matplotlib(self):
        code = "import sys, beamid; print([name for name in ('pandas', 'matplotlib', 'scipy') if name in sys.modules])"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=os.environ)
        self.assertEqual(done.stdout, "[]\n")


if __name__ == "__main__":
    unittest.main()
