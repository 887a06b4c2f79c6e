"""What an audit found, chapter by chapter."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.measure.checker import CheckReport

SHOWN = 5
"""Faults of a chapter that a summary shows."""


@dataclass(frozen=True, slots=True)
class Chapter:
    """One account of a run, and what is wrong with it.

    Attributes
    ----------
    name
        Of what: `stock`, `orders`, ...
    told
        What was looked at, in words.
    faults
        One line for each thing that is wrong, by time; nothing if all is right.
    """

    name: str
    told: str
    faults: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Audit:
    """The verdict over a run, from its files alone.

    Attributes
    ----------
    motion
        What the trace checker says.
    chapters
        The other accounts.
    """

    motion: CheckReport
    chapters: list[Chapter]

    @property
    def ok(self) -> bool:
        """Whether nothing is wrong."""
        return self.motion.ok and not any(chapter.faults for chapter in self.chapters)

    def summary(self) -> str:
        """Return the verdict: a line for each chapter, and the first faults of each."""
        lines = [f"motion: {self.motion.summary(SHOWN)}"]
        for chapter in self.chapters:
            if not chapter.faults:
                lines.append(f"{chapter.name}: {chapter.told}: ok")
                continue
            lines.append(f"{chapter.name}: {chapter.told}: {len(chapter.faults)} faults")
            lines += [f"  {fault}" for fault in chapter.faults[:SHOWN]]
        return "\n".join(lines)
