"""What a user says about a demonstration, and what is refused."""

import json
import os
import signal
import socket
import subprocess
import sys
import time

import pandas as pd
import pytest

from rmfs import layout as layouts
from rmfs.cli import main
from rmfs.demonstrator import settings
from rmfs.errors import InputError

WRONG_INPUT = 2


@pytest.fixture(scope="module")
def plan():
    return layouts.load("demonstrator")


@pytest.mark.parametrize(
    ("url", "parts"),
    [
        ("tcp://0.0.0.0:7888", ("tcp", "0.0.0.0", 7888)),
        ("room://[::1]:80", ("room", "::1", 80)),
        ("tcp://lab.local:0", ("tcp", "lab.local", 0)),
    ],
)
def test_addresses(url, parts):
    assert settings.address(url, "--robots") == parts


@pytest.mark.parametrize(
    "url",
    ["", "lab:7888", "http://lab:80", "tcp://lab", "tcp://lab:99999", "tcp://lab:x", "tcp://a:1/b"],
)
def test_what_is_no_address(url):
    with pytest.raises(InputError, match=r"--robots .*must be tcp://HOST:PORT"):
        settings.address(url, "--robots")


def test_robots(plan):
    assert settings.robots(plan, None) == {f"robot-{i}": i for i in range(4)}
    assert settings.robots(plan, "3, 1") == {"robot-3": 3, "robot-1": 1}
    for wrong in ("", "4", "-1", "a", "1,,2"):
        with pytest.raises(InputError, match="indices of robots, 0 to 3"):
            settings.robots(plan, wrong)
    with pytest.raises(InputError, match="twice"):
        settings.robots(plan, "1,1")


def test_tags(plan, tmp_path):
    file = tmp_path / "tags.csv"
    lines = [f"{w};e0{w:02x}" for w in range(36)]
    file.write_text("\n".join(reversed(lines)) + "\n")
    assert settings.tags(plan, file)[35] == "E023"
    for wrong, why in [
        (lines[:-1], "waypoint 35 has no tag"),
        ([*lines[:-1], "36;AA"], "line 36: must be WAYPOINT;TAG"),
        ([*lines[:-1], "35,AA"], "line 36: must be WAYPOINT;TAG"),
        ([*lines[:-1], "35;E000"], "line 36: the waypoint or the tag occurs twice"),
    ]:
        file.write_text("\n".join(wrong))
        with pytest.raises(InputError, match=why):
            settings.tags(plan, file)
    with pytest.raises(InputError, match="cannot be read"):
        settings.tags(plan, tmp_path / "none")


def test_secrets(tmp_path, monkeypatch):
    monkeypatch.delenv(settings.SECRET, raising=False)
    with pytest.raises(InputError, match="RMFS_SECRET: must hold the secret"):
        settings.secret(None)
    monkeypatch.setenv(settings.SECRET, " from outside \n")
    assert settings.secret(None) == b"from outside"
    file = tmp_path / "secret"
    file.write_text("short")
    with pytest.raises(InputError, match="at least 8"):
        settings.secret(file)


# --- the command line ----------------------------------------------------------------------------


@pytest.fixture
def lab(monkeypatch, tmp_path):
    monkeypatch.setenv(settings.SECRET, "a secret of tests")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (["--robots", "lab:1"], "must be tcp://HOST:PORT"),
        (["--robots", "tcp://127.0.0.1:0", "--real", "9"], "indices of robots"),
        (["--robots", "tcp://127.0.0.1:0", "--layout", "nowhere"], "nowhere"),
        (["--robots", "tcp://127.0.0.1:0", "--layout", "study-tiers"], "elevators cannot"),
        (["--robots", "tcp://127.0.0.1:0", "--tags", "none.csv"], "none.csv: cannot be read"),
        (["--robots", "tcp://127.0.0.1:0", "--secret", "none"], "--secret none: cannot be read"),
        (
            ["--robots", "tcp://127.0.0.1:0", "--set", "controllers.pp.name=far"],
            "require time-windows",
        ),
        (["--robots", "tcp://192.0.2.1:7"], "cannot listen there"),
        (["--robots", "emulated", "--past-failure"], "whose room ends with the server"),
    ],
)
def test_wrong_input_ends_in_one_line(lab, capsys, arguments, why):
    assert main(["demonstrate", *arguments]) == WRONG_INPUT
    told = capsys.readouterr().err.strip().splitlines()
    assert why in told[-1]
    assert told[-1].startswith("rmfs: ")
    assert not list(lab.glob("results/*"))


def test_a_port_that_is_taken(lab, capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        url = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
        assert main(["demonstrate", "--robots", url]) == WRONG_INPUT
    assert "cannot listen there" in capsys.readouterr().err


def test_a_demonstration_with_a_room_of_its_own(lab):
    """The whole command: a run folder, and what really happened."""
    asked = ["--set", "scenario.duration_s=5", "--set", "scenario.warmup_s=0", "--trace"]
    assert main(["demonstrate", "--robots", "emulated", *asked, "--out", "a"]) == 0
    assert pd.read_csv(lab / "a" / "footprint.csv").loc[0, "robots"] == 4
    truth = json.loads((lab / "a" / "room.json").read_text())
    assert truth["emulated_s"] == pytest.approx(5.0, abs=0.1)
    assert 0.5 < truth["driven_m"] < 4 * 5 * 0.21 * 1.06
    assert truth["nearest_m"] >= 0.34
    assert (lab / "a" / "journal.jsonl").stat().st_size > 1000
    assert not [path for path in lab.iterdir() if path.name != "a"]


def test_a_killed_demonstration_with_a_room_of_its_own_begins_again(lab):
    """Its room has ended with it; a journal of half a demonstration would find robots elsewhere."""
    asked = ["--set", "scenario.duration_s=15", "--set", "scenario.warmup_s=0"]
    command = ["demonstrate", "--robots", "emulated", *asked]
    killed = subprocess.Popen(
        [sys.executable, "-m", "rmfs", *command, "--out", "a"],
        start_new_session=True,
        env=os.environ,
    )
    until = time.monotonic() + 120
    while not any(path.stat().st_size > 2000 for path in lab.rglob("*journal.jsonl")):
        assert killed.poll() is None and time.monotonic() < until
        time.sleep(0.01)
    os.killpg(killed.pid, signal.SIGKILL)
    killed.wait()
    assert not (lab / "a").exists()
    for out in ("a", "b"):
        assert main([*command, "--out", out]) == 0
    rooms = [json.loads((lab / out / "room.json").read_text()) for out in ("a", "b")]
    assert rooms[0] == rooms[1] and rooms[0]["driven_m"] > 2
    journals = [(lab / out / "journal.jsonl").read_bytes() for out in ("a", "b")]
    assert journals[0] == journals[1]
    assert not [path for path in lab.iterdir() if path.name not in ("a", "b")]
