"""A set of rules to be installed together, as written in a controllers file."""

from __future__ import annotations

from typing import Any

import pydantic

from rmfs.control.base import RuleTables
from rmfs.control.choices import Choice, choose
from rmfs.control.problems import Problem


class Rules(RuleTables):
    """Rules for some problems, each given as a table of a controllers file or by its name alone."""

    @pydantic.field_validator(*(problem.value for problem in Problem), mode="before")
    @classmethod
    def _in_full(cls, value: Any, info: pydantic.ValidationInfo) -> Any:
        """Validate a table and write out all its parameters."""
        if isinstance(value, str):
            value = {"name": value}
        if not isinstance(value, dict):
            return value
        return choose(Problem(info.field_name or ""), value, "exchange").to_table()

    @pydantic.model_validator(mode="after")
    def _at_least_one(self) -> Rules:
        if not self.choices():
            raise ValueError(
                f"must name a rule for at least one problem; valid: {', '.join(Problem)}"
            )
        return self

    def choices(self) -> list[Choice]:
        """Return the rules with their parameters, in the order of `Problem`."""
        return [
            choose(problem, table, "exchange")
            for problem in Problem
            if (table := getattr(self, problem)) is not None
        ]
