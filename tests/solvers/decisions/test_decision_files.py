"""Questions and answers as files: what is written is read again, bit for bit."""

from __future__ import annotations

import gzip
import json
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from decision_samples import sample

from rmfs.errors import InputError
from rmfs.solvers.decisions.files import Decision, Found, read, read_solution, write_to
from rmfs.solvers.decisions.files import write_solution as write_found
from rmfs.solvers.decisions.models import model_data, plain_data
from rmfs.solvers.decisions.schema import SCHEMAS
from rmfs.solvers.decisions.solving import solve
from rmfs.solvers.models.families import FAMILIES

MATCHING = sample("matching", 0)


def test_every_family_has_a_schema() -> None:
    assert set(SCHEMAS) == set(FAMILIES)


@pytest.mark.parametrize("family", SCHEMAS)
def test_a_schema_names_all_fields_of_the_model(family: str) -> None:
    data = model_data(sample(family, 0))
    named = {field.name for field in SCHEMAS[family].data}
    expected = set()
    for field in fields(data):
        value = getattr(data, field.name)
        if is_dataclass(value):
            expected |= {f"{field.name}.{one.name}" for one in fields(value)}
        else:
            expected.add(field.name)
    assert named == expected


@pytest.mark.parametrize("ending", ["json", "json.gz"])
@pytest.mark.parametrize("family", SCHEMAS)
def test_what_is_written_is_read_again(family: str, ending: str, tmp_path: Path) -> None:
    for seed in range(6):
        question = sample(family, seed)
        found = solve(question)
        whole = Decision(family, question.data, {"seed": seed}, {"by": ""}, found)
        path = tmp_path / f"{seed}.{ending}"
        write_to(whole, path)
        again = read(path)
        assert (again.hash, again.provenance) == (question.hash, {"seed": seed})
        for name, value in question.data.items():
            assert np.array_equal(np.asarray(again.data[name]), np.asarray(value)), name
        # the model takes it, and changes nothing
        assert Decision(family, plain_data(family, model_data(again))).hash == question.hash
        assert again.recorded is not None
        assert again.recorded.objective == found.objective
        write_found(question, found, tmp_path / "solution.json")
        same = read_solution(again, tmp_path / "solution.json")
        assert same.values is not None
        assert found.values is not None
        for name, value in found.values.items():
            equal = same.values[name] == value
            assert equal if isinstance(equal, bool) else equal.all(), name


def test_equal_content_gives_equal_bytes_and_names(tmp_path: Path) -> None:
    for name in ("a.json.gz", "b.json.gz"):
        write_to(sample("planning", 3), tmp_path / name)
    assert (tmp_path / "a.json.gz").read_bytes() == (tmp_path / "b.json.gz").read_bytes()
    assert sample("planning", 3).name == sample("planning", 3).name != sample("planning", 4).name


def test_large_arrays_are_written_by_their_exceptions(tmp_path: Path) -> None:
    """And read as the same question, whose hash knows nothing of it."""
    units = np.zeros((20, 30), np.int64)
    units[3, 4] = 7
    data = {"units": units, "stock": np.ones((9, 30), np.int64), "slots": np.array([1])}
    question = Decision("rack_allocation", data)
    write_to(question, tmp_path / "q.json")
    raw = json.loads((tmp_path / "q.json").read_text())
    assert raw["data"]["units"] == {"shape": [20, 30], "all": 0, "at": [94], "values": [7]}
    assert read(tmp_path / "q.json").hash == question.hash
    raw["data"]["units"] = units.tolist()
    (tmp_path / "q.json").write_text(json.dumps(raw))
    assert read(tmp_path / "q.json").hash == question.hash


def test_tables_without_rows_keep_their_width(tmp_path: Path) -> None:
    question = Decision("matching", {"travel_s": np.zeros((0, 2)), "leave_s": np.ones(2)})
    write_to(question, tmp_path / "q.json")
    assert read(tmp_path / "q.json").data["travel_s"].shape == (0, 2)


DAMAGE: dict[str, tuple[Any, str]] = {
    "family": (lambda raw: raw.update(family="pileon"), "family: must be one of pile_on"),
    "family-kind": (lambda raw: raw.update(family=3), "family: must be one of"),
    "format": (lambda raw: raw.update(format="rmfs-decision/2"), 'must be "rmfs-decision/1"'),
    "changed": (lambda raw: raw["data"]["leave_s"].__setitem__(0, 1.5), "hash: does not match"),
    "missing": (lambda raw: raw["data"].pop("leave_s"), "data.leave_s: is missing"),
    "unknown": (lambda raw: raw["data"].update(speed=1), "data.speed: unknown field; valid: tr"),
    "short": (lambda raw: raw["data"]["leave_s"].pop(), "has size 3, but T is 4"),
    "ragged": (lambda raw: raw["data"]["travel_s"][0].pop(), "rows of different lengths"),
    "flat": (lambda raw: raw["data"].update(travel_s=[1.0]), "must be lists in 1 dim"),
    "nan": (lambda raw: raw["data"]["leave_s"].__setitem__(0, float("nan")), "NaN is not a number"),
    "inf": (lambda raw: raw["data"]["leave_s"].__setitem__(0, "-inf"), "leave_s: must hold a n"),
    "text": (lambda raw: raw["data"]["leave_s"].__setitem__(0, "7"), "leave_s: must hold a nu"),
    "truth": (lambda raw: raw["data"]["leave_s"].__setitem__(0, True), "leave_s: must hold a n"),
    "huge": (lambda raw: raw["data"]["leave_s"].__setitem__(0, 10**40), "is too large"),
    "no-data": (lambda raw: raw.update(data=[]), "data: must be an object"),
    "recorded": (lambda raw: raw.update(recorded=[1]), "recorded: must be an object"),
    "asked": (lambda raw: raw.update(asked="no"), "asked: must be an object"),
    "sparse-at": (
        lambda raw: raw["data"].update(
            leave_s={"shape": [4], "all": 0, "at": [2, 1], "values": [1, 2]}
        ),
        "at must hold ascending positions",
    ),
    "sparse-size": (
        lambda raw: raw["data"].update(
            leave_s={"shape": [10**12], "all": 0, "at": [], "values": []}
        ),
        "more than",
    ),
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damaged_questions_are_refused_in_one_line(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "q.json"
    write_to(MATCHING, path)
    raw = json.loads(path.read_text())
    damage, told = DAMAGE[kind]
    damage(raw)
    path.write_text(json.dumps(raw))
    with pytest.raises(InputError, match=r"q\.json: ") as caught:
        read(path)
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_the_model_refuses_is_refused() -> None:
    data = MATCHING.data | {"travel_s": -np.ones((3, 4))}
    with pytest.raises(InputError, match=r"data.travel_s\[0, 0\]: must be at least 0"):
        model_data(Decision("matching", data))


@pytest.mark.parametrize(
    "content",
    [b"", b"[", b"[]", b"\x1f\x8b garbage", gzip.compress(b"{}", mtime=0)[:-3], b"\xff\xfe"],
)
def test_what_is_no_json_is_refused(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "q.json.gz").write_bytes(content)
    with pytest.raises(InputError, match=r"q\.json\.gz: "):
        read(tmp_path / "q.json.gz")


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read(tmp_path / "none.json")


def test_solutions_of_other_questions_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "s.json"
    write_found(MATCHING, Found({"robot": np.array([-1, -1, -1, -1])}), path)
    with pytest.raises(InputError, match=r"question: must be .* this solves another question"):
        read_solution(sample("matching", 1), path)
    with pytest.raises(InputError, match="family: must be balance"):
        read_solution(sample("balance", 0), path)


def test_times_and_spaces_are_whole_parts(tmp_path: Path) -> None:
    """A model that rounds them would solve another question than the file asks."""
    question = sample("sequence", 0)
    shifted = question.data | {"ready_s": question.data["ready_s"] + 0.0004}
    write_to(Decision("sequence", shifted), tmp_path / "q.json")
    with pytest.raises(InputError, match="ready_s: must hold a number of seconds in whole mill"):
        read(tmp_path / "q.json")
