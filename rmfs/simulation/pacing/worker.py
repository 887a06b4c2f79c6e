"""A worker process: answers questions one after another until its connection is closed.

It is started as a new Python interpreter, without forking and without importing the user's script
again. A script therefore needs no `if __name__ == "__main__"`, and workers also start from a
notebook.
"""

from __future__ import annotations

import importlib
import os
import pickle
import signal
import struct
import sys
import threading
import time
from multiprocessing.connection import Connection
from typing import Any

from rmfs.control.asks import checked

STAMP = struct.Struct("d")
"""Prefix of each reply: the time in s when it was ready, on the clock that all processes share."""

READY = -1
"""Number of the first reply, which means that the modules are imported."""


def main(handle: int, modules: list[str]) -> None:
    """Import the modules, then answer questions until the connection is closed.

    Parameters
    ----------
    handle
        File descriptor of the connection.
    modules
        Modules to import first.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_leave_with, args=(os.getppid(),), daemon=True).start()
    connection = Connection(handle)
    try:
        for module in modules:
            importlib.import_module(module)
    except Exception as error:
        _reply(connection, READY, None, _told(error))
        return
    _reply(connection, READY, None, "")
    while True:
        try:
            message = connection.recv_bytes()
        except EOFError:
            return
        _reply(connection, *_solved(message))


def _solved(message: bytes) -> tuple[int, Any, str]:
    number, load = pickle.loads(message)
    try:
        solve, question = pickle.loads(load)
        return number, checked(solve(question)), ""
    except Exception as error:
        return number, None, _told(error)


def _told(error: Exception) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def _reply(connection: Connection, number: int, answer: Any, failure: str) -> None:
    try:
        load = pickle.dumps((number, answer, failure))
    except Exception as error:
        load = pickle.dumps((number, None, _told(error)))
    try:
        connection.send_bytes(STAMP.pack(time.monotonic()) + load)
    except OSError:
        sys.exit()


def _leave_with(parent: int) -> None:
    """End this process, whatever it is doing, when the one that started it is gone."""
    while os.getppid() == parent:
        time.sleep(1.0)
    os._exit(1)
