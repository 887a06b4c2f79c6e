"""The result of an audit, divided into chapters."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.measure.checker import CheckReport

SHOWN = 5
"""Maximum number of faults of a chapter shown in a summary."""


@dataclass(frozen=True, slots=True)
class Chapter:
    """One part of an audit, with the faults found.

    Attributes
    ----------
    name
        Name of the part: `stock`, `orders`, ...
    told
        Text that states what was examined, such as numbers of orders.
    faults
        One line per fault; empty if there are none.
    """

    name: str
    told: str
    faults: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Audit:
    """The result of an audit.

    Attributes
    ----------
    motion
        Result of the trace checker.
    chapters
        The parts of the audit other than motion.
    """

    motion: CheckReport
    chapters: list[Chapter]

    @property
    def ok(self) -> bool:
        """Whether no faults were found."""
        return self.motion.ok and not any(chapter.faults for chapter in self.chapters)

    def summary(self) -> str:
        """Return the result as text: `ok` or the first faults, for the motion and each chapter."""
        lines = [f"motion: {self.motion.summary(SHOWN)}"]
        for chapter in self.chapters:
            if not chapter.faults:
                lines.append(f"{chapter.name}: {chapter.told}: ok")
                continue
            lines.append(f"{chapter.name}: {chapter.told}: faults found: {len(chapter.faults)}")
            lines += [f"  {fault}" for fault in chapter.faults[:SHOWN]]
        return "\n".join(lines)
