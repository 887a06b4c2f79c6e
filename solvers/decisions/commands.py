"""`rmfs decisions`: questions from files, solved, checked, bounded, converted and profiled."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rmfs.errors import InputError

if TYPE_CHECKING:
    from rmfs.solvers.decisions.files import Decision, Found

app = typer.Typer(no_args_is_help=True, context_settings={"help_option_names": ["-h", "--help"]})

Files = Annotated[
    list[Path],
    typer.Argument(metavar="FILE...", help="Decision files (rmfs-decision/1), or folders of them."),
]
Work = Annotated[
    float | None,
    typer.Option(
        min=0.0,
        help="Limit of work: deterministic seconds; nodes of HiGHS; steps of a local search.",
        show_default=False,
    ),
]
Seed = Annotated[int, typer.Option(min=0, help="Seed of the method.")]
Method = Annotated[
    str,
    typer.Option(
        help="Who answers: a method of the family, or `asked`: as in the run. [default: as in the "
        "run, if a controller asked and no limit, seed or start is given]",
        show_default=False,
    ),
]
Out = Annotated[
    Path, typer.Option(help="Folder of what is written; files are named by their question.")
]


@app.command()
def solve(
    files: Files,
    method: Method = "",
    work: Work = None,
    seed: Seed = 0,
    out: Out = Path("results/solutions"),
) -> None:
    """Answer questions; write a solution file for each."""
    from rmfs.solvers.decisions.files import write_solution
    from rmfs.solvers.decisions.solving import solve as answered

    for path in expanded(files):
        decision = _read(path)
        found = answered(decision, method, work=work, seed=seed, where=str(path))
        target = out / f"{decision.name}.solution.json"
        write_solution(decision, found, target)
        typer.echo(_line(decision, found))
        typer.echo(target)


@app.command()
def check(
    file: Annotated[Path, typer.Argument(metavar="QUESTION", help="A decision file.")],
    solution: Annotated[
        Path, typer.Argument(metavar="SOLUTION", help="A solution file, from anybody.")
    ],
) -> None:
    """Verify a solution without the models, and work out its value; exit code 2 if it is wrong."""
    from rmfs.solvers.decisions.checking import WrongError
    from rmfs.solvers.decisions.checking import check as checked
    from rmfs.solvers.decisions.files import read_solution

    decision = _read(file)
    try:
        value = checked(decision, read_solution(decision, solution))
    except WrongError as error:
        raise InputError(f"{solution}: {error}") from None
    typer.echo(f"{decision.name}: allowed, value {value!r}")


def expanded(files: list[Path]) -> list[Path]:
    """Replace folders by the decision files in them.

    Raises
    ------
    InputError
        If there are none.
    """
    found: list[Path] = []
    for one in files:
        inside = sorted(p for p in one.rglob("*.json*") if ".solution" not in p.name)
        found += inside if one.is_dir() else [one]
    if not found:
        raise InputError(f"{', '.join(map(str, files))}: no decision files")
    return found


def _read(path: Path) -> Decision:
    """Read a question that its model accepts, too."""
    from rmfs.solvers.decisions.files import read
    from rmfs.solvers.decisions.models import model_data

    decision = read(path)
    model_data(decision, str(path))
    return decision


def _line(decision: Decision, found: Found) -> str:
    by = found.by
    told = f"{decision.name}: {by.get('backend', '?')}, {by.get('status', '?')}"
    told += f", value {found.objective:.10g}, bound {found.bound:.10g}"
    return f"{told}, work {by.get('work', 0):g}, {by.get('total_s', 0):.3f} s"
