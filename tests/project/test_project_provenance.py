"""What is published was made by code that can be had."""

import json
import subprocess

import pytest
from project_files import ROOT


def git(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)


def commits_named() -> dict[str, str]:
    """Return the commits that the provenance of published results names, each with one file."""
    found = {}
    for path in sorted((ROOT / "results" / "published").glob("*.provenance.json")):
        told = json.loads(path.read_text(encoding="utf-8"))
        for code in (told.get("written_by", {}), *told.get("runs_made_by", [])):
            if commit := code.get("git_commit"):
                found.setdefault(commit, path.name)
    return found


@pytest.mark.slow  # a clone need not hold the whole history
def test_commits_that_made_published_results_are_in_the_history():
    if git("rev-parse", "--is-shallow-repository").stdout.strip() != "false":
        pytest.skip("no history here")
    named = commits_named()
    assert named
    lost = {
        commit: name
        for commit, name in named.items()
        if git("merge-base", "--is-ancestor", commit, "HEAD").returncode
    }
    assert lost == {}
