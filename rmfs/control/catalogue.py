"""The catalogue of controllers, written from the code: `python -m rmfs.control.catalogue`."""

from __future__ import annotations

import inspect
import json
import sys
from typing import TYPE_CHECKING, Any

import pydantic_core

from rmfs.control import registry
from rmfs.control.problems import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from pydantic.fields import FieldInfo

    from rmfs.control.base import Controller

HEAD = """\
# Controllers

Every controller there is, by decision problem: rules first, then those that ask an
[optimiser](optimisers-in-the-loop.md). `name` in a controllers file chooses one, the parameters
stand beside the name. Written from the code by `python -m rmfs.control.catalogue`; a test keeps
this page up to date. [How to write a controller](write-a-controller.md).
"""


def markdown() -> str:
    """Write the page: a section per problem, controllers with descriptions and parameters."""
    parts = [HEAD]
    for problem in Problem:
        parts.append(f"## {problem.upper()}: {problem.meaning}\n")
        shipped = [*registry.built_in(problem), *registry.solver_backed(problem)]
        parts += [_entry(problem, name) for name in shipped]
    return "\n".join(parts)


def _entry(problem: Problem, name: str) -> str:
    controller = registry.find(problem, name)
    lines = [f"### `{name}`", "", inspect.getdoc(controller) or "", ""]
    rows = list(_parameters(controller))
    if rows:
        lines += ["| parameter | default | |", "|---|---|---|", *rows, ""]
    if controller.decides:
        others = ", ".join(f"`{problem}`" for problem in sorted(controller.decides))
        lines += [f"Decides for {others} as well, where `dummy` stands.", ""]
    asks = " It asks an optimiser." if controller.optimisers else ""
    lines += [f"Source: `{controller.__module__}`.{asks}", ""]
    return "\n".join(lines)


def _parameters(controller: type[Controller[Any]]) -> Iterator[str]:
    for name, field in controller.parameters_model.model_fields.items():
        meaning = " ".join((field.description or "").split())
        yield f"| `{name}` | {_default(field)} | {meaning} |"


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    value = pydantic_core.to_jsonable_python(field.get_default(call_default_factory=True))
    return f"`{json.dumps(value, ensure_ascii=False)}`"


if __name__ == "__main__":
    sys.stdout.write(markdown())
