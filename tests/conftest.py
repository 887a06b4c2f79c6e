"""Makes what lies beside this file importable from the tests in all folders; bounds every run."""

import gc
import signal

import pytest
from bounds import Counter
from ledger import check_delays

from rmfs.simulation import run as runs
from rmfs.simulation.kernel import Kernel
from rmfs.simulation.run import Simulation
from rmfs.traffic import Traffic
from tests.simulation.energy_ledger import EnergyLedger

# a shell ignores SIGINT in what it puts into the background, and children inherit that
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_finish():
    """Modules and tests stay, so that no collection of garbage need look at them."""
    gc.collect()
    gc.freeze()


ROBOT_HOURS = 100.0
"""Longer runs are not traced for the balance of energy."""


@pytest.fixture(autouse=True, scope="session")
def no_run_exceeds_its_bound(pytestconfig):
    """Let every simulation of every test fail if it does more than is possible.

    Or if the parts of the time of its orders do not add up, or the energy of a robot does not: what
    it drew is worked out of the trace, which is kept for that unless the run is very long.

    Where speed is measured, nothing is added to the runs.
    """
    if pytestconfig.getoption("markexpr") == "benchmark":
        yield
        return
    build, finish = Kernel.__init__, Simulation.result
    load, begin, move = runs.load_inputs, Simulation.__init__, Traffic.__init__
    traced = False

    def bounded(self, *arguments, observers=(), **named):
        build(self, *arguments, observers=[*observers, Counter(), EnergyLedger()], **named)

    def loaded(*arguments):
        nonlocal traced
        inputs = load(*arguments)
        scenario = inputs.scenario
        hours = (scenario.warmup_s + scenario.duration_s) / 3600
        traced = (
            scenario.energy is not None
            and scenario.disturbances.slow is None  # which the ledger knows nothing of
            and hours * inputs.layout.robots < ROBOT_HOURS
        )
        return inputs

    def moving(self, *arguments, record_trace=False, **named):
        move(self, *arguments, record_trace=record_trace or traced, **named)

    def beginning(self, *arguments, **named):
        nonlocal traced
        begin(self, *arguments, **named)
        traced = False

    def checked(self):
        run = finish(self)
        check_delays(run)
        return run

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Kernel, "__init__", bounded)
        patch.setattr(Simulation, "result", checked)
        patch.setattr(runs, "load_inputs", loaded)
        patch.setattr(Traffic, "__init__", moving)
        patch.setattr(Simulation, "__init__", beginning)
        yield
