"""Planners in Python: the questions they may ask, and their errors. (The documented example is run
with all code of the documentation.)"""

import numpy as np
import pytest
from random_tasks import RandomTasks

from rmfs.control.pp import PathPlanningInPython, RollingParameters
from rmfs.layout import load
from rmfs.measure.checker import check
from rmfs.traffic import PlannerSettings, Step, Traffic
from rmfs.traffic.planner import Along, Conflict, Reserved, Search

RHYTHM = {"period_s": 1.0, "runs_granted": 4.0}


def traffic_of(planner, robots=2, **options):
    layout = load("default", [(["robots"], robots)])
    return layout, Traffic(layout, planner=PlannerSettings("python", RHYTHM, 1, planner), **options)


class Recorder:
    """Puts the questions of a function and keeps the answers."""

    def __init__(self, questions):
        self.questions = questions
        self.answers = []

    def plan(self, now_us, agents):
        ways = yield from self.questions(now_us, agents, self.answers)
        return ways


def test_answers():
    """A search finds the unhindered way; the same way by its stops takes as long; and they meet."""

    def questions(now_us, agents, answers):
        agent = agents[0]
        way = yield Search(0)
        stops = [move[1] for move in way.moves()]
        again = yield Along(0, stops)
        late = yield Along(0, stops, agent.ready_us + 5_000_000)
        around = yield Search(0, [way])
        meeting = yield Conflict([way, late])
        taken = yield Reserved(agent.waypoint)
        answers.append((agent, way, again, late, around, meeting, taken))
        return [way]

    recorder = Recorder(questions)
    layout, traffic = traffic_of(recorder, robots=1)
    goal = int(layout.pod_waypoint[100])
    traffic.command(0, [(Step.DRIVE, goal)])
    traffic.advance(1)
    agent, way, again, late, around, meeting, _ = recorder.answers[0]
    assert (agent.robot, agent.goal, agent.loaded, agent.needs_plan) == (0, goal, False, True)
    assert way.waypoint == goal
    assert way.end_us == way.total_us
    assert abs(way.end_us - agent.ready_us - agent.to_go_us) < 100
    assert again.moves() == way.moves()
    assert late.end_us - way.end_us == 5_000_000
    # a way of the same agent is in the way like any other: nothing is free at the start
    assert around is None or around.end_us > way.end_us
    assert meeting[:2] == (0, 1) or meeting[:2] == (1, 0)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_planner_that_sees_nobody_is_safe(seed):
    """Everybody plans as if alone; what is granted is still free of collisions."""

    class Blind(PathPlanningInPython[RollingParameters]):
        def plan(self, now_us, agents):
            ways = []
            for agent in range(len(agents)):
                way = yield Search(agent)
                ways.append(None if self.draw(10) == 0 else way)
            return ways

    blind = Blind(RollingParameters(), None, np.random.default_rng(seed))
    settings = PlannerSettings("python", RHYTHM, 1, blind)
    tasks = RandomTasks(load("default", [(["robots"], 12)]), seed, planner=settings).run(400)
    report = check(tasks.layout, tasks.traffic.trace(), until_us=400_000_000)
    assert report.ok, report.summary()
    assert len(tasks.visits) > 20


def raising(now_us, agents, answers):
    yield Search(0)
    raise KeyError("my mistake")


def asking_for_nobody(now_us, agents, answers):
    yield Search(7)


def asking_nonsense(now_us, agents, answers):
    yield "way"


def jumping(now_us, agents, answers):
    yield Along(0, [agents[0].goal])


def too_few(now_us, agents, answers):
    yield Search(0)
    return []


@pytest.mark.parametrize(
    ("questions", "error", "message"),
    [
        (raising, KeyError, "my mistake"),
        (asking_for_nobody, ValueError, "no agent 7: there are 1"),
        (asking_nonsense, TypeError, "yields Search, Along, Conflict or Reserved"),
        (jumping, ValueError, "no straight run of robot 0"),
        (too_few, ValueError, "0 ways for 1 agents"),
    ],
)
def test_errors_come_out(questions, error, message):
    layout, traffic = traffic_of(Recorder(questions))
    traffic.command(0, [(Step.DRIVE, int(layout.pod_waypoint[200]))])
    with pytest.raises(error, match=message):
        traffic.advance(10_000_000)
