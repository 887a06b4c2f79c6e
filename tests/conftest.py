"""Makes what lies beside this file importable from the tests in all folders; bounds every run."""

import signal

import pytest
from bounds import Counter
from ledger import check_delays

from rmfs.simulation.kernel import Kernel
from rmfs.simulation.run import Simulation

# a shell ignores SIGINT in what it puts into the background, and children inherit that
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True, scope="session")
def no_run_exceeds_its_bound(pytestconfig):
    """Let every simulation of every test fail if it does more than is possible.

    Or if the parts of the time of its orders do not add up.

    Where speed is measured, nothing is added to the runs.
    """
    if pytestconfig.getoption("markexpr") == "benchmark":
        yield
        return
    build, finish = Kernel.__init__, Simulation.result

    def bounded(self, *arguments, observers=(), **named):
        build(self, *arguments, observers=[*observers, Counter()], **named)

    def checked(self):
        run = finish(self)
        check_delays(run)
        return run

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Kernel, "__init__", bounded)
        patch.setattr(Simulation, "result", checked)
        yield
