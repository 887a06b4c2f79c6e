"""The layout of a warehouse: waypoints, stations, and pods and robots at the start of a run.

`load` reads every kind of layout file, `generate` makes a default layout from parameters, `check`
returns the violations of a layout, and `draw` draws a layout.
"""

from typing import TYPE_CHECKING, Any

from rmfs.layout.checks import Violation as Violation
from rmfs.layout.checks import check as check
from rmfs.layout.checks import refuse as refuse
from rmfs.layout.explicit import save_json as save_json
from rmfs.layout.generator import generate as generate
from rmfs.layout.loading import load as load
from rmfs.layout.loading import load_with_notes as load_with_notes
from rmfs.layout.loading import names as names
from rmfs.layout.model import Elevator as Elevator
from rmfs.layout.model import Layout as Layout
from rmfs.layout.model import PickStation as PickStation
from rmfs.layout.model import ReplenishmentStation as ReplenishmentStation
from rmfs.layout.model import RobotKind as RobotKind
from rmfs.layout.model import Tier as Tier
from rmfs.layout.overrides import override as override
from rmfs.layout.parameters import LayoutParameters as LayoutParameters

if TYPE_CHECKING:
    from rmfs.layout.picture import draw as draw
    from rmfs.layout.picture import save_picture as save_picture


def __getattr__(name: str) -> Any:
    """Import the drawing functions on first use, so that runs need no matplotlib."""
    if name in ("draw", "save_picture"):
        from rmfs.layout import picture

        return getattr(picture, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
