"""Imports needed by runs, loaded once by the server from which worker processes are forked."""

from contextlib import suppress
from importlib import import_module

from rmfs.control import registry
from rmfs.control.problems import Problem

# pandas imports it at the first table
import_module("pyarrow.pandas_compat")
import_module("rmfs.experiments.running.execute")

for problem in Problem:
    # a rule that cannot be imported fails in the run that uses it, and says why there
    with suppress(Exception):
        for name in registry.names(problem):
            registry.find(problem, name)
