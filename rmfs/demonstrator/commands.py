"""`rmfs demonstrate` and `rmfs emulate`.

If an input is wrong, these functions raise `InputError`; the command line then prints the error as
one line and exits with code 2.
"""

from __future__ import annotations

import json
import logging
import os
import secrets
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rmfs import layout as layouts
from rmfs.config import parse_override
from rmfs.demonstrator import settings
from rmfs.demonstrator.server.clock import RoomGoneError
from rmfs.demonstrator.server.demonstration import Demonstration, expected
from rmfs.demonstrator.server.hub import Hub
from rmfs.errors import InputError
from rmfs.files import write_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.demonstrator.emulator.room import Room

app = typer.Typer()

EMULATED = "emulated"
"""Value of the option `--robots` that starts an emulated room along with the server."""

GIVEN_UP = 1
TRUTH = "room.json"
JOURNAL = "journal.jsonl"

Layout = Annotated[str, typer.Option(help="Name of a shipped layout, or a file.")]
Real = Annotated[
    str | None,
    typer.Option(
        metavar="I,J,...",
        help="Indices of the robots that connect to the server; the others are simulated. "
        "[default: all]",
        show_default=False,
    ),
]
Tags = Annotated[
    Path | None,
    typer.Option(
        help="File of the floor tags, with a line WAYPOINT;TAG for each waypoint. [default: tags "
        "W0, W1, ...]",
        show_default=False,
    ),
]
Secret = Annotated[
    Path | None,
    typer.Option(
        help="File with the secret that server and robots share. [default: environment variable "
        f"{settings.SECRET}]",
        show_default=False,
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Override a parameter; may be repeated."),
]


@app.command()
def demonstrate(
    robots: Annotated[
        str,
        typer.Option(
            metavar="URL",
            help="Address to which robots connect: tcp://HOST:PORT in real time, or "
            "room://HOST:PORT for an emulated room that keeps the clock. The value `emulated` "
            "also starts such a room.",
        ),
    ],
    layout: Layout = "demonstrator",
    scenario: Annotated[
        str, typer.Option(help="Name of a shipped scenario, or a file.")
    ] = "demonstrator",
    controllers: Annotated[
        str, typer.Option(help="Name of a shipped set of controllers, or a file.")
    ] = "default",
    real: Real = None,
    tags: Tags = None,
    secret: Secret = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of all random streams.")] = 0,
    out: Annotated[
        Path | None, typer.Option(help="Run folder. [default: below results/]", show_default=False)
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing run folder.")] = False,
    past_failure: Annotated[
        bool,
        typer.Option(
            "--past-failure",
            help="Resume from a journal whose last tick failed, and ignore the messages received "
            "in that tick.",
        ),
    ] = False,
    set_: Settings = None,
    trace: Annotated[bool, typer.Option("--trace", help="Write the trace of all motion.")] = False,
    allow_not_well_formed: Annotated[
        bool,
        typer.Option(
            "--allow-not-well-formed", help="Accept a layout in which robots may block each other."
        ),
    ] = False,
) -> None:
    """Run a warehouse with real robots, or emulated ones, and write a run folder.

    If the command is killed, run it again with the same arguments: the demonstration continues
    where it stopped. With `--robots emulated`, it starts again from the beginning instead, and the
    result is the same as without the interruption.
    """
    from rmfs.cli.simulate import conclude, default_name
    from rmfs.cli.terminal import progress, step
    from rmfs.measure.folder import fill, load_run, reserved
    from rmfs.simulation.loop import StalledError
    from rmfs.simulation.pacing import OptimiserError

    _log_to_stderr()
    inputs = {"layout": layout, "scenario": scenario, "controllers": controllers}
    overrides = [parse_override(text) for text in set_ or []]
    of_layout = [(path[1:], value) for path, value in overrides if path[0] == "layout"]
    plan = layouts.load(layout, of_layout)
    chosen = settings.robots(plan, real)
    is_own = robots == EMULATED
    scheme, host, port = (
        (settings.ROOM, "127.0.0.1", 0) if is_own else settings.address(robots, "--robots")
    )
    is_emulated = scheme == settings.ROOM
    known = secrets.token_hex(16).encode() if is_own else settings.secret(secret)
    target = out or Path("results") / f"demonstration-{default_name(inputs, seed, set_ or [])}"
    if is_own and past_failure:
        raise InputError(
            f"--past-failure: cannot be combined with --robots {EMULATED}, whose room ends with "
            "the server; start a room by rmfs emulate, and use --robots room://HOST:PORT"
        )
    hub = _hub(host, port, known, expected(chosen, is_emulated=is_emulated), robots)
    with reserved(target, force=force) as folder:
        # a room that ends with the server begins anew, and so does the demonstration
        beside = target.parent / f".{target.name}.{JOURNAL}"
        journal = folder / JOURNAL if is_own else beside
        demonstration = Demonstration(
            hub, chosen, settings.tags(plan, tags), journal, is_emulated, past_failure
        )
        asked = ["--layout", layout, "--seed", str(seed), *(["--real", real] if real else [])]
        asked += [
            part for text in set_ or [] if text.startswith("layout.") for part in ("--set", text)
        ]
        with (
            _room_of_its_own(hub, known, folder / TRUTH, asked, is_wanted=is_own),
            progress(f"demonstrating {', '.join(inputs.values())}, seed {seed}") as advance,
        ):
            step("waiting for robots at {}:{}".format(*hub.address))
            try:
                done = demonstration.run(
                    *inputs.values(),
                    seed=seed,
                    overrides=overrides,
                    trace=trace,
                    progress=advance,
                    allow_not_well_formed=allow_not_well_formed,
                )
            except (StalledError, OptimiserError, RoomGoneError) as error:
                print(f"rmfs: {error}", file=sys.stderr)
                raise typer.Exit(GIVEN_UP) from None
        step("writing the tables")
        fill(folder, done, trace=trace, inputs=inputs)
        if not is_own:
            shutil.move(journal, folder / JOURNAL)
        footprint = load_run(folder).footprint
    conclude(target, footprint, None)


@app.command()
def emulate(
    server: Annotated[
        str,
        typer.Option(
            metavar="URL",
            help="Address of the server. With room://HOST:PORT, the room keeps the clock of the "
            "server and runs faster than real time; with tcp://HOST:PORT, it runs in real time.",
        ),
    ],
    layout: Layout = "demonstrator",
    real: Real = None,
    tags: Tags = None,
    secret: Secret = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of all imperfections.")] = 0,
    set_: Settings = None,
    speed_error: Annotated[
        float,
        typer.Option(min=0.0, max=0.5, help="Largest relative error of a wheel's speed."),
    ] = 0.05,
    slip: Annotated[
        float,
        typer.Option(min=0.0, max=0.5, help="Largest share of a wheel's travel lost to slip."),
    ] = 0.01,
    missed_tags: Annotated[
        float,
        typer.Option(
            min=0.0, max=0.5, help="Share of the passages over a tag in which the tag is not read."
        ),
    ] = 0.02,
    lost_messages: Annotated[
        float, typer.Option(min=0.0, max=0.5, help="Share of the messages lost in each direction.")
    ] = 0.01,
    delay_s: Annotated[
        float, typer.Option(min=0.0, max=1.0, help="Largest delay of a message in seconds.")
    ] = 0.04,
    memory: Annotated[
        Path | None,
        typer.Option(
            help="Folder in which robots store the routes that they have been ordered to "
            "drive. [default: a temporary folder]",
            show_default=False,
        ),
    ] = None,
    duration_s: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            help="Emulated seconds after which the command ends. [default: when the server ends; "
            "with tcp://, never]",
            show_default=False,
        ),
    ] = None,
    report: Annotated[
        Path | None,
        typer.Option(help="JSON file for measurements of the true motion.", show_default=False),
    ] = None,
) -> None:
    """Emulate a room: its floor, and robots with imperfections such as wheel slip."""
    try:
        from rmfs.demonstrator.emulator.pace import RealTime
        from rmfs.demonstrator.emulator.room import Address, Room
        from rmfs.demonstrator.emulator.unkind import Unkindness
    except ImportError as error:
        raise InputError(f"{error}: install the extra `demonstrator`") from None

    _log_to_stderr()
    overrides = [parse_override(text) for text in set_ or []]
    plan = layouts.load(layout, [(path[1:], value) for path, value in overrides])
    scheme, host, port = settings.address(server, "--server")
    room = Room(
        plan,
        settings.robots(plan, real),
        settings.tags(plan, tags),
        Address(host, port, settings.secret(secret)),
        Unkindness(speed_error, slip, missed_tags, lost_messages, round(delay_s * 1e6)),
        seed,
        memory,
        RealTime() if scheme == settings.TCP else None,
    )
    try:
        room.run(None if duration_s is None else round(duration_s * 1e6))
    finally:
        room.close()
    text = json.dumps(_truth(room), indent=2)
    print(text)
    if report is not None:
        write_text(report, text + "\n")


def _truth(room: Room) -> dict[str, Any]:
    truth = room.truth
    return {
        "emulated_s": room.now_us / 1e6,
        "driven_m": round(truth.driven_m, 3),
        "nearest_m": round(truth.nearest_m, 4) if len(room.robots) > 1 else None,
        "lateral_error_mean_m": round(truth.lateral_mean_m, 5),
        "lateral_error_max_m": round(truth.lateral_max_m, 5),
    }


def _hub(host: str, port: int, secret: bytes, names: list[str], given: str) -> Hub:
    try:
        return Hub(host, port, secret, names)
    except OSError as error:
        raise InputError(f"--robots {given}: cannot listen there ({error.strerror})") from None


@contextmanager
def _room_of_its_own(
    hub: Hub, secret: bytes, truth: Path, asked: list[str], *, is_wanted: bool
) -> Iterator[None]:
    """Run an emulated room in a separate process for the duration of the context, if wanted."""
    if not is_wanted:
        yield
        return
    url = "{}://{}:{}".format(settings.ROOM, *hub.address)
    command = [sys.executable, "-m", "rmfs", "emulate", "--server", url, *asked]
    room = subprocess.Popen(
        [*command, "--report", str(truth)],
        env={**os.environ, settings.SECRET: secret.decode()},
        stdout=subprocess.DEVNULL,
    )
    try:
        yield
        room.wait(60.0)
    finally:
        room.kill()
        room.wait()


def _log_to_stderr() -> None:
    logging.basicConfig(level=logging.WARNING, format="rmfs: %(message)s", stream=sys.stderr)
