"""The program of a real robot: `python -m rmfs.demonstrator.robot`.

If this folder has been copied to the robot, the command is `python -m robot`.
"""

from __future__ import annotations

import argparse
import logging
import sys
import time
from collections.abc import Callable
from pathlib import Path

import serial

from .client import Link, TcpWire
from .create2 import BaseError, Create2
from .guard import guarded
from .lines import Camera, CameraLine, VideoCamera
from .program import Program
from .tags import SerialTagReader

STEP_S = 0.05
BAUD, TAG_BAUD = 115_200, 9_600
ANSWER_S = 0.1
"""Maximum time, in s, to wait for an answer of the base."""

_log = logging.getLogger("rmfs.robot")


def main(arguments: list[str] | None = None, camera: Callable[[], Camera] | None = None) -> int:
    """Drive a robot until interrupted; stop the motors and restart the program when it dies.

    Parameters
    ----------
    arguments
        Command-line arguments.
    camera
        Function that opens the camera. Default: OpenCV opens the camera with the given number.

    Returns
    -------
    The exit code.
    """
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(message)s")
    see = camera or (lambda: VideoCamera(options.camera))
    while True:
        code = guarded(lambda alive: drive(options, see(), alive), lambda: stop(options.base))
        if code in (0, 130) or options.once:
            return max(code, 0)
        _log.error("the program has ended with exit code %d and is restarted", code)
        time.sleep(1.0)


def drive(options: argparse.Namespace, camera: Camera, alive: Callable[[], None]) -> None:
    """Run the program step by step until it fails, and call `alive` after each step."""
    host, _, port = options.server.rpartition(":")
    secret = options.secret.read_bytes().strip()
    base = Create2(serial.Serial(options.base, BAUD, timeout=ANSWER_S))
    tags = SerialTagReader(serial.Serial(options.tags, TAG_BAUD, timeout=0))
    link = Link(lambda: TcpWire(host, int(port)), secret, options.robot)
    program = Program(base, CameraLine(camera), tags, link, memory=options.memory)
    try:
        while True:
            begun = time.monotonic()
            program.step(round(begun * 1e6))
            alive()
            time.sleep(max(0.0, STEP_S - (time.monotonic() - begun)))
    except BaseError as error:
        _log.error("%s", error)
        raise


def stop(base: str) -> None:
    """Stop the motors, whatever the state of the base; log an error if its port fails."""
    try:
        with serial.Serial(base, BAUD, timeout=ANSWER_S) as port:
            create = Create2(port)
            create.start()
            create.stop()
            port.flush()
    except serial.SerialException as error:
        _log.error("the motors cannot be stopped: %s", error)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("robot", description=__doc__)
    parser.add_argument("--server", required=True, metavar="HOST:PORT")
    parser.add_argument("--robot", required=True, metavar="NAME", help="for example robot-0")
    parser.add_argument("--secret", required=True, type=Path, metavar="FILE")
    parser.add_argument("--base", required=True, metavar="DEVICE", help="serial port of the base")
    parser.add_argument("--tags", required=True, metavar="DEVICE", help="port of the tag reader")
    parser.add_argument("--camera", type=int, default=0, metavar="NUMBER")
    parser.add_argument("--memory", type=Path, default=Path("robot.json"), metavar="FILE")
    parser.add_argument("--once", action="store_true", help="do not restart the program")
    return parser


if __name__ == "__main__":
    sys.exit(main())
