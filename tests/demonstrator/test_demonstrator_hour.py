"""An hour on the paper's floor, and a server that is killed in the midst of its work."""

import json
import os
import signal
import socket
import subprocess
import sys
import time

import pandas as pd
import pytest
from laboratory import RADII_M, Laboratory

import rmfs
from rmfs.demonstrator import settings
from rmfs.demonstrator.emulator.unkind import Unkindness

pytestmark = pytest.mark.slow

HOUR = [(["scenario", "duration_s"], 3600.0), (["scenario", "warmup_s"], 0.0)]


class Strangers:
    """Every five minutes somebody who knows no secret writes something to the server."""

    GARBAGE = (b"GET / HTTP/1.1\r\n\r\n", b"\xff" * 50, bytes(500))

    def __init__(self):
        self.known = []

    def __call__(self, room):
        if room.now_us % 300_000_000 == 150_000_000:
            stranger = socket.create_connection((room._address.host, room._address.port))
            stranger.sendall(self.GARBAGE[len(self.known) % 3])
            self.known.append(stranger)


@pytest.mark.parametrize("controllers", ["default", "random"])
def test_an_hour_of_four_robots_in_an_unkind_room(tmp_path, controllers):
    """Speed error 5 %, tags missed 2 %, messages lost 1 % or late; strangers at the door."""
    unkind = Unkindness()
    assert (unkind.speed_error, unkind.missed_tags, unkind.lost_messages) == (0.05, 0.02, 0.01)
    strangers = Strangers()
    lab = Laboratory(tmp_path, unkind, mischief=strangers)
    real = lab.run(3600.0, controllers).footprint
    pure = rmfs.simulate("demonstrator", "demonstrator", controllers, overrides=HOUR).footprint
    truth = lab.room.truth
    print(controllers, real["units_per_h"], pure["units_per_h"], real["bundles_per_h"], vars(truth))
    assert truth.nearest_m >= RADII_M
    assert truth.lateral_mean_m < 0.01
    assert real["units_per_h"] >= 0.8 * pure["units_per_h"]
    assert real["bundles_per_h"] >= 0.8 * pure["bundles_per_h"]
    assert real["distance_m"] == pytest.approx(truth.driven_m, rel=0.02)
    assert len(strangers.known) == lab.hub.refused == 12
    assert real["sim_per_wall"] > 1


def test_in_real_time_like_a_laboratory(tmp_path):
    """No room keeps the clock: server, two real robots and two simulated ones follow the wall's."""
    lab = Laboratory(tmp_path, real="0,3", in_step=False)
    run = lab.run(15.0)
    assert lab.room.truth.nearest_m >= RADII_M
    assert (run.traffic.motion()["distance_m"] > 0.3).all()
    assert lab.room.truth.driven_m > 0.6


def test_a_server_that_is_killed_goes_on_where_it_was(tmp_path, monkeypatch):
    """As a user does it: the same command once more. What was done is done, and work goes on."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    monkeypatch.setenv(settings.SECRET, "a secret of tests")
    monkeypatch.chdir(tmp_path)
    url = ["room://127.0.0.1:" + str(port)]
    duration = ["--set", "scenario.duration_s=300", "--set", "scenario.warmup_s=0"]
    server = ["demonstrate", "--robots", *url, *duration, "--out", "run", "--trace"]
    journal = tmp_path / ".run.journal.jsonl"
    room = started("emulate", "--server", *url, "--report", "room.json")
    try:
        first = started(*server)
        while first.poll() is None and last_us(journal) < 100_000_000:
            time.sleep(0.02)
        first.send_signal(signal.SIGKILL)
        assert first.wait() == -signal.SIGKILL
        before = journal.read_bytes()
        before = before[: before.rfind(b"\n") + 1]
        time.sleep(2)  # the robots stop where their grants end
        second = started(*server)
        assert second.wait(300) == 0, second.stderr.read()
        assert room.wait(60) == 0
    finally:
        for process in (room, first, second):
            process.kill()
    kept = (tmp_path / "run" / "journal.jsonl").read_bytes()
    assert kept.startswith(before)
    assert len(kept) > 1.5 * len(before)
    assert not journal.exists()
    truth = json.loads((tmp_path / "room.json").read_text())
    assert truth["nearest_m"] >= RADII_M
    orders = pd.read_parquet(tmp_path / "run" / "orders.parquet")
    done = orders["completed_s"].dropna()
    assert (done < 100).sum() > 10
    assert (done > 150).sum() > 10
    pure = rmfs.simulate(
        "demonstrator",
        "demonstrator",
        "default",
        overrides=[(["scenario", "duration_s"], 300.0), (["scenario", "warmup_s"], 0.0)],
    )
    units = pd.read_csv(tmp_path / "run" / "footprint.csv").loc[0, "units_picked"]
    assert units >= 0.7 * pure.footprint["units_picked"]


def started(*arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "rmfs", *arguments],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ,
    )


def last_us(journal):
    """Time of the last whole line."""
    try:
        lines = journal.read_bytes().splitlines(keepends=True)[1:]
    except OSError:
        return -1
    whole = [line for line in lines if line.endswith(b"\n")]
    return json.loads(whole[-1])["time_us"] if whole else -1
