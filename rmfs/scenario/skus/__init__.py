"""Sets of SKUs as arrays: generated, read, written, and plotted by popularity."""

from typing import TYPE_CHECKING, Any

from rmfs.scenario.skus.affinity import Affinity as Affinity
from rmfs.scenario.skus.drawing import draw_sku_set as draw_sku_set
from rmfs.scenario.skus.file import read_sku_set as read_sku_set
from rmfs.scenario.skus.file import write_sku_set as write_sku_set
from rmfs.scenario.skus.sku_set import SkuSet as SkuSet

if TYPE_CHECKING:
    from rmfs.scenario.skus.picture import draw_popularity as draw_popularity


def __getattr__(name: str) -> Any:
    """Import the drawing functions on first use, so that runs need no matplotlib."""
    if name == "draw_popularity":
        from rmfs.scenario.skus import picture

        return picture.draw_popularity
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
