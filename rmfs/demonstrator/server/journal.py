"""A journal of received messages, tick by tick, so that a killed server can resume.

A tick is a step of 50 ms. A server that is restarted with its journal repeats the demonstration as
fast as it can. It reaches the same state, because it processes the same messages and all its random
draws are seeded. If an error ended the server, the same error would therefore occur again in the
same tick of the repetition. Such a failed tick is marked in the journal, and a repetition can omit
its messages. Nothing has been sent to the robots in a failed tick.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.demonstrator.robot.protocol import Message

FORMAT = "rmfs-journal/1"

Heard = tuple[list[tuple[int, "Message"]], frozenset[int]]


class Journal:
    """A journal file, with an entry for each tick in which there is something to record.

    There is an entry if messages were received or sent, robots were silent, or the tick failed. The
    messages sent are not part of the entry.

    Parameters
    ----------
    path
        The file; created if it does not exist.
    settings
        Settings of the demonstration; a journal with other settings is refused.
    past_failure
        Whether to omit the messages of the last failed tick. Default: False.

    Raises
    ------
    InputError
        If the file is not a journal or belongs to another demonstration. Also if `past_failure` is
        true and there are no messages to omit: no tick has failed since messages were last omitted,
        or the last tick failed although its messages had been omitted.
    """

    def __init__(self, path: Path, settings: dict[str, Any], *, past_failure: bool = False) -> None:
        head = json.dumps({"format": FORMAT, "settings": settings}, sort_keys=True)
        past = _Past(path, head)
        left_out = _to_leave_out(path, past) if past_failure else None
        self.left_out = past.left_out | ({left_out} if left_out is not None else set())
        """Times (us) of the failed ticks whose messages are omitted."""
        self.begins_us = max([*past.heard, *self.left_out], default=-1)
        """Time (us) up to which messages come from the journal."""
        self._by_time = past.heard
        if not path.exists():
            path.write_text(head + "\n", encoding="utf-8")
        # a line that was cut off when the server was killed was not acted upon
        self._drop_half_line(path)
        self._file = path.open("a", encoding="utf-8")
        if left_out is not None:
            self._write({"time_us": left_out, "left_out": True})

    def heard_at(self, time_us: int) -> Heard:
        """Return the messages and silent robots of a past tick; none if they have to be omitted."""
        if time_us in self.left_out:
            return [], frozenset()
        return self._by_time.get(time_us, ([], frozenset()))

    def note(
        self, time_us: int, messages: list[tuple[int, Message]], silent: frozenset[int]
    ) -> None:
        """Before a tick is processed, record the messages received in it and the silent robots."""
        self._write({"time_us": time_us, "heard": messages, "silent": sorted(silent)})

    def note_failure(self, time_us: int, error: str) -> None:
        """Mark the tick at `time_us` as failed; nothing has been sent to the robots in it."""
        self._write({"time_us": time_us, "failed": error})

    def _write(self, entry: dict[str, Any]) -> None:
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


class _Past:
    """The contents of a journal.

    Attributes
    ----------
    heard
        Messages and silent robots of each tick, by its time (us).
    left_out
        Times (us) of the ticks to be replayed without their messages.
    failed
        Time (us) of the last failed tick; None if no tick has failed since the last one left out.
    """

    def __init__(self, path: Path, head: str) -> None:
        self.heard: dict[int, Heard] = {}
        self.left_out: set[int] = set()
        self.failed: int | None = None
        if not path.exists():
            return
        lines = path.read_text(encoding="utf-8").split("\n")
        if lines[0] != head:
            raise InputError(
                f"{path}: is not a journal of this demonstration; use the same layout, scenario, "
                "controllers and seed as before, or choose another --out"
            )
        for number, line in enumerate(lines[1:-1], start=2):
            try:
                self._add(json.loads(line))
            except (ValueError, KeyError, TypeError) as error:
                raise InputError(f"{path}: line {number} is damaged: {error!r}") from None

    def _add(self, entry: dict[str, Any]) -> None:
        time_us = int(entry["time_us"])
        if "failed" in entry:
            self.failed = time_us
        elif "left_out" in entry:
            self.left_out.add(time_us)
            self.failed = None
        else:
            messages = [(int(robot), dict(message)) for robot, message in entry["heard"]]
            self.heard[time_us] = messages, frozenset(entry["silent"])


def _to_leave_out(path: Path, past: _Past) -> int:
    """Return the time (us) of the tick that failed."""
    if past.failed is None:
        raise InputError(
            f"{path}: contains no failure; --past-failure needs a journal whose last tick failed"
        )
    if past.failed in past.left_out:
        raise InputError(
            f"{path}: the tick at {past.failed / 1e6:.2f} s fails even without the messages "
            "received then; start again with another --out"
        )
    return past.failed
