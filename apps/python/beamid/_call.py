"""From arguments and keywords to the words of a command, and to what it finds."""
import contextlib
import os
import re
import shlex
import subprocess
import sys
import tempfile

from . import _beamid
from ._arrays import ArrayRecord, is_array
from ._errors import InputError, unknown
from ._matrices import as_matrices, matrix_files
from ._record import Record, RecordFile
from ._results import Results, write_input
from ._specification import commands, keyword_of, table_of_key, tables
from ._structures import Experiment, Table, _with_absolute_files, checked
from ._toml import toml_text

NOT_OFFERED = ("json", "quiet", "config")  # Results have both; config is an argument of every function
UNKNOWN = "unknown"  # unknown=[...] is parameters=[...] of model="beam", unless a model is named


class _Call:
    """One call on its way to the command's words."""

    def __init__(self, name, arguments, keywords):
        self.name, self.about = name, commands()[name]
        self.options = {option["name"]: option for option in self.about["options"]}
        self.keywords = {keyword_of(option): option for option in self.about["options"]
                         if option["name"] not in NOT_OFFERED}
        self.takes = [word["name"] for word in self.about["words"]]
        self.root, self.records, self.words = {}, [], []
        self.inputs = {}  # files that have only been in memory, by name
        self.config = keywords.pop("config", None)
        self.arrays = []
        for argument in arguments:
            self.take_argument(argument)
        if self.arrays:
            self.records.append(ArrayRecord(self.arrays, keywords.get("rate"), keywords.pop("quantity", None),
                                            keywords.pop("unit", None)))
        self.option_words, self.given = [], keywords
        for keyword, value in keywords.items():
            if value is not None:
                self.take_keyword(keyword, value)

    # Arguments: structures, records, and the command's own words.

    def take_argument(self, argument):
        if isinstance(argument, (Record, RecordFile)):
            self.records.append(argument)
        elif is_array(argument) and {"record", "like"} & {*self.takes, *self.options}:
            self.arrays.append(argument)
        elif isinstance(argument, Experiment):
            self.merge(argument.keywords)
        elif isinstance(argument, Table):
            self.merge({argument._table: argument.keywords})
        elif isinstance(argument, (list, tuple)):
            for one in argument:
                self.take_argument(one)
        elif isinstance(argument, (str, os.PathLike)):
            if "modes" in self.takes and not self.words:  # the first file is that of the modes, whatever its ending
                self.words.append(os.fspath(argument))
            elif os.fspath(argument).endswith(".toml") and "config" in self.options and self.config is None:
                self.config = argument
            elif "record" in self.takes:
                self.records.append(RecordFile(argument, {}))
            else:
                self.words.append(os.fspath(argument))
        else:
            raise InputError(f"{self.name} takes no {type(argument).__name__}; expected records, arrays, structures "
                             "(Beam, Chain, Frame, SpaceFrame, System, Experiment) or names of files")

    def merge(self, root):
        for table, value in checked("", root, self.name).items():
            if table in self.root and isinstance(value, dict):
                self.root[table] = {**self.root[table], **value}
            else:
                self.root[table] = value

    # Keywords: the command's options, tables of the experiment file, keys of these.

    def take_keyword(self, keyword, value):
        option = self.keywords.get(keyword)
        is_table = isinstance(value, dict) or (isinstance(value, (list, tuple)) and
                                               any(isinstance(one, dict) for one in value))
        if option and not (is_table and keyword in tables()[""]):
            self.option_words += self.option(option, value)
            return
        if not self.takes_experiment():
            raise unknown(self.name, keyword, self.known_keywords())
        table = "parameters" if keyword == UNKNOWN else keyword
        if keyword == UNKNOWN and "model" not in self.root and "model" not in self.given:
            self.take_keyword("model", "beam")
        if isinstance(value, Table) and value._table == table:
            value = value.keywords
        if table in tables()[""]:
            self.merge({table: value})
            return
        holders = table_of_key().get(keyword, [])
        if len(holders) > 1:
            raise InputError(f"{keyword!r} is a key of {' and '.join(f'[{one}]' for one in holders)}; expected it in "
                             f"a table, such as {holders[0]}={{{keyword!r}: {value!r}}}")
        if not holders:
            raise unknown(self.name, keyword, self.known_keywords())
        self.merge({holders[0]: {keyword: value}} if holders[0] else {keyword: value})

    def takes_experiment(self):
        return "config" in self.options or self.name == "validate"

    def known_keywords(self):
        if not self.takes_experiment():
            return self.keywords
        return [*self.keywords, *tables()[""], *table_of_key(), UNKNOWN, "config"]

    def option(self, option, value):
        name = "--" + option["name"]
        if option["type"] == "flag":
            return [name] if value else []
        if isinstance(value, Table):
            root = value.keywords if isinstance(value, Experiment) else {value._table: value.keywords}
            return [name, self.add_experiment(option["name"] + ".toml", root)]
        values = _flat(value)
        if option["values"] != 1:
            return [name, *values]
        if len(values) > 1 and not option["repeats"]:
            raise InputError(f"{keyword_of(option)} is {value!r}; expected one value")
        return [word for one in values for word in (name, one)]

    # Files for the command.

    def add_experiment(self, name, root):
        root = _with_absolute_files(root, os.getcwd())
        if "system" in root:
            keywords, files = matrix_files(as_matrices(root["system"], "system"))
            root = {**root, "system": keywords}
            self.inputs.update(files)
        self.inputs[name] = toml_text(root)
        return name

    def add_records(self):
        """Words that name the records; what [record] says of them goes into the experiment."""
        for record in self.records[1:]:
            if record.keys != self.records[0].keys:
                raise InputError(f"records {self.records[0].name!r} and {record.name!r} have different keys; expected "
                                 "the same channels and window, since a command reads all of them alike")
        names = []
        for number, record in enumerate(self.records, 1):
            name = record.path
            if name is None:
                name = record.file_name
                if name in self.inputs:
                    stem, ending = os.path.splitext(name)
                    name = f"{stem}{number}{ending}"
                self.inputs[name] = record
            names.append(name)
        if not names:
            return []
        if self.records[0].keys:
            mine = self.root.get("record", {})
            self.root["record"] = {**self.records[0].keys, **mine}
        if "record" in self.takes:
            return names
        for option in ("record", "like"):
            if option in self.options:
                return ["--" + option, *names]
        raise InputError(f"{self.name} takes no record")

    def all_words(self):
        """The command's words, with the names of the files that are still to be written."""
        records = self.add_records()
        configs = [os.fspath(one) for one in (self.config if isinstance(self.config, (list, tuple)) else
                                              [self.config] if self.config is not None else [])]
        if self.root:
            if len(configs) > 1:
                raise InputError("several config files take no structure or key beside them")
            if configs:
                base = Experiment.read(configs[0]).keywords
                given, self.root = self.root, {}
                self.merge(base)
                self.merge(given)
            configs = [self.add_experiment("experiment.toml", self.root)]
        if not configs and self.options.get("config", {}).get("required"):
            raise InputError(f"{self.name} needs a structure; expected a Beam, Chain, Frame, SpaceFrame, System or Experiment, or "
                             "an experiment file, config=FILE")
        if self.name == "validate" and not self.words:
            return [*configs, *records, *self.option_words]
        return [*self.words, *records, *(word for one in configs for word in ("--config", one)), *self.option_words]


def _flat(value):
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        values = value.tolist() if hasattr(value, "tolist") else value
        return [word for one in (values if isinstance(values, (list, tuple)) else [values]) for word in _flat(one)]
    return [repr(value) if isinstance(value, float) else os.fspath(value) if isinstance(value, os.PathLike)
            else str(value)]


def _placed(words, inputs, folder):
    return [os.path.join(folder, word) if word in inputs else word for word in words]


def _python_message(message, name, folder):
    """Files that the user never saw are no places, and an option is a keyword: "modes: elements is 0; expected ..."."""
    message = message.removeprefix("beamid: ")
    for option in commands()[name]["options"]:
        message = re.sub(rf"--{option['name']}\b(?!-)", keyword_of(option), message)
    if folder:
        message = re.sub(re.escape(folder) + r"/[^/:]*\.toml(:\d+)*: ", "", message).replace(folder + "/", "")
    return message


def _memory_for(inputs):
    """A folder in memory, where there is one with room; else None, the usual place."""
    size = sum(30 * content.numbers for content in inputs.values() if isinstance(content, (Record, ArrayRecord)))  # bytes of text
    try:
        free = os.statvfs("/dev/shm")
    except OSError:
        return None
    has_room = free.f_bavail * free.f_frsize > 10 * (size + 1_000_000)
    return "/dev/shm" if has_room and os.access("/dev/shm", os.W_OK | os.X_OK) else None


@contextlib.contextmanager
def _folder_of(inputs):
    """A private folder with these files, for the time of a call; none where nothing has only been in memory."""
    if not inputs:
        yield ""
        return
    with tempfile.TemporaryDirectory(prefix="beamid_", dir=_memory_for(inputs)) as folder:
        for file, content in inputs.items():
            write_input(content, os.path.join(folder, file))
        yield folder


def call(name, arguments, keywords):
    one = _Call(name, arguments, dict(keywords))
    words = one.all_words()
    with _folder_of(one.inputs) as folder:
        outcome = _beamid.run(name, _placed(words, one.inputs, folder))
        if outcome.message:
            raise (InputError if outcome.code == 2 else RuntimeError)(_python_message(outcome.message, name, folder))
        if not outcome.has_results:
            return outcome.report().replace(folder + "/", "") if folder else outcome.report()
    return Results(outcome, shlex.join(["beamid", name, *words]), one.inputs)


def stream(record, *arguments, **keywords):
    """Estimates after each sample, as `beamid stream` prints them: a dictionary of columns, numpy arrays (N).

    :param record: whose samples arrive one after the other, as its file says or as [record] prepares them
    :param arguments: a structure; like=RECORD, an earlier record of the rig, from which noise, amplitude and sampling
        interval are taken; without it this one

    >>> import beamid
    >>> folder = "docs/tutorials/02_identify_a_record/"
    >>> found = beamid.stream(beamid.read(folder + "tip_acceleration.csv"), config=folder + "cantilever.toml")
    >>> round(found["damping_ratio"][-1], 4), found["status"][-1]
    (0.0045, 'settled')
    """
    from ._results import _columns  # pylint: disable=import-outside-toplevel

    record = record if isinstance(record, (Record, RecordFile)) else RecordFile(record, {})
    one = _Call("stream", arguments, dict(keywords))
    with tempfile.TemporaryDirectory(prefix="beamid_") as folder:
        if not one.records and "like" not in keywords:
            one.records = [record]
        words = one.all_words()
        for file, content in one.inputs.items():
            write_input(content, os.path.join(folder, file))
        if record.path is None:
            record.save(os.path.join(folder, "samples.csv"))
            record = RecordFile(os.path.join(folder, "samples.csv"), record.keys)
        lines = "".join(f"{t!r},{','.join(map(repr, row))}\n" for t, row in
                        zip(record.time.tolist(), record.samples.tolist()))
        search = os.pathsep.join([os.path.dirname(os.path.dirname(__file__)), os.environ.get("PYTHONPATH", "")])
        done = subprocess.run([sys.executable, "-m", "beamid", "stream", *_placed(words, one.inputs, folder)],
                              input=lines, capture_output=True, text=True, check=False,
                              env={**os.environ, "PYTHONPATH": search.rstrip(os.pathsep)})
        if done.returncode == 2:
            raise InputError(_python_message(done.stderr.split("\nTry: ")[0].strip(), "stream", folder))
    header, *rows = [line.split(",") for line in done.stdout.splitlines()]
    return _columns([{key: _number(cell) for key, cell in zip(header, row)} for row in rows])


def _number(cell):
    try:
        return float(cell)
    except ValueError:
        return cell or None
