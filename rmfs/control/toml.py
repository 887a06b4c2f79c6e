"""Writes a set of controllers as TOML, with parameter descriptions as comments."""

from __future__ import annotations

import json
from math import isinf
from typing import TYPE_CHECKING, Any

from rmfs.control.settings import FORMAT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.choices import Choice
    from rmfs.control.settings import ControllerSettings


def to_toml(settings: ControllerSettings) -> str:
    """Return a set of controllers as TOML text, including default values of parameters.

    Reading the text gives an equal set.
    """
    head = [f'format = "{FORMAT}"', f"name = {_value(settings.name)}"]
    if settings.description:
        head.append(f"description = {_value(settings.description)}")
    tables = (line for choice in settings.choices.values() for line in _table(choice))
    return "\n".join([*head, *tables]) + "\n"


def _table(choice: Choice) -> Iterator[str]:
    yield ""
    yield f"[{choice.problem}]  # {choice.problem.meaning}"
    yield f"name = {_value(choice.name)}"
    fields = type(choice.parameters).model_fields
    for name, value in choice.parameters.model_dump(mode="json", exclude_none=True).items():
        description = fields[name].description
        line = f"{name} = {_value(value)}"
        yield f"{line}  # {' '.join(description.split())}" if description else line


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    if isinstance(value, float) and isinf(value):
        return str(value)
    # a JSON value is a TOML value, but for a character that JSON leaves as it is
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
