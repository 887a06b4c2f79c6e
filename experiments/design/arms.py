"""The arms of a design, made from factors, lists and files.

A factor is either a parameter (`layout.robots`, `controllers.psa`, or just `scenario` for the whole
file) or a user-defined name. Each level of a user-defined factor sets one or more parameters.
"""

from __future__ import annotations

import csv
import difflib
import io
import itertools
import json
import math
import tomllib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rmfs import references
from rmfs.config import Table, read_toml
from rmfs.errors import InputError
from rmfs.files import read_bounded
from rmfs.measure.dictionary import footprint_column
from rmfs.measure.registry import RESERVED

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from pathlib import Path

    from rmfs.experiments.design.file import DesignFile

PARTS = ("layout", "scenario", "controllers")
"""The three inputs of a run."""

MOST_ARMS = 100_000
"""Maximum number of arms in a file."""
MOST_COMBINATIONS = 1_000_000
"""Maximum number of combinations of the levels of factors."""
LARGEST_MIB = 16
"""Maximum size of a file of arms, in MiB."""

Overrides = list[tuple[list[str], Any]]


@dataclass(frozen=True)
class Arm:
    """One configuration that is simulated.

    Attributes
    ----------
    name
        Name, unique in the design.
    levels
        Level of each factor as shown in tables: a number, a string or a boolean; None if neither
        the arm nor the design's `base` sets the factor.
    inputs
        Names or paths of the layout, the scenario and the controllers.
    overrides
        Parameters that replace values in these inputs: pairs of a key (as a list of words) and a
        value.
    pacing
        Pacing mode: how much simulated time the computations of optimisers take.
    digest
        Hash of everything that determines a run except its seed; empty until the inputs are read.
    """

    name: str
    levels: Mapping[str, Any]
    inputs: Mapping[str, str]
    overrides: Overrides
    pacing: str = "instant"
    digest: str = ""


@dataclass(frozen=True)
class Level:
    """One level of one factor, or one entry of the design's list of arms.

    Attributes
    ----------
    shown
        Values shown in a result table, by column.
    settings
        Values of the parameters that the level sets, by dotted key.
    name
        Name of the level as a part of the arm's name.
    raw
        For each column, the values by which the design's `exclude` may refer to this level.
    of_grid
        Whether this is a level of a factor of the grid (the design's `factors`), not an entry of
        the list of arms. In the arm's name, a level of the grid appears as `factor=level`, whereas
        an entry of the list appears as its name alone.
    """

    shown: dict[str, Any]
    settings: dict[str, Any]
    name: str
    raw: dict[str, list[Any]] = field(default_factory=dict)
    of_grid: bool = True


def arms(design: DesignFile, folder: Path) -> tuple[list[Arm], list[str]]:
    """Return the arms of a design, and the errors found while making them.

    Parameters
    ----------
    folder
        The design's folder, which is searched first for files.
    """
    problems: list[str] = []
    factors = [_grid_factor(key, levels, problems) for key, levels in design.factors.items()]
    listed = _listed(design, folder, problems)
    if listed:
        factors.insert(0, listed)
    keys = list(dict.fromkeys(k for factor in factors for level in factor for k in level.shown))
    problems += _key_problems(design, keys)
    if (count := math.prod(len(factor) for factor in factors)) > MOST_COMBINATIONS:
        raise InputError(
            f"factors: {count:,} combinations; at most {MOST_COMBINATIONS:,} are allowed"
        )
    combinations = [
        combination
        for combination in itertools.product(*factors)
        if not any(_matches(rule, combination) for rule in design.exclude)
    ]
    if design.only_file is not None:
        combinations = _fraction(combinations, keys, folder / design.only_file, problems)
    made = [_arm(design, combination, keys, folder, problems) for combination in combinations]
    if not made:
        problems.append("no arms are left: the exclusions leave out every combination")
    return made, list(dict.fromkeys([*problems, *_name_problems(made)]))


def factor_names(keys: Iterable[str]) -> dict[str, str]:
    """Return a short name for each factor: the shortest unique ending of its key.

    A final `name` (of a rule) is left out: `controllers.psa.name` becomes `psa`.
    """
    keys = list(keys)
    words = {key: key.removesuffix(".name").split(".") for key in keys}
    short = dict.fromkeys(keys, "")
    for key in keys:
        for count in range(1, len(words[key]) + 1):
            short[key] = ".".join(words[key][-count:])
            same = [k for k in keys if ".".join(words[k][-count:]) == short[key]]
            if same == [key]:
                break
        else:
            short[key] = key
    return short


def shown_value(value: Any) -> Any:
    """Return the value that tables show for a level."""
    if isinstance(value, bool | int | float | str) or value is None:
        return value
    if isinstance(value, dict) and isinstance(value.get("name"), str):
        more = [f"{key}={_compact(item)}" for key, item in value.items() if key != "name"]
        return f"{value['name']}({', '.join(more)})" if more else value["name"]
    return _compact(value)


def is_parameter(key: str) -> bool:
    """Whether a factor's key is a parameter rather than a user-defined name."""
    return key.split(".")[0] in (*PARTS, "pacing")


def _compact(value: Any) -> str:
    if isinstance(value, str):
        return value
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False, default=str)


def _grid_factor(key: str, levels: list[Any], problems: list[str]) -> list[Level]:
    made = [_level(key, level, problems) for level in levels]
    names = [level.name for level in made]
    doubles = sorted({name for name in names if names.count(name) > 1})
    problems += [f"factor {key}: level {name} occurs more than once" for name in doubles]
    return made


def _level(key: str, value: Any, problems: list[str]) -> Level:
    if is_parameter(key):
        label = None
        if isinstance(value, dict) and set(value) == {"label", "value"}:
            label, value = str(value["label"]), value["value"]
        shown = shown_value(value) if label is None else label
        return Level({key: shown}, {key: value}, _compact(shown), {key: [value, shown]})
    if not isinstance(value, dict) or not isinstance(value.get("label"), str):
        problems.append(
            f"factor {key}: is no parameter (layout..., scenario..., controllers..., pacing), so "
            "each of its levels must be a table with a label and the parameters it sets"
        )
        return Level({key: shown_value(value)}, {}, _compact(value))
    settings = {path: item for path, item in value.items() if path != "label"}
    return Level({key: value["label"]}, settings, value["label"], {key: [value["label"]]})


def _listed(design: DesignFile, folder: Path, problems: list[str]) -> list[Level]:
    tables = [dict(table) for table in design.arms]
    if design.arms_file is not None:
        try:
            tables += _read_arms(folder / design.arms_file)
        except InputError as error:
            problems.append(str(error))
    made = []
    for table in tables:
        name = table.pop("name", None)
        shown = {key: shown_value(value) for key, value in table.items()}
        short = factor_names(table)
        spoken = ",".join(f"{short[key]}={_compact(shown[key])}" for key in table)
        raw = {key: [value, shown[key]] for key, value in table.items()}
        made.append(
            Level(shown, table, str(name) if name is not None else spoken, raw, of_grid=False)
        )
    return made


def _fraction(
    combinations: list[tuple[Level, ...]], keys: list[str], path: Path, problems: list[str]
) -> list[tuple[Level, ...]]:
    """Return those combinations of levels that are listed in a file."""
    try:
        rows = _read_csv(path)
    except InputError as error:
        problems.append(str(error))
        return combinations
    short = factor_names(keys)
    if rows and sorted(rows[0]) != sorted(short.values()):
        problems.append(f"{path}: the columns must be the factors {', '.join(short.values())}")
        return combinations
    known = {_told(combination, short): combination for combination in combinations}
    wanted = [frozenset(row.items()) for row in rows]
    problems += [
        f"{path}: line {number}: no such combination of levels"
        for number, row in enumerate(wanted, 2)
        if row not in known
    ]
    return [known[row] for row in dict.fromkeys(wanted) if row in known]


def _told(combination: tuple[Level, ...], short: Mapping[str, str]) -> frozenset[tuple[str, str]]:
    """Return the factors and levels of a combination as a file of combinations lists them."""
    levels = {key: value for level in combination for key, value in level.shown.items()}
    return frozenset(
        (name, "" if levels.get(key) is None else _compact(levels[key]))
        for key, name in short.items()
    )


def _read_arms(path: Path) -> list[Table]:
    """Read arms from a file.

    Raises
    ------
    InputError
        If the file is missing or invalid.
    """
    if path.suffix.lower() == ".toml":
        table = read_toml(path)
        given = table.get("arms")
        if set(table) - {"format"} != {"arms"} or not isinstance(given, list):
            raise InputError(f"{path}: must hold nothing but [[arms]]")
        return given
    if path.suffix.lower() != ".csv":
        raise InputError(f"{path}: expected a .csv or .toml file of arms")
    # an empty cell leaves the parameter as it is in the base
    return [
        {key: _cell(value) for key, value in row.items() if value != ""} for row in _read_csv(path)
    ]


def _read_csv(path: Path) -> list[dict[str, str]]:
    """Read a .csv file; all cells are returned as text.

    Raises
    ------
    InputError
        If the file is missing or invalid.
    """
    try:
        text = read_bounded(path, LARGEST_MIB).decode("utf-8")
        reader = csv.DictReader(io.StringIO(text, newline=""), strict=True)
        columns = list(reader.fieldnames or ())
        rows = list(itertools.islice(reader, MOST_ARMS + 1))
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    doubled = [name for name in dict.fromkeys(columns) if columns.count(name) > 1]
    if doubled:
        raise InputError(f"{path}: line 1 names the column {doubled[0]} more than once")
    if len(rows) > MOST_ARMS:
        raise InputError(f"{path}: more than {MOST_ARMS:,} lines")
    for number, row in enumerate(rows, 2):
        if None in row or None in row.values():
            raise InputError(f"{path}: line {number} has not as many cells as the first line")
    return rows


def _cell(text: str) -> Any:
    """Read a cell as a TOML value; return it as text if it is not one."""
    try:
        return tomllib.loads(f"value = {text.strip()}")["value"]
    except tomllib.TOMLDecodeError:
        return text.strip()


def _key_problems(design: DesignFile, keys: list[str]) -> Iterator[str]:
    for key in keys:
        known = key in RESERVED or footprint_column(key) is not None
        if known and key not in PARTS:
            yield f"factor {key}: this is the name of another column of the results"
    for number, rule in enumerate(design.exclude, 1):
        if not rule:
            yield f"exclude {number}: names no factor"
        for key in rule:
            if key not in keys:
                near = difflib.get_close_matches(key, keys, n=1)
                hint = f"did you mean {near[0]}?" if near else f"factors: {', '.join(keys)}"
                yield f"exclude {number}: {key} is not a factor; {hint}"
    for key in design.seeded:
        if "." not in key or key.split(".")[0] not in PARTS:
            yield f"seeded: {key}: must begin with layout., scenario. or controllers."


def _matches(rule: Table, combination: tuple[Level, ...]) -> bool:
    """Whether all conditions of an exclusion hold; each names one level or a list of levels."""
    raw = {key: values for level in combination for key, values in level.raw.items()}
    return bool(rule) and all(
        any(_same(one, known) for one in _as_list(wanted) for known in raw.get(key, []))
        for key, wanted in rule.items()
    )


def _as_list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def _same(first: Any, second: Any) -> bool:
    """Whether two levels are equal; true and 1 are different."""
    return isinstance(first, bool) == isinstance(second, bool) and first == second


def _arm(
    design: DesignFile,
    combination: tuple[Level, ...],
    keys: list[str],
    folder: Path,
    problems: list[str],
) -> Arm:
    settings: dict[str, Any] = dict(design.base)
    for level in combination:
        settings |= level.settings
    levels = dict.fromkeys(keys) | {k: v for level in combination for k, v in level.shown.items()}
    # a parameter that an arm of a list leaves alone has the level of the base
    levels |= {
        key: shown_value(design.base[key])
        for key, value in levels.items()
        if value is None and key in design.base
    }
    inputs = {part: settings.pop(part, "default") for part in PARTS}
    for part, given in inputs.items():
        if not isinstance(given, str):
            problems.append(f"base: {part} = {given!r} is neither a name nor a file")
    pacing = settings.pop("pacing", design.pacing)
    overrides: Overrides = []
    for key, value in settings.items():
        path = key.split(".")
        if path[0] not in (*PARTS, "pacing") or "" in path or len(path) < 2:
            problems.append(
                f"{key}: not a parameter; must begin with layout., scenario., controllers. or "
                "pacing."
            )
        else:
            overrides.append((path, _anchored_rule(path, value, folder)))
    return Arm(
        name=_arm_name(combination, keys),
        levels=levels,
        inputs={part: anchored(str(given), folder) for part, given in inputs.items()},
        overrides=overrides,
        pacing=str(pacing),
    )


def _arm_name(combination: tuple[Level, ...], keys: list[str]) -> str:
    short = factor_names(keys)
    parts = []
    for level in combination:
        told = [f"{short[key]}={level.name}" for key in level.shown] if level.of_grid else []
        parts.append(told[0] if told else level.name)
    return ",".join(parts) or "base"


def anchored(given: str, folder: Path) -> str:
    """Return the path of the file `given` in `folder` if it exists; otherwise, `given` itself."""
    beside = folder / given
    try:
        return str(beside) if beside.is_file() else given
    except OSError:  # too long for a file name: reported where the input is read
        return given


_FOUND: dict[str, Callable[[str, Path], str]] = {
    "name": references.anchored,
    "guidance": references.anchored_file,
}
"""Keys of a rule's table whose values may name files, and the functions that find the files."""


def _anchored_rule(path: list[str], value: Any, folder: Path) -> Any:
    """Return a value of a parameter; if it names a file, with the absolute path of the file."""
    if path[0] != "controllers":
        return value
    if isinstance(value, dict):
        named = {
            key: find(value[key], folder)
            for key, find in _FOUND.items()
            if isinstance(value.get(key), str)
        }
        return {**value, **named}
    if path[-1] == "guidance" and isinstance(value, str):
        return references.anchored_file(value, folder)
    is_name = len(path) == 2 or path[-1] == "name"
    return references.anchored(value, folder) if is_name and isinstance(value, str) else value


def _name_problems(made: list[Arm]) -> list[str]:
    names = [arm.name for arm in made]
    doubles = sorted({name for name in names if names.count(name) > 1})
    return [f"arm {name}: the name occurs more than once" for name in doubles]
