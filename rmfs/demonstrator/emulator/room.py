"""The emulated room: its floor, its robots and its clock."""

from __future__ import annotations

import logging
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rmfs.demonstrator.emulator.base import EmulatedBase
from rmfs.demonstrator.emulator.floor import Floor
from rmfs.demonstrator.emulator.pace import InStep
from rmfs.demonstrator.emulator.sensors import FloorCamera, FloorTags
from rmfs.demonstrator.emulator.truth import Truth
from rmfs.demonstrator.emulator.wire import UnkindWire
from rmfs.demonstrator.robot.client import Link, TcpWire
from rmfs.demonstrator.robot.create2 import BaseError, Create2
from rmfs.demonstrator.robot.lines import CameraLine
from rmfs.demonstrator.robot.program import Program, Settings
from rmfs.demonstrator.server.guide import TICK_US

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.demonstrator.emulator.pace import Pace
    from rmfs.demonstrator.emulator.unkind import Unkindness
    from rmfs.layout.model import Layout

_log = logging.getLogger("rmfs.emulator")
_PARTS = 2  # physics steps in a tick


@dataclass
class Address:
    """The address of the server, and the secret that the server and the robots share."""

    host: str
    port: int
    secret: bytes


class EmulatedRobot:
    """An emulated robot: its base, its sensors and its program, which is None unless running."""

    def __init__(
        self,
        name: str,
        base: EmulatedBase,
        camera: FloorCamera,
        tags: FloorTags,
        start: Callable[[EmulatedRobot], Program],
    ) -> None:
        self.name, self.base, self.camera, self.tags = name, base, camera, tags
        self._start = start
        self.wire: UnkindWire | None = None
        self.program: Program | None = None
        self.start()

    def start(self) -> None:
        """Start the robot's program, as after a boot."""
        self.program = self._start(self)

    def kill(self) -> None:
        """Kill the robot's program (its unsaved state and connection are lost); stop the wheels."""
        self.program = None
        if self.wire is not None:
            self.wire.close()
        self.base.stop()

    def step(self, now_us: int) -> None:
        """Send the delayed messages that are now due; if the program runs, let it do one step."""
        if self.wire is not None:
            self.wire.now_us = now_us
            self.wire.pump()
        if self.program is None:
            return
        try:
            self.program.step(now_us)
        except BaseError as error:
            _log.warning("%s: %s", self.name, error)
            self.kill()


class Room:
    """An emulated room: a floor, and robots that connect to the server.

    Parameters
    ----------
    layout
        The layout whose edges are the lines on the floor.
    robots
        The robots in the room: the index of each in the layout, by name.
    tags
        The tag of every waypoint.
    address
        Address of the server.
    unkindness
        Imperfections of the room.
    seed
        Seed of all random draws.
    memory
        Folder in which the robots' programs save their route orders (commands of the server to
        drive over waypoints). Default: a temporary folder.
    pace
        Timing of the room. Default: synchronised with the server.

    Attributes
    ----------
    now_us
        Present time in microseconds.
    truth
        Measurements of the true motion on the floor.
    """

    def __init__(
        self,
        layout: Layout,
        robots: dict[str, int],
        tags: Sequence[str],
        address: Address,
        unkindness: Unkindness,
        seed: int,
        memory: Path | None = None,
        pace: Pace | None = None,
    ) -> None:
        self._layout, self._tags, self._address = layout, list(tags), address
        self._unkindness = unkindness
        self._own_memory = tempfile.TemporaryDirectory() if memory is None else None
        self._memory = memory or Path(self._own_memory.name if self._own_memory else "")
        self._seeds = np.random.SeedSequence([seed, 0xF1008])
        floor, *seeds = self._seeds.spawn(1 + len(robots))
        self._floor = Floor(layout, unkindness, np.random.default_rng(floor))
        self.now_us = 0
        self.truth = Truth.of(layout)
        self._pace = pace or InStep(address)
        self.robots = {
            name: self._robot(name, index, np.random.default_rng(seed))
            for (name, index), seed in zip(robots.items(), seeds, strict=True)
        }

    def run(self, until_us: int | None = None, each: Callable[[Room], None] | None = None) -> None:
        """Run the room until the demonstration ends or the room is stopped.

        If the room is synchronised with the server, first wait until the server is available.

        Parameters
        ----------
        until_us
            Time of the room, in microseconds, at which the run ends at the latest. Default: no
            limit.
        each
            Function called once per tick, for example to cause failures.
        """
        if self.now_us == 0:
            self._pace.begin()
        while not self._pace.has_ended and (until_us is None or self.now_us < until_us):
            for robot in self.robots.values():
                robot.step(self.now_us)
            if not self._pace.tick(self):
                break
            self._roll()
            if each is not None:
                each(self)
            self.now_us += TICK_US

    def stop(self) -> None:
        """Stop the room after the present tick."""
        self._pace.has_ended = True

    def close(self) -> None:
        """Kill the robots' programs, end all connections, and remove any temporary folder."""
        for robot in self.robots.values():
            robot.kill()
        self._pace.close()
        if self._own_memory is not None:
            self._own_memory.cleanup()

    # --- what goes over the wires -------------------------------------------------------------

    def sent(self) -> dict[str, int]:
        """Return how many bytes each connected robot has sent; the keys are the robots' names."""
        wires = {name: robot.wire for name, robot in self.robots.items()}
        return {name: wire.written for name, wire in wires.items() if wire and not wire.is_closed}

    def fetch(self, sizes: dict[str, int]) -> None:
        """Wait until each robot in `sizes` has received at least the number of bytes stated there.

        The wait for a robot also ends if nothing arrives for 0.5 s or if the robot's connection is
        closed.
        """
        for name, size in sizes.items():
            wire = self.robots[name].wire if name in self.robots else None
            if wire is not None:
                wire.fetch(size, 0.5)

    # --- floor --------------------------------------------------------------------------------

    def _roll(self) -> None:
        robots = list(self.robots.values())
        bases = [robot.base for robot in robots]
        seconds = TICK_US / 1e6 / _PARTS
        for _ in range(_PARTS):
            for robot in robots:
                robot.base.roll(seconds)
                robot.tags.look()
            self.truth.look(bases, seconds)

    def _robot(self, name: str, index: int, rng: np.random.Generator) -> EmulatedRobot:
        layout, unkindness = self._layout, self._unkindness
        at = int(layout.robot_waypoint[index])
        base = EmulatedBase(
            float(layout.x_m[at]),
            float(layout.y_m[at]),
            float(layout.robot_heading_rad[index]),
            1.0 + unkindness.speed_error * rng.uniform(-1.0, 1.0),
            unkindness.slip,
            rng,
        )
        tags = FloorTags(self._tags, layout.x_m, layout.y_m, base, unkindness.missed_tags, rng)
        camera = FloorCamera(self._floor, base, rng)
        return EmulatedRobot(name, base, camera, tags, self._program(index, rng))

    def _program(self, index: int, rng: np.random.Generator) -> Callable[[EmulatedRobot], Program]:
        kind = self._layout.robot_kinds[int(self._layout.robot_kind[index])]
        settings = Settings(
            speed_m_s=kind.top_speed_m_s,
            acceleration_m_s2=kind.acceleration_m_s2,
            turn_rad_s=2 * np.pi / kind.full_turn_s,
        )

        def start(robot: EmulatedRobot) -> Program:
            def connect() -> UnkindWire:
                tcp = TcpWire(self._address.host, self._address.port)
                robot.wire = UnkindWire(tcp, self._unkindness, rng, self.now_us)
                robot.wire.await_frame()
                return robot.wire

            return Program(
                Create2(robot.base),
                CameraLine(robot.camera),
                robot.tags,
                Link(connect, self._address.secret, robot.name),
                settings,
                self._memory / f"{robot.name}.json",
            )

        return start
