"""`rmfs run`: options, outputs, errors of one line, exit codes, and nothing left behind."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
import typer

from rmfs import cli
from rmfs.cli import main
from rmfs.cli import simulate as simulate_command
from rmfs.cli.groups import ELSEWHERE, _loaded, tell_defaults
from rmfs.cli.simulate import default_name
from rmfs.errors import InputError, InternalError, LayoutError
from rmfs.measure import load_run


def one_line(capsys) -> str:
    """The only line on the error stream, whatever steps were told before it."""
    lines = capsys.readouterr().err.splitlines()
    steps = ("simulating", "writing", "checking")
    complaints = [line for line in lines if not line.split(": ", 1)[1].startswith(steps)]
    assert len(complaints) == 1, lines
    assert complaints[0].startswith("rmfs: ")
    return complaints[0]


def files(folder: Path = Path()) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*"))


def test_a_run_with_defaults(calls, capsys):
    assert main(["run"]) == 0
    target = Path("results/default-default-default-seed0")
    assert load_run(target).footprint["orders_completed"] == 1
    (call,) = calls
    assert call["layout"] == call["scenario"] == call["controllers"] == "default"
    assert (call["seed"], call["pacing"], call["overrides"]) == (0, "instant", [])
    assert call["trace"] is False
    out = capsys.readouterr()
    assert "units per hour" in out.out and "18.0" in out.out
    assert str(target) in out.out
    assert [line.split()[1] for line in out.err.splitlines()] == ["simulating", "writing"]


def test_folders_are_named_by_inputs_changes_and_seed():
    inputs = {"layout": "a/small.toml", "scenario": "basic", "controllers": "default"}
    assert default_name(inputs, 7) == "small-basic-default-seed7"
    changes = ["layout.robots=16", "controllers.psa.name=random"]
    assert default_name(inputs, 7, changes) == (
        "small-basic-default-layout.robots=16,controllers.psa=random-seed7"
    )
    assert default_name(inputs, 7, [], "work") == "small-basic-default-pacing=work-seed7"
    odd = [default_name(inputs, 7, [f"controllers.psa.name=a{sign}b:C"]) for sign in "/ \\"]
    assert len({*odd}) == 3 and all("/" not in name and ":" not in name for name in odd)
    long = [default_name(inputs, 7, [f"layout.x={'9' * 300}{last}"]) for last in "12"]
    assert long[0] != long[1] and len(long[0]) < 200


def test_runs_with_other_changes_go_to_other_folders(calls):
    assert main(["run", "--set", "layout.robots=16"]) == 0
    assert main(["run", "--set", "layout.robots=8"]) == 0
    assert sorted(path.name for path in Path("results").iterdir()) == [
        "default-default-default-layout.robots=16-seed0",
        "default-default-default-layout.robots=8-seed0",
    ]


def test_a_run_is_replaced_only_by_force(calls, capsys):
    assert main(["run", "--out", "run"]) == 0
    before = Path("run/run.json").read_bytes()
    capsys.readouterr()
    assert main(["run", "--out", "run"]) == 2
    assert one_line(capsys).endswith(
        "/run: a run folder of this name exists already; --force replaces it, "
        "--out chooses another name"
    )
    assert len(calls) == 1 and Path("run/run.json").read_bytes() == before
    Path("run/mark").touch()
    assert main(["run", "--out", "run", "--force"]) == 0
    assert len(calls) == 2 and not Path("run/mark").exists()
    assert files() == ["run", *(f"run/{name}" for name in files(Path("run")))]


def test_two_runs_into_one_folder(calls, capsys, monkeypatch):
    """The second is refused while the first goes on, whatever it was told."""
    import rmfs.simulation.run

    first = rmfs.simulation.run.simulate
    codes = []

    def simulate(*given, **more):
        monkeypatch.setattr("rmfs.simulation.run.simulate", first)
        codes.append(main(["run", "--out", "run", "--force", "--seed", "2"]))
        return first(*given, **more)

    monkeypatch.setattr("rmfs.simulation.run.simulate", simulate)
    assert main(["run", "--out", "run"]) == 0
    assert codes == [2] and len(calls) == 1
    assert "/run: is being written by another process" in capsys.readouterr().err
    assert load_run(Path("run")).footprint["orders_completed"] == 1
    assert main(["run", "--out", "run", "--force"]) == 0


def test_a_run_prints_its_own_figures(calls, capsys, monkeypatch):
    """Although another one has taken its folder by force in the meantime."""
    from fake_run import run

    from rmfs.measure import write_run

    replaced = simulate_command.conclude

    def other_comes_in_between(target, footprint, report):
        other = run()
        other.seed = 9
        write_run(other, target)
        replaced(target, footprint, report)

    monkeypatch.setattr(simulate_command, "conclude", other_comes_in_between)
    assert main(["run", "--out", "run"]) == 0
    assert load_run(Path("run")).footprint["seed"] == 9
    assert "seed 3" in " ".join(capsys.readouterr().out.split())


def test_all_options_arrive(calls):
    arguments = "run --layout basic --scenario basic --controllers random --seed 7 --out here/run"
    more = ["--set", "layout.robots=16", "--set", "controllers.psa.name=random", "--trace"]
    assert main([*arguments.split(), *more, "--allow-not-well-formed"]) == 0
    (call,) = calls
    assert call["overrides"] == [
        (["layout", "robots"], 16),
        (["controllers", "psa", "name"], "random"),
    ]
    assert (call["layout"], call["controllers"], call["seed"]) == ("basic", "random", 7)
    assert call["allow_not_well_formed"] is True
    assert load_run(Path("here/run")).trace["robot"].nunique() == 2


def test_check_fills_collisions(calls, capsys):
    assert main(["run", "--out", "run", "--check"]) == 0
    assert load_run(Path("run")).footprint["collisions"] == 0
    assert not Path("run/trace.parquet").exists()
    assert calls[0]["trace"] is True


def test_an_unsafe_trace_ends_in_exit_code_1(calls, capsys, monkeypatch):
    import fake_run
    from scripted_trace import Script

    def colliding(self):
        script = Script(fake_run.layout())
        script.robot(0).hold(1)
        script.robot(1).run(0)
        return script.columns(500.0)

    monkeypatch.setattr(fake_run.FakeTraffic, "trace", colliding)
    assert main(["run", "--out", "run", "--check"]) == 1
    assert load_run(Path("run")).footprint["collisions"] == 1
    assert "robots overlap: 1" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["run", "--seed", "abc"], "--seed"),
        (["run", "--seed", "-1"], "--seed"),
        (["run", "--sead", "1"], "--sead"),
        (["run", "extra"], "extra"),
        (["run", "--set", "layout.robots"], "expected KEY=VALUE"),
        (["rum"], "rum"),
        (["run", "--out", "taken.txt"], "taken.txt: is not a folder"),
        (["run", "--out", "taken.txt/below"], "cannot be written"),
        (["run", "--out", "precious"], "not a run folder"),
    ],
)
def test_wrong_usage_is_one_line_and_code_2(calls, capsys, arguments, text):
    Path("taken.txt").write_text("precious")
    Path("precious").mkdir()
    Path("precious/thesis.txt").write_text("precious")
    before = files()
    assert main(arguments) == 2
    assert text in one_line(capsys)
    assert not calls
    assert files() == before


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (InputError("layout.toml: unknown key robts;\ndid you mean robots?"), 2),
        (LayoutError("layout.toml", ["station 3 cannot be reached", "too many robots"]), 2),
        (KeyboardInterrupt(), 130),
    ],
)
def test_errors_of_a_run_leave_nothing(calls, capsys, monkeypatch, error, code):
    def simulate(*given, **arguments):
        raise error

    monkeypatch.setattr("rmfs.simulation.run.simulate", simulate)
    assert main(["run"]) == code
    one_line(capsys)
    assert files() == []


def test_an_interruption_while_writing_leaves_nothing(calls, capsys, monkeypatch):
    import pandas as pd

    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(pd.DataFrame, "to_csv", interrupted)
    assert main(["run", "--out", "a/b"]) == 130
    assert "interrupted" in one_line(capsys)
    assert files() == []


def test_a_defect_keeps_its_traceback(calls, monkeypatch):
    def simulate(*given, **arguments):
        raise ZeroDivisionError

    monkeypatch.setattr("rmfs.simulation.run.simulate", simulate)
    with pytest.raises(ZeroDivisionError):
        main(["run"])
    assert files() == []


def test_defaults_stated_in_help_texts_are_shown(capsys):
    """The help is read as markup, in which brackets have a meaning."""
    assert main(["run", "--help"]) == 0
    shown = " ".join(capsys.readouterr().out.replace("│", " ").split())
    assert "[default: as fast as possible]" in shown
    assert "[default: none]" in shown


def test_every_option_tells_its_default():
    root = tell_defaults(typer.main.get_command(cli.app))
    lacking, seen = [], 0

    def look(command, name):
        nonlocal seen
        for word, one in getattr(command, "commands", {}).items():
            look(one, f"{name} {word}")
        context = command.make_context(name, [], resilient_parsing=True)
        for option in command.params:
            if option.param_type_name == "option" and not option.hidden and not option.is_flag:
                seen += 1
                told = " ".join(option.get_help_record(context) or ("",))
                if "default:" not in told and not option.required:
                    lacking.append(f"{name} {option.opts[0]}")

    look(root, "rmfs")
    for name in ELSEWHERE:
        look(_loaded(name), f"rmfs {name}")
    assert lacking == [] and seen > 80


def test_help_names_all_commands_without_loading_them(capsys):
    loaded = set(sys.modules)
    assert main(["--help"]) == 0
    text = capsys.readouterr().out
    for name in ("run", "layout", "scenario", "controllers"):
        assert name in text
    assert not {name for name in set(sys.modules) - loaded if name.endswith(".commands")}


def test_without_a_command_help_is_shown(capsys):
    assert main([]) == 0
    assert "Usage: rmfs" in capsys.readouterr().out


@pytest.mark.parametrize("group", ["layout", "scenario", "controllers"])
def test_a_group_without_a_command_shows_its_help(capsys, group):
    assert main([group]) == 0
    told = capsys.readouterr()
    assert f"Usage: rmfs {group}" in told.out
    assert told.err == ""


def test_version(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("rmfs ")


def test_a_stalled_run_ends_with_its_report(calls, capsys, monkeypatch):
    from rmfs.simulation.loop import StalledError

    def simulate(*given, **arguments):
        raise StalledError("nothing has moved since 12 s\nrobot 0: waits")

    monkeypatch.setattr("rmfs.simulation.run.simulate", simulate)
    assert main(["run"]) == 1
    assert capsys.readouterr().err.splitlines()[-1] == "robot 0: waits"
    assert files() == []


def test_a_defect_leaves_a_file_to_report(monkeypatch, tmp_path, capsys):
    """Exit code 1, one line with run, seed and file, no run folder; the file has the traceback."""

    def simulate(*inputs, **options):
        raise InternalError("a defect of the traffic core: src/here.rs:1:2: oh")

    monkeypatch.setattr("rmfs.simulation.run.simulate", simulate)
    monkeypatch.chdir(tmp_path)
    assert main(["run", "--seed", "31", "--layout", "small"]) == 1
    line = one_line(capsys)
    assert "small, default, default, seed 31" in line
    assert "src/here.rs:1:2" in line
    (file,) = tmp_path.glob("rmfs-defect-*.txt")
    assert str(file) in line
    told = file.read_text()
    assert "rmfs run --seed 31 --layout small" in told
    assert "Traceback" in told and "src/here.rs:1:2" in told
    assert [path for path in files() if path.startswith("results/")] == []
