"""The data of the form that starts a run, derived from the declared parameters.

A parameter is declared once, in the Pydantic model of a layout, scenario or controller; its name,
meaning, bounds and default are sent to the page as JSON Schema.
"""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import pydantic_core

from rmfs import control, instances, scenario
from rmfs.control import registry
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.layout.overrides import ExplicitOverrides
from rmfs.layout.parameters import LayoutParameters
from rmfs.measure.provenance import layout_parameters
from rmfs.scenario import Scenario

if TYPE_CHECKING:
    import pydantic

PARTS: dict[str, instances.Kind] = {
    "layout": "layouts",
    "scenario": "scenarios",
    "controllers": "controllers",
}


def names() -> dict[str, list[str]]:
    """Return the names of the shipped files of each part: `layout`, `scenario`, `controllers`."""
    return {part: instances.names(kind) for part, kind in PARTS.items()}


def shipped(part: str, name: str) -> str:
    """Return `name` if a file of this name is shipped; pages cannot use other files.

    Raises
    ------
    InputError
        If no file of this name is shipped.
    """
    known = instances.names(PARTS[part])
    if name not in known:
        raise InputError(f"{part} {name}: must be one of {', '.join(known)}")
    return name


def form(chosen: dict[str, str]) -> dict[str, Any]:
    """Return the contents of the form for the chosen layout, scenario and controllers.

    Parameters
    ----------
    chosen
        Names of the chosen layout, scenario and controllers. Default of each: `default`.

    Returns
    -------
    dict
        `names` holds the possible choices, and `chosen` the current ones. `layout` and `scenario`
        each hold the `schema` and the `values` of their parameters. `controllers` holds
        `problems`, the decision problems with all their controllers, and `values`, the chosen
        controller of each problem with its parameters.

    Raises
    ------
    InputError
        If a name is unknown.
    """
    picked = {part: shipped(part, chosen.get(part, "default")) for part in PARTS}
    parameters = layout_parameters(picked["layout"], [])
    work = scenario.load(picked["scenario"])
    return {
        "names": names(),
        "chosen": picked,
        "layout": {
            # an explicit layout has no parameters but those that may be overridden
            "schema": _schema(ExplicitOverrides if parameters is None else LayoutParameters),
            "values": parameters or {},
        },
        "scenario": {"schema": _schema(Scenario), "values": work.model_dump(mode="json")},
        "controllers": {
            "problems": problems(),
            "values": {
                str(problem): choice.to_table()
                for problem, choice in control.load(picked["controllers"]).choices.items()
            },
        },
    }


def problems() -> dict[str, Any]:
    """Return every decision problem with the descriptions and parameters of its controllers."""
    return {
        str(problem): {
            "meaning": problem.meaning,
            "rules": {name: _rule(problem, name) for name in registry.names(problem)},
        }
        for problem in Problem
    }


def _rule(problem: Problem, name: str) -> dict[str, Any]:
    rule = registry.find(problem, name)
    about = (inspect.getdoc(rule) or "").partition("\n")[0]
    return {"about": about, "schema": _schema(rule.parameters_model)}


def _schema(model: type[pydantic.BaseModel]) -> dict[str, Any]:
    schema: dict[str, Any] = pydantic_core.to_jsonable_python(model.model_json_schema())
    return schema
