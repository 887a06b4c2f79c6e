"""`rmfs traffic`: experiments with path planners, and how computing time grows with the fleet."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rmfs import layout as layouts
from rmfs.cli.options import SetOption
from rmfs.config import parse_override
from rmfs.errors import InputError
from rmfs.experiments.traffic import duel as duels
from rmfs.trips import drive, mapf, random_trips

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.layout.model import Layout
    from rmfs.trips import TripRun, TripStream

app = typer.Typer(
    help="Compare path planners, measure the growth of computing time, and optimise guidance.",
    no_args_is_help=True,
)

UNSAFE = 1
"""Exit code if the checker finds a trace unsafe, or no robot can move any more."""

LayoutArgument = Annotated[
    str, typer.Argument(metavar="LAYOUT", help="Name of a shipped layout, or a file.")
]
Robots = Annotated[
    int | None, typer.Option(min=1, help="Number of robots per tier. [default: as in the layout]")
]
Seed = Annotated[int, typer.Option(min=0, help="Seed of all random streams.")]
Duration = Annotated[float, typer.Option(min=1.0, help="Measured time, in simulated seconds.")]
Warmup = Annotated[float, typer.Option(min=0.0, help="Warm-up, in simulated seconds.")]
Check = Annotated[bool, typer.Option("--check", help="Prove the motion free of collisions.")]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Override a parameter of the layout; may be repeated."
    ),
]
Allow = Annotated[
    bool,
    typer.Option(
        "--allow-not-well-formed", help="Accept a layout in which robots may block each other."
    ),
]
Out = Annotated[
    Path | None, typer.Option(help=".csv or .md file for the table.", show_default=False)
]
Scenario = Annotated[
    Path | None,
    typer.Option(
        help="For a .map: a .scen file of MovingAI with the starts and goals of the robots.",
        show_default=False,
    ),
]
Agents = Annotated[
    Path | None,
    typer.Option(
        help="For a .map: file with the starts of the robots, in the format of the League of Robot "
        "Runners.",
        show_default=False,
    ),
]
Tasks = Annotated[
    Path | None,
    typer.Option(
        help="For a .map: file with the goals of the trips, in the format of the League of Robot "
        "Runners.",
        show_default=False,
    ),
]
PLANNER_HELP = "Path planner: NAME, or NAME:KEY=VALUE,KEY=VALUE to set parameters"


@app.command()
def bench(
    layout: LayoutArgument,
    robots: Robots = None,
    planner: Annotated[str, typer.Option(help=f"{PLANNER_HELP}.")] = "time-windows",
    seed: Seed = 0,
    duration: Duration = 3600.0,
    warmup: Warmup = 0.0,
    check: Check = False,
    set_: Settings = None,
    allow_not_well_formed: Allow = False,
    out: Out = None,
) -> None:
    """Simulate random trips, without orders, with one path planner."""
    duel(layout, robots, [planner], seed, duration, warmup, check, set_, allow_not_well_formed, out)


@app.command()
def duel(
    layout: LayoutArgument,
    robots: Robots = None,
    planner: Annotated[
        list[str] | None,
        typer.Option(help=f"{PLANNER_HELP}; may be repeated. [default: all]", show_default=False),
    ] = None,
    seed: Seed = 0,
    duration: Duration = 3600.0,
    warmup: Warmup = 0.0,
    check: Check = False,
    set_: Settings = None,
    allow_not_well_formed: Allow = False,
    out: Out = None,
    scen: Scenario = None,
    agents: Agents = None,
    tasks: Tasks = None,
) -> None:
    """Compare path planners on the same trips: random trips or, on a .map, trips from files."""
    names = planner or duels.all_planners()
    duels.check_planners(names)
    loaded, trips = _given(
        layout, robots, set_, seed, (scen, agents, tasks), allowed=allow_not_well_formed
    )
    rows, unsafe = {}, []
    for name in names:
        _tell(f"{layout}, {loaded.robots} robots: {name}")
        run = drive(
            loaded,
            trips(),
            duels.settings(name, seed, loaded),
            duration_s=duration,
            warmup_s=warmup,
            proven=check,
        )
        rows[name] = duels.row(run)
        unsafe += _complaints(name, run)
    frame = duels.table(rows)
    typer.echo(duels.markdown(frame))
    if out is not None:
        duels.save(frame, out)
    for complaint in unsafe:
        print(f"rmfs: {complaint}", file=sys.stderr)
    if unsafe:
        raise typer.Exit(UNSAFE)


@app.command("scale")
def scale_command(
    most: Annotated[int, typer.Option(min=32, help="Largest fleet.")] = 2000,
    planner: Annotated[str, typer.Option(help=f"{PLANNER_HELP}.")] = "time-windows:swift=true",
    duration: Duration = 600.0,
    seed: Seed = 1,
    out: Annotated[Path, typer.Option(help="Folder for the table and the picture.")] = Path(
        "results/scale"
    ),
) -> None:
    """Measure how computing time and memory grow with the fleet at a constant density of robots."""
    from rmfs.experiments.traffic import scale

    duels.check_planners([planner])
    frame = scale.table(planner, most, duration, seed, _tell)
    typer.echo(duels.markdown(frame, scale.DECIMALS))
    grown = (("trips/h", "trips"), ("km/h", "metres driven")) if len(frame) > 1 else ()
    for column, what in grown:
        grows = scale.exponent(frame, column)
        typer.echo(f"CPU time grows like {what} to the power of {grows:.2f}")
    for path in scale.save(frame, out, planner=planner, duration_s=duration, seed=seed):
        typer.echo(path)


@app.command("warehouses")
def warehouses_command(
    least: Annotated[int, typer.Option(min=125, help="Smallest fleet.")] = 250,
    most: Annotated[int, typer.Option(min=125, help="Largest fleet.")] = 2000,
    rules: Annotated[
        list[str] | None,
        typer.Option(
            help="Set of controllers; may be repeated. [default: default, random]",
            show_default=False,
        ),
    ] = None,
    later: Annotated[
        float,
        typer.Option(
            min=1.0,
            help="Start of the second measured window, in simulated seconds. The first window "
            "begins at 0; each window lasts 600 s.",
        ),
    ] = 1200.0,
    seed: Seed = 1,
    check: Check = False,
    out: Annotated[Path, typer.Option(help="Folder for the table.")] = Path("results/scale"),
) -> None:
    """Measure how computing time grows with the fleet if the warehouse grows in proportion."""
    from rmfs.experiments.traffic import warehouses

    if not any(least <= site.robots <= most for site in warehouses.SITES):
        valid = ", ".join(str(site.robots) for site in warehouses.SITES)
        raise InputError(f"--least {least} --most {most}: no site in this range; valid: {valid}")
    chosen = rules or ["default", "random"]
    frame = warehouses.table(chosen, (least, most), later, seed, check=check, tell=_tell)
    typer.echo(duels.markdown(frame, warehouses.DECIMALS))
    for name, times in warehouses.growth(frame).items():
        typer.echo(f"{name}: CPU time per robot-hour grows {times:.1f}-fold")
    settings = {"rules": chosen, "later_s": later, "seed": seed, "check": check}
    for path in warehouses.save(frame, out, **settings):
        typer.echo(path)
    unsafe = int(frame["collisions"].fillna(0).sum())
    if unsafe:
        print(f"rmfs: {unsafe} collisions", file=sys.stderr)
        raise typer.Exit(UNSAFE)


@app.command("guide")
def guide_command(
    layout: LayoutArgument,
    out: Annotated[Path, typer.Option(help="Guidance file to write (.json).")],
    scenario: Annotated[
        str, typer.Option(help="Name of a shipped scenario, or a file.")
    ] = "default",
    controllers: Annotated[
        str, typer.Option(help="Name of a shipped set of controllers, or a file.")
    ] = "default",
    trips: Annotated[
        bool,
        typer.Option(
            "--trips",
            help="Simulate random trips, without orders, and maximise the number of trips per hour "
            "instead of the objective.",
        ),
    ] = False,
    objective: Annotated[
        str,
        typer.Option(
            help="Objective to maximise, a weighted sum of footprint columns: COLUMN=WEIGHT,..."
        ),
    ] = "trip_delay_mean_s=-1",
    seeds: Annotated[
        str,
        typer.Option(
            help="Seeds of the runs, separated by commas. The final choice among the best results "
            "is made with twice as many new seeds, which follow the greatest of these."
        ),
    ] = "1001,1002,1003",
    weights: Annotated[
        str | None,
        typer.Option(
            help="Weights of the features, in s, from which the search starts: FEATURE=WEIGHT,...",
            show_default=False,
        ),
    ] = None,
    generations: Annotated[
        int,
        typer.Option(
            min=0,
            help="Number of generations of the search; 0: no search, use the given --weights.",
        ),
    ] = 10,
    population: Annotated[
        int, typer.Option(min=4, help="Number of weight vectors per generation.")
    ] = 8,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the search.")] = 1,
    jobs: Annotated[int, typer.Option(min=1, help="Number of parallel processes.")] = 1,
    set_: SetOption = None,
) -> None:
    """Optimise guidance (extra costs of a layout's edges) on simulated runs."""
    from rmfs.experiments.traffic import guide, guide_tasks

    if out.suffix.lower() != ".json":
        raise InputError(f"--out {out}: must be a .json file")
    if generations == 0 and weights is None:
        raise InputError("--generations 0: needs --weights")
    given = {".".join(path): value for path, value in map(parse_override, set_ or [])}
    numbers = [_seed(one) for one in seeds.split(",")]
    task: guide_tasks.Task
    if trips:
        task = guide_tasks.Trips(layout, numbers, given)
    else:
        goal = _numbers("--objective", objective)
        task = guide_tasks.Orders(layout, numbers, given, scenario, controllers, goal)
    start = None if weights is None else _numbers("--weights", weights)
    found = guide.optimise(
        task,
        start=start,
        generations=generations,
        population=population,
        seed=seed,
        jobs=jobs,
        told=_tell,
    )
    settings = {"generations": generations, "population": population, "seed": seed}
    found.write(out, task, **settings)
    for name, weight in found.weights.items():
        typer.echo(f"{name}: {weight:.4g} s")
    typer.echo(
        f"{out}: mean objective over other seeds {found.value:.6g} "
        f"(without guidance: {found.base_value:.6g})"
    )


def _numbers(option: str, text: str) -> dict[str, float]:
    """Read `NAME=NUMBER,...`."""
    found = {}
    for part in text.split(","):
        name, _, number = part.partition("=")
        try:
            found[name.strip()] = float(number)
        except ValueError:
            raise InputError(f"{option} {text}: must be NAME=NUMBER,...") from None
    return found


def _seed(text: str) -> int:
    if not text.strip().isdigit():
        raise InputError(f"--seeds {text}: must be numbers, 0 or greater, separated by commas")
    return int(text)


def _given(
    layout: str,
    robots: int | None,
    set_: list[str] | None,
    seed: int,
    lists: tuple[Path | None, Path | None, Path | None],
    *,
    allowed: bool,
) -> tuple[Layout, Callable[[], TripStream]]:
    """Return the layout and what makes its stream of trips."""
    scen, agents, tasks = lists
    is_map = layout.lower().endswith(".map")
    if any(lists) and not is_map:
        raise InputError(f"{layout}: --scen, --agents and --tasks need a .map")
    if (scen is not None and agents is not None) or (tasks is not None and agents is None):
        raise InputError("give --scen, or --agents with or without --tasks")
    if scen is not None:
        return mapf.scenario(Path(layout), scen, robots)
    if agents is not None:
        return mapf.league(Path(layout), agents, tasks, robots, seed)
    loaded = _loaded(layout, robots, set_, allow_not_well_formed=allowed or is_map)
    return loaded, lambda: random_trips(loaded, seed)


def _loaded(
    layout: str, robots: int | None, set_: list[str] | None, *, allow_not_well_formed: bool
) -> Layout:
    overrides: list[tuple[list[str], Any]] = [] if robots is None else [(["robots"], robots)]
    for text in set_ or []:
        path, value = parse_override(text)
        overrides.append((path[1:] if path[0] == "layout" else path, value))
    loaded = layouts.load(layout, overrides)
    if not layout.lower().endswith(".map"):  # a grid without stations is refused by every check
        layouts.refuse(loaded, layout, allow_not_well_formed=allow_not_well_formed)
    return loaded


def _complaints(name: str, run: TripRun) -> list[str]:
    found = []
    if run.report is not None and not run.report.ok:
        found.append(f"{name}: {run.report.summary()}")
    if run.stalled:
        found.append(f"{name}: no robot can move any more at {run.end_s:.0f} s\n{run.stalled}")
    return found


def _tell(text: str) -> None:
    print(f"rmfs: {text}", file=sys.stderr, flush=True)
