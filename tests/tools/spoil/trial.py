"""One case in a process of its own, and the judgement on how it ended.

A command may end with exit code 0, and then a run that it has made passes the trace checker and the
ledger; or with 2 and one line, and then it leaves nothing behind; or with 1 and a line, where a run
is stopped by what its controllers decide. It may not end in a traceback, a defect or a signal, or
go on without getting anywhere, or take more memory than it may.
"""

from __future__ import annotations

import contextlib
import io
import mmap
import os
import resource
import shutil
import signal
import struct
import sys
import tempfile
import time
import traceback
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.tools.spoil.cases import Case, made

if TYPE_CHECKING:
    from collections.abc import Iterator

LIMIT_S = 20.0
"""Seconds of the processor that a case may take without its simulated clock going on."""
LONGEST_S = 60.0
"""Seconds of the processor after which a case that goes on is given up: long, not endless."""
MEMORY_MIB = 3072
"""Memory that a case may map beyond what the fuzzer itself has mapped."""

FINE = ("ran", "refused", "stopped", "long")


@dataclass(frozen=True)
class Verdict:
    """How a case ended.

    Attributes
    ----------
    outcome
        One of `FINE`, or `traceback`, `defect`, `endless`, `killed`, `wrong`, `litter`, `untold`.
    """

    case: Case
    outcome: str
    told: str
    seconds: float

    @property
    def fine(self) -> bool:
        """Whether nothing happened that must not."""
        return self.outcome in FINE

    def __str__(self) -> str:
        """Return a line for people."""
        return f"case {self.case.number} ({self.case.kind}) {self.outcome}: {self.told}"


def tried(number: int, whole: Path, keep: Path | None = None) -> Verdict:
    """Run a case.

    Parameters
    ----------
    whole
        Folder of `samples.prepared`.
    keep
        Folder that is to have the files of the case if it fails.
    """
    top = Path(tempfile.mkdtemp(prefix="spoil-"))
    try:
        here, temporary = top / "here", top / "tmp"
        here.mkdir()
        temporary.mkdir()
        case = made(number, whole, here)
        before = _files(top)
        verdict = _judged(case, top, before)
        if keep is not None and not verdict.fine:
            shutil.rmtree(keep / str(number), ignore_errors=True)
            shutil.copytree(here, keep / str(number))
        return verdict
    finally:
        shutil.rmtree(top, ignore_errors=True)


def _files(top: Path) -> dict[str, bytes]:
    """Return the content of every file below the working and the temporary folder."""
    paths = (path for path in top.rglob("*") if path.is_file() and path.parent != top)
    return {str(path.relative_to(top)): path.read_bytes() for path in paths}


def _judged(case: Case, top: Path, before: dict[str, bytes]) -> Verdict:
    began = time.monotonic()
    code, stopped = _in_child(case.arguments, top)
    seconds = time.monotonic() - began
    told = (top / "stderr").read_text("utf-8", "replace")
    lines = [line for line in told.splitlines() if line.strip()]
    last = lines[-1][:300] if lines else ""

    def verdict(outcome: str, what: str = last) -> Verdict:
        return Verdict(case, outcome, what, seconds)

    if stopped:
        return verdict(stopped)
    if "Traceback (most recent call last)" in told or code == CRASHED:
        return verdict("traceback", told[-1500:])
    if code is None or "internal error" in told:
        return verdict("defect")
    if code == JUDGED_WRONG:
        return verdict("wrong", told[-600:])
    after = _files(top)
    new = [name for name in after if name not in before]
    odd = [name for name in new if name.startswith("tmp/") or Path(name).name.startswith(".")]
    shown = (top / "stdout").read_text("utf-8", "replace").strip()
    if code == 2:
        # what a check finds is its result, not an error
        if not last.startswith("rmfs: ") and not (shown and case.arguments[1] == "check"):
            return verdict("untold", f"exit code 2: {told!r:.200}")
        return (
            verdict("litter", f"{last} {sorted(after)}") if after != before else verdict("refused")
        )
    if odd:
        return verdict("litter", str(odd))
    if code == 0:
        return verdict("ran")
    if code in (1, 3) and (last or shown):
        return verdict("stopped")
    return verdict("untold", f"exit code {code}: {told!r:.200}")


CRASHED = 97
JUDGED_WRONG = 98


def _in_child(arguments: list[str], top: Path) -> tuple[int | None, str]:
    """Return the exit code, and `endless`, `long` or `killed` if it was ended."""
    clock = mmap.mmap(-1, 8)
    child = os.fork()
    if child == 0:
        code = CRASHED
        try:
            os.setpgid(0, 0)
            code = _called(arguments, top, clock)
        except BaseException:
            with (top / "stderr").open("a") as file:
                traceback.print_exc(file=file)
        finally:
            os._exit(code)
    seen, since, outcome = 0.0, 0.0, ""
    while True:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            break
        used = _cpu_s(child)
        (now,) = struct.unpack("d", clock[:8])
        if now > seen:
            seen, since = now, used
        if not outcome and used > LONGEST_S:
            outcome = "long" if used - since < LIMIT_S else "endless"
        elif not outcome and used - since > LIMIT_S:
            outcome = "endless"
        if outcome:
            _end(child)
        time.sleep(0.005)
    if not outcome and os.WIFSIGNALED(status):
        outcome = "killed"
    _end(child)  # what it may have started
    return (os.WEXITSTATUS(status) if os.WIFEXITED(status) else None), outcome


def _end(child: int) -> None:
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(child, signal.SIGKILL)


def _cpu_s(process: int) -> float:
    """Return the seconds of the processor that a process has used."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / float(os.sysconf("SC_CLK_TCK"))


def _called(arguments: list[str], top: Path, clock: mmap.mmap) -> int:
    """In the child: call the command line in bounded memory, and judge what it has made."""
    os.chdir(top / "here")
    os.environ["TMPDIR"] = tempfile.tempdir = str(top / "tmp")
    mapped = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    most = mapped + (MEMORY_MIB << 20)
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    error = os.open(top / "stderr", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(error, 2)
    output = os.open(top / "stdout", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(output, 1)
    sys.stderr = io.TextIOWrapper(io.FileIO(2, "w", closefd=False), "utf-8", write_through=True)
    sys.stdout = io.TextIOWrapper(io.FileIO(1, "w", closefd=False), "utf-8", write_through=True)
    from rmfs.cli import main

    with _watched(clock) as runs:
        code = main(arguments)
    for run, ledger in runs if code == 0 else []:
        problem = _refuted(run, ledger)
        if problem:
            print(problem, file=sys.stderr)
            return JUDGED_WRONG
    return code


@contextlib.contextmanager
def _watched(clock: mmap.mmap) -> Iterator[list[tuple[Any, Any]]]:
    """Have every run of this process write its time, keep its trace, and have a ledger."""
    from rmfs.simulation import run as runs
    from tests.ledger import Ledger

    whole, made_runs = runs.simulate, []

    def simulate(*given: Any, **options: Any) -> Any:
        ledger = Ledger()

        def told(now: float, total: float) -> None:
            clock[:8] = struct.pack("d", now + 1.0)

        options["progress"] = told
        options["trace"] = True
        options["observers"] = [*options.get("observers", []), ledger]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            done = whole(*given, **options)
        made_runs.append((done, ledger))
        return done

    runs.simulate = simulate
    try:
        yield made_runs
    finally:
        runs.simulate = whole


def _refuted(run: Any, ledger: Any) -> str:
    """Return what the trace checker or the ledger has against a run; nothing if it is right."""
    report = run.check()
    if not report.ok:
        return str(report.summary())
    try:
        ledger.check()
    except AssertionError as error:
        return f"ledger: {error} {traceback.format_exc()[-500:]}"
    return ""
