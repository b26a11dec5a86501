"""Every example of the docstrings, of docs/python.md, of the guide from_matlab_and_python and of docs/tutorials/python gives what it shows."""
import contextlib
import doctest
import importlib.util
import io
import os
import pkgutil
import re
import unittest

import numpy as np

import beamid
from beamid import _commands
from support import SOURCE, working_folder

if hasattr(np, "long"):  # NumPy 2 shows its scalars as np.float64(3.5); pages show the numbers
    np.set_printoptions(legacy="1.25")
UPDATES = bool(os.environ.get("BEAMID_UPDATE_GOLDEN"))  # writes what is printed into the pages, in place of comparing
FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


class Remembering(doctest.DocTestRunner):
    """Puts the examples and what they print together again."""

    text = ""

    def add(self, example, printed):
        lines = example.source.rstrip("\n").split("\n")
        self.text += f">>> {lines[0]}\n" + "".join(f"... {line}\n" for line in lines[1:]) + printed

    def report_success(self, out, test, example, got):
        self.add(example, example.want)

    def report_failure(self, out, test, example, got):
        self.add(example, got)
        super().report_failure(out, test, example, got)

    def report_unexpected_exception(self, out, test, example, exc_info):
        self.add(example, f"Traceback (most recent call last):\n...\nbeamid.{exc_info[0].__name__}: {exc_info[1]}\n")
        super().report_unexpected_exception(out, test, example, exc_info)


def failures(test):
    out = io.StringIO()
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    runner.run(test, out=out.write)
    return runner.summarize(verbose=False).failed, out.getvalue()


class Documentation(unittest.TestCase):
    def setUp(self):
        os.chdir(SOURCE)  # where the examples find the tutorials

    def examples(self, objects):
        for owner in objects:
            for test in doctest.DocTestFinder().find(owner, getattr(owner, "__name__", "beamid"), module=False):
                if test.examples:
                    yield test

    def check(self, tests):
        count = 0
        for test in tests:
            with self.subTest(test.name):
                failed, text = failures(test)
                self.assertEqual(failed, 0, text)
                count += 1
        return count

    def test_examples_of_the_public_names(self):
        public = [beamid, *(getattr(beamid, name) for name in {*beamid.__all__, *_commands.names()})]
        self.assertGreater(self.check(self.examples(public)), 8)

    def test_examples_of_the_private_modules(self):
        for one in pkgutil.iter_modules(beamid.__path__):
            if one.name in ("__main__", "_beamid"):
                continue
            module = importlib.import_module("beamid." + one.name)
            functions = [value for value in vars(module).values()
                         if callable(value) and getattr(value, "__module__", "") == module.__name__]
            self.check(self.examples([module, *functions]))

    def test_the_pages_show_what_their_examples_print(self):
        for name in ("docs/python.md", "docs/guides/from_matlab_and_python.md"):
            with self.subTest(name):
                self.check_page(name)

    def check_page(self, name):
        page = (SOURCE / name).read_text()
        names = {}
        with working_folder() as folder:
            os.symlink(SOURCE / "docs", folder / "docs")
            for block in re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S):
                # A fence shows blank lines as they are; doctest takes them for the end of what is expected.
                marked = re.sub(r"\n(?=\n+(?!>>>)[^\n])", "\n<BLANKLINE>", block)
                test = doctest.DocTestParser().get_doctest(marked, names, name, None, None)
                if importlib.util.find_spec("pandas") is None:
                    test.examples = [one for one in test.examples if ".frame(" not in one.source]
                runner = Remembering(optionflags=FLAGS)
                out = io.StringIO()
                runner.run(test, out=out.write, clear_globs=False)
                names = test.globs
                if UPDATES:
                    page = page.replace(block, runner.text.replace("<BLANKLINE>", ""))
                else:
                    self.assertEqual(runner.summarize(verbose=False).failed, 0, out.getvalue())
        if UPDATES:
            (SOURCE / name).write_text(page)

    def test_the_tutorials_print_what_they_show(self):
        try:
            import matplotlib
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("no python3-matplotlib or python3-pandas")
        matplotlib.use("Agg")
        tutorials = sorted((SOURCE / "docs/tutorials/python").glob("*.py"))
        self.assertGreaterEqual(len(tutorials), 3)
        for tutorial in tutorials:
            with self.subTest(tutorial.name), working_folder() as folder:
                os.symlink(SOURCE / "docs", folder / "docs")
                text, names = "", {"__name__": "__main__"}
                for cell in re.split(r"^(?=# %%)", tutorial.read_text(), flags=re.M):
                    out = io.StringIO()
                    with contextlib.redirect_stdout(out):
                        exec(compile(cell, str(tutorial), "exec"), names)  # pylint: disable=exec-used
                    printed = "".join(f"#> {line}".rstrip() + "\n" for line in out.getvalue().splitlines())
                    shown = "".join(re.findall(r"^#>.*\n", cell, re.M))
                    if not UPDATES:
                        self.assertEqual(printed, shown)
                    text += cell.replace(shown, printed) if shown else cell
                if UPDATES:
                    tutorial.write_text(text)


if __name__ == "__main__":
    unittest.main()
