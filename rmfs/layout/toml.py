"""Writes layout parameters as a self-explanatory TOML file."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pydantic

if TYPE_CHECKING:
    from rmfs.layout.parameters import LayoutParameters


def to_toml(parameters: LayoutParameters) -> str:
    """Return the text of a layout file; comments explain the parameters and their units."""
    plain, tables = [], []
    for key, field in type(parameters).model_fields.items():
        value = getattr(parameters, key)
        comment = f"  # {field.description}" if field.description else ""
        if isinstance(value, dict):
            tables += [f"[{key}.{name}]\n{_entries(entry)}" for name, entry in value.items()]
        elif isinstance(value, pydantic.BaseModel):
            tables.append(f"[{key}]{comment}\n{_entries(value)}")
        else:
            plain.append(f"{key} = {_value(value)}{comment}")
    return "\n\n".join(["\n".join(plain), *tables]) + "\n"


def _entries(value: pydantic.BaseModel) -> str:
    return "\n".join(f"{name} = {_value(entry)}" for name, entry in value)


def _value(value: Any) -> str:
    """Return a TOML value; JSON notation is valid for strings, numbers and booleans."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_value(entry)}" for key, entry in value.items()) + "}"
    return json.dumps(value, ensure_ascii=False)
