"""What is drawn for readers is drawn from everything, and drawn again alike."""

from __future__ import annotations

import csv
import re

from tests.tools.prose import docstrings, draw, main, mixed, others, pages


def test_a_seed_draws_the_same_again():
    first, again, other = draw(24, 10, 50), draw(24, 10, 50), draw(25, 10, 50)
    assert first == again != other
    assert len(set(first[0])) == 10 and len(set(first[1])) == 50


def test_pages_are_those_of_the_documentation():
    assert {"README.md", "docs/index.md", "docs/examples/first-run.md"} <= set(pages())
    assert not any("_build" in name or "paper/" in name for name in pages())


def test_docstrings_are_public_and_each_is_there_once():
    found = docstrings()
    names = [one.name for one in found]
    assert {"rmfs.simulation.result.Run", "solvers.models.solution.Solution"} <= set(names)
    assert {"experiments.study.Study.compare", "rmfs.cli"} <= set(names)
    assert not any(part.startswith("_") for name in names for part in name.split("."))
    assert not any(name.startswith(("rmfs.solvers", "rmfs.experiments")) for name in names)
    assert len({one.place for one in found}) == len(found)


def test_the_draw_is_printed(capsys):
    assert main(["--seed", "1", "--pages", "2", "--docstrings", "3"]) == 0
    assert capsys.readouterr().out.count("\n    ") >= 3
    assert main(["--seed", "1", "--pages", "100000"]) == 2
    assert "not that many" in capsys.readouterr().err


def test_as_many_docstrings_of_others_are_mixed_in_with_no_origin_shown(tmp_path, capsys):
    ours = {one.name for one in draw(3, 0, 20)[1]}
    arguments = ["--seed", "3", "--docstrings", "20", "--among", "networkx", "scipy"]
    assert main([*arguments, "--out", str(tmp_path)]) == 0
    rows = list(csv.DictReader((tmp_path / "key.csv").read_text("utf-8").splitlines()))
    names = [row["name"] for row in rows]
    assert ours <= set(names) and len(names) == 40
    assert [sum(name.startswith(other) for name in names) for other in ("networkx", "scipy")] == [
        10,
        10,
    ]
    text = (tmp_path / "passages.md").read_text("utf-8")
    assert re.findall(r"^## (\d+): ", text, re.M) == [row["number"] for row in rows]
    assert not re.search(r"\.py:\d+", text)
    # not ours first, then the others
    assert len({name.partition(".")[0] for name in names[:20]}) > len({"rmfs", "solvers"})
    assert [one.name for one in mixed(3, 20, ["networkx", "scipy"])] == names


def test_examples_and_references_of_others_are_left_out():
    found = others("networkx")
    assert len(found) > 500
    assert not any(">>>" in one.text or "References\n---" in one.text for one in found)


def test_another_package_must_be_there(tmp_path, capsys):
    given = ["--seed", "3", "--among", "no_such_package", "--out", str(tmp_path / "out")]
    assert main(given) == 2
    assert "no_such_package" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
