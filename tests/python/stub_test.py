"""The stub names what the module has. Oracles: the module itself, and mypy where it is installed."""
import ast
import os
import subprocess
import sys
import unittest

import beamid
from beamid import _commands
from support import SOURCE, working_folder

STUB = SOURCE / "apps/python/beamid/__init__.pyi"
USE = """import beamid
import numpy as np
beam = beamid.Beam(length_m=1.1, mass_kg=3.0)
record = beamid.Record(np.zeros(3), acceleration_g=np.zeros((3, 2)), position_m=[0.5, 1.0])
found = beamid.identify(record, beam, window_s=(0.8, 1.6), filter="ukf")
value: float = found["damping_ratio"].interval(0.95)[0]
text: str = beamid.list("filters")
"""


class Stub(unittest.TestCase):
    def test_the_stub_is_what_write_stub_writes(self):
        made = subprocess.run([sys.executable, SOURCE / "apps/python/stub/write_stub.py"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(STUB.read_text(), made, "run apps/python/stub/write_stub.py as its first lines say")

    def test_public_names_are_those_of_the_module(self):
        tree = ast.parse(STUB.read_text())
        names = {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))} - {"_Structure"}
        self.assertEqual(names, {*beamid.__all__, *_commands.names()})
        for node in tree.body:
            if not isinstance(node, ast.ClassDef) or node.name.startswith("_"):
                continue
            one = getattr(beamid, node.name)
            stubbed = {item.name if isinstance(item, ast.FunctionDef) else item.target.id for item in node.body
                       if isinstance(item, (ast.FunctionDef, ast.AnnAssign))}
            public = {name for name in vars(one) if not name.startswith("_")}
            self.assertLessEqual(public, stubbed | {name for base in one.__mro__[1:] for name in vars(base)}, node.name)

    def test_mypy_takes_a_program_that_uses_it(self):
        try:
            subprocess.run([sys.executable, "-m", "mypy", "--version"], capture_output=True, check=True)
        except subprocess.CalledProcessError:
            self.skipTest("no Debian package mypy")
        with working_folder() as folder:
            (folder / "use.py").write_text(USE)
            (folder / "wrong.py").write_text(USE + "beamid.identify(3)\n")
            for file, code in (("use.py", 0), ("wrong.py", 1)):
                done = subprocess.run([sys.executable, "-m", "mypy", "--follow-imports=silent", "--ignore-missing-imports", file],
                                      capture_output=True, text=True, check=False,
                                      env={**os.environ, "MYPYPATH": str(STUB.parents[1])})
                self.assertEqual(done.returncode, code, done.stdout)


if __name__ == "__main__":
    unittest.main()
