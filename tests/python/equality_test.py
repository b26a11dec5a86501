"""Results are the command's, bit for bit. Oracle: the executable, run with the words of tests/golden/commands.json."""
import json
import os
import pathlib
import shlex
import shutil
import unittest

import beamid
from beamid import _specification
from support import COMMAND, SOURCE, STEEL, TUTORIAL, copy_of_tutorials, shell, working_folder

# Here they would take longer than all others together.
SLOW = {"paper", "budget", "noise", "efficiency", "efficiency_coverage", "efficiency_decays", "efficiency_records",
        "check_massa", "compare_mesh"}


def cases():
    """Of the golden commands of each name the one of most words: every kind of argument, each command once."""
    longest = {}
    for folder, commands in json.loads((SOURCE / "tests/golden/commands.json").read_text())["folders"].items():
        for case in commands:
            if case.get("text_only") or case["name"] in SLOW or set(case["command"]) & set("|<>"):
                continue
            if all((SOURCE / "../shared/data" / file).exists() for file in case.get("data", [])):
                name, words = case["command"].split()[1], len(case["command"].split())
                if name not in longest or words > len(longest[name][1]["command"].split()):
                    longest[name] = (folder, case)
    return longest.values()


def printed(case):
    """What the command prints with --json: as the golden tests of this build have kept it, else anew."""
    kept = pathlib.Path(os.environ.get("BEAMID_GOLDEN_OUTPUT", ".")) / (case["name"] + ".json")
    if kept.exists() and kept.stat().st_mtime > os.stat(COMMAND).st_mtime:
        return kept.read_bytes()
    return shell(case["command"] + " --json", ".").stdout


def as_call(command):
    """The words of a command as arguments and keywords of its function."""
    _, name, *words = shlex.split(command)
    options = {option["name"]: option for option in _specification.commands()[name]["options"]}
    arguments, keywords = [], {}
    while words:
        word = words.pop(0)
        if not word.startswith("--"):
            arguments.append(word)
            continue
        option = options[word[2:]]
        count = len(words) if option["values"] < 0 else option["values"]
        values = []
        while words and len(values) < count and not words[0].startswith("--"):
            values.append(words.pop(0))
        keyword = _specification.keyword_of(option)
        if option["type"] == "flag":
            keywords[keyword] = True
        elif option["repeats"]:
            keywords.setdefault(keyword, []).extend(values)
        else:
            keywords[keyword] = values if len(values) > 1 else values[0]
    return name, arguments, keywords


class Equality(unittest.TestCase):
    def test_every_command_gives_the_same_bytes(self):
        for folder, case in cases():
            with self.subTest(case["name"]), copy_of_tutorials() as root:
                for file in case.get("data", []):
                    shutil.copy(SOURCE / "../shared/data" / file, root / folder)
                os.chdir(root / folder)
                if "before" in case:
                    self.assertEqual(shell(case["before"], ".").returncode, 0)
                expected = printed(case)
                name, arguments, keywords = as_call(case["command"])
                found = getattr(beamid, name)(*arguments, **keywords)
                self.assertEqual(found.json.encode(), expected)
                golden = (SOURCE / "tests/golden" / (case["name"] + ".txt")).read_text()
                self.assertTrue(golden.startswith(f"exit code {found.code}\n"))
                # The command that it names is the same again, and so is its report.
                self.assertEqual(shell(found.command + " --json", ".").stdout, expected)
                text = shell(found.command, ".").stdout.decode()
                self.assertTrue(text.startswith(found.report), found.command)

    def test_arrays_and_a_beam_give_the_bytes_of_the_command_that_results_name(self):
        file = beamid.read(TUTORIAL / "tip_acceleration.csv")
        record = beamid.Record(file.time, acceleration_m_per_s2=file.samples, position_m=1.1, name="hit")
        found = beamid.identify(record, beamid.Beam(**STEEL), window_s=(2, 10), filter="ukf", smoother="rts",
                                unknown=["bending_stiffness", "damping_ratio"])
        with working_folder() as folder:
            self.assertEqual(found.write_inputs(folder), ["hit.csv", "experiment.toml"])
            self.assertEqual(shell(found.command + " --json", folder).stdout, found.json.encode())

    def test_a_record_in_arrays_is_that_of_its_file(self):
        file = beamid.read(TUTORIAL / "tip_acceleration.csv")
        arrays = beamid.Record(file.time, acceleration_m_per_s2=file.samples, name="tip_acceleration")
        of_file, of_arrays = (beamid.identify(one, beamid.Beam(**STEEL), window_s=(2, 10)) for one in (file, arrays))
        self.assertEqual(of_file["stiffness_n_per_m"], of_arrays["stiffness_n_per_m"])
        self.assertEqual(of_file["damping_ratio"].interval(), of_arrays["damping_ratio"].interval())

    def test_writing_results_gives_the_files_of_out(self):
        with working_folder() as folder:
            beamid.modes(tip_mass=0.36, modes=2).write(folder / "mine")
            shell("beamid modes --tip-mass 0.36 --modes 2 --out theirs", folder)
            names = sorted(os.listdir(folder / "theirs"))
            self.assertEqual(sorted(os.listdir(folder / "mine")), names)
            for name in names:
                if name != "timing.json":  # the only one that depends on the clock
                    self.assertEqual((folder / "mine" / name).read_bytes(), (folder / "theirs" / name).read_bytes(), name)


if __name__ == "__main__":
    unittest.main()
