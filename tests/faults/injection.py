"""Commands in processes whose n-th change of a file fails; see `shim.c`.

    python injection.py FILE BELOW < requests > answers

reads a line of JSON for each call: number and kind of the fault, working folder and arguments. It
imports everything once and forks for each, so that a fault costs no start.
"""

from __future__ import annotations

import errno
import json
import mmap
import os
import struct
import subprocess
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
KINDS = {
    "none": (0, errno.ENOSPC),
    "fails": (1, errno.EIO),
    "disk full": (2, errno.ENOSPC),
    "killed": (3, errno.ENOSPC),
    "read-only": (2, errno.EROFS),
}
"""What the shim is told of each kind of fault: what to do from its call on, with which error."""

KILLED = -9


@dataclass(frozen=True)
class Ended:
    """How a command ended: its exit code (-9: killed), its words, and how many changes it made."""

    code: int
    words: str
    calls: int


def built(folder: Path) -> Path | None:
    """Build the shim; None where no C compiler is."""
    target = folder / "shim.so"
    command = ["cc", "-O1", "-shared", "-fPIC", "-o", str(target), str(HERE / "shim.c"), "-ldl"]
    try:
        done = subprocess.run(command, capture_output=True, check=False)
    except FileNotFoundError:
        return None
    return target if done.returncode == 0 else None


class Injector:
    """A process with the shim that calls what it is told to, fork by fork.

    Parameters
    ----------
    below
        Changes of files below this folder count.
    what
        Module and function that are called with the arguments, `rmfs.cli:main` or others.
    """

    def __init__(self, shim: Path, below: Path, what: str) -> None:
        self.page = below.parent / "faults"
        self.page.write_bytes(bytes(32))
        environment = {
            **os.environ,
            "LD_PRELOAD": str(shim),
            "RMFS_FAULTS": str(self.page),
            "RMFS_FAULTS_BELOW": f"{below}/",
            "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests/experiments"), str(HERE)]),
        }
        self.process = subprocess.Popen(
            [sys.executable, str(HERE / "injection.py"), str(self.page), what],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment,
            text=True,
        )

    def call(
        self, arguments: list[str], folder: Path, kind: str = "none", number: int = 0
    ) -> Ended:
        """Call once, with a fault; with kind `none` and number 0 only count the changes."""
        request = {"arguments": arguments, "folder": str(folder), "kind": kind, "number": number}
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        return Ended(**json.loads(self.process.stdout.readline()))

    def close(self) -> None:
        """End the process."""
        self.process.stdin.close()
        self.process.wait(timeout=60)


def served(page: Path, what: Callable[[list[str]], int]) -> None:
    """Fork for each request, and answer how it ended."""
    with page.open("r+b") as file:
        state = mmap.mmap(file.fileno(), 32)
    words = page.with_suffix(".words")
    for line in sys.stdin:
        asked = json.loads(line)
        # what never comes true counts only
        number = asked["number"] or 2**62
        kind, error = KINDS[asked["kind"]]
        child = os.fork()
        if child == 0:
            code = 70
            try:
                stream = os.open(words, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
                os.dup2(stream, 2)
                os.dup2(stream, 1)
                sys.stdout = sys.stderr = os.fdopen(2, "w", buffering=1, closefd=False)
                os.chdir(asked["folder"])
                state[:] = struct.pack("4q", 0, number, kind or 1, error)
                code = what(asked["arguments"])
            except BaseException:
                traceback.print_exc()
            finally:
                os._exit(code)
        _, status = os.waitpid(child, 0)
        (calls,) = struct.unpack("q", state[:8])
        state[16:24] = struct.pack("q", 0)
        code = os.waitstatus_to_exitcode(status)
        told = {"code": code, "words": words.read_text("utf-8", "replace"), "calls": calls}
        print(json.dumps(told), flush=True)


def main() -> None:
    """Import what is called, and serve."""
    import importlib

    import rmfs.experiments.commands
    import rmfs.simulation.run  # noqa: F401

    module, _, name = sys.argv[2].partition(":")
    served(Path(sys.argv[1]), getattr(importlib.import_module(module), name))


if __name__ == "__main__":
    main()
