"""The settings of a demonstration, read from options and validated."""

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
    """Return the scheme, host and port of an address.

    Raises
    ------
    InputError
        If the text is not a valid address.
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
    """Return the secret from a file, or from the environment variable.

    Raises
    ------
    InputError
        If there is no secret, or it is too short.
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
    """Return the names of the robots outside the simulation, with their indices in the layout.

    Parameters
    ----------
    layout
        The warehouse. Its robot with index 3 is called `robot-3`.
    chosen
        Indices of the robots, separated by commas; None for all robots.

    Raises
    ------
    InputError
        If there is no such robot, or one is named twice.
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
    """Return the tag of every waypoint.

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
