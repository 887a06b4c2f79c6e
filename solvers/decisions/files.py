"""Files of questions and files of answers: validated when read, and written atomically."""

from __future__ import annotations

import gzip
import io
import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError
from rmfs.files import read_bounded, replacing
from rmfs.solvers.decisions.coding import content_hash, decoded, encoded, sizes_of
from rmfs.solvers.decisions.schema import SCHEMAS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.solvers.decisions.schema import Plain, Schema

QUESTION = "rmfs-decision/1"
SOLUTION = "rmfs-decision-solution/1"
NAMED_BY = 16
"""Number of digits of the hash in the name of a file."""
_LARGEST_MIB = 256


@dataclass(frozen=True, eq=False)
class Found:
    """An answer to a question, and how it was found.

    Attributes
    ----------
    values
        Fields of the answer; None if there is no answer.
    objective, bound
        Value of the answer and proven bound, as stated by the solver; nan if unknown.
    by
        How the answer was found: method, seed, limits, status, work, ...
    """

    values: Plain | None
    objective: float = math.nan
    bound: float = math.nan
    by: Mapping[str, Any] = field(default_factory=dict)

    @property
    def is_there(self) -> bool:
        """Whether there is an answer."""
        return self.values is not None


@dataclass(frozen=True, eq=False)
class Decision:
    """A question to an optimiser, in the form in which it is saved.

    Attributes
    ----------
    family
        Name of the question's family, a key of `SCHEMAS`.
    data
        Fields of the question.
    provenance
        Where the question comes from: run, simulated time, decision problem, controller.
    asked
        How a controller asked the question: the name of the controller (`by`, as in
        `asking.ASKERS`), and the settings passed along with the data. Empty if no shipped
        controller asked.
    recorded
        The answer given in the run, if there was one.
    """

    family: str
    data: Plain
    provenance: Mapping[str, Any] = field(default_factory=dict)
    asked: Mapping[str, Any] = field(default_factory=dict)
    recorded: Found | None = None

    @property
    def schema(self) -> Schema:
        """Definition of the question's fields."""
        return SCHEMAS[self.family]

    @property
    def hash(self) -> str:
        """Hash of family and data, which identifies the question."""
        return content_hash(self.family, self.data)

    @property
    def name(self) -> str:
        """Name of the question's file, without the suffix."""
        return f"{self.family}-{self.hash[:NAMED_BY]}"

    @property
    def sizes(self) -> dict[str, int]:
        """Sizes of the question's dimensions, by the letters that name them in the schema."""
        return sizes_of(self.family, self.data)

    @property
    def sign(self) -> int:
        """1 if the objective is minimised, -1 if it is maximised."""
        return -1 if self.schema.maximise else 1


def write(decision: Decision, folder: Path) -> bool:
    """Write a question to a folder, as a compressed file that is named by `Decision.name`.

    Returns
    -------
    Whether the file is new. If the folder already contains the question, nothing is written.
    """
    path = folder / f"{decision.name}.json.gz"
    if path.exists():
        return False
    write_to(decision, path)
    return True


def write_to(decision: Decision, path: Path) -> None:
    """Write a question to a file, which is compressed if the path ends in `.gz`."""
    told: dict[str, Any] = {
        "format": QUESTION,
        "family": decision.family,
        "hash": decision.hash,
        "provenance": dict(decision.provenance),
        "asked": dict(decision.asked),
        "recorded": None,
        "data": encoded(decision.schema.data, decision.data),
    }
    if decision.recorded is not None:
        told["recorded"] = _told(decision.schema, decision.recorded)
    _write(path, told)


def write_solution(decision: Decision, found: Found, path: Path) -> None:
    """Write an answer to a file, which is compressed if the path ends in `.gz`."""
    head = {"format": SOLUTION, "family": decision.family, "question": decision.hash}
    _write(path, {**head, **_told(decision.schema, found)})


def read(path: Path) -> Decision:
    """Read a question.

    Raises
    ------
    InputError
        If the file is not a question, or its data do not match the hash that it states.
    """
    raw = _read(path, QUESTION)
    family = raw.get("family")
    if not isinstance(family, str) or family not in SCHEMAS:
        raise InputError(f"{path}: family: must be one of {', '.join(SCHEMAS)}, not {family!r}")
    schema = SCHEMAS[family]
    data = decoded(str(path), schema, "data", raw.get("data"))
    decision = Decision(family, data, _object(path, raw, "provenance"), _object(path, raw, "asked"))
    if raw.get("hash") != decision.hash:
        raise InputError(
            f"{path}: hash: does not match the data, whose hash is {decision.hash}: the file was "
            "changed"
        )
    if raw.get("recorded") is None:
        return decision
    recorded = _found(f"{path}: recorded", decision, _object(path, raw, "recorded"))
    return Decision(family, data, decision.provenance, decision.asked, recorded)


def read_solution(decision: Decision, path: Path) -> Found:
    """Read an answer to a question.

    Raises
    ------
    InputError
        If the file is not an answer, or is an answer to another question.
    """
    raw = _read(path, SOLUTION)
    if raw.get("family") != decision.family:
        raise InputError(f"{path}: family: must be {decision.family}, is {raw.get('family')!r}")
    if raw.get("question") != decision.hash:
        raise InputError(f"{path}: question: must be {decision.hash}; this solves another question")
    return _found(str(path), decision, raw)


def question_named(path: Path) -> str:
    """Return the name of the question that a solution file answers.

    Raises
    ------
    InputError
        If the file is not a solution file.
    """
    raw = _read(path, SOLUTION)
    return f"{raw.get('family')}-{str(raw.get('question'))[:NAMED_BY]}"


def _told(schema: Schema, found: Found) -> dict[str, Any]:
    values = None if found.values is None else encoded(schema.values, found.values)
    return {
        "objective": _number(found.objective),
        "bound": _number(found.bound),
        "by": dict(found.by),
        "values": values,
    }


def _number(value: float) -> float | None:
    """Return a number for JSON; None for infinity and nan, which JSON does not have."""
    return value if math.isfinite(value) else None


def _found(where: str, decision: Decision, raw: dict[str, Any]) -> Found:
    values = raw.get("values")
    if values is not None:
        values = decoded(where, decision.schema, "values", values, decision.sizes)
    numbers = {}
    for name in ("objective", "bound"):
        value = raw.get(name)
        if value is not None and type(value) not in (int, float):
            raise InputError(f"{where}: {name}: must be a number or null")
        numbers[name] = math.nan if value is None else float(value)
    by = raw.get("by", {})
    if not isinstance(by, dict):
        raise InputError(f"{where}: by: must be an object")
    return Found(values, numbers["objective"], numbers["bound"], by)


def _object(path: Path, raw: dict[str, Any], name: str) -> dict[str, Any]:
    value = raw.get(name, {})
    if not isinstance(value, dict):
        raise InputError(f"{path}: {name}: must be an object")
    return value


def _write(path: Path, told: dict[str, Any]) -> None:
    text = json.dumps(told, separators=(",", ":"), allow_nan=False).encode()
    with replacing(path) as temporary:
        # without a time, so that equal content gives equal bytes
        packed = gzip.compress(text, 9, mtime=0) if path.suffix == ".gz" else text + b"\n"
        temporary.write_bytes(packed)


def _read(path: Path, wanted: str) -> dict[str, Any]:
    content = read_bounded(path, _LARGEST_MIB)
    try:
        if content[:2] == b"\x1f\x8b":
            content = _unpacked(content)
        raw = json.loads(content, parse_constant=_refuse)
    except (ValueError, OSError, EOFError, RecursionError) as error:
        raise InputError(f"{path}: is not valid JSON ({str(error).splitlines()[0]})") from None
    if not isinstance(raw, dict) or raw.get("format") != wanted:
        is_ = raw.get("format") if isinstance(raw, dict) else type(raw).__name__
        raise InputError(f'{path}: format: must be "{wanted}", is {is_!r}')
    return raw


def _unpacked(content: bytes) -> bytes:
    with gzip.GzipFile(fileobj=io.BytesIO(content)) as file:
        text = file.read((_LARGEST_MIB << 20) + 1)
    if len(text) > _LARGEST_MIB << 20:
        raise ValueError(f"larger than {_LARGEST_MIB} MiB")
    return text


def _refuse(word: str) -> float:
    raise ValueError(f"{word} is not a number")
