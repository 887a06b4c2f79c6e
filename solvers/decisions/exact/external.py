"""External solvers as commands, which read a mathematical program and write a solution file.

No external solver is required. A solver is specified by its name, if its command is on the search
path (`PATH`), or by a command with the placeholders `{program}`, `{solution}` and `{seconds}`. The
command is split into words as in a shell, but run without a shell. A solution counts only if
the package `checking` accepts it.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import highspy  # type: ignore[import-untyped]

from rmfs.errors import InputError
from rmfs.solvers.decisions.exact.formulation import exact
from rmfs.solvers.decisions.exact.reading import answer_of
from rmfs.solvers.decisions.exact.writing import write_program
from rmfs.solvers.decisions.files import Found

if TYPE_CHECKING:
    from rmfs.solvers.decisions.files import Decision

HIGHS = "highs"
"""HiGHS as installed with rmfs, on one thread, otherwise with its default settings."""

COMMANDS = {
    "scip": 'scip -q -c "read {program}" -c "set limits time {seconds}" -c optimize '
    '-c "write solution {solution}" -c quit',
    "gurobi": "gurobi_cl Threads=1 TimeLimit={seconds} ResultFile={solution} {program}",
    "cplex": 'cplex -c "read {program}" "set threads 1" "set timelimit {seconds}" optimize '
    '"write {solution}"',
    "cbc": "cbc {program} seconds {seconds} solve solution {solution}",
}
"""Command of each known solver, according to its manual."""

_GRACE_S = 30.0
"""Seconds after its time limit at which a command is stopped: some solvers do not count the time in
which they read the program."""


def available() -> tuple[str, ...]:
    """Return the names of the solvers that can be called on this machine."""
    there = (name for name, command in COMMANDS.items() if shutil.which(command.split()[0]))
    return HIGHS, *there


def solve_externally(decision: Decision, solver: str, seconds: float, where: str = "") -> Found:
    """Solve the exact program of a question with an external solver.

    Parameters
    ----------
    decision
        The question to be solved.
    solver
        `highs`, a name in `COMMANDS`, or a command.
    seconds
        Time limit, in s of wall time.
    where
        Name of the question in error messages, such as the path of its file. Default:
        `decision.name`.

    Returns
    -------
    The answer, without a bound, as solution files contain none. Its attribute `by` states the wall
    time for building and writing the program (`build_s`), and the total wall time (`wall_s`), in s.

    Raises
    ------
    InputError
        If the solver is not available, fails, or writes no feasible solution.
    """
    name = where or decision.name
    command = COMMANDS.get(solver, solver)
    if solver != HIGHS:
        _require_command(solver, command)
    began = perf_counter()
    stated = exact(decision, name)
    with tempfile.TemporaryDirectory(prefix="rmfs-") as folder:
        program, solution = Path(folder) / "question.mps", Path(folder) / "answer.sol"
        write_program(stated, program)
        built_s = perf_counter() - began
        if solver == HIGHS:
            _highs(program, solution, seconds)
        else:
            _run(solver, command, program, solution, seconds)
        if not solution.exists():
            raise InputError(f"{name}: {solver} wrote no solution")
        by: dict[str, object] = {
            "method": f"mps:{solver}",
            "backend": solver.split()[0],
            "status": "feasible",
            "seconds": seconds,
            "build_s": built_s,
            "wall_s": perf_counter() - began,
        }
        by["total_s"] = by["wall_s"]
        try:
            return answer_of(decision, stated, solution, by)
        except InputError as error:
            told = str(error).removeprefix(f"{solution}: ")
            raise InputError(f"{name}: {solver}: {told}") from None


def _require_command(solver: str, command: str) -> None:
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise InputError(f"solver {solver!r}: {error}") from None
    is_command = all(f"{{{part}}}" in command for part in ("program", "solution"))
    if not is_command:
        known = ", ".join((HIGHS, *COMMANDS))
        raise InputError(
            f"solver {solver!r}: must be one of {known}, or a command with {{program}}, "
            "{solution} and {seconds}"
        )
    if shutil.which(words[0]) is None:
        raise InputError(f"solver {solver!r}: the program {words[0]} was not found")


def _run(solver: str, command: str, program: Path, solution: Path, seconds: float) -> None:
    given = {"program": program, "solution": solution, "seconds": f"{seconds:g}"}
    words = [_absolute(word.format(**given)) for word in shlex.split(command)]
    try:
        done = subprocess.run(
            words,
            cwd=program.parent,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=seconds + _GRACE_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return  # it may have left a solution
    except OSError as error:
        raise InputError(f"{solver}: cannot be run ({error.strerror})") from None
    if done.returncode and not solution.exists():
        last = (done.stderr or done.stdout).strip().splitlines()[-1:] or ["no message"]
        raise InputError(f"{solver}: ended with code {done.returncode} ({last[0]})")


def _absolute(word: str) -> str:
    """Return the absolute path of a file in the working folder, because the solver runs in another.

    The name of a program without a folder is left to the search path.
    """
    if os.sep not in word and shutil.which(word) is not None:
        return word
    path = Path(word)
    return str(path.absolute()) if path.is_file() else word


def _highs(program: Path, solution: Path, seconds: float) -> None:
    solver = highspy.Highs()
    for option, value in (("output_flag", False), ("threads", 1), ("time_limit", seconds)):
        solver.setOptionValue(option, value)
    solver.readModel(str(program))
    solver.run()
    if solver.getInfo().primal_solution_status == highspy.SolutionStatus.kSolutionStatusFeasible:
        solver.writeSolution(str(solution), 0)
