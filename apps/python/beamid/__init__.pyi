# Written by apps/python/stub/write_stub.py: do not edit.
import builtins  # `list` is a command
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import pandas

_Path = str | os.PathLike[str]
_Number = float | np.floating[Any] | np.integer[Any]
_Table = str | Mapping[str, Any]
_Tables = _Table | Sequence[_Table]
_Argument = Record | RecordFile | npt.ArrayLike | _Structure | _Path | Sequence[Record | RecordFile | _Path]

__version__: str

class InputError(ValueError): ...

class _Structure:
    keywords: dict[str, Any]
    def replace(self, **keywords: Any) -> Any: ...
    def __getattr__(self, name: str) -> Any: ...

class Estimate(float):
    standard_deviation: float
    unit: str
    def __new__(cls, value: float | None, standard_deviation: float | None, unit: str = ..., lower_95: float | None = ...,
                upper_95: float | None = ...) -> Estimate: ...
    @property
    def value(self) -> float: ...
    def interval(self, probability: float = ...) -> tuple[float, float]: ...

class Results:
    command: str
    code: int
    json: str
    report: str
    values: dict[str, Any]
    figures: dict[str, Any]
    arrays: dict[str | tuple[str, str], npt.NDArray[np.float64]]
    covariance: npt.NDArray[np.float64]
    parameters: builtins.list[str]
    @property
    def innovations(self) -> npt.NDArray[np.float64]: ...
    @property
    def reproduced(self) -> npt.NDArray[np.float64]: ...
    @property
    def time(self) -> npt.NDArray[np.float64]: ...
    tables: dict[str, dict[str, npt.NDArray[Any]]]
    estimates: dict[str | tuple[str, str], Estimate]
    @property
    def messages(self) -> builtins.list[dict[str, str]]: ...
    @property
    def verdict(self) -> dict[str, Any]: ...
    def frame(self, table: str | None = ...) -> pandas.DataFrame: ...
    def plot(self, name: str | None = ..., figure: Any = ...) -> Any: ...
    def __getitem__(self, name: str | tuple[str, str]) -> Any: ...
    def __contains__(self, name: object) -> bool: ...
    def keys(self) -> builtins.list[str | tuple[str, str]]: ...
    def write(self, folder: _Path, force: bool = ...) -> None: ...
    def write_inputs(self, folder: _Path = ...) -> builtins.list[str]: ...

class FilterRun:
    mean: npt.NDArray[np.float64]
    covariance: npt.NDArray[np.float64]
    innovations: npt.NDArray[np.float64]
    whitened_innovations: npt.NDArray[np.float64]
    means: npt.NDArray[np.float64]
    deviations: npt.NDArray[np.float64]
    log_likelihood: float
    failure: str | None
    remarks: builtins.list[str]

def run_filter(filter: str, model: Any, outputs: npt.ArrayLike, mean: npt.ArrayLike, covariance: npt.ArrayLike, *,
               inputs: npt.ArrayLike | None = ..., keep: Literal["last", "all"] = ..., **options: Any) -> FilterRun: ...
def run_oscillator(outputs: npt.ArrayLike, interval_s: float, *, mass_kg: float, mean: npt.ArrayLike, covariance: npt.ArrayLike,
                   noise: npt.ArrayLike, observed: str | Sequence[str] = ...,
                   discretisation: Literal["exponential", "forward_euler"] = ...) -> FilterRun: ...
def register_filter(name: str, make: Any, summary: str = ..., options: Mapping[str, Any] | None = ...) -> None: ...

class RecordFile:
    path: str
    keys: dict[str, Any]
    @property
    def name(self) -> str: ...
    @property
    def file_name(self) -> str: ...
    @property
    def time(self) -> npt.NDArray[np.float64]: ...
    @property
    def samples(self) -> npt.NDArray[np.float64]: ...
    @property
    def channels(self) -> builtins.list[dict[str, Any]]: ...
    @property
    def remarks(self) -> builtins.list[str]: ...
    def plot(self, figure: Any = ...) -> Any: ...
    def replace(self, **keys: Any) -> RecordFile: ...

class Record:
    name: str
    keys: dict[str, Any]
    def __init__(self, time: npt.ArrayLike | None = ..., acceleration: npt.ArrayLike | None = ..., *,
        position_m: npt.ArrayLike | None = ..., name: str = ..., rate_hz: _Number | None = ...,
        displacement_m: npt.ArrayLike = ..., displacement_mm: npt.ArrayLike = ...,
        displacement_um: npt.ArrayLike = ..., velocity_m_per_s: npt.ArrayLike = ...,
        velocity_mm_per_s: npt.ArrayLike = ..., acceleration_m_per_s2: npt.ArrayLike = ...,
        acceleration_mm_per_s2: npt.ArrayLike = ..., acceleration_g: npt.ArrayLike = ...,
        force_n: npt.ArrayLike = ..., force_kn: npt.ArrayLike = ..., strain_m_per_m: npt.ArrayLike = ...,
        strain_um_per_m: npt.ArrayLike = ..., base_acceleration_m_per_s2: npt.ArrayLike = ...,
        base_acceleration_mm_per_s2: npt.ArrayLike = ..., base_acceleration_g: npt.ArrayLike = ...,
        support_acceleration_m_per_s2: npt.ArrayLike = ..., support_acceleration_mm_per_s2: npt.ArrayLike = ...,
        support_acceleration_g: npt.ArrayLike = ..., angular_acceleration_rad_per_s2: npt.ArrayLike = ...,
        angular_acceleration_mrad_per_s2: npt.ArrayLike = ..., files: Sequence[str] = ..., reader: str = ...,
        separator: str = ..., decimal: str = ..., header_lines: int = ..., malformed: str = ...,
        missing_input: str = ..., stamps: str = ..., input: str = ..., own_clock: Sequence[str] = ...,
        sampling_rate_hz: _Number = ..., window_s: Sequence[_Number] = ..., prepare: _Tables = ...) -> None: ...
    @property
    def numbers(self) -> int: ...
    @property
    def path(self) -> None: ...
    @property
    def file_name(self) -> str: ...
    def plot(self, figure: Any = ...) -> Any: ...
    def save(self, path: _Path) -> None: ...

class Beam(_Structure):
    def __init__(self, *, length_m: _Number | None = ..., width_m: _Number | None = ...,
        height_m: _Number | None = ..., diameter_m: _Number | None = ..., end_width_m: _Number | None = ...,
        end_height_m: _Number | None = ..., end_diameter_m: _Number | None = ...,
        youngs_modulus_pa: _Number | None = ..., bending_stiffness_n_m2: _Number | None = ...,
        mass_kg: _Number | None = ..., mass_per_length_kg_per_m: _Number | None = ...,
        density_kg_per_m3: _Number | None = ..., theory: str | None = ..., poissons_ratio: _Number | None = ...,
        shear_modulus_pa: _Number | None = ..., shear_factor: _Number | None = ...,
        shear_stiffness_n: _Number | None = ..., rotary_inertia: bool | None = ...,
        rotary_inertia_kg_m: _Number | None = ..., support: str | None = ...,
        root_rotational_stiffness_n_m_per_rad: _Number | None = ...,
        root_translational_stiffness_n_per_m: _Number | None = ..., tip_mass_kg: _Number | None = ...,
        tip_rotary_inertia_kg_m2: _Number | None = ..., tip_eccentricity_m: _Number | None = ...,
        sensor_mass_kg: _Number | None = ..., axial_load_n: _Number | None = ..., mass_model: str | None = ...,
        elements: int | None = ..., segments: _Tables | None = ..., bodies: _Tables | None = ...,
        supports: _Tables | None = ..., springs: _Tables | None = ..., dashpots: _Tables | None = ...,
        absorbers: _Tables | None = ..., damages: _Tables | None = ...,
        added_masses: _Tables | None = ...) -> None: ...

class Chain(_Structure):
    def __init__(self, *, masses_kg: npt.ArrayLike | None = ..., stiffnesses_n_per_m: npt.ArrayLike | None = ...,
        dashpots_n_s_per_m: npt.ArrayLike | None = ..., heights_m: npt.ArrayLike | None = ...,
        layers: _Tables | None = ..., storeys: _Tables | None = ...) -> None: ...

class Frame(_Structure):
    def __init__(self, *, elements_per_member: int | None = ..., mass_model: str | None = ...,
        base_motion: str | None = ..., joints: _Tables | None = ..., members: _Tables | None = ...,
        supports: _Tables | None = ..., bodies: _Tables | None = ..., springs: _Tables | None = ...,
        dashpots: _Tables | None = ...) -> None: ...

class SpaceFrame(_Structure):
    def __init__(self, *, elements_per_member: int | None = ..., mass_model: str | None = ...,
        base_direction: npt.ArrayLike | None = ..., joints: _Tables | None = ..., sections: _Tables | None = ...,
        members: _Tables | None = ..., supports: _Tables | None = ..., bodies: _Tables | None = ...,
        springs: _Tables | None = ..., dashpots: _Tables | None = ...) -> None: ...

class System(_Structure):
    def __init__(self, *, mass: Any | None = ..., stiffness: Any | None = ..., damping: Any | None = ...,
        labels: Sequence[str] | None = ..., base_motion: npt.ArrayLike | None = ...,
        parameters: _Tables | None = ...) -> None: ...
    @classmethod
    def of(cls, function: Any, values: Mapping[str, float], **keywords: Any) -> System: ...

class Experiment(_Structure):
    def __init__(self, *, title: str | None = ..., beam: _Table | _Structure | None = ...,
        chain: _Table | _Structure | None = ..., system: _Table | _Structure | None = ...,
        damping: _Table | _Structure | None = ..., excitation: _Table | _Structure | None = ...,
        excitations: _Tables | None = ..., sensors: _Tables | None = ...,
        acquisition: _Table | _Structure | None = ..., simulation: _Table | _Structure | None = ...,
        frequency_response: _Table | _Structure | None = ..., record: _Table | _Structure | None = ...,
        reduction: _Table | _Structure | None = ..., reductions: _Tables | None = ...,
        model: _Table | _Structure | None = ..., parameters: _Tables | None = ...,
        substructures: _Tables | None = ..., unknown_forces: _Tables | None = ...,
        virtual_sensors: _Tables | None = ..., filter: _Table | _Structure | None = ...,
        filters: _Tables | None = ..., fatigue: _Table | _Structure | None = ...,
        compare: _Table | _Structure | None = ..., identifiability: _Table | _Structure | None = ...,
        prior: _Table | _Structure | None = ..., noise: _Table | _Structure | None = ...,
        frame: _Table | _Structure | None = ..., space_frame: _Table | _Structure | None = ...,
        sweep: _Table | _Structure | None = ...) -> None: ...
    @classmethod
    def read(cls, path: _Path) -> Experiment: ...

def read(path: _Path, *, files: Sequence[str] = ..., reader: str = ..., separator: str = ..., decimal: str = ...,
    header_lines: int = ..., malformed: str = ..., missing_input: str = ..., stamps: str = ..., input: str = ...,
    own_clock: Sequence[str] = ..., sampling_rate_hz: _Number = ..., window_s: Sequence[_Number] = ...,
    time: _Table | _Structure = ..., channels: _Tables = ..., prepare: _Tables = ...) -> RecordFile: ...
def inspect(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., write: str | None = ...,
    column: str | Sequence[str] | None = ..., quantity: str | Sequence[str] | None = ...,
    unit: str | Sequence[str] | None = ..., position: str | Sequence[str] | None = ..., time: str | None = ...,
    rate: _Number | None = ..., window: Sequence[_Number] | None = ..., stamps: str | None = ...,
    delimiter: str | None = ..., decimal: str | None = ..., header_lines: int | None = ...,
    skip_malformed: bool | None = ..., reader: str | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def modal(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., method: str | None = ...,
    band: Sequence[_Number] | None = ..., order: int | None = ..., modes: int | None = ...,
    amplitude: bool | None = ..., events: bool | None = ..., polish: bool | None = ..., no_polish: bool | None = ...,
    column: str | Sequence[str] | None = ..., quantity: str | Sequence[str] | None = ...,
    unit: str | Sequence[str] | None = ..., position: str | Sequence[str] | None = ..., time: str | None = ...,
    rate: _Number | None = ..., window: Sequence[_Number] | None = ..., stamps: str | None = ...,
    delimiter: str | None = ..., decimal: str | None = ..., header_lines: int | None = ...,
    skip_malformed: bool | None = ..., reader: str | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def identify(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., mass: _Number | None = ...,
    window: Sequence[_Number] | Sequence[Sequence[_Number]] | None = ..., on_failure: str | None = ...,
    smoother: str | None = ..., estimator: str | None = ..., damping_law: str | None = ...,
    column: str | Sequence[str] | None = ..., quantity: str | Sequence[str] | None = ...,
    unit: str | Sequence[str] | None = ..., position: str | Sequence[str] | None = ..., time: str | None = ...,
    rate: _Number | None = ..., stamps: str | None = ..., delimiter: str | None = ..., decimal: str | None = ...,
    header_lines: int | None = ..., skip_malformed: bool | None = ..., reader: str | None = ...,
    out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...,
    **keys: Any) -> Results: ...
def modes(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., modes: int | None = ...,
    surface: bool | None = ..., length: _Number | None = ..., width: _Number | None = ...,
    height: _Number | None = ..., diameter: _Number | None = ..., youngs_modulus: _Number | None = ...,
    density: _Number | None = ..., beam_mass: _Number | None = ..., tip_mass: _Number | None = ...,
    tip_inertia: _Number | None = ..., tip_eccentricity: _Number | None = ..., axial_load: _Number | None = ...,
    root_rotational_stiffness: _Number | None = ..., support: str | None = ..., damping_ratio: _Number | None = ...,
    elements: int | None = ..., out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ...,
    no_progress: bool | None = ..., **keys: Any) -> Results: ...
def simulate(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., duration: _Number | None = ...,
    sampling_rate: _Number | None = ..., method: str | None = ..., surface: bool | None = ...,
    length: _Number | None = ..., width: _Number | None = ..., height: _Number | None = ...,
    diameter: _Number | None = ..., youngs_modulus: _Number | None = ..., density: _Number | None = ...,
    beam_mass: _Number | None = ..., tip_mass: _Number | None = ..., tip_inertia: _Number | None = ...,
    tip_eccentricity: _Number | None = ..., axial_load: _Number | None = ...,
    root_rotational_stiffness: _Number | None = ..., support: str | None = ..., damping_ratio: _Number | None = ...,
    elements: int | None = ..., out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ...,
    no_progress: bool | None = ..., **keys: Any) -> Results: ...
def compare(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ...,
    truth: _Path | _Structure | None = ..., channel: str | Sequence[str] | None = ...,
    reduction: str | Sequence[str] | None = ..., filter: str | Sequence[str] | None = ...,
    discretisation: str | Sequence[str] | None = ..., model: str | None = ..., length: _Number | None = ...,
    width: _Number | None = ..., height: _Number | None = ..., diameter: _Number | None = ...,
    youngs_modulus: _Number | None = ..., density: _Number | None = ..., beam_mass: _Number | None = ...,
    tip_mass: _Number | None = ..., tip_inertia: _Number | None = ..., tip_eccentricity: _Number | None = ...,
    axial_load: _Number | None = ..., root_rotational_stiffness: _Number | None = ..., support: str | None = ...,
    damping_ratio: _Number | None = ..., elements: int | None = ..., column: str | Sequence[str] | None = ...,
    quantity: str | Sequence[str] | None = ..., unit: str | Sequence[str] | None = ...,
    position: str | Sequence[str] | None = ..., time: str | None = ..., rate: _Number | None = ...,
    stamps: str | None = ..., delimiter: str | None = ..., decimal: str | None = ..., header_lines: int | None = ...,
    skip_malformed: bool | None = ..., reader: str | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def report(*arguments: _Argument, out: _Path | None = ..., pdf: _Path | None = ..., png: _Path | None = ...,
    all: bool | None = ..., force: bool | None = ...) -> str: ...
def prepare(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ...,
    column: str | Sequence[str] | None = ..., quantity: str | Sequence[str] | None = ...,
    unit: str | Sequence[str] | None = ..., position: str | Sequence[str] | None = ..., time: str | None = ...,
    rate: _Number | None = ..., stamps: str | None = ..., delimiter: str | None = ..., decimal: str | None = ...,
    header_lines: int | None = ..., skip_malformed: bool | None = ..., reader: str | None = ...,
    out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...,
    **keys: Any) -> Results: ...
def track(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., band: Sequence[_Number] | None = ...,
    walk: _Number | None = ..., false_alarms: _Number | None = ..., shortest: _Number | None = ...,
    column: str | Sequence[str] | None = ..., quantity: str | Sequence[str] | None = ...,
    unit: str | Sequence[str] | None = ..., position: str | Sequence[str] | None = ..., time: str | None = ...,
    rate: _Number | None = ..., window: Sequence[_Number] | None = ..., stamps: str | None = ...,
    delimiter: str | None = ..., decimal: str | None = ..., header_lines: int | None = ...,
    skip_malformed: bool | None = ..., reader: str | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def backbone(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ...,
    band: Sequence[_Number] | None = ..., mass: _Number | None = ..., amplitude_ratio: _Number | None = ...,
    fewest_cycles: _Number | None = ..., linear: _Number | None = ..., column: str | Sequence[str] | None = ...,
    quantity: str | Sequence[str] | None = ..., unit: str | Sequence[str] | None = ...,
    position: str | Sequence[str] | None = ..., time: str | None = ..., rate: _Number | None = ...,
    window: Sequence[_Number] | None = ..., stamps: str | None = ..., delimiter: str | None = ...,
    decimal: str | None = ..., header_lines: int | None = ..., skip_malformed: bool | None = ...,
    reader: str | None = ..., out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ...,
    no_progress: bool | None = ..., **keys: Any) -> Results: ...
def stream(record: Record | RecordFile | _Path, *arguments: _Argument, config: _Path | Sequence[_Path] | None = ...,
    like: _Path | None = ..., on_failure: str | None = ..., resume: _Path | None = ...,
    save_state: _Path | None = ..., column: str | Sequence[str] | None = ...,
    quantity: str | Sequence[str] | None = ..., unit: str | Sequence[str] | None = ...,
    position: str | Sequence[str] | None = ..., time: str | None = ..., rate: _Number | None = ...,
    stamps: str | None = ..., delimiter: str | None = ..., decimal: str | None = ..., header_lines: int | None = ...,
    skip_malformed: bool | None = ..., reader: str | None = ..., **keys: Any) -> dict[str, npt.NDArray[Any]]: ...
def check(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., model_error: _Number | None = ...,
    shape_error: _Number | None = ..., candidate: str | Sequence[str] | None = ..., method: str | None = ...,
    band: Sequence[_Number] | None = ..., column: str | Sequence[str] | None = ...,
    quantity: str | Sequence[str] | None = ..., unit: str | Sequence[str] | None = ...,
    position: str | Sequence[str] | None = ..., time: str | None = ..., rate: _Number | None = ...,
    stamps: str | None = ..., delimiter: str | None = ..., decimal: str | None = ..., header_lines: int | None = ...,
    skip_malformed: bool | None = ..., reader: str | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def steps(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ...,
    window: Sequence[_Number] | None = ..., discretisation: str | Sequence[str] | None = ...,
    steps: int | None = ..., whole_model: bool | None = ..., published_xi: _Number | None = ...,
    scheme: str | None = ..., interval: _Number | None = ..., frequency: _Number | None = ...,
    column: str | Sequence[str] | None = ..., quantity: str | Sequence[str] | None = ...,
    unit: str | Sequence[str] | None = ..., position: str | Sequence[str] | None = ..., time: str | None = ...,
    rate: _Number | None = ..., stamps: str | None = ..., delimiter: str | None = ..., decimal: str | None = ...,
    header_lines: int | None = ..., skip_malformed: bool | None = ..., reader: str | None = ...,
    out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...,
    **keys: Any) -> Results: ...
def sense(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., at: str | Sequence[str] | None = ...,
    filter: str | None = ..., column: str | Sequence[str] | None = ..., quantity: str | Sequence[str] | None = ...,
    unit: str | Sequence[str] | None = ..., position: str | Sequence[str] | None = ..., time: str | None = ...,
    rate: _Number | None = ..., stamps: str | None = ..., delimiter: str | None = ..., decimal: str | None = ...,
    header_lines: int | None = ..., skip_malformed: bool | None = ..., reader: str | None = ...,
    out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...,
    **keys: Any) -> Results: ...
def substructures(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., no_whole: bool | None = ...,
    column: str | Sequence[str] | None = ..., quantity: str | Sequence[str] | None = ...,
    unit: str | Sequence[str] | None = ..., position: str | Sequence[str] | None = ..., time: str | None = ...,
    rate: _Number | None = ..., stamps: str | None = ..., delimiter: str | None = ..., decimal: str | None = ...,
    header_lines: int | None = ..., skip_malformed: bool | None = ..., reader: str | None = ...,
    out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...,
    **keys: Any) -> Results: ...
def update(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., model_error: _Number | None = ...,
    shape_error: _Number | None = ..., starts: int | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def twins(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., model_error: _Number | None = ...,
    shape_error: _Number | None = ..., starts: int | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def posterior(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., model_error: _Number | None = ...,
    shape_error: _Number | None = ..., starts: int | None = ..., draws: int | None = ...,
    particles: int | None = ..., seed: int | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def frf(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., from_: _Number | None = ...,
    to: _Number | None = ..., kind: str | None = ..., length: _Number | None = ..., width: _Number | None = ...,
    height: _Number | None = ..., diameter: _Number | None = ..., youngs_modulus: _Number | None = ...,
    density: _Number | None = ..., beam_mass: _Number | None = ..., tip_mass: _Number | None = ...,
    tip_inertia: _Number | None = ..., tip_eccentricity: _Number | None = ..., axial_load: _Number | None = ...,
    root_rotational_stiffness: _Number | None = ..., support: str | None = ..., damping_ratio: _Number | None = ...,
    elements: int | None = ..., out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ...,
    no_progress: bool | None = ..., **keys: Any) -> Results: ...
def frame(*arguments: _Argument, modes: int | None = ..., elements: int | None = ..., out: _Path | None = ...,
    force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...) -> Results: ...
def reduce(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ...,
    reduction: str | Sequence[str] | None = ..., shape_file: _Path | None = ..., modes: int | None = ...,
    band: _Number | None = ..., length: _Number | None = ..., width: _Number | None = ...,
    height: _Number | None = ..., diameter: _Number | None = ..., youngs_modulus: _Number | None = ...,
    density: _Number | None = ..., beam_mass: _Number | None = ..., tip_mass: _Number | None = ...,
    tip_inertia: _Number | None = ..., tip_eccentricity: _Number | None = ..., axial_load: _Number | None = ...,
    root_rotational_stiffness: _Number | None = ..., support: str | None = ..., damping_ratio: _Number | None = ...,
    elements: int | None = ..., out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ...,
    no_progress: bool | None = ..., **keys: Any) -> Results: ...
def identifiability(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., model: str | None = ...,
    reduction: str | None = ..., duration: _Number | None = ..., sampling_rate: _Number | None = ...,
    length: _Number | None = ..., width: _Number | None = ..., height: _Number | None = ...,
    diameter: _Number | None = ..., youngs_modulus: _Number | None = ..., density: _Number | None = ...,
    beam_mass: _Number | None = ..., tip_mass: _Number | None = ..., tip_inertia: _Number | None = ...,
    tip_eccentricity: _Number | None = ..., axial_load: _Number | None = ...,
    root_rotational_stiffness: _Number | None = ..., support: str | None = ..., damping_ratio: _Number | None = ...,
    elements: int | None = ..., out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ...,
    no_progress: bool | None = ..., **keys: Any) -> Results: ...
def sweep(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ...,
    truth: _Path | _Structure | None = ..., vary: str | Sequence[str] | None = ..., random: int | None = ...,
    seeds: int | None = ..., seed: int | None = ..., once: bool | None = ..., threads: int | None = ...,
    resume: bool | None = ..., shard: str | None = ..., merge: str | Sequence[str] | None = ...,
    out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...,
    **keys: Any) -> Results: ...
def efficiency(*arguments: _Argument, study: str | None = ..., model: str | None = ..., only: int | None = ...,
    filter: str | Sequence[str] | None = ..., damping_ratio: _Number | Sequence[_Number] | None = ...,
    passes: str | None = ..., guess: str | None = ..., runs: int | None = ..., sampled_runs: int | None = ...,
    seed: int | None = ..., noise: _Number | None = ..., out: _Path | None = ..., force: bool | None = ...,
    verbose: bool | None = ..., no_progress: bool | None = ...) -> Results: ...
def atlas(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., frequency: _Number | None = ...,
    damping_ratio: _Number | None = ..., interval: _Number | None = ..., out: _Path | None = ...,
    force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def budget(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., seed: _Number | None = ...,
    orders: _Number | None = ..., noise: _Number | None = ..., bias: _Number | None = ...,
    sensor_mass: _Number | None = ..., amplitude_damping: _Number | None = ..., out: _Path | None = ...,
    force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ..., **keys: Any) -> Results: ...
def noise(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., modes: _Number | None = ...,
    trials: _Number | None = ..., seed: _Number | None = ..., noise: _Number | None = ...,
    blow: _Number | None = ..., interval: _Number | None = ..., duration: _Number | None = ...,
    out: _Path | None = ..., force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...,
    **keys: Any) -> Results: ...
def paper(*arguments: _Argument, seed: _Number | None = ..., trials: _Number | None = ..., out: _Path | None = ...,
    force: bool | None = ..., verbose: bool | None = ..., no_progress: bool | None = ...) -> Results: ...
def new(*arguments: _Argument, structure: str | None = ..., force: bool | None = ...) -> str: ...
def validate(*arguments: _Argument, config: _Path | Sequence[_Path] | None = ..., record: _Path | None = ...,
    **keys: Any) -> str: ...
def list(*arguments: _Argument) -> str: ...
