"""The inputs of a run: layout, scenario and controllers, from files, names or objects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import control, references, scenario
from rmfs import layout as layouts
from rmfs.control.settings import ControllerSettings
from rmfs.errors import InputError
from rmfs.layout.model import Layout
from rmfs.scenario import Scenario

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Overrides = list[tuple[list[str], Any]]


@dataclass(frozen=True)
class Inputs:
    """The inputs of a run, with all overrides applied.

    Attributes
    ----------
    overrides
        All overrides, as pairs of a path (list of keys) and a value: the given ones, and those that
        a scenario of RAWSim-O implies for the layout.
    pacing
        The overrides of the pacing; their paths lack the first key, `pacing`.
    notes
        Remarks on what an import from RAWSim-O files leaves out or changes, by input (`layout`,
        `scenario` or `controllers`).
    """

    layout: Layout
    scenario: Scenario
    controllers: ControllerSettings
    overrides: Overrides
    pacing: Overrides
    notes: dict[str, list[str]]


def load_inputs(
    layout: str | Path | Layout,
    work: str | Path | Scenario,
    rules: str | Path | ControllerSettings,
    overrides: Sequence[tuple[list[str], Any]] = (),
) -> Inputs:
    """Load the inputs of a run; see `rmfs.simulate`.

    Values that a scenario of RAWSim-O implies for the layout are applied first, so that the given
    overrides take precedence.

    Raises
    ------
    InputError
        If an argument is wrong; the message names it and the valid values.
    """
    given = _split(overrides)
    asked = [] if isinstance(work, Scenario) else scenario.asked_of_layout(work)
    of_layout = [*_split(asked)["layout"], *given["layout"]]
    notes: dict[str, list[str]] = {}
    if isinstance(layout, Layout) and not given["layout"]:
        plan = layouts.override(layout, of_layout, layout.name)
    else:
        plan = _loaded("layout", layout, Layout, layouts.load_with_notes, of_layout, notes)
    return Inputs(
        layout=plan,
        scenario=_loaded(
            "scenario", work, Scenario, scenario.load_with_notes, given["scenario"], notes
        ),
        controllers=_loaded(
            "controllers",
            rules,
            ControllerSettings,
            control.load_with_notes,
            given["controllers"],
            notes,
        ),
        overrides=[*asked, *overrides],
        pacing=given["pacing"],
        notes=notes,
    )


def as_overrides(settings: Mapping[str, Any]) -> Overrides:
    """Split the dotted keys of `settings` into lists of keys; return (list of keys, value) pairs.

    A class given as a value is replaced by a name by which this process can find the class.

    Raises
    ------
    InputError
        If `settings` is not a mapping, or a key is not a string.
    """
    if not isinstance(settings, Mapping):
        raise InputError(
            'set: must be a mapping of keys to values, such as {"layout.robots": 16} '
            f"(given: {type(settings).__name__})"
        )
    wrong = [key for key in settings if not isinstance(key, str)]
    if wrong:
        raise InputError(f'set: {wrong[0]!r}: must be a dotted key, such as "layout.robots"')
    return [
        (key.split("."), references.plain(value, references.name_of))
        for key, value in settings.items()
    ]


def name_of(given: Any) -> str:
    """Return the name of an input: the stem of a path, or the attribute `name` of an object."""
    return Path(given).stem if isinstance(given, str | Path) else str(given.name)


def _split(overrides: Sequence[tuple[list[str], Any]]) -> dict[str, Overrides]:
    """Sort overrides by input."""
    parts: dict[str, Overrides] = {"layout": [], "scenario": [], "controllers": [], "pacing": []}
    for path, value in overrides:
        if path[0] not in parts or len(path) < 2:
            raise InputError(
                f"--set {'.'.join(path)}: must begin with layout., scenario., controllers. "
                "or pacing."
            )
        parts[path[0]].append((path[1:], value))
    return parts


def _loaded(
    part: str,
    given: Any,
    kind: type,
    load: Callable[..., Any],
    overrides: Overrides,
    notes: dict[str, list[str]],
) -> Any:
    """Load an input unless it is already an object, which overrides cannot change."""
    if not isinstance(given, kind):
        loaded, remarks = load(str(given), overrides)
        if remarks:
            notes[part] = remarks
        return loaded
    if overrides:
        path = ".".join(overrides[0][0])
        raise InputError(f"--set {path}: {kind.__name__} was given as an object, not as a file")
    return given
