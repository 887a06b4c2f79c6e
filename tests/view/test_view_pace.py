"""How fast a watched run may go, on a clock told by hand."""

import pytest

from rmfs.errors import InputError
from rmfs.simulation.agenda import NEVER_US
from rmfs.view.pace import Pace


def test_without_a_speed_nothing_holds_it_back() -> None:
    pace = Pace()
    assert pace.is_free
    assert pace.limit_us(5_000_000, 0.0) == NEVER_US


def test_a_speed_is_kept() -> None:
    pace = Pace(10.0)
    # 0.02 s of wall time are 0.2 simulated seconds: nothing is paid for yet
    assert pace.limit_us(0, 100.0) is None
    assert pace.wait_s(0, 100.0) == pytest.approx(0.02)
    assert pace.limit_us(0, 100.25) == 2_500_000
    assert pace.limit_us(2_500_000, 100.25) is None
    assert pace.limit_us(2_500_000, 100.5) == 5_000_000


def test_a_run_that_lags_behind_does_not_hurry_later() -> None:
    pace = Pace(10.0)
    assert pace.limit_us(0, 0.0) is None
    assert pace.limit_us(1_000_000, 60.0) == 1_200_000
    assert pace.limit_us(1_200_000, 60.02) == 1_400_000


def test_a_step_ends_where_it_says() -> None:
    pace = Pace()
    pace.step(1_000_000, 10.0)
    assert pace.limit_us(1_000_000, 0.0) == 11_000_000
    assert pace.limit_us(4_000_000, 0.0) == 11_000_000
    assert pace.limit_us(11_000_000, 0.0) is None
    assert pace.paused


def test_a_step_to_the_next_event_is_one_round() -> None:
    pace = Pace(3.0)
    pace.step(0)
    assert pace.limit_us(0, 0.0) == NEVER_US
    assert pace.limit_us(7, 0.0) is None


def test_let_go_it_is_as_in_the_beginning() -> None:
    pace = Pace(5.0)
    pace.run(100.0)
    pace.pause()
    pace.let_go()
    assert pace.speed == 5.0
    assert not pace.paused


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_nonsense_is_refused(speed: float) -> None:
    with pytest.raises(InputError, match="speed"):
        Pace(speed)
    with pytest.raises(InputError, match="step"):
        Pace().step(0, -1.0 if speed == 0 else -abs(speed))
