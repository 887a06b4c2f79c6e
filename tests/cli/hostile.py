"""Runs commands in bounded memory: `python hostile.py MIB < commands.json > answers.json`."""

import contextlib
import io
import json
import resource
import sys
from pathlib import Path


def answers(mib: int, commands: list[list[str]]) -> list[tuple[int, str]]:
    """Return exit code and error stream of each command.

    Everything is imported first, so that what is bounded is what reading takes.
    """
    from rmfs import simulation  # noqa: F401
    from rmfs.cli import main
    from rmfs.layout import commands as layouts  # noqa: F401
    from rmfs.rawsimo import folder  # noqa: F401
    from rmfs.rawsimo.layout import xinst, xlayo  # noqa: F401
    from rmfs.scenario import commands as scenarios  # noqa: F401

    mapped = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    limit = mapped + (mib << 20)
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    told = []
    for command in commands:
        stream = io.StringIO()
        with contextlib.redirect_stderr(stream), contextlib.redirect_stdout(io.StringIO()):
            code = main(command)
        told.append((code, stream.getvalue()))
    return told


if __name__ == "__main__":
    json.dump(answers(int(sys.argv[1]), json.load(sys.stdin)), sys.stdout)
