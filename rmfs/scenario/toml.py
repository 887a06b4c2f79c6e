"""Writes a configuration as TOML, with descriptions as comments."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pydantic

if TYPE_CHECKING:
    from collections.abc import Iterator


def to_toml(model: pydantic.BaseModel) -> str:
    """Return a configuration as TOML text.

    The text contains all parameters, including those with default values, except parameters that
    are None. Reading the text gives an equal configuration.
    """
    return "\n".join(_table(model, [])).lstrip("\n") + "\n"


def _table(model: pydantic.BaseModel, path: list[str]) -> Iterator[str]:
    """Yield the lines of a table: first its own values, then the tables in it."""
    tables: list[tuple[str, pydantic.BaseModel, str | None]] = []
    for name, field in type(model).model_fields.items():
        value = getattr(model, name)
        if isinstance(value, pydantic.BaseModel):
            tables.append((name, value, field.description))
        elif value is not None:
            yield _with_comment(f"{name} = {toml_value(value)}", field.description)
    for name, table, description in tables:
        yield ""
        yield _with_comment(f"[{'.'.join([*path, name])}]", description)
        yield from _table(table, [*path, name])


def _with_comment(line: str, comment: str | None) -> str:
    return f"{line:<32}  # {comment}" if comment else line


def toml_value(given: Any) -> str:
    """Return a value as TOML text.

    Raises
    ------
    TypeError
        If TOML cannot represent the value.
    """
    if isinstance(given, bool):
        return str(given).lower()
    if isinstance(given, (int, float)):
        return repr(given)
    if isinstance(given, (str, Path)):
        # a JSON string is a TOML string, but for a character that JSON leaves as it is
        return json.dumps(str(given), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(given, (tuple, list)):
        return f"[{', '.join(map(toml_value, given))}]"
    if isinstance(given, dict):
        pairs = (f"{toml_value(str(key))} = {toml_value(item)}" for key, item in given.items())
        return f"{{ {', '.join(pairs)} }}"
    raise TypeError(f"no TOML value: {given!r}")
