"""A journal of received messages, tick by tick, so that a killed server can resume.

A server that is restarted with its journal repeats everything as fast as it can. It reaches the
same state, as it receives the same messages and all its random draws are seeded.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rmfs.demonstrator.robot.protocol import Message

FORMAT = "rmfs-journal/1"

Heard = tuple[list[tuple[int, "Message"]], frozenset[int]]


class Journal:
    """A file with one line for every tick at which messages were received.

    Parameters
    ----------
    path
        The file; created if it does not exist.
    settings
        Settings of the demonstration; a journal of another one is refused.

    Raises
    ------
    InputError
        If the file is not a journal, or belongs to another demonstration.
    """

    def __init__(self, path: Path, settings: dict[str, Any]) -> None:
        head = json.dumps({"format": FORMAT, "settings": settings}, sort_keys=True)
        self._past = list(_read(path, head)) if path.exists() else []
        self.begins_us = self._past[-1][0] if self._past else -1
        """Up to this time everything has been heard already."""
        self._by_time = dict(self._past)
        if not path.exists():
            path.write_text(head + "\n", encoding="utf-8")
        # a line that was cut off when the server was killed was not acted upon
        self._drop_half_line(path)
        self._file = path.open("a", encoding="utf-8")

    def heard_at(self, time_us: int) -> Heard:
        """Return the messages received at a past time."""
        return self._by_time.get(time_us, ([], frozenset()))

    def note(
        self, time_us: int, messages: list[tuple[int, Message]], silent: frozenset[int]
    ) -> None:
        """Record received messages before they are processed."""
        entry = {"time_us": time_us, "heard": messages, "silent": sorted(silent)}
        self._file.write(json.dumps(entry, separators=(",", ":")) + "\n")
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    @staticmethod
    def _drop_half_line(path: Path) -> None:
        data = path.read_bytes()
        whole = data.rfind(b"\n") + 1
        if whole < len(data):
            with path.open("r+b") as file:
                file.truncate(whole)


def _read(path: Path, head: str) -> Iterator[tuple[int, Heard]]:
    lines = path.read_text(encoding="utf-8").split("\n")
    if lines[0] != head:
        raise InputError(
            f"{path}: the journal of another demonstration (or none); go on with the same layout, "
            "scenario, controllers and seed, or choose another --out"
        )
    for number, line in enumerate(lines[1:-1], start=2):
        try:
            entry = json.loads(line)
            messages = [(int(robot), dict(message)) for robot, message in entry["heard"]]
            yield int(entry["time_us"]), (messages, frozenset(entry["silent"]))
        except (ValueError, KeyError, TypeError) as error:
            raise InputError(f"{path}: line {number} is damaged: {error!r}") from None
