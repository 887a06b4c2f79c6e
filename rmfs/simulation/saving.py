"""Simulations in files: a header that identifies the file, and the simulation itself."""

from __future__ import annotations

import io
import json
import pickle
from typing import TYPE_CHECKING, Any, TypeVar

from rmfs.code import code_hash
from rmfs.digest import digest
from rmfs.errors import InputError
from rmfs.files import replacing
from rmfs.simulation.arrays import ArrayPickler

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.simulation.kernel import Kernel

FORMAT = "rmfs-checkpoint/1"

K = TypeVar("K", bound="Kernel")


def save(simulation: Kernel, path: Path) -> None:
    """Save a simulation to a file; see `Simulation.save`."""
    stream = io.BytesIO()
    ArrayPickler(stream).dump(simulation)
    header = {
        "format": FORMAT,
        "code": code_hash(),
        "time_s": simulation.now_s,
        "inputs": inputs_of(simulation),
    }
    with replacing(path) as temporary, temporary.open("wb") as file:
        file.write(json.dumps(header).encode() + b"\n")
        file.write(stream.getbuffer())


def load(kind: type[K], path: Path) -> K:
    """Load a simulation, which must be of class `kind`, from a file; see `Simulation.load`."""
    try:
        with path.open("rb") as file:
            header, content = _header(file.readline(), path), file.read()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from None
    if header["code"] != code_hash():
        raise InputError(
            f"{path}: was written by another version of rmfs ({header['code']}, this is "
            f"{code_hash()}); start the run again"
        )
    try:
        simulation = pickle.loads(content)
    except Exception as error:
        raise InputError(f"{path}: damaged ({type(error).__name__}: {error})") from None
    if not isinstance(simulation, kind):
        raise InputError(f"{path}: holds a {type(simulation).__name__}, not a {kind.__name__}")
    return simulation


def refuse_other(path: Path, simulation: Kernel) -> None:
    """Raise an error if the run saved in a file had other inputs than the given simulation.

    Raises
    ------
    InputError
        If layout, scenario, controllers, seed, pacing, measures or the recording of a trace differ
        (the message names which), or if the file cannot be read.
    """
    try:
        with path.open("rb") as file:
            header = _header(file.readline(), path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from None
    now = inputs_of(simulation)
    other = [name for name in now if header["inputs"].get(name) != now[name]]
    if other:
        raise InputError(
            f"{path}: belongs to a run with another {', '.join(other)}; use the same inputs, or "
            "start the run again"
        )


def inputs_of(simulation: Kernel) -> dict[str, str]:
    """Return, by name, the values in which a resumed run must agree with a simulation.

    They are the seed; hashes of the layout, scenario, controllers, pacing and choice of measures;
    and whether a trace is recorded.
    """
    measures = getattr(simulation, "measures", [])
    return {
        "layout": digest(simulation.layout),
        "scenario": digest(simulation.scenario.model_dump(mode="json")),
        "controllers": digest(simulation.controllers.to_table()),
        "seed": str(simulation.seed),
        "pacing": digest(simulation.pacing),
        "choice of measures": digest(sorted(type(one).__qualname__ for one in measures)),
        "choice of trace": str(getattr(simulation, "log", None) is not None),
    }


def _header(line: bytes, path: Path) -> dict[str, Any]:
    try:
        header = json.loads(line)
    except ValueError:
        header = None
    if not isinstance(header, dict) or header.get("format") != FORMAT:
        raise InputError(f"{path}: is not a checkpoint ({FORMAT})")
    if not isinstance(header.get("code"), str) or not isinstance(header.get("inputs"), dict):
        raise InputError(f"{path}: damaged (its header is incomplete)")
    return header
