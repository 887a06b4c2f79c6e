"""`rmfs run`: simulate a warehouse and write a run folder."""

from __future__ import annotations

import hashlib
import re
import sys
import warnings
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rmfs.cli.exit_codes import GIVEN_UP, UNSAFE
from rmfs.cli.options import (
    ControllersOption,
    LayoutOption,
    NotWellFormedOption,
    ScenarioOption,
    SetOption,
)
from rmfs.cli.terminal import progress, step, terminable
from rmfs.errors import InputError, InternalError, RuleError

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from rmfs.measure.checker import CheckReport
    from rmfs.simulation.result import Run
    from rmfs.solvers.decisions.recording import DecisionRecorder

LONGEST = 100
"""Maximum number of characters of a folder name that describe the changed parameters."""


def run(
    layout: LayoutOption = "default",
    scenario: ScenarioOption = "default",
    controllers: ControllersOption = "default",
    seed: Annotated[int, typer.Option(min=0, help="Seed of all random streams.")] = 0,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Run folder. [default: a folder below results/, named after the inputs, the "
            "changed parameters and the seed]",
            show_default=False,
        ),
    ] = None,
    force: Annotated[
        bool,
        typer.Option(
            "--force",
            help="Replace an existing run folder, and start even if memory may not suffice.",
        ),
    ] = False,
    set_: SetOption = None,
    pacing: Annotated[
        str,
        typer.Option(
            metavar="MODE",
            help="How much simulated time the optimisers' computation takes: instant, wall, "
            "work, fixed=SECONDS or replay=RUN_DIR. Parameters of the mode are set by --set "
            "pacing.KEY=VALUE.",
        ),
    ] = "instant",
    trace: Annotated[bool, typer.Option("--trace", help="Write a trace of all motion.")] = False,
    record: Annotated[
        Path | None,
        typer.Option(
            help="Folder in which to record the arriving orders and bundles (orders.csv, "
            "bundles.csv), so that other runs can use them.",
            show_default=False,
        ),
    ] = None,
    decisions: Annotated[
        Path | None,
        typer.Option(
            help="Folder in which to save every question to an optimiser as a file (see rmfs "
            "decisions).",
            show_default=False,
        ),
    ] = None,
    check: Annotated[
        bool,
        typer.Option(
            "--check", help="Prove the motion free of collisions; fills the column `collisions`."
        ),
    ] = False,
    allow_not_well_formed: NotWellFormedOption = False,
    measure: Annotated[
        list[str] | None,
        typer.Option(
            "--measure",
            metavar="REF",
            help="Additional measure: path/to/file.py:Class, module:Class, or the name of an "
            "installed measure; may be repeated.",
        ),
    ] = None,
    checkpoint_every: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            help="Save the state of the run every S simulated seconds, in the file "
            "FOLDER.checkpoint beside the run folder; the file is removed when the run ends.",
            show_default=False,
        ),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Continue from the checkpoint of a killed run.")
    ] = False,
    live: Annotated[
        bool, typer.Option("--live", help="Show the run in the browser while it is simulated.")
    ] = False,
    speed: Annotated[
        float | None,
        typer.Option(
            help="With --live: initial speed, in simulated seconds per second of real time. "
            "[default: as fast as possible]",
            show_default=False,
        ),
    ] = None,
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="With --live: port of the page; 0: any free port.")
    ] = 0,
    open_: Annotated[
        bool, typer.Option("--open/--no-open", help="With --live: open a browser.")
    ] = True,
    await_page: Annotated[bool, typer.Option("--await-page", hidden=True)] = False,
) -> None:
    """Simulate a warehouse and write a run folder."""
    from rmfs.config import parse_override
    from rmfs.measure.folder import fill, load_run, reserved
    from rmfs.room import forced
    from rmfs.scenario import StreamRecorder, write_streams
    from rmfs.simulation.checkpoints import Checkpoints

    overrides = [parse_override(text) for text in set_ or []]
    inputs = {"layout": layout, "scenario": scenario, "controllers": controllers}
    target = out or Path("results") / default_name(inputs, seed, set_ or [], pacing)
    streams = None if record is None else StreamRecorder()
    if speed is not None and not live:
        raise InputError("--speed: only valid with --live")
    keeps = record is not None or decisions is not None
    if (checkpoint_every is not None or resume) and (live or keeps):
        raise InputError("--checkpoint-every, --resume: invalid with --live, --record, --decisions")
    with ExitStack() as stack:
        stack.enter_context(terminable())
        stack.enter_context(forced(force))
        watching: dict[str, Any] = {}
        if live:
            from rmfs.view.commands import watched

            watcher = stack.enter_context(
                watched(
                    inputs,
                    target.name,
                    port=port,
                    speed=speed,
                    open_browser=open_,
                    await_page=await_page,
                )
            )
            watching = {"events": watcher.events, "driver": watcher.drive}
        folder = stack.enter_context(reserved(target, force=force))
        file = target.with_name(f"{target.name}.checkpoint")
        if checkpoint_every is not None:
            watching["driver"] = Checkpoints(file, checkpoint_every)
        if resume:
            watching["resume"] = file
        keeper = None if decisions is None else kept_decisions(decisions, inputs, seed, set_ or [])
        done = simulated(
            inputs,
            seed=seed,
            overrides=overrides,
            pacing=pacing,
            trace=trace or check,
            streams=streams,
            measures=measure or [],
            allow_not_well_formed=allow_not_well_formed,
            observers=[] if keeper is None else [keeper],
            **watching,
        )
        if keeper is not None:
            step(keeper.summary())
        if record is not None and streams is not None:
            step("writing the streams")
            write_streams(streams, done.world.skus, record)
        report = proven(done) if check else None
        step("writing the tables")
        fill(folder, done, report=report, trace=trace, inputs=inputs)
        footprint = load_run(folder).footprint
    if resume:
        file.unlink(missing_ok=True)
    conclude(target, footprint, report)


def kept_decisions(
    folder: Path, inputs: dict[str, str], seed: int, changes: Sequence[str] = ()
) -> DecisionRecorder:
    """Return an observer that saves the questions to optimisers in a folder, one file each.

    Questions of a kind that the file format does not cover are left out.
    """
    from rmfs.solvers.decisions.recording import DecisionRecorder

    names = {part: Path(given).stem for part, given in inputs.items()}
    return DecisionRecorder(folder, {**names, "seed": seed, "set": list(changes)})


def simulated(inputs: dict[str, str], *, seed: int, **options: Any) -> Run:
    """Simulate with a display of progress; return the finished run.

    The command prints the reason and exits with code 1 in each of these cases: no robot can move
    any more; a user's rule makes an impossible decision; an optimiser fails in a run that must be
    reproducible; a replay deviates from its recording.

    Parameters
    ----------
    inputs
        Layout, scenario and controllers as the user named them.
    options
        Further parameters of `rmfs.simulate`.
    """
    from rmfs.simulation.idle_rules import IdleRuleWarning
    from rmfs.simulation.loop import StalledError
    from rmfs.simulation.pacing import OptimiserError, ReplayError
    from rmfs.simulation.run import simulate

    def told(part: str, note: str) -> None:
        print(f"rmfs: {inputs[part]}: {note}", file=sys.stderr)

    what = f"simulating {', '.join(inputs.values())}, seed {seed}"
    with progress(what) as advance, warnings.catch_warnings():
        warnings.simplefilter("ignore", IdleRuleWarning)  # reported below in our own format
        try:
            done = simulate(*inputs.values(), seed=seed, progress=advance, remark=told, **options)
        except (StalledError, OptimiserError, ReplayError, RuleError) as error:
            print(f"rmfs: {error}", file=sys.stderr)
            raise typer.Exit(GIVEN_UP) from None
        except InternalError as error:
            error.add_note(what)
            raise
    for idle in done.idle_rules:
        print(f"rmfs: warning: {idle}", file=sys.stderr)
    return done


def default_name(
    inputs: dict[str, str], seed: int, changes: Sequence[str] = (), pacing: str = "instant"
) -> str:
    """Return the name of the run folder: layout-scenario-controllers-changes-seedN.

    Parameters
    ----------
    changes
        The `--set` arguments. The name contains them separated by commas. If this text has
        unsuitable characters, they are replaced; if it is longer than `LONGEST` characters, it is
        cut. In both cases, a hash of the full text is added.
    pacing
        The pacing as specified by the user. Unless it is `instant`, the name contains it after the
        changes, as another change.
    """
    told = [text.replace(".name=", "=") for text in changes]
    told += [] if pacing == "instant" else [f"pacing={pacing}"]
    between = ",".join(told)
    safe = re.sub(r"[^A-Za-z0-9._=,+-]", "_", between)
    if safe != between or len(safe) > LONGEST:
        mark = hashlib.sha256(between.encode()).hexdigest()[:8]
        safe = f"{safe[:LONGEST]}-{mark}"
    stems = [Path(given).stem for given in inputs.values()]
    return "-".join([*stems, *([safe] if safe else []), f"seed{seed}"])


def proven(done: Run) -> CheckReport:
    """Check the trace of a run and return the report."""
    step("checking the trace")
    return done.check()


def conclude(target: Path, footprint: pd.Series, report: CheckReport | None) -> None:
    """Print the main figures of a run.

    Exits with code 1 if the trace is unsafe or the units score exceeds 1.
    """
    from rich.console import Console

    from rmfs.measure.summary import summarised

    Console(highlight=False).print(summarised(footprint))
    print(target)
    if footprint["units_score"] > 1.0:
        print(
            "rmfs: more units were picked than the proven upper bound allows (units_score > 1): "
            "please report this defect",
            file=sys.stderr,
        )
        raise typer.Exit(UNSAFE)
    if report is not None and not report.ok:
        print(f"rmfs: {report.summary()}", file=sys.stderr)
        raise typer.Exit(UNSAFE)
