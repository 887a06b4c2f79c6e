"""The single file holds everything, and allows nothing else."""

import base64
import gzip
import hashlib
import re
from pathlib import Path

import pytest

import rmfs
from rmfs.cli import main
from rmfs.measure import RunFolder
from rmfs.view import scene
from rmfs.view.container import unpack
from rmfs.view.export import export


def test_the_file_holds_page_and_scenes(runs: list[RunFolder], tmp_path: Path) -> None:
    export(runs, tmp_path / "two.html")
    text = (tmp_path / "two.html").read_text("utf-8")
    found = re.findall(r'<script type="application/octet-stream" data-scene>([^<]*)<', text)
    scenes = [gzip.decompress(base64.b64decode(one)) for one in found]
    assert scenes == [scene.of_run(run) for run in runs]
    assert not re.search(r"<(?:script|link|img)[^>]*(?:src|href)=\"(?!data:)", text)


def test_the_policy_names_script_and_style_by_their_hash(
    runs: list[RunFolder], tmp_path: Path
) -> None:
    export(runs[:1], tmp_path / "one.html")
    content = (tmp_path / "one.html").read_bytes()
    policy = re.search(rb'Content-Security-Policy" content="([^"]*)"', content)
    assert policy is not None
    for begin, end in ((b'<script type="module">', b"</script>"), (b"<style>", b"</style>")):
        inside = content.split(begin)[1].split(end)[0]
        digest = base64.b64encode(hashlib.sha256(inside).digest())
        assert b"'sha256-" + digest + b"'" in policy[1]


def test_the_same_run_gives_the_same_file(runs: list[RunFolder], tmp_path: Path) -> None:
    export(runs[:1], tmp_path / "a.html")
    export(runs[:1], tmp_path / "b.html")
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


@pytest.mark.parametrize("speeds", [None, [0.5]])
def test_with_pickers_no_constant_time_per_unit_is_told(
    tmp_path: Path, speeds: list[float] | None
) -> None:
    given = {"scenario.duration_s": 60.0}
    more = {} if speeds is None else {"scenario.pickers.speeds": speeds}
    run = rmfs.simulate("small", "small", "default", set=given | more, trace=True)
    header, _ = unpack(scene.of_run(run.save(tmp_path / "run")))
    for told, station in zip(header["stations"], run.layout.stations, strict=True):
        constant = speeds is None or told["kind"] != "pick"
        assert told["transfer_s"] == (station.kind.busy_s(station) if constant else 0.0)


def test_what_is_wrong_is_said_in_one_line(
    runs: list[RunFolder], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    out = ["--export", str(tmp_path / "out.html")]
    (folder / "run.json").write_bytes((runs[0].path / "run.json").read_bytes())
    assert main(["view", str(folder), *out]) == 2
    assert "run with --trace" in capsys.readouterr().err
    assert main(["view", str(tmp_path), *out]) == 2
    assert "is not a run folder" in capsys.readouterr().err
    assert main(["view", *3 * [str(folder)], *out]) == 2
    assert "at most 2" in capsys.readouterr().err
    for name in ("layout.json", "events.parquet", "trace.parquet"):
        (folder / name).write_bytes((runs[0].path / name).read_bytes()[:500])
        assert main(["view", str(folder), *out]) == 2
        message = capsys.readouterr().err
        assert message.count("\n") == 1
        (folder / name).write_bytes((runs[0].path / name).read_bytes())
    assert not (tmp_path / "out.html").exists()
