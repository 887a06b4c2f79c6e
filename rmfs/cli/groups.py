"""Commands defined in other sub-packages: listed here by name, imported when they are called."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Literal

import typer
from typer.core import TyperGroup

if TYPE_CHECKING:
    from collections.abc import Callable

SUB_COMMANDS = {
    "layout": ("rmfs.layout.commands", "Generate, draw, check and import layouts."),
    "scenario": ("rmfs.scenario.commands", "List, show and check scenarios."),
    "controllers": ("rmfs.control.commands", "List, show and check sets of controllers."),
    "traffic": ("rmfs.experiments.traffic.commands", "Compare path planners without orders."),
    "decisions": ("rmfs.solvers.decisions.commands", "Solve, check and compare saved decisions."),
    "experiment": (
        "rmfs.experiments.commands",
        "Plan and run experiments; make tables and figures.",
    ),
}
"""Module and help of each command group; the module is imported when the group is called."""

COMMANDS = {
    "demonstrate": ("rmfs.demonstrator.commands", "Run a warehouse with physical robots."),
    "learn": ("rmfs.learning.commands", "Train linear rules on simulated runs."),
    "learn-network": (
        "rmfs.learning.network_commands",
        "Train rules with small neural networks on simulated runs, by PPO.",
    ),
    "emulate": (
        "rmfs.demonstrator.commands",
        "Emulate a room: its floor, and robots with imperfections such as wheel slip.",
    ),
}
"""Module and help of each single command; the module is imported when it is called."""

ELSEWHERE = {**SUB_COMMANDS, **COMMANDS}


def names_of(kind: Literal["layouts", "scenarios", "controllers"]) -> Callable[[str], list[str]]:
    """Return a function that lists the shipped names that begin with a given text.

    They are names of layouts, scenarios or sets of controllers, depending on `kind`.
    """

    def complete(incomplete: str) -> list[str]:
        from rmfs import instances

        return [name for name in instances.names(kind) if name.startswith(incomplete)]

    return complete


class LazyGroup(TyperGroup):
    """A command group that imports commands of other sub-packages only when they are called."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of all commands, loaded or not."""
        return [*super().list_commands(ctx), *(n for n in ELSEWHERE if n not in self.commands)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command; if it is not loaded yet, a stub that has only the help text."""
        if cmd_name in ELSEWHERE and cmd_name not in self.commands:
            return TyperGroup(name=cmd_name, help=ELSEWHERE[cmd_name][1])
        return super().get_command(ctx, cmd_name)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the command that is called, and load it if it is not loaded yet."""
        if args and args[0] in ELSEWHERE:
            self.add_command(_loaded(args[0]), args[0])
        return super().resolve_command(ctx, args)


def tell_defaults(command: Any) -> Any:
    """Add `[default: none]` to the help of each option without a default; return the command.

    In a help text, `[default: ...]` is escaped, because it would otherwise be read as markup and
    not be shown. Sub-commands are included.
    """
    for one in getattr(command, "commands", {}).values():
        tell_defaults(one)
    for parameter in command.params:
        told = getattr(parameter, "help", None) or ""
        is_option = parameter.param_type_name == "option" and not parameter.required
        if is_option and parameter.default is None and "[default:" not in told:
            told = f"{told} [default: none]".lstrip()
        if "[default:" in told and "\\[default:" not in told:
            parameter.help = told.replace("[default:", "\\[default:")
    return command


def _loaded(name: str) -> Any:
    """Import a command or group, wrapped in another so that it gets no options of its own."""
    module = importlib.import_module(ELSEWHERE[name][0])
    above = typer.Typer(add_completion=False)
    above.add_typer(module.app, name=name if name in SUB_COMMANDS else None)
    return tell_defaults(typer.main.get_group(above).commands[name])
