"""`rmfs decisions`: solves, checks, bounds, converts and profiles saved questions."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rmfs.solvers.decisions.files import Decision, Found

app = typer.Typer(
    help="Solve, check, bound and convert saved questions to optimisers, and compare methods.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="FILE...", help="Question files (rmfs-decision/1), or folders of such files."
    ),
]
WORK = "Limit of work: deterministic seconds, nodes (HiGHS) or steps (local and beam search)."
Seed = Annotated[
    int | None, typer.Option(min=0, help="Seed of the method. [default: 0]", show_default=False)
]
Method = Annotated[
    str,
    typer.Option(
        help="Name of a method of the family, or `asked` for the method, limits and seed used in "
        "the run. [default: asked, if a controller asked the question and neither --work nor "
        "--seed is given; otherwise the default method of the family]",
        show_default=False,
    ),
]


@app.command()
def solve(
    files: Files,
    method: Method = "",
    work: Annotated[float | None, typer.Option(min=0.0, help=WORK, show_default=False)] = None,
    seed: Seed = None,
    with_: Annotated[
        str,
        typer.Option(
            "--with",
            metavar="SOLVER",
            help="Use an external solver, which gets the exact program as an MPS file: highs, "
            "scip, gurobi, cplex, cbc, or a command that contains {program}, {solution} and "
            "{seconds}. [default: the methods of rmfs]",
            show_default=False,
        ),
    ] = "",
    limit: Annotated[
        float, typer.Option(min=0.1, help="With --with: time limit per question, in seconds.")
    ] = 60.0,
    out: Annotated[
        Path,
        typer.Option(help="Folder for the solution files, named after their questions."),
    ] = Path("results/solutions"),
) -> None:
    """Solve questions and write a solution file for each."""
    from rmfs.solvers.decisions.exact.external import solve_externally
    from rmfs.solvers.decisions.files import write_solution
    from rmfs.solvers.decisions.solving import solve as answered

    if with_ and (method or work is not None):
        raise InputError(
            "--with: cannot be combined with --method or --work, which are for our own methods"
        )
    for path in expanded(files):
        decision = _read(path)
        if with_:
            found = solve_externally(decision, with_, limit, str(path))
        else:
            found = answered(decision, method, work=work, seed=seed, where=str(path))
        target = out / f"{decision.name}.solution.json"
        write_solution(decision, found, target)
        typer.echo(_line(decision, found))
        typer.echo(target)


@app.command()
def check(
    file: Annotated[Path, typer.Argument(metavar="QUESTION", help="Question file.")],
    solution: Annotated[
        Path, typer.Argument(metavar="SOLUTION", help="Solution file, from any source.")
    ],
) -> None:
    """Check a solution independently and compute its value; a wrong solution gives exit code 2."""
    from rmfs.solvers.decisions.checking import WrongError
    from rmfs.solvers.decisions.checking import check as checked
    from rmfs.solvers.decisions.files import read_solution

    decision = _read(file)
    try:
        value = checked(decision, read_solution(decision, solution))
    except WrongError as error:
        raise InputError(f"{solution}: {error}") from None
    typer.echo(f"{decision.name}: feasible, value {value!r}")


@app.command()
def bound(
    files: Files,
    work: Annotated[float, typer.Option(min=0.0, help=WORK)] = 1.0,
) -> None:
    """Prove bounds on objectives by Lagrangian relaxation, linear relaxation and exact search.

    The last line printed for each question states the best of its bounds.
    """
    from rmfs.solvers.decisions.bounding import bounds

    for path in expanded(files):
        decision = _read(path)
        found = list(bounds(decision, work, str(path)))
        for by, value in found:
            typer.echo(f"{decision.name}: {by}: {value!r}")
        least = max(
            (one for _, one in found), key=lambda one: one * decision.sign, default=math.nan
        )
        typer.echo(f"{decision.name}: bound {least!r}")


@app.command()
def convert(
    files: Files,
    to: Annotated[Literal["mps", "lp"], typer.Option(help="File format.")] = "mps",
    solution: Annotated[
        Path | None,
        typer.Option(
            help="Solution file of a solver, to be converted to a solution file of rmfs instead; "
            "exactly one question must be given.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for the files.")] = Path("results/exact"),
) -> None:
    """Write exact programs with maps of their columns, or convert a solver's solution file."""
    from rmfs.solvers.decisions.exact import exact
    from rmfs.solvers.decisions.exact.reading import answer_of
    from rmfs.solvers.decisions.exact.writing import write_map, write_program
    from rmfs.solvers.decisions.files import write_solution

    paths = expanded(files)
    if solution is not None and len(paths) != 1:
        raise InputError("--solution: requires exactly one question")
    for path in paths:
        decision = _read(path)
        stated = exact(decision, str(path))
        if solution is not None:
            found = answer_of(decision, stated, solution, {"file": solution.name})
            target = out / f"{decision.name}.solution.json"
            write_solution(decision, found, target)
            typer.echo(f"{decision.name}: feasible, value {found.objective!r}")
            typer.echo(target)
            continue
        target = out / f"{decision.name}.{to}"
        write_program(stated, target)
        write_map(decision, stated, out / f"{decision.name}.map.json")
        program = stated.program
        typer.echo(f"{target}: {program.columns} columns, {program.rows} rows")


@app.command()
def profile(
    files: Files,
    method: Annotated[
        list[str] | None,
        typer.Option(help="Method; may be repeated. [default: all methods of the family]"),
    ] = None,
    work: Annotated[
        float,
        typer.Option(
            min=0.001,
            help="Largest limit of work, in the unit of the method (see `solve --help`).",
        ),
    ] = 1.0,
    seeds: Annotated[
        int, typer.Option(min=1, help="Number of seeds per method; the first seed is 0.")
    ] = 1,
    out: Annotated[Path, typer.Option(help="File for the table (.csv).")] = Path(
        "results/profile.csv"
    ),
) -> None:
    """Run methods with repeatedly doubled limits of work; write values, gaps and times."""
    import pandas as pd

    from rmfs.files import write_text
    from rmfs.solvers.decisions.profiling import points
    from rmfs.solvers.decisions.ranking import integrals, with_gaps
    from rmfs.solvers.decisions.solving import methods

    rows = []
    for path in expanded(files):
        decision = _read(path)
        for one in method or methods(decision.family):
            rows += list(points(decision, one, work, range(seeds)))
    table = with_gaps(pd.DataFrame(rows))
    write_text(out, table.to_csv(index=False))
    by_method = ["family", "method"]
    told = integrals(table).groupby(by_method)[["over_wall", "over_work"]].mean()
    # its only answer comes at the end of all its work, so the integral is 1 however good it is
    once = table.groupby([*by_method, "question", "seed"]).size().groupby(by_method).max() == 1
    told.loc[once, "over_work"] = math.nan
    typer.echo("mean primal integrals: 0 is perfect, 1 is nothing found")
    typer.echo(told.round(4).to_string(na_rep="-"))
    typer.echo(out)


def expanded(files: list[Path]) -> list[Path]:
    """Replace folders by the question files that they contain.

    Raises
    ------
    InputError
        If there are no question files.
    """
    found: list[Path] = []
    for one in files:
        inside = sorted(p for p in one.rglob("*.json*") if ".solution" not in p.name)
        found += inside if one.is_dir() else [one]
    if not found:
        raise InputError(f"{', '.join(map(str, files))}: no decision files")
    return found


def _read(path: Path) -> Decision:
    """Read a question and validate it with its model."""
    from rmfs.solvers.decisions.files import read
    from rmfs.solvers.decisions.models import model_data

    decision = read(path)
    model_data(decision, str(path))
    return decision


def _line(decision: Decision, found: Found) -> str:
    by = found.by
    told = f"{decision.name}: {by.get('backend', '?')}, {by.get('status', '?')}"
    told += f", value {found.objective:.10g}, bound {found.bound:.10g}"
    return f"{told}, work {by.get('work', math.nan):g}, {by.get('total_s', 0):.3f} s"


LIBRARY = Path("instances/decisions")

LibraryFolder = Annotated[Path, typer.Option("--library", help="Folder of the library.")]
Family = Annotated[
    list[str] | None, typer.Option(help="Family of questions; may be repeated. [default: all]")
]
Size = Annotated[
    list[str] | None, typer.Option(help="Size of the site; may be repeated. [default: all]")
]


@app.command()
def draw(
    out: Annotated[Path, typer.Option(help="Folder of the library.")] = LIBRARY,
    family: Family = None,
    size: Size = None,
) -> None:
    """Simulate the sites of the library again, and draw its questions from these runs."""
    from rmfs.solvers.decisions.files import write
    from rmfs.solvers.decisions.library.drawing import draw
    from rmfs.solvers.decisions.library.sites import SITES
    from rmfs.solvers.decisions.schema import SCHEMAS

    for one in known("family", family, SCHEMAS):
        for big in known("size", size, SITES):
            count = sum(write(drawn, out / one / big) for drawn in draw(one, big))
            typer.echo(f"{one} {big}: {count} new")


@app.command("import")
def import_(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", help="File with racks and orders, in the format of Valle and Beasley."
        ),
    ],
    pickers: Annotated[int, typer.Option(min=1, max=1000, help="Number of pick stations.")],
    orders_each: Annotated[
        int, typer.Option(min=1, max=1000, help="Number of orders per pick station.")
    ],
    out: Annotated[Path, typer.Option(help="Folder for the question.")] = Path("questions"),
) -> None:
    """Convert an instance from the literature to a question of the family rack_allocation."""
    from rmfs.solvers.decisions.files import write
    from rmfs.solvers.decisions.racks import read_racks

    question = read_racks(file, pickers, orders_each)
    write(question, out)
    typer.echo(out / f"{question.name}.json.gz")


@app.command()
def improve(
    library: LibraryFolder = LIBRARY,
    family: Family = None,
    size: Size = None,
    work: Annotated[
        float, typer.Option(min=0.01, help="Deterministic seconds per search in the first round.")
    ] = 1.0,
    rounds: Annotated[
        int,
        typer.Option(
            min=1, help="Number of rounds; each does four times the work of the previous round."
        ),
    ] = 1,
    seconds: Annotated[
        float, typer.Option(min=1.0, help="Total wall time, in seconds.")
    ] = math.inf,
    load: Annotated[
        float, typer.Option(min=0.0, help="Load of the machine above which the search pauses.")
    ] = math.inf,
    guard: Annotated[
        float, typer.Option(min=1.0, help="Wall time, in seconds, after which a search is aborted.")
    ] = 120.0,
) -> None:
    """Search for better solutions and bounds for the questions in the library."""
    import os

    from rmfs.solvers.decisions.library.improving import Effort
    from rmfs.solvers.decisions.library.improving import improve as improved
    from rmfs.solvers.decisions.library.sites import SITES
    from rmfs.solvers.decisions.library.table import Library
    from rmfs.solvers.decisions.schema import SCHEMAS

    os.nice(15)
    families, sizes = known("family", family, SCHEMAS), known("size", size, SITES)
    effort = Effort(work, rounds, seconds, guard, load)
    count = improved(Library.load(library), effort, families, sizes, tell=typer.echo)
    typer.echo(f"{count} values and bounds improved")


@app.command()
def enter(
    solutions: Annotated[
        list[Path], typer.Argument(metavar="SOLUTION...", help="Solution files, from any source.")
    ],
    by: Annotated[str, typer.Option(help="Who found the solutions, and how.")],
    library: LibraryFolder = LIBRARY,
) -> None:
    """Add solutions to the library if they are feasible and better than the known ones."""
    from rmfs.solvers.decisions.checking import WrongError
    from rmfs.solvers.decisions.files import question_named, read, read_solution
    from rmfs.solvers.decisions.library.table import Library

    known_ = Library.load(library)
    for path in solutions:
        name = question_named(path)
        if name not in known_.rows:
            raise InputError(f"{path}: question: {name} is not in {library}")
        decision = read(known_.path(known_.rows[name]))
        try:
            better = known_.enter(decision, read_solution(decision, path), by)
        except WrongError as error:
            raise InputError(f"{path}: {error}") from None
        row = known_.rows[name]
        told = "entered" if better else "feasible, but no better than the known solution"
        typer.echo(f"{name}: {told}: best value {row.value!r}, bound {row.bound!r}")


def known(what: str, given: list[str] | None, names: Iterable[str]) -> list[str]:
    """Return the names given with an option; without the option, all names.

    Raises
    ------
    InputError
        If a name is unknown.
    """
    for one in given or ():
        if one not in names:
            raise InputError(f"--{what} {one}: must be one of {', '.join(names)}")
    return given or list(names)
