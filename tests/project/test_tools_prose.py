"""What is drawn for readers is drawn from everything, and drawn again alike."""

from __future__ import annotations

from tests.tools.prose import docstrings, draw, main, pages


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
