"""Classes that users write, found by what they are called."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import pytest

from rmfs import references
from rmfs.errors import InputError
from rmfs.observer import Observer
from rmfs.references import anchored, reference_of, resolve

CLASS = """
from rmfs.observer import Observer
from beside_it import WORD

class Mine(Observer):
    word = WORD
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "own.watch.py").write_text(CLASS)
    (tmp_path / "watch_me.py").write_text(CLASS)
    (tmp_path / "beside_it.py").write_text("WORD = 'found'\n")
    (tmp_path / "broken_one.py").write_text("1 / 0\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    for name in ("watch_me", "beside_it", "broken_one"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    return tmp_path


@pytest.mark.parametrize("given", ["watch_me:Mine", "own.watch.py:Mine", "{0}/own.watch.py:Mine"])
def test_a_class_is_found_with_what_lies_beside_it(folder: Path, given: str) -> None:
    found = resolve(given.format(folder), Observer, "observer")
    assert found.word == "found"
    assert resolve(found, Observer, "observer") is found
    assert resolve(reference_of(found), Observer, "observer") is found


def test_what_was_pickled_is_found_in_another_process(folder: Path) -> None:
    made = pickle.dumps(resolve("own.watch.py:Mine", Observer, "observer")())
    (folder / "made").write_bytes(made)
    code = "import pickle, rmfs.references; print(pickle.load(open('made', 'rb')).word)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "found"


def test_a_reference_to_a_file_is_made_independent_of_the_folder(folder: Path) -> None:
    (folder / "below").mkdir()
    (folder / "below" / "other.py").touch()
    assert anchored("other.py:A", Path("below")) == f"{folder}/below/other.py:A"
    assert anchored("own.watch.py:A", Path("below")) == f"{folder}/own.watch.py:A"
    assert anchored("watch_me:A") == "watch_me:A"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            "nowhere.to:Mine",
            r"nowhere.to:Mine: there is no module nowhere.to, neither installed nor in "
            ".*",
        ),
        ("missing.py:Mine", r"missing.py:Mine: there is no file .*/missing.py"),
        ("watch_me:Yours", "watch_me:Yours: watch_me has no class Yours; its classes: Mine"),
        ("watch_me:WORD", r"watch_me:WORD: is not an observer \(a class derived from rmfs"),
        ("broken_one:A", r"broken_one:A: cannot be loaded \(ZeroDivisionError: division by zero"),
        ("watch_me", "watch_me: no observer has this name; expected module:Class or"),
    ],
)
def test_what_is_wrong_is_said(folder: Path, given: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        resolve(given, Observer, "observer")


def test_a_class_of_a_function_or_a_prompt_has_no_reference(monkeypatch) -> None:
    class Local(Observer):
        pass

    with pytest.raises(InputError, match="in a module, not in a function"):
        reference_of(Local)
    typed = type("Typed", (Observer,), {"__module__": "__main__", "__qualname__": "Typed"})
    monkeypatch.delattr(sys.modules["__main__"], "__file__", raising=False)
    with pytest.raises(InputError, match="notebook or at a prompt"):
        reference_of(typed)
    assert references.source_file(typed) is None
