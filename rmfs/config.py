"""Configuration: TOML files read into frozen pydantic models, with errors a user can act on."""

from __future__ import annotations

import difflib
import re
import tomllib
import types
import typing
from collections.abc import Iterator
from math import inf
from pathlib import Path
from typing import Any, TypeVar

import pydantic

from rmfs.errors import InputError
from rmfs.files import read_bounded

LARGEST_MIB = 4
"""Size limit of a TOML file in MiB; such files are written by hand."""


LARGEST = 1e9
"""Largest absolute value of a parameter that is neither infinite nor a seed; 1e9 s are 31 years."""
SMALLEST = 1e-9
"""Smallest absolute value of a parameter that is not 0; its reciprocal stays within `LARGEST`."""
LARGEST_SEED = 2**63 - 1
"""Largest seed: the largest signed 64-bit integer."""


class Model(pydantic.BaseModel):
    """Base class of all configuration blocks: unknown keys are errors, and values are immutable.

    A number must be 0 or infinite, or have an absolute value from `SMALLEST` to `LARGEST` (for a
    `seed`: to `LARGEST_SEED`); a field may have a narrower range. Booleans must be written as
    `true` or `false`.
    """

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, validate_default=True)

    @pydantic.model_validator(mode="before")
    @classmethod
    def _truth_is_written_as_such(cls, data: Any) -> Any:
        if isinstance(data, dict):
            for key, field in cls.model_fields.items():
                if field.annotation is bool and not isinstance(data.get(key, True), bool):
                    raise ValueError(f"{key} must be true or false (given: {data[key]!r})")
        return data

    @pydantic.field_validator("*")
    @classmethod
    def _numbers_are_of_a_sensible_size(cls, value: Any, info: pydantic.ValidationInfo) -> Any:
        most = LARGEST_SEED if info.field_name == "seed" else LARGEST
        for number in _numbers(value):
            size = abs(number)
            if most < size < inf:
                raise ValueError(f"must be at most {most:g} in absolute value")
            if 0 < size < SMALLEST:
                raise ValueError(f"must be 0, or at least {SMALLEST:g} in absolute value")
        return value


def _numbers(value: Any) -> Iterator[float]:
    """Yield a number, or the numbers of a tuple or list."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        yield value
    elif isinstance(value, tuple | list):
        for item in value:
            yield from _numbers(item)


M = TypeVar("M", bound=pydantic.BaseModel)
Table = dict[str, Any]


def read_toml(path: Path) -> Table:
    """Read a TOML file.

    Raises
    ------
    InputError
        If the file is missing, unreadable, larger than `LARGEST_MIB`, or not valid TOML.
    """
    content = read_bounded(path, LARGEST_MIB)
    try:
        return tomllib.loads(content.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    except (ValueError, RecursionError) as error:  # ValueError also for integers of 1000s of digits
        raise InputError(f"{path}: not valid TOML: {error!s:.200}") from None


def parse_override(text: str) -> tuple[list[str], Any]:
    """Parse one `--set a.b=value`; a value that is not valid TOML is taken as a string.

    Returns
    -------
    tuple
        The parts of the key, such as `["a", "b"]`, and the value.

    Raises
    ------
    InputError
        If `=` or the key is missing, or the value has too many digits or levels of nesting.
    """
    key, separator, value = text.partition("=")
    if not separator or not key.strip():
        raise InputError(f"--set {text}: expected KEY=VALUE, for example layout.robots=16")
    try:
        parsed = tomllib.loads(f"value = {value.strip()}")["value"]
    except tomllib.TOMLDecodeError:
        parsed = value.strip()
    except (ValueError, RecursionError) as error:
        raise InputError(f"--set {key}: {error!s:.200}") from None
    return key.strip().split("."), parsed


def apply_overrides(table: Table, overrides: list[tuple[list[str], Any]]) -> Table:
    """Return a copy of `table` with each (path, value) set; missing tables are created.

    Raises
    ------
    InputError
        If a path leads through a value that is not a table.
    """
    result = _copied(table)
    for path, value in overrides:
        node = result
        for key in path[:-1]:
            child = node.setdefault(key, {})
            if not isinstance(child, dict):
                raise InputError(f"--set {'.'.join(path)}: {key} is a value, not a table")
            node = child
        node[path[-1]] = value
    return result


def validate(model: type[M], table: Table, source: str) -> M:
    """Validate a table and return the model made from it.

    Parameters
    ----------
    source
        Name of the file that the table came from, for error messages.

    Raises
    ------
    InputError
        If the table is invalid. The message lists all errors on one line, each with its key. For
        an unknown key, it names the valid key that is spelt most similarly or, if none is similar,
        all valid keys. If the file has another `format`, the message lists no other error.
    """
    try:
        return model.model_validate(table)
    except pydantic.ValidationError as error:
        found = error.errors()
        other = [detail for detail in found if detail["loc"] == ("format",)]
        problems = [_explain(model, detail) for detail in _without_other_forms(other or found)]
        raise InputError(f"{source}: {'; '.join(dict.fromkeys(problems))}") from None


def _copied(table: Table) -> Table:
    return {k: _copied(v) if isinstance(v, dict) else v for k, v in table.items()}


_NO_TABLE = ("model_type", "model_attributes_type", "dict_type")
_BRANCH = re.compile(r"(constrained-|function-|(tagged-union|list|dict|tuple|literal)\[).*")
"""What pydantic calls an alternative of a union that is not a model."""


def _without_other_forms(details: list[Any]) -> list[Any]:
    """Leave out that a wrong number, say, is no table where a table is possible, too."""

    def place(detail: Any) -> tuple[Any, ...]:
        where: tuple[Any, ...] = detail["loc"]
        return where[:-1] if where and _BRANCH.fullmatch(str(where[-1])) else where

    wrong = {place(detail) for detail in details if detail["type"] not in _NO_TABLE}
    return [
        detail
        for detail in details
        if detail["type"] not in _NO_TABLE or place(detail) not in wrong
    ]


def _explain(model: type[pydantic.BaseModel], detail: Any) -> str:
    unknown = detail["type"] == "extra_forbidden"
    location = [str(part) for part in detail["loc"]]
    shown, models = _walk(model, location[:-1] if unknown else location)
    if unknown:
        valid = [name for candidate in models for name in _names(candidate)]
        near = difflib.get_close_matches(location[-1], valid, n=1)
        hint = f"did you mean {near[0]}?" if near else f"valid: {', '.join(sorted(set(valid)))}"
        return f"unknown key {'.'.join([*shown, location[-1]])}; {hint}"
    message, given = detail["msg"].removeprefix("Value error, "), detail.get("input")
    if detail["type"] in _NO_TABLE:
        keys = sorted({name for candidate in models for name in _names(candidate)})
        message = "must be a table" + (f" with keys such as {', '.join(keys)}" if keys else "")
    if detail["type"] in ("union_tag_invalid", "union_tag_not_found"):
        # the key that selects the alternative is wrong or missing
        context = detail["ctx"]
        key = context["discriminator"].strip("'")
        shown, given = [*shown, key], context.get("tag", {})
        message = f"must be one of {context['expected_tags']}" if given else "Field required"
    given_shown = (
        "" if isinstance(given, dict) or detail["type"] == "missing" else f" (given: {given!r})"
    )
    return f"{'.'.join(shown)}: {message}{given_shown}" if shown else message


def _walk(
    model: type[pydantic.BaseModel], location: list[str]
) -> tuple[list[str], list[type[pydantic.BaseModel]]]:
    """Follow the path that pydantic reports for an error.

    Returns
    -------
    list of str
        The keys of the path as in the file. Where a key holds one of several models, pydantic also
        includes the model that it chose; that part is left out.
    list of type
        The models that the path may lead to.
    """
    shown: list[str] = []
    current: list[type[pydantic.BaseModel]] = [model]
    for part in location:
        fields = [field for candidate in current if (field := _field(candidate, part)) is not None]
        taken = [candidate for candidate in current if part in _tags(candidate)]
        if fields:
            current = [following for field in fields for following in _models_in(field.annotation)]
        elif taken:
            current = taken
            continue
        elif _BRANCH.fullmatch(part):
            continue
        shown.append(part)
    return shown, current


def _tags(model: type[pydantic.BaseModel]) -> set[Any]:
    """Return what pydantic may call a model in a union: its name or the value of a `Literal`."""
    values = {model.__name__}
    for field in model.model_fields.values():
        if typing.get_origin(field.annotation) is typing.Literal:
            values.update(typing.get_args(field.annotation))
    return values


def _field(model: type[pydantic.BaseModel], name: str) -> Any:
    for key, field in model.model_fields.items():
        if name in (key, field.alias):
            return field
    return None


def _names(model: type[pydantic.BaseModel]) -> list[str]:
    return [field.alias or key for key, field in model.model_fields.items()]


def _models_in(annotation: Any) -> list[type[pydantic.BaseModel]]:
    if isinstance(annotation, type) and not isinstance(annotation, types.GenericAlias):
        return [annotation] if issubclass(annotation, pydantic.BaseModel) else []
    return [model for part in typing.get_args(annotation) for model in _models_in(part)]
