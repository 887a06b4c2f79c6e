"""Configuration: TOML files read into frozen pydantic models, with errors a user can act on."""

from __future__ import annotations

import difflib
import tomllib
import types
import typing
from pathlib import Path
from typing import Any, TypeVar

import pydantic

from rmfs.errors import InputError


class Model(pydantic.BaseModel):
    """Base of every configuration block: unknown keys are errors, values cannot change."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, validate_default=True)


M = TypeVar("M", bound=pydantic.BaseModel)
Table = dict[str, Any]


def read_toml(path: Path) -> Table:
    """Read a TOML file.

    Raises
    ------
    InputError
        If the file is missing, unreadable or not TOML.
    """
    try:
        with path.open("rb") as file:
            return tomllib.load(file)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: not valid TOML: {error}") from None


def parse_override(text: str) -> tuple[list[str], Any]:
    """Split one `--set a.b=value`; the value is TOML, and a bare word is a string.

    Raises
    ------
    InputError
        If there is no `=` or no key.
    """
    key, separator, value = text.partition("=")
    if not separator or not key.strip():
        raise InputError(f"--set {text}: expected KEY=VALUE, for example layout.robots=16")
    try:
        parsed = tomllib.loads(f"value = {value.strip()}")["value"]
    except tomllib.TOMLDecodeError:
        parsed = value.strip()
    return key.strip().split("."), parsed


def apply_overrides(table: Table, overrides: list[tuple[list[str], Any]]) -> Table:
    """Return a copy of `table` with each (path, value) set; tables on the way are created."""
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
    """Turn a table into a model.

    Parameters
    ----------
    source
        Name of the file the table came from, for messages.

    Raises
    ------
    InputError
        One line that lists every problem with its key; an unknown key comes with the nearest
        valid one.
    """
    try:
        return model.model_validate(table)
    except pydantic.ValidationError as error:
        problems = [_explain(model, detail) for detail in error.errors()]
        raise InputError(f"{source}: {'; '.join(dict.fromkeys(problems))}") from None


def _copied(table: Table) -> Table:
    return {k: _copied(v) if isinstance(v, dict) else v for k, v in table.items()}


def _explain(model: type[pydantic.BaseModel], detail: Any) -> str:
    location = [str(part) for part in detail["loc"]]
    key = ".".join(location)
    if detail["type"] == "extra_forbidden":
        valid = _fields_at(model, location[:-1])
        near = difflib.get_close_matches(location[-1], valid, n=1)
        hint = f"did you mean {near[0]}?" if near else f"valid: {', '.join(sorted(valid))}"
        return f"unknown key {key}; {hint}"
    message = detail["msg"].removeprefix("Value error, ")
    given = detail.get("input")
    shown = "" if isinstance(given, dict) or detail["type"] == "missing" else f" (given: {given!r})"
    return f"{key}: {message}{shown}" if key else message


def _fields_at(model: type[pydantic.BaseModel], path: list[str]) -> list[str]:
    """Names of the fields of the nested model that `path` leads to."""
    current: list[type[pydantic.BaseModel]] = [model]
    for part in path:
        following: list[type[pydantic.BaseModel]] = []
        for candidate in current:
            field = _field(candidate, part)
            if field is not None:
                following.extend(_models_in(field.annotation))
        # a discriminator value or list index appears in the path without being a field
        current = following or current
    return [name for candidate in current for name in _names(candidate)]


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
