"""MM rules: what is installed when, and what a controllers file may say."""

from __future__ import annotations

from math import inf
from typing import Any

import pytest
from doubles import Situation, rules

from rmfs.control.mm.random import RandomExchange
from rmfs.control.mm.scheduled import Scheduled
from rmfs.control.problems import Problem
from rmfs.control.settings import load
from rmfs.control.toml import to_toml
from rmfs.errors import InputError


@pytest.fixture
def situation() -> Situation:
    """A run of 1000 s."""
    made = Situation()
    made.view.end_s = 1000.0
    return made


def installed(rule) -> list[tuple[str, str]]:
    return [(str(decision.choice.problem), decision.choice.name) for decision in rule.decide()]


class TestScheduled:
    def test_by_share_of_the_run(self, situation) -> None:
        """Half of 1000 s, then all of it."""
        exchanges = ({"at_share": 0.5, "psa": "nearest"}, {"at_share": 1.0, "psa": "random"})
        rule = situation.make(Scheduled, exchanges=exchanges)
        assert installed(rule) == []
        assert rule.next_event_s() == 500.0
        situation.world.now_s = 500.0
        assert installed(rule) == [("psa", "nearest")]
        assert rule.next_event_s() == 1000.0
        situation.world.now_s = 1000.0
        assert installed(rule) == [("psa", "random")]
        assert rule.next_event_s() == inf

    def test_by_time_several_at_once_with_parameters(self, situation) -> None:
        """In the order of the problems."""
        entry = {"at_s": 0, "ta": {"name": "swarm", "growth": 2.0}, "poa": "random"}
        rule = situation.make(Scheduled, exchanges=(entry,))
        first, second = rule.decide()
        assert (first.choice.problem, first.choice.name) == (Problem.POA, "random")
        assert second.choice.parameters.growth == 2.0

    def test_installed_later_it_leaves_out_what_is_past(self, situation) -> None:
        situation.world.now_s = 600.0
        exchanges = ({"at_share": 0.5, "psa": "nearest"}, {"at_share": 0.7, "psa": "random"})
        rule = situation.make(Scheduled, exchanges=exchanges)
        assert installed(rule) == []
        assert rule.next_event_s() == 700.0


class TestRandom:
    def test_one_of_the_alternatives_after_each_period(self, situation) -> None:
        rule = situation.make(RandomExchange, period_s=100.0)
        assert installed(rule) == []
        drawn = []
        for number in range(1, 101):
            assert rule.next_event_s() == number * 100.0
            situation.world.now_s = number * 100.0
            drawn += installed(rule)
        assert len(drawn) == 100
        assert {name for _, name in drawn} == {"nearest", "random", "station-based", "turnover"}

    def test_periods_count_from_when_it_is_installed(self, situation) -> None:
        situation.world.now_s = 30.0
        assert situation.make(RandomExchange, period_s=100.0).next_event_s() == 130.0

    def test_any_problem_and_any_parameters(self, situation) -> None:
        alternative = {"ta": {"name": "constant-ratio", "pick_share": 0.5}, "sa": "constant-ratio"}
        rule = situation.make(RandomExchange, alternatives=(alternative,))
        situation.world.now_s = 7200.0
        assert installed(rule) == [("ta", "constant-ratio"), ("sa", "constant-ratio")]


BRUTE = {"ta": "brute-force", "pps": "dummy", "psa": "dummy"}
BACK = {"ta": "balanced", "pps": "random", "psa": "nearest"}


class TestFile:
    def scheduled(self, *exchanges: dict[str, Any]):
        return rules(mm={"name": "scheduled", "exchanges": list(exchanges)})

    def test_as_it_is_written(self, tmp_path) -> None:
        file = tmp_path / "figure.toml"
        file.write_text(
            'format = "rmfs-controllers/1"\nname = "figure"\npsa = { name = "random" }\n'
            '[mm]\nname = "scheduled"\n'
            '[[mm.exchanges]]\nat_share = 0.5\npsa = { name = "nearest", metric = "path" }\n'
        )
        entry = load(file).choices[Problem.MM].parameters.exchanges[0]
        (choice,) = entry.choices()
        assert (entry.at_share, choice.name, choice.parameters.metric) == (0.5, "nearest", "path")

    def test_what_is_shown_can_be_read_again(self, tmp_path) -> None:
        given = self.scheduled({"at_s": 5.0, **BRUTE}, {"at_s": 9.0, **BACK})
        file = tmp_path / "test.toml"
        file.write_text(to_toml(given))
        assert load(file) == given
        assert "robots_per_station = 9" in file.read_text()  # in full

    @pytest.mark.parametrize(
        ("entry", "message"),
        [
            ({"at_s": 1, "at_share": 0.5, "psa": "random"}, "must have exactly one of at_s"),
            ({"psa": "random"}, "must have exactly one of at_s"),
            ({"at_s": 1}, "must name a rule for at least one problem"),
            ({"at_share": 1.5, "psa": "random"}, "at_share"),
            ({"at_s": 1, "psa": "neares"}, "no psa rule named neares; did you mean nearest?"),
            ({"at_s": 1, "psa": {"metrik": "time"}}, "unknown key psa.metrik; did you mean metric"),
            ({"at_s": 1, "psaa": "random"}, "unknown key exchanges.0.psaa; did you mean psa?"),
            ({"at_s": 1, "psa": "dummy"}, "mm.exchanges.0: psa.name: a dummy decides nothing"),
            ({"at_s": 1, "ta": "random"}, "mm.exchanges.0: ta random decides pps as well"),
        ],
    )
    def test_mistakes_are_named(self, entry, message) -> None:
        with pytest.raises(InputError) as error:
            self.scheduled(entry)
        assert message in str(error.value)

    def test_joint_controllers_come_and_go_with_their_dummies(self) -> None:
        self.scheduled({"at_s": 5, **BRUTE}, {"at_s": 9, **BACK})
        with pytest.raises(InputError, match="ta brute-force decides psa as well"):
            self.scheduled({"at_s": 5, **BRUTE}, {"at_s": 9, "psa": "nearest"})

    @pytest.mark.parametrize(
        ("exchanges", "message"),
        [
            (
                [{"at_s": 5, "psa": "random"}, {"at_s": 1, "psa": "nearest"}],
                "in chronological order",
            ),
            (
                [{"at_s": 5, "psa": "random"}, {"at_share": 1, "psa": "nearest"}],
                "all entries must have at_s",
            ),
        ],
    )
    def test_entries_are_in_order(self, exchanges, message) -> None:
        with pytest.raises(InputError, match=message):
            self.scheduled(*exchanges)

    @pytest.mark.parametrize(
        ("alternative", "message"),
        [
            (BRUTE, "must be combined with others"),
            ({"psa": "dummy"}, "must be combined with others"),
            ({"roa": "random", "psa": "randm"}, "did you mean random?"),
        ],
    )
    def test_alternatives_must_go_with_everything(self, alternative, message) -> None:
        with pytest.raises(InputError) as error:
            rules(mm={"name": "random", "alternatives": [alternative]})
        assert message in str(error.value)

    def test_nor_may_a_partner_of_a_joint_controller_be_exchanged(self) -> None:
        with pytest.raises(InputError, match="ta brute-force decides psa as well"):
            rules(
                **{problem: {"name": name} for problem, name in BRUTE.items()},
                mm={"name": "random", "alternatives": [{"psa": "nearest"}]},
            )

    def test_alternatives_must_go_with_what_others_have_installed(self) -> None:
        """RPS nearest waits for ROA, and ROA same-pod for RPS."""
        roa = {"name": "random"}
        drawn = [{"rps": "nearest"}, {"roa": "same-pod"}]
        rules(roa=roa, mm={"name": "random", "alternatives": drawn[:1]})
        with pytest.raises(InputError, match=r"mm\.alternatives\.0 after 1: .* neither would ever"):
            rules(roa=roa, mm={"name": "random", "alternatives": drawn})
        drawn[1]["rps"] = "random"
        drawn[0]["roa"] = "random"
        rules(roa=roa, mm={"name": "random", "alternatives": drawn})
