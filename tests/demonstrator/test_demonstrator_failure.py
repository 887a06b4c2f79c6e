"""A server that fails on what a robot says, whenever it hears it."""

import json

import pytest
from laboratory import RADII_M, Laboratory

from rmfs.demonstrator.emulator.unkind import KIND
from rmfs.demonstrator.server.guide import Guide
from rmfs.demonstrator.server.journal import Journal
from rmfs.errors import InputError, InternalError

SECONDS = 60.0


@pytest.fixture
def defect(monkeypatch):
    """A guide that cannot stand the first tag of robot 1 that it hears after 15 s."""
    tick = Guide.tick

    def fail(self, messages, silent, **options):
        now_us = self.traffic.now_us
        is_due = fail.at_us == now_us if fail.at_us else now_us > 15_000_000
        if is_due and any(robot == 1 and said["type"] == "tag" for robot, said in messages):
            fail.at_us = now_us
            raise RuntimeError("only driving steps are planned")
        return tick(self, messages, silent, **options)

    fail.at_us = 0
    monkeypatch.setattr(Guide, "tick", fail)
    return fail


def test_a_journal_that_fails_on_replay_is_resumed_past_the_failure(tmp_path, defect):
    lab = Laboratory(tmp_path, KIND)
    port = lab.hub.address[1]
    with lab.room_goes_on():
        with pytest.raises(InternalError, match=r"driving steps.*--past-failure"):
            lab.serve(SECONDS)
        before = lab.journal.read_text()
        lab.start_server(port)
        with pytest.raises(InternalError, match=r"driving steps.*--past-failure"):
            lab.serve(SECONDS)
        lab.start_server(port, past_failure=True)
        run = lab.serve(SECONDS)
    kept = lab.journal.read_text()
    assert kept.startswith(before)
    assert f'{{"time_us":{defect.at_us},"left_out":true}}' in kept
    assert lab.room.truth.nearest_m >= RADII_M
    # everybody goes on, the robot whose word was left out as well
    trips = run.traffic.trips()
    late = trips["robot"][trips["t1_us"] > defect.at_us + 10_000_000]
    assert set(late.tolist()) == {0, 1, 2, 3}
    assert not any(robot.given_up for robot in lab.demonstration.traffic.guide.robots.values())


def test_what_was_left_out_stays_left_out(tmp_path):
    path, heard = tmp_path / "journal", [(0, {"type": "astray", "tag": "W1"})]
    journal = Journal(path, {})
    journal.note(50_000, heard, frozenset())
    journal.note(100_000, heard, frozenset({1}))
    journal.note_failure(100_000, "RuntimeError()")
    journal.close()
    assert Journal(path, {}).heard_at(100_000) == (heard, frozenset({1}))
    for journal in (Journal(path, {}, past_failure=True), Journal(path, {})):
        assert journal.heard_at(100_000) == ([], frozenset())
        assert journal.heard_at(50_000) == (heard, frozenset())
        assert journal.begins_us == 100_000
    assert json.loads(path.read_text().splitlines()[2])["heard"]


def test_only_a_failure_can_be_left_out(tmp_path):
    path = tmp_path / "journal"
    journal = Journal(path, {})
    with pytest.raises(InputError, match="contains no failure"):
        Journal(path, {}, past_failure=True)
    journal.note_failure(50_000, "x")
    Journal(path, {}, past_failure=True).note_failure(50_000, "x")
    with pytest.raises(InputError, match=r"0\.05 s fails even without"):
        Journal(path, {}, past_failure=True)
