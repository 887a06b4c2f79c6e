"""The fields of file formats as tables, from the models that read the files."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

from rmfs.layout.drawn.parameters import Equipment, MapStations, PictureHead
from rmfs.layout.drawn.picture_file import SIGNS
from rmfs.layout.explicit.schema import ExplicitLayout
from rmfs.layout.parameters import LayoutParameters

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    import pydantic

WORDS = {
    "integer": "whole number",
    "number": "number",
    "string": "text",
    "boolean": "true or false",
    "object": "table",
}
BOUNDS = (
    ("exclusiveMinimum", "> {}"),
    ("minimum", "≥ {}"),
    ("exclusiveMaximum", "< {}"),
    ("maximum", "≤ {}"),
    ("multipleOf", "multiple of {}"),
)


def sections() -> dict[str, str]:
    """Return the generated parts of the page on file formats, by name."""
    signs = ["| sign | cell |", "|---|---|", *(f"| `{s}` | {told} |" for s, told in SIGNS.items())]
    return {
        "layout parameters": fields(LayoutParameters),
        "signs": "\n".join(signs),
        "head of a picture": fields(PictureHead),
        "stations of a map": fields(MapStations, known=Equipment.model_fields),
        "explicit layout": fields(ExplicitLayout),
    }


def fields(model: type[pydantic.BaseModel], known: Collection[str] = ()) -> str:
    """Return the keys of a file as a table, and below it those of the tables in it.

    Parameters
    ----------
    known
        Keys that are left out, as they are described elsewhere.
    """
    schema = model.model_json_schema()
    keys = [key for key in schema["properties"] if key not in known]
    keys.sort(key=lambda key: key != "format")
    schema["properties"] = {key: schema["properties"][key] for key in keys}
    parts = ["\n".join(_table(schema))]
    for name, part in _parts(schema, schema.get("$defs", {}), ""):
        parts.append(f"`{name}`: {_lowered(part['description'])}\n\n" + "\n".join(_table(part)))
    return "\n\n".join(parts)


def _table(schema: dict[str, Any]) -> Iterator[str]:
    yield "| key | value | default | meaning |"
    yield "|---|---|---|---|"
    needed = schema.get("required", [])
    for key, field in schema["properties"].items():
        default = "required" if key in needed else _default(field)
        meaning = field.get("description", "").replace("|", "\\|")
        yield f"| `{key}` | {_value(field)} | {default} | {meaning} |"


def _default(field: dict[str, Any]) -> str:
    given = field.get("default")
    if given is None or given in ({}, []) or isinstance(given, dict):
        return "" if not given else f"`{json.dumps({k: v for k, v in given.items() if v})}`"
    return f"`{json.dumps(given)}`"


def _value(field: dict[str, Any]) -> str:
    """Say in words what a key may hold."""
    if "const" in field:
        return f"`{json.dumps(field['const'])}`"
    if "enum" in field:
        return " or ".join(f"`{json.dumps(one)}`" for one in field["enum"])
    if "anyOf" in field:
        return _value(next(one for one in field["anyOf"] if one.get("type") != "null"))
    if "$ref" in field:
        return "table"
    if field["type"] == "array":
        least = f" (length ≥ {field['minItems']})" if field.get("minItems") else ""
        if least and field["minItems"] == field.get("maxItems"):
            least = f" (length {field['minItems']})"
        item = _value(field["items"])
        many = re.sub(r"^(whole number|table|list|number)", r"\1s", item)
        return f"list{least} of {many}"
    further = field.get("additionalProperties")
    if field["type"] == "object" and isinstance(further, dict):
        return "table of tables"
    bounds = [text.format(f"{field[key]:g}") for key, text in BOUNDS if key in field]
    return " ".join([WORDS[field["type"]], ", ".join(bounds)]).rstrip()


def _parts(
    schema: dict[str, Any], known: dict[str, Any], before: str
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the tables in a table, each with the keys that lead to it."""
    for key, field in schema["properties"].items():
        name = f"{before}{key}"
        item = field
        while "$ref" not in item:
            if item.get("type") == "array":
                item, name = item["items"], f"{name}[]"
            elif isinstance(item.get("additionalProperties"), dict):
                item, name = item["additionalProperties"], f"{name}.NAME"
            else:
                break
        if "$ref" in item:
            part = known[item["$ref"].rpartition("/")[2]]
            yield name, part
            yield from _parts(part, known, f"{name}.")


def _lowered(text: str) -> str:
    """Let a description go on a sentence."""
    return " ".join(f"{text[0].lower()}{text[1:]}".split())
