"""Times of units: distributions against scipy, files, learning curves."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from rmfs.errors import InputError
from rmfs.scenario import load, named_files
from rmfs.scenario.parameters import Pickers
from rmfs.scenario.parameters.pickers import Learning
from rmfs.scenario.pick_times import UnitTimes, learned, least_factor, measured_s
from rmfs.scenario.writing import write_scenario

STATION_S, DRAWS = 8.0, 4000


def draws(seed=3, **unit_time):
    times = UnitTimes(Pickers(unit_time=unit_time).unit_time)
    rng = np.random.default_rng(seed)
    return np.array([times.draw_s(STATION_S, rng) for _ in range(DRAWS)]), times


def test_constant_is_that_of_the_station():
    made, times = draws(distribution="constant")
    assert set(made) == {STATION_S}
    assert times.mean_s(STATION_S) == times.least_s(STATION_S) == STATION_S


@pytest.mark.parametrize("variation", [0.2, 0.7, 1.0, 1.6])
@pytest.mark.parametrize("name", ["gamma", "lognormal"])
def test_draws_follow_their_distribution(name, variation):
    made, times = draws(distribution=name, variation=variation)
    if name == "gamma":
        expected = stats.gamma(variation**-2, scale=STATION_S * variation**2)
    else:
        sigma = np.sqrt(np.log(1 + variation**2))
        expected = stats.lognorm(sigma, scale=STATION_S * np.exp(-(sigma**2) / 2))
    assert expected.mean() == pytest.approx(STATION_S)
    assert expected.std() == pytest.approx(STATION_S * variation)
    assert stats.kstest(made, expected.cdf).pvalue > 0.01
    assert times.mean_s(STATION_S) == STATION_S
    assert times.least_s(STATION_S) == 0.0


def test_measured_times_are_drawn_evenly(tmp_path):
    file = tmp_path / "times.csv"
    file.write_text("who,time_s\nA,4\nB,6.5\nA,6.5\n\nC,12\n")
    made, times = draws(distribution="empirical", file=file)
    values, counts = np.unique(made, return_counts=True)
    assert values.tolist() == [4.0, 6.5, 12.0]
    assert stats.chisquare(counts, DRAWS * np.array([0.25, 0.5, 0.25])).pvalue > 0.01
    assert times.mean_s(STATION_S) == 7.25
    assert times.least_s(STATION_S) == 4.0


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "line 1: must have one column time_s"),
        ("time\n3\n", "line 1: must have one column time_s"),
        ("time_s,time_s\n3,4\n", "line 1: must have one column time_s"),
        ("time_s\n", "contains no times"),
        ("time_s\n3\n0\n", "line 3: time_s must be"),
        ("time_s\n-1\n", "line 2: time_s must be"),
        ("time_s\nnan\n", "line 2: time_s must be"),
        ("time_s\ninf\n", "line 2: time_s must be"),
        ("time_s\n1_0\n", "line 2: time_s must be"),
        ("a,time_s\n3\n", "line 2: time_s must be"),
        ("time_s\n90000\n", "line 2: time_s must be"),
        ('time_s\n"3\n', "line"),
    ],
)
def test_broken_files_are_told_in_one_line(tmp_path, text, told):
    file = tmp_path / "times.csv"
    file.write_text(text)
    with pytest.raises(InputError, match=told) as error:
        measured_s(file)
    assert "\n" not in str(error.value)


def test_a_file_that_is_no_text(tmp_path):
    file = tmp_path / "times.csv"
    file.write_bytes(b"time_s\n\xff\xfe\n")
    with pytest.raises(InputError, match="is not UTF-8 text"):
        measured_s(file)


class TestLearning:
    def test_wright(self):
        """Each doubling of the units leaves the rate of the time."""
        given = Learning(rate=0.8, incompressible=0.0)
        for doubling in range(8):
            assert learned(given, 2**doubling - 1) == pytest.approx(0.8**doubling)

    def test_de_jong_keeps_what_cannot_be_learned(self):
        given = Learning(rate=0.8, incompressible=0.4)
        assert learned(given, 0) == 1.0
        assert learned(given, 7) == pytest.approx(0.4 + 0.6 * 0.8**3)
        assert learned(given, 1e300) == pytest.approx(0.4)

    def test_who_has_experience(self):
        """Unit 64 takes the station's time, and 63 are done at time zero."""
        given = Learning(rate=0.9, incompressible=0.2, units_before=63, standard_units=64)
        assert learned(given, 0) == pytest.approx(1.0)
        beginner = Learning(rate=0.9, incompressible=0.2)
        assert learned(given, 64) == pytest.approx(learned(beginner, 127) / learned(beginner, 63))


def test_the_least_factor():
    assert least_factor(Pickers()) == 1.0
    assert least_factor(Pickers(speeds=(0.5, 1.25))) == pytest.approx(0.8)
    assert least_factor(Pickers(speed_variation=0.1)) == 0.0
    assert least_factor(Pickers(layers={"time_factors": (1.5, 0.7)})) == pytest.approx(0.7)
    assert least_factor(Pickers(learning={"incompressible": 0.3})) == pytest.approx(0.3)
    assert least_factor(Pickers(fatigue={}, errors={})) == 1.0


@pytest.mark.parametrize(
    "given",
    [
        {"unit_time": {"distribution": "gamma", "variation": 0}},
        {"unit_time": {"distribution": "weibull"}},
        {"unit_time": {"distribution": "empirical", "file": "none.csv"}},
        {"speeds": (0,)},
        {"speeds": (1.0,), "speed_variation": 0.2},
        {"learning": {"rate": 0.4}},
        {"fatigue": {"initial": 1.0}},
        {"fatigue": {"per_h": -1.0}},
        {"layers": {"time_factors": ()}},
        {"errors": {"share": 0.2, "at_full_fatigue": 0.1}},
        {"roster": {"shifts_s": ()}},
        {"roster": {"shifts_s": ((0, 3600), (1800, 7200))}},
        {"roster": {"shifts_s": ((3600, 3600),)}},
        {"roster": {"shifts_s": ((0, 90000),)}},
        {"roster": {"shifts_s": ((0, 3600),), "pickers": (1, 2)}},
    ],
)
def test_what_cannot_be_is_refused(given):
    with pytest.raises(ValueError, match="1 validation error"):
        Pickers.model_validate(given)


def test_a_scenario_takes_its_file_along(tmp_path):
    """Relative to the scenario file; written with it; told among its files."""
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "t.csv").write_text("time_s\n4\n5\n")
    (tmp_path / "in" / "own.toml").write_text(
        'format = "rmfs-scenario/1"\nname = "own"\nduration_s = 60\n[pickers]\n'
        'unit_time = {distribution = "empirical", file = "t.csv"}\n'
    )
    read = load(tmp_path / "in" / "own.toml")
    assert named_files(read) == {"pickers.unit_time.file": tmp_path / "in" / "t.csv"}
    write_scenario(read, tmp_path / "out.toml")
    again = load(tmp_path / "out.toml")
    assert measured_s(named_files(again)["pickers.unit_time.file"]).tolist() == [4.0, 5.0]


@pytest.mark.parametrize("spoil", ["bytes", "gone"])
def test_a_file_that_cannot_be_taken_along_is_named(tmp_path, spoil):
    given = tmp_path / "t.csv"
    given.write_text("time_s\n4\n5\n")
    (tmp_path / "own.toml").write_text(
        'format = "rmfs-scenario/1"\nname = "own"\nduration_s = 60\n[pickers]\n'
        'unit_time = {distribution = "empirical", file = "t.csv"}\n'
    )
    read = load(tmp_path / "own.toml")
    if spoil == "bytes":
        given.write_bytes(b"time_s\n\xff\n")
    else:
        given.unlink()
    with pytest.raises(InputError, match=r"t\.csv"):
        write_scenario(read, tmp_path / "out.toml")
