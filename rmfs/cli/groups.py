"""Commands of other packages: known by name, imported when they are called."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Literal

import typer
from typer.core import TyperGroup

if TYPE_CHECKING:
    from collections.abc import Callable

SUB_COMMANDS = {
    "layout": ("rmfs.layout.commands", "Make, draw, check and import layouts."),
    "scenario": ("rmfs.scenario.commands", "List, show and check scenarios."),
    "controllers": ("rmfs.control.commands", "List, show and check sets of controllers."),
    "traffic": ("rmfs.experiments.traffic.commands", "Path planners alone: trips, duels, growth."),
    "decisions": ("rmfs.solvers.decisions.commands", "Decisions as files: solve, check, compare."),
    "experiment": ("rmfs.experiments.commands", "Plan and run experiments; tables and figures."),
}
"""Module and help of each group of commands; its module is imported when it is called."""

COMMANDS = {
    "demonstrate": ("rmfs.demonstrator.commands", "Run a warehouse with real robots."),
    "learn": ("rmfs.learning.commands", "Train linear rules on simulated runs."),
    "emulate": ("rmfs.demonstrator.commands", "Emulate a room with robots like real ones."),
}
"""The same of commands that are no groups."""

ELSEWHERE = {**SUB_COMMANDS, **COMMANDS}


def names_of(kind: Literal["layouts", "scenarios", "controllers"]) -> Callable[[str], list[str]]:
    """Return what completes the name of a shipped instance."""

    def complete(incomplete: str) -> list[str]:
        from rmfs import instances

        return [name for name in instances.names(kind) if name.startswith(incomplete)]

    return complete


class LazyGroup(TyperGroup):
    """A group that knows its sub-commands by name and loads one when it is called."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Name all commands, loaded or not."""
        return [*super().list_commands(ctx), *(n for n in ELSEWHERE if n not in self.commands)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command, or what help needs to know of it if it is not loaded."""
        if cmd_name in ELSEWHERE and cmd_name not in self.commands:
            return TyperGroup(name=cmd_name, help=ELSEWHERE[cmd_name][1])
        return super().get_command(ctx, cmd_name)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Load the command that is called."""
        if args and args[0] in ELSEWHERE:
            self.add_command(_loaded(args[0]), args[0])
        return super().resolve_command(ctx, args)


def tell_defaults(command: Any) -> Any:
    """Let the help of every option say its default, also where that is none."""
    for one in getattr(command, "commands", {}).values():
        tell_defaults(one)
    for parameter in command.params:
        told = getattr(parameter, "help", None) or ""
        is_option = parameter.param_type_name == "option" and not parameter.required
        if is_option and parameter.default is None and "[default:" not in told:
            parameter.help = f"{told} [default: none]".lstrip()
    return command


def _loaded(name: str) -> Any:
    """Import a command or group; it is put below another so that it gets no options of its own."""
    module = importlib.import_module(ELSEWHERE[name][0])
    above = typer.Typer(add_completion=False)
    above.add_typer(module.app, name=name if name in SUB_COMMANDS else None)
    return tell_defaults(typer.main.get_group(above).commands[name])
