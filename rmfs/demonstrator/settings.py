"""The settings of a demonstration (a run with real robots), from command-line options."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from rmfs.errors import InputError

if TYPE_CHECKING:
    from rmfs.layout.model import Layout

TCP, ROOM = "tcp", "room"
"""Address schemes: for real time, and for the time of an emulated room."""

SECRET = "RMFS_SECRET"
"""Environment variable that contains the secret."""

SHORTEST_SECRET = 8


def address(url: str, option: str) -> tuple[str, str, int]:
    """Return the scheme (`tcp` or `room`), host and port of an address.

    Raises
    ------
    InputError
        If `url` has neither the form tcp://HOST:PORT nor room://HOST:PORT.
    """
    try:
        parts = urlsplit(url)
        rest = parts.path or parts.query or parts.fragment or parts.username
        if parts.scheme in (TCP, ROOM) and parts.hostname and parts.port is not None and not rest:
            return parts.scheme, parts.hostname, parts.port
    except ValueError:
        pass  # a port that is none
    raise InputError(
        f"{option} {url}: must be {TCP}://HOST:PORT (real time) or {ROOM}://HOST:PORT (an emulated "
        "room keeps the clock)"
    )


def secret(file: Path | None) -> bytes:
    """Return the secret that the server shares with the robots.

    It is read from the file or, if `file` is None, from the environment variable `RMFS_SECRET`.

    Raises
    ------
    InputError
        If the secret is missing or too short, or the file cannot be read.
    """
    try:
        given = os.environ.get(SECRET, "") if file is None else file.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise InputError(f"--secret {file}: cannot be read ({error})") from None
    known = given.strip().encode()
    if len(known) < SHORTEST_SECRET:
        where = f"environment variable {SECRET}" if file is None else f"--secret {file}"
        raise InputError(
            f"{where}: must hold the secret shared with the robots, of at least {SHORTEST_SECRET} "
            "characters"
        )
    return known


def robots(layout: Layout, chosen: str | None, option: str = "--real") -> dict[str, int]:
    """Return the names of the real or emulated robots, with their indices in the layout.

    Parameters
    ----------
    layout
        The warehouse. The robot with index 3 is called `robot-3`.
    chosen
        Indices of the robots, separated by commas; None for all robots.

    Raises
    ------
    InputError
        If an index belongs to no robot of the layout, or is given twice.
    """
    indices = list(range(layout.robots)) if chosen is None else _indices(chosen)
    if not indices or not set(indices) <= set(range(layout.robots)):
        raise InputError(
            f"{option} {chosen}: must be indices of robots, 0 to {layout.robots - 1}, separated by "
            "commas"
        )
    if len(set(indices)) < len(indices):
        raise InputError(f"{option} {chosen}: names a robot twice")
    return {f"robot-{index}": index for index in indices}


def tags(layout: Layout, file: Path | None) -> list[str]:
    """Return, for every waypoint, the tag on the floor that robots read there.

    Parameters
    ----------
    layout
        The warehouse.
    file
        File with one line `waypoint;tag` per waypoint; None for the tags W0, W1, ... of an
        emulated floor.

    Raises
    ------
    InputError
        If the file cannot be read, or does not give each waypoint a different tag.
    """
    if file is None:
        return [f"W{waypoint}" for waypoint in range(layout.waypoints)]
    known: dict[int, str] = {}
    for number, line in enumerate(_lines(file), start=1):
        waypoint, _, tag = (part.strip() for part in line.partition(";"))
        if not waypoint.isdecimal() or not tag or int(waypoint) >= layout.waypoints:
            raise InputError(
                f"--tags {file}: line {number}: must be WAYPOINT;TAG with a waypoint from 0 to "
                f"{layout.waypoints - 1}"
            )
        if int(waypoint) in known or tag.upper() in known.values():
            raise InputError(f"--tags {file}: line {number}: the waypoint or the tag occurs twice")
        known[int(waypoint)] = tag.upper()
    missing = sorted(set(range(layout.waypoints)) - set(known))
    if missing:
        raise InputError(f"--tags {file}: waypoint {missing[0]} has no tag")
    return [known[waypoint] for waypoint in range(layout.waypoints)]


def _indices(chosen: str) -> list[int]:
    parts = [part.strip() for part in chosen.split(",")]
    return [int(part) if part.isdecimal() else -1 for part in parts]


def _lines(file: Path) -> list[str]:
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise InputError(f"--tags {file}: cannot be read ({error})") from None
    return [line for line in text.splitlines() if line.strip()]
