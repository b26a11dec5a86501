"""Functions and classes have the words of commands and experiment files. Oracle: what the executable's help and lists
print, and docs/configuration.md."""
import inspect
import re
import unittest

import beamid
from beamid import _commands, _specification
from support import SOURCE, beamid as command


def printed(*words):
    return command(*words).stdout.decode()


class Vocabulary(unittest.TestCase):
    def test_every_command_is_a_function_but_those_that_only_a_shell_needs(self):
        listed = re.findall(r"^  ([a-z_]+) {2,}", printed("--help"), re.M)
        self.assertGreater(len(listed), 20)
        for name in listed:
            self.assertEqual(hasattr(beamid, name), name not in _commands.SHELL_ONLY, name)

    def test_every_option_is_a_keyword_with_its_help(self):
        for name in _commands.names():
            if name == "stream":
                continue
            help_text = printed("help", name)
            options = set(re.findall(r"^ {2}(?:-\w, |    )--([a-z-]+)", help_text, re.M)) - {"help", "version"}
            keywords = {keyword.rstrip("_").replace("_", "-") for keyword, parameter in
                        inspect.signature(getattr(beamid, name)).parameters.items()
                        if parameter.kind == parameter.KEYWORD_ONLY}
            self.assertEqual(options - {"json", "quiet", "config"}, keywords - {"config"}, name)
            for keyword in keywords:
                self.assertRegex(getattr(beamid, name).__doc__, f":param {keyword.replace('-', '_')}_?:")

    def test_the_keywords_of_structures_are_the_keys_of_their_tables(self):
        page = (SOURCE / "docs/configuration.md").read_text()
        for one in (beamid.Beam, beamid.Chain, beamid.Frame, beamid.SpaceFrame, beamid.System):
            table = re.sub(r"(?<!^)([A-Z])", r"_\1", one.__name__).lower()
            section = re.search(rf"\n#+ `\[{table}\]`.*?\n(.*?)\n#", page, re.S).group(1)
            documented = set(re.findall(r"^\| `(\w+)` \|", section, re.M))
            known = {key for key, about in _specification.tables()[table].items()
                     if about["type"] not in ("table", "tables")}
            self.assertEqual(documented, known, table)
            for key in known:
                self.assertIn(key, one.__doc__)

    def test_unknown_keywords_are_refused_with_the_one_that_was_meant(self):
        for call, message in (
                (lambda: beamid.Beam(lenght_m=1), "Beam has no keyword 'lenght_m'; did you mean 'length_m'?"),
                (lambda: beamid.modes(tip_mas=1), "modes has no keyword 'tip_mas'; did you mean 'tip_mass'?"),
                (lambda: beamid.modal("x", windw_s=(1, 2)), "modal has no keyword 'windw_s'; did you mean 'window_s'?"),
                (lambda: beamid.list("filters", kind=1), "list has no keyword 'kind'; known: "),
                (lambda: beamid.modes(beam={"spring": []}), "beam has no keyword 'spring'; did you mean 'springs'?"),
                (lambda: beamid.Record([0.0], acceleratio_g=[0.0]), "Record has no keyword 'acceleratio_g'; did you"),
                (lambda: beamid.identify(sampling_rate_hz=1), "'sampling_rate_hz' is a key of [simulation] and [record]")):
            with self.assertRaises(beamid.InputError) as refused:
                call()
            self.assertIn(message, str(refused.exception))

    def test_impossible_values_are_refused_by_their_keys_and_not_by_files_that_nobody_saw(self):
        with self.assertRaises(beamid.InputError) as refused:
            beamid.modes(beamid.Beam(length_m=-1.0, bending_stiffness_n_m2=1.0, mass_kg=1.0))
        self.assertEqual(str(refused.exception), "beam.length_m is -1; expected a positive number")

    def test_what_the_command_says_of_options_is_said_of_keywords(self):
        for call, message in (
                (lambda: beamid.modes(elements=0), "modes: elements is 0; expected a whole number from 1 to "),
                (lambda: beamid.identify("a.csv"), "a.csv: no such file"),
                (lambda: beamid.identify("a.csv", "nowhere.toml"), "nowhere.toml: no such file")):
            with self.assertRaises(beamid.InputError) as refused:
                call()
            self.assertTrue(str(refused.exception).startswith(message), str(refused.exception))

    def test_a_text_stands_for_the_first_key_of_a_table(self):
        self.assertEqual(beamid.Experiment(filter="ukf", parameters=["mass", {"quantity": "tip_mass"}]).keywords,
                         {"filter": {"method": "ukf"}, "parameters": [{"quantity": "mass"}, {"quantity": "tip_mass"}]})

    def test_text_of_toml_reads_back_as_it_was(self):
        import tomllib

        from beamid._toml import toml_text

        root = {"title": "a \"b\"\n\\ µ\x01", "beam": {"length_m": 0.1 + 0.2, "elements": 3, "springs": [{"position_m": 1e-300}]},
                "record": {"window_s": [0.0, 1e22], "time": {"column": "t [s]", "unit": "s"}, "channels": []}}
        self.assertEqual(tomllib.loads(toml_text(root)), root)


if __name__ == "__main__":
    unittest.main()
