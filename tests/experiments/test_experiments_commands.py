"""`rmfs experiment` and `rmfs compare`: what is printed, written and returned."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
from stand_in import Inline, work_that_fails_for_random

from rmfs import experiments
from rmfs.cli import main
from rmfs.experiments.results import to_csv
from rmfs.experiments.running.driver import drive
from rmfs.experiments.store import Store
from rmfs.measure.columns import REAL, Column


@pytest.fixture
def made(design, finished, tmp_path, monkeypatch):
    """A design whose results are in results/tiny below the working directory."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(finished, "results/tiny")
    return str(design(keep=["series"]))


def told(capsys) -> str:
    return capsys.readouterr().out


def test_plan_counts_runs_and_estimates_time(design, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = str(design())
    assert main(["experiment", "plan", path, "--arms", "--jobs", "2"]) == 0
    out = told(capsys)
    assert "arms     4" in out and "runs     12, 0 finished" in out
    assert "factor   psa (controllers.psa): nearest, random" in out
    assert "robots=16,psa=random" in out
    assert "for 12 runs, 2 at a time" in out and "from 4 short runs" in out
    assert not (tmp_path / "results").exists()


def test_plan_of_a_finished_experiment(made, capsys):
    assert main(["experiment", "plan", made]) == 0
    out = told(capsys)
    assert "runs     12, 12 finished" in out and "time" not in out


def test_problems_are_told_one_a_line(design, capsys):
    path = design(factors={"layout.robts": [1], "controllers.psa": ["nearst"]})
    for verb in ("plan", "run", "status", "table", "plot"):
        assert main(["experiment", verb, str(path)]) == 2
        lines = capsys.readouterr().err.splitlines()
        assert len(lines) == 2
        assert all(line.startswith(f"rmfs: {path}: arm robts=1,psa=nearst: ") for line in lines)


def test_run_is_told_in_lines(design, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = str(design(seeds=[1], base={
        "layout": "basic", "scenario": "basic", "controllers": "default",
        "scenario.duration_s": 60,
    }))  # fmt: skip
    assert main(["experiment", "run", path, "--jobs", "2"]) == 0
    out = capsys.readouterr()
    assert out.out.splitlines() == ["4 of 4 runs finished, 0 failed", "results/tiny"]
    # a slow machine is told about progress, too
    assert out.err.splitlines()[0] == "rmfs: 4 runs, 0 of them finished"
    assert set(experiments.load("results/tiny")["units_picked"] > 0) == {True}
    assert main(["experiment", "status", path]) == 0
    assert "4 of 4 runs finished" in told(capsys)


def test_failed_runs_end_in_exit_code_1(design, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = design()
    monkeypatch.setattr(
        "rmfs.experiments.running.local.LocalProcesses",
        lambda processes: Inline(do=work_that_fails_for_random),
    )
    assert main(["experiment", "run", str(path)]) == 1
    out = capsys.readouterr()
    assert "10 of 12 runs finished, 2 failed" in out.out
    assert "robots=8,psa=random, seed 2: failed: ValueError: a robot is lost" in out.err
    assert main(["experiment", "status", str(path)]) == 1
    out = told(capsys)
    assert "10 of 12 runs finished" in out
    assert "failed: robots=16,psa=random, seed 2: ValueError: a robot is lost" in out


def test_tables_and_pictures_say_what_runs_are_lacking(design, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = str(design())
    drive(
        experiments.plan(path), Store(Path("results/tiny")), Inline(do=work_that_fails_for_random)
    )
    # a fourth seed has not been run at all
    path = str(design(seeds=[1, 2, 3, 4]))
    note = "incomplete: 10 of 16 runs are finished, 2 failed"
    assert main(["experiment", "table", path]) == 3
    out = capsys.readouterr()
    assert note in " ".join(out.out.split()) and out.err == f"rmfs: {note}\n"
    for arguments in (["--file", "t.md"], ["--file", "t.tex"], ["--file", "t.html"]):
        assert main(["experiment", "table", path, *arguments]) == 3
        assert note in Path(arguments[1]).read_text()
    assert main(["experiment", "table", path, "--anova", "--allow-incomplete"]) == 0
    out = capsys.readouterr()
    assert note in " ".join(out.out.split()) and note in out.err
    assert main(["experiment", "plot", path, "-f", "p.svg"]) == 3
    assert json.loads(Path("p.svg.provenance.json").read_text())["note"] == note
    assert main(["experiment", "plot", path, "-f", "q.svg", "--allow-incomplete"]) == 0
    arm = "results/tiny#robots=16,psa=random"
    for sources in (["results/tiny"], ["results/tiny", "results/tiny"]):
        assert main(["compare", *sources, "-c", "units_per_h"]) == 3
        out = " ".join(told(capsys).split())
        assert "Note: results/tiny: incomplete: 10 of 12 runs are finished, 2 failed." in out
    assert main(["compare", "results/tiny", "--allow-incomplete"]) == 0
    assert "Note: " in capsys.readouterr().out
    whole = "results/tiny#robots=8,psa=nearest"
    assert main(["compare", arm, whole, "-c", "units_per_h"]) == 3
    out = " ".join(told(capsys).split())
    assert "paired by 2 common seeds, of 2 and 3" in out
    assert f"Note: {arm}: incomplete: 2 of 3 runs are finished, 1 failed." in out
    assert main(["compare", whole, "results/tiny#robots=16,psa=nearest"]) == 0
    assert "Note: " not in told(capsys)
    assert main(["experiment", "table", str(design())]) == 3
    assert "10 of 12 runs are finished, 2 failed" in capsys.readouterr().err
    design(seeds=[1])
    assert main(["experiment", "table", path]) == 0
    assert capsys.readouterr().err == ""


def test_arms_without_a_run_are_counted(design, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = design()
    with pytest.raises(KeyboardInterrupt):
        drive(experiments.plan(path), Store(Path("results/tiny")), Inline(after=1, slots=1))
    assert main(["experiment", "plot", str(path), "-f", "p.png"]) == 3
    assert "1 of 12 runs are finished, 3 of 4 arms have none" in capsys.readouterr().err


def test_tables_on_the_terminal_and_in_files(made, tmp_path, capsys):
    assert main(["experiment", "table", made]) == 0
    assert "robots=8,psa=nearest" in told(capsys)
    assert main(["experiment", "table", made, "--anova", "-c", "units_per_h"]) == 0
    out = told(capsys)
    assert "Analysis of variance of units_per_h" in out and "robots x psa" in out
    arguments = ["--anova", "--no-interactions", "-c", "units_per_h"]
    assert main(["experiment", "table", made, *arguments]) == 0
    out = told(capsys)
    assert "interactions are in the residual" in out and "robots x psa" not in out
    assert main(["experiment", "table", made, "--across", "psa", "-c", "units_per_h"]) == 0
    assert "units per hour, psa=random" in told(capsys)
    assert main(["experiment", "table", "results/tiny", "--by-factor"]) == 0
    assert re.search(r"16 +random ", told(capsys))
    arguments = ["--baseline", "robots=8,psa=nearest", "--file", "table.tex"]
    assert main(["experiment", "table", made, *arguments]) == 0
    assert told(capsys) == "table.tex: written, with table.tex.provenance.json\n"
    provenance = json.loads(Path("table.tex.provenance.json").read_text())
    assert provenance["rows"]["count"] == 12 and "p values" in provenance["caption"]
    assert main(["experiment", "table", made, "--rows", "rows.csv"]) == 0
    rows = pd.read_csv("rows.csv")
    assert len(rows) == 12 and "wall_s" not in rows and "code" not in rows


def test_results_are_found_from_their_folder(made, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir("/")
    folder = str(tmp_path / "results" / "tiny")
    Path(made).unlink()
    assert main(["experiment", "status", folder]) == 0
    assert "tiny: 12 of 12 runs finished" in told(capsys)
    assert main(["experiment", "table", folder, "-c", "units_per_h"]) == 0
    assert "robots=8,psa=nearest" in told(capsys)
    assert main(["experiment", "plot", folder]) == 0
    assert (tmp_path / "results" / "tiny" / "intervals-units_per_h.png").exists()
    for arguments, text in (
        (["status", str(tmp_path)], "contains no experiment"),
        (["table", folder, "--out", "x"], "cannot be combined with a folder of results"),
        (["run", folder], "name the design file, and --out"),
    ):
        assert main(["experiment", *arguments]) == 2
        assert text in capsys.readouterr().err


def test_report_is_one_file_with_everything(made, design, capsys):
    assert main(["experiment", "report", made, "-c", "units_per_h", "-c", "robots"]) == 0
    assert told(capsys) == "results/tiny/report.html: written\n"
    text = Path("results/tiny/report.html").read_text()
    assert "12 runs of 4 arms, 3 seeds" in text and "incomplete" not in text
    assert "Differences to robots=8,psa=nearest" in text and "robots x psa" in text
    assert text.count("data:image/png;base64,") == 4
    assert "Every run: units per hour" in text and "http" not in text
    # a design without factors, and with runs lacking
    path = str(design(file="more.toml", factors=None, seeds=[1, 2], name="single"))
    drive(experiments.plan(path), Store(Path("results/single")), Inline())
    design(file="more.toml", factors=None, seeds=[1, 2, 3], name="single", description="a < b")
    assert main(["experiment", "report", path, "-f", "r.html"]) == 3
    text = Path("r.html").read_text()
    assert "incomplete: 2 of 3 runs are finished" in text and "a &lt; b" in text
    assert "Differences" not in text
    assert main(["experiment", "report", made, "--baseline", "x"]) == 2


def test_analyses_of_variance_have_the_confidence_that_is_asked_for(made, capsys):
    chosen = ["-c", "units_per_h", "--confidence", "0.9"]
    assert main(["experiment", "table", made, "--anova", *chosen]) == 0
    assert "the 90% confidence interval" in " ".join(told(capsys).split())
    assert main(["experiment", "report", made, *chosen]) == 0
    text = Path("results/tiny/report.html").read_text()
    assert "the 90% confidence interval" in text and "95%" not in text


def test_experiments_are_listed(made, capsys):
    assert main(["experiment", "list"]) == 0
    out = told(capsys)
    assert "rule-screening" in out and "72 of 1620 controllers" in out
    (line,) = [line for line in out.splitlines() if "results/tiny" in line]
    assert line.split() == ["results/tiny", "tiny", "12", "of", "12", "0"]
    assert main(["experiment", "list", "elsewhere"]) == 0
    assert "elsewhere: no results of experiments" in told(capsys)


def test_pictures(made, capsys):
    assert main(["experiment", "plot", made, "--kind", "pareto", "-f", "p.png"]) == 0
    assert Path("p.png").exists() and Path("p.png.provenance.json").exists()
    columns = ["-c", "tasks_pick", "-c", "units_per_h"]
    assert main(["experiment", "plot", made, "--kind", "pareto", *columns]) == 2
    assert "--goal tasks_pick=more" in capsys.readouterr().err
    columns += ["--goal", "tasks_pick=less", "-f", "q.png"]
    assert main(["experiment", "plot", made, "--kind", "pareto", *columns]) == 0
    arguments = ["--kind", "interaction", "--factor", "robots", "--factor", "psa"]
    assert main(["experiment", "plot", made, *arguments, "-f", "i.svg"]) == 0
    assert main(["experiment", "plot", made, "--kind", "effects", "-f", "e.svg"]) == 0
    capsys.readouterr()
    assert main(["experiment", "plot", made]) == 0
    assert "results/tiny/intervals-units_per_h.png: written" in told(capsys)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["experiment", "plot", "DESIGN", "--kind", "pie"], "valid: intervals, effects"),
        (["experiment", "table", "DESIGN", "-c", "unit_per_h"], "did you mean units_per_h"),
        (["experiment", "table", "DESIGN", "-c", "layout"], "column layout: is not numeric"),
        (["experiment", "table", "DESIGN", "--baseline", "x"], "x: no such arm; arms: robots=8"),
        (["experiment", "table", "DESIGN", "--out", "empty"], "no finished runs yet"),
        (["experiment", "run", "nothing.toml"], "no such file, and no shipped design"),
        (["compare", "nothing", "results/tiny"], "nothing: neither a run folder"),
        (["compare", "results/tiny#x"], "x: no such arm"),
        (["compare", "results/tiny#robots=8,psa=random"], "nothing to compare: give two"),
        (["compare", "results/tiny", "-c", "unit"], "column unit: not in both"),
    ],
)
def test_wrong_usage_is_one_line_and_code_2(made, capsys, arguments, text):
    arguments = [made if argument == "DESIGN" else argument for argument in arguments]
    assert main(arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert text in line


def test_compare_arms(made, capsys):
    arms = [f"results/tiny#robots={robots},psa=nearest" for robots in (8, 16)]
    assert main(["compare", *arms, "-c", "units_per_h", "-c", "robots"]) == 0
    out = told(capsys)
    assert "layout.robots" in out and "paired by 3 common seeds" in out
    assert "+100.0%" in out
    assert "controllers.psa" not in out
    # one folder alone: all of its arms with the first
    assert main(["compare", "results/tiny", "-c", "units_per_h"]) == 0
    assert told(capsys).count("baseline  results/tiny#robots=8,psa=nearest") == 3


def test_compare_tables(made, capsys):
    to_csv(experiments.load("results/tiny"), Path("a.csv"))
    frame = pd.read_csv("a.csv")
    frame.assign(units_per_h=frame["units_per_h"] + 1.0).to_parquet("b.parquet")
    assert main(["compare", "a.csv", "results/tiny"]) == 0
    assert told(capsys).count("identical: all reproducible columns are the same") == 4
    assert main(["compare", "a.csv", "b.parquet", "--all"]) == 0
    out = told(capsys)
    assert "identical" not in out
    assert out.count("units_per_h") == 4 and "orders_per_h" not in out
    frame[frame["arm"] == "robots=8,psa=random"].assign(seed=range(7, 10)).drop(
        columns=["arm", "replication"]
    ).to_csv("c.csv", index=False)
    assert main(["compare", "results/tiny#robots=8,psa=random", "c.csv"]) == 0
    assert "no common seed: 3 and 3 runs treated as independent (Welch)" in told(capsys)
    assert main(["compare", "c.csv", "results/tiny"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "no arms have the same name" in line and "results/tiny#robots=8,psa=random" in line


def test_only_equal_seeds_are_compared_as_pairs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    units = {"units_per_h": [600.0, 620.0, 640.0]}
    apart = {"seed": [11, 12, 13], "replication": [1, 2, 3]}
    pd.DataFrame(apart | units).to_csv("a.csv", index=False)
    pd.DataFrame({"seed": [1, 2, 3]} | units).to_csv("b.csv", index=False)
    assert main(["compare", "a.csv", "b.csv"]) == 0
    assert "no common seed: 3 and 3 runs treated as independent (Welch)" in told(capsys)
    pd.DataFrame({"seed": [1, 2, 1]} | units).to_csv("c.csv", index=False)
    assert main(["compare", "b.csv", "c.csv"]) == 2
    assert "c.csv: has several rows with seed 1" in capsys.readouterr().err


def test_what_says_nothing_is_not_printed(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    head = {"seed": [1, 2], "units_per_h": [600.0, 620.0], "wall_s": [1.0, 9.0]}
    a = {"late_share": [0.0, 1e-7], "pick_station_idle_share": [0.5, 0.5]}
    b = {"late_share": [0.1, 0.2], "pick_station_idle_share": [-2.2e-16, 0.0]}
    pd.DataFrame(head | a).to_csv("a.csv", index=False)
    slower = {"units_per_h": [600.0, 620.0 + 1e-12], "wall_s": [2.0, 20.0]}
    pd.DataFrame(head | b | slower).to_csv("b.csv", index=False)
    for more in ([], ["--all"]):
        assert main(["compare", "a.csv", "b.csv", *more]) == 0
        out = told(capsys)
        assert "wall_s" not in out and "e-16" not in out and "00,000" not in out
        rows = {line.split()[0]: line.split()[1:] for line in out.splitlines() if "share" in line}
        assert rows["late_share"][:4] == ["5e-08", "0.15", "0.15", "-"]
        assert rows["pick_station_idle_share"][:4] == ["0.5", "0", "-0.5", "-100.0%"]
    (row,) = [line.split() for line in out.splitlines() if line.startswith("  units_per_h")]
    assert row[3:5] == ["0", "0%"]
    assert main(["compare", "a.csv", "b.csv", "-c", "wall_s"]) == 0
    assert "wall_s" in told(capsys)


def test_compare_runs(tmp_path, monkeypatch, capsys):
    from rmfs.measure import write_run
    from rmfs.simulation.run import simulate

    monkeypatch.chdir(tmp_path)
    short = [(["scenario", "duration_s"], 60.0)]
    for name, more in (("a", []), ("b", [(["layout", "robots"], 8)]), ("c", [])):
        run = simulate("basic", "basic", "default", seed=1, overrides=[*short, *more])
        write_run(run, Path(name))
    assert main(["compare", "a", "b"]) == 0
    out = told(capsys)
    assert "layout.parameters.robots" in out and "paired by 1 common seed" in out
    assert "interval" not in out.split("output")[1]
    assert main(["compare", "a#x", "b"]) == 2
    assert "a#x: a is a run, which has no arms" in capsys.readouterr().err
    assert main(["compare", "a", "c"]) == 0
    out = told(capsys)
    assert "identical" in out and "input: the same" in out


def test_compare_takes_the_seeds_with_a_value_on_both_sides(tmp_path, monkeypatch, capsys):
    """The difference is that of the two means beside it."""
    monkeypatch.chdir(tmp_path)
    nan = float("nan")
    a = {"seed": [1, 2, 3], "late_by_mean_s": [10.0, 20.0, 600.0], "units_per_h": [1.0, 2.0, 3.0]}
    b = {"seed": [1, 2, 3], "late_by_mean_s": [30.0, 60.0, nan], "units_per_h": [2.0, 3.0, 4.0]}
    pd.DataFrame(a).to_csv("a.csv", index=False)
    pd.DataFrame(b).to_csv("b.csv", index=False)
    assert main(["compare", "a.csv", "b.csv", "-c", "late_by_mean_s", "-c", "units_per_h"]) == 0
    out = told(capsys)
    (row,) = [line.split() for line in out.splitlines() if line.startswith("  late_by_mean_s")]
    assert row[1:5] == ["15", "45", "30", "+200.0%"]
    assert "late_by_mean_s: 2 of these seeds have a value on both sides" in out
    assert "units_per_h: " not in out


def test_compare_reads_arms_and_inputs_of_tables_as_they_are_written(tmp_path, monkeypatch, capsys):
    """No arm is left out because of its name; an input that is set nowhere does not differ."""
    monkeypatch.chdir(tmp_path)
    rows = {"arm": ["a", "a", "None", "None"], "seed": [1, 2] * 2, "scenario.packing.slots": None}
    pd.DataFrame({**rows, "units_per_h": [1.0, 2.0, 3.0, 5.0]}).to_csv("t.csv", index=False)
    assert main(["compare", "t.csv"]) == 0
    out = told(capsys)
    assert "other     t.csv#None" in out and "paired by 2 common seeds" in out
    assert "scenario.packing.slots" not in out and "input: the same" in out


def test_compare_shows_all_columns_of_own_measures(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    own = Column("crowd_mean", REAL, "robots", "Own measure")
    monkeypatch.setattr("rmfs.measure.dictionary._LEARNT", {own.name: own})
    for name, crowd in (("a", 3.0), ("b", 4.0)):
        rows = {"seed": [1, 2], "units_per_h": [1.0, 2.0], "crowd_mean": crowd}
        pd.DataFrame(rows).to_csv(f"{name}.csv", index=False)
    assert main(["compare", "a.csv", "b.csv", "--all"]) == 0
    out = told(capsys)
    assert "crowd_mean" in out and "units_per_h" not in out


def test_compare_refuses_several_rows_for_a_seed(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    pd.DataFrame({"seed": [1, 2, 1, 2], "units_per_h": [1.0, 2.0, 9.0, 9.0]}).to_csv("a.csv")
    pd.DataFrame({"seed": [1, 2], "units_per_h": [1.0, 2.0]}).to_csv("b.csv")
    assert main(["compare", "a.csv", "b.csv"]) == 2
    assert "a.csv: has several rows with seed 1" in capsys.readouterr().err


def test_compare_does_not_pair_arms_with_seeds_of_their_own(design, capsys):
    """Without common random numbers, the replications of two arms share no seed."""
    path = str(design(common_random_numbers=False))
    plan = experiments.plan(path)
    drive(plan, Store(Path("results/tiny")), Inline())
    names = [f"results/tiny#{arm.name}" for arm in plan.arms[:2]]
    assert main(["compare", *names]) == 0
    assert "no common seed: 3 and 3 runs treated as independent (Welch)" in told(capsys)
