"""The preview of a layout, shown by the form in which a run is set up and started."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs import layout
from rmfs.errors import InputError
from rmfs.references import installed_only
from rmfs.view import scene
from rmfs.view.container import pack
from rmfs.view.forms import shipped

if TYPE_CHECKING:
    from rmfs.config import Table


def preview(wish: Table) -> bytes:
    """Pack a layout as a scene without motion.

    Parameters
    ----------
    wish
        `layout` is the name of a shipped layout. `set` contains values of parameters by key, such
        as `{"layout.robots": 16}`; only parameters of the layout are used.

    Raises
    ------
    InputError
        If there is no such layout, or it cannot be built with these values.
    """
    name, changes = shipped("layout", str(wish.get("layout", "default"))), wish.get("set", {})
    if not isinstance(changes, dict):
        raise InputError("set: must map keys to values")
    paths = [(key.split("."), value) for key, value in changes.items()]
    own = [(path[1:], value) for path, value in paths if path[0] == "layout"]
    with installed_only():  # a page may name no code
        plan = layout.load(name, own)
    header = scene.head(
        plan, names={"layout": name}, seed=0, warmup_s=0.0, end_s=0.0, title=name, details=[]
    )
    return pack(header, scene.describe(plan, np.zeros(0)))
