"""The colours of the page, for a light and a dark theme.

The colours of stations (by kind) and of robots (by task or by delay) differ in hue and lightness:
stations are darker than robots in the light theme and lighter in the dark theme, and delay has a
separate colour scale. A test ensures that people with common kinds of colour blindness can
distinguish the colours, and that the colours contrast with the floor.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rmfs.layout.kinds import TASK_COLOURS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.layout.model import Layout


@dataclass(frozen=True)
class Theme:
    """The colours of one theme.

    Attributes
    ----------
    floor
        Colour of the background.
    pod, elevator
        Colours of pods and of elevators.
    towards, share
        Colour that is mixed into the colours of stations other than pick and replenishment
        stations, and the share of this colour in the mixture.
    stations, tasks
        Colours of pick and replenishment stations, by kind, and of robots, by task.
    delay
        Colours of robots by delay, from none to long.
    """

    floor: str
    pod: str
    elevator: str
    towards: str
    share: float
    stations: Mapping[str, str]
    tasks: Mapping[str, str]
    delay: tuple[str, ...]


THEMES = {
    "light": Theme(
        floor="#FFFFFF",
        pod="#1F457A",
        elevator="#460214",
        towards="#000000",
        share=0.45,
        stations={"pick": "#842114", "replenishment": "#5C760B"},
        tasks={
            "pick": "#D87B64",
            "replenish": "#AD9100",
            "park": "#2C94C6",
            "reposition": "#FF20B5",
            "rest": "#595959",
        },
        delay=("#B782FE", "#A225E1", "#140736"),
    ),
    "dark": Theme(
        floor="#1B2128",
        pod="#2873A2",
        elevator="#FADBF0",
        towards="#FFFFFF",
        share=0.55,
        stations={"pick": "#F1B4A9", "replenishment": "#FDFF92"},
        tasks={
            "pick": "#AB512B",
            "replenish": "#C0BC16",
            "park": "#59AFEC",
            "reposition": "#F9006A",
            "rest": "#838383",
        },
        delay=("#3B0BC9", "#9B72FF", "#C2B1F5"),
    ),
}


def themes_of(layout: Layout, visits: Mapping[str, str]) -> dict[str, Any]:
    """Return each theme's colours of stations, pods, elevators, and robots by task and by delay.

    Parameters
    ----------
    visits
        Colours of robots, by task, for tasks that lead to stations other than pick and
        replenishment stations.
    """
    return {
        name: {
            "pod": theme.pod,
            "elevator": theme.elevator,
            "stations": [
                theme.stations.get(kind.name) or _mixed(kind.colour, theme.towards, theme.share)
                for kind in (station.kind for station in layout.stations)
            ],
            "task": {task: theme.tasks[task] for task in TASK_COLOURS} | dict(visits),
            "delay": list(theme.delay),
        }
        for name, theme in THEMES.items()
    }


def _mixed(colour: str, towards: str, share: float) -> str:
    pairs = (
        (int(colour[i : i + 2], 16), int(towards[i : i + 2], 16)) for i in range(1, len(colour), 2)
    )
    return "#" + "".join(f"{round(a + share * (b - a)):02X}" for a, b in pairs)
