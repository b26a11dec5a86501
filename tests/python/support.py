"""What the tests of the Python module share: the command as a user runs it, and a copy of the tutorials."""
import contextlib
import os
import pathlib
import shutil
import subprocess
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
COMMAND = os.environ.get("BEAMID_COMMAND", str(SOURCE / "build/release/bin/beamid"))
TUTORIAL = SOURCE / "docs/tutorials/02_identify_a_record"
STEEL = dict(length_m=1.1, width_m=0.06, height_m=0.006, youngs_modulus_pa=2.12e11, mass_kg=3.055, tip_mass_kg=0.36049)


def beamid(*words, folder=SOURCE):
    """The executable, the oracle of these tests."""
    return subprocess.run([COMMAND, *map(str, words)], cwd=folder, capture_output=True, check=False)


def shell(line, folder):
    """A line as a user types it, where `beamid` is the executable."""
    return subprocess.run(["bash", "-c", f"beamid() {{ '{COMMAND}' \"$@\"; }}\n{line}"], cwd=folder,
                          capture_output=True, check=False)


@contextlib.contextmanager
def working_folder():
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            yield pathlib.Path(folder)
        finally:
            os.chdir(before)


@contextlib.contextmanager
def copy_of_tutorials():
    with working_folder() as folder:
        shutil.copytree(SOURCE / "docs/tutorials", folder / "docs/tutorials")
        yield folder
