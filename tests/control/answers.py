"""Prepared answers to what TA asks the other controllers, and decisions applied to the world."""

from __future__ import annotations

from doubles import Situation

from rmfs.control.decisions import BringForBundles, BringForPicks, Park, Prepare, Reposition, Rest
from rmfs.control.pps.random import RandomPod


class Answers:
    """Gives prepared answers in place of PPS, PSA and repositioning; remembers what it was asked.

    Whether a pod has work at a station, PPS itself says.
    """

    def __init__(self, pods=None, place: int = -1, next_station: int = -1, moves=()) -> None:
        self.pods = pods or {}
        self.place = place
        self.station = next_station
        self.moves = list(moves)
        self.asked: list[tuple] = []
        self.pps: RandomPod

    def serves(self, pod, station):
        return self.pps.serves(pod, station)

    def pod_for(self, robot, station):
        self.asked.append(("pod", robot.index, station))
        return self.pods.get(station, -1)

    def next_station(self, robot, stations):
        self.asked.append(("station", robot.index, tuple(stations)))
        return self.station

    def place_for(self, robot):
        self.asked.append(("place", robot.index))
        return self.place

    def may_move(self):
        return True

    def move_for(self, robot):
        return self.moves.pop(0) if self.moves else None


def decide(situation: Situation, controller, answers: Answers) -> list:
    """Apply all decisions to the world, but command nobody."""
    world, made = situation.world, []
    answers.pps = situation.make(RandomPod)
    for decision in controller.decide(answers):
        made.append(decision)
        match decision:
            case BringForPicks(robot, pod, station):
                world.start_pick(robot, pod, station)
            case BringForBundles(robot, pod, station):
                world.start_replenish(robot, pod, station)
            case Park(robot, place):
                world.start_park(robot, place)
                robot.waypoint = place
            case Reposition(robot, pod, place):
                world.start_reposition(robot, pod, place)
            case Rest(robot, place):
                world.start_rest(robot, place)
                robot.waypoint = place
                world.storage.departed(robot, place)
            case Prepare(robot, tasks):
                robot.prepared.extend(tasks)
    return made
