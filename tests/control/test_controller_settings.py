"""Controllers files, overrides, and rules by name."""

from __future__ import annotations

import tomllib

import pytest
from typer.testing import CliRunner

from rmfs import control, instances
from rmfs.control import registry
from rmfs.control.base import NoParameters
from rmfs.control.commands import app
from rmfs.control.poa.pod_match import PodMatchParameters
from rmfs.control.problems import Problem
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.settings import DEFAULTS, settings
from rmfs.control.toml import to_toml
from rmfs.errors import InputError

HEAD = {"format": "rmfs-controllers/1", "name": "test"}


class FirstPlace(PodStorageAssignment[NoParameters]):
    """A rule from outside."""

    def place(self, robot):
        return int(self.view.storage.places[self.view.storage.is_empty][0])


@pytest.mark.parametrize("name", instances.names("controllers"))
def test_shipped_files_can_be_read(name) -> None:
    assert control.load(name).name == name


def test_the_default_file_says_what_the_defaults_are() -> None:
    """Nothing changes for a problem that a file leaves out."""
    shipped = control.load("default").choices
    assert shipped == settings(HEAD).choices
    assert {problem: choice.name for problem, choice in shipped.items()} == DEFAULTS


def test_parameters_are_read() -> None:
    chosen = settings({**HEAD, "poa": {"name": "pod-match", "fast_lane": False}})
    assert chosen.choices[Problem.POA].parameters == PodMatchParameters(fast_lane=False)


def test_a_table_without_name_sets_the_default_rule() -> None:
    chosen = settings({**HEAD, "poa": {"fast_lane": False}})
    assert chosen.choices[Problem.POA].name == "pod-match"


def test_what_is_shown_can_be_read_again(tmp_path) -> None:
    for name in instances.names("controllers"):
        given = control.load(name)
        file = tmp_path / f"{name}.toml"
        file.write_text(to_toml(given))
        assert control.load(file) == given


def test_values_that_toml_writes_in_another_way_than_json_are_read_again() -> None:
    rps = {"name": "emptiest", "buffer_timeout_s": float("inf")}
    given = settings({**HEAD, "description": "\x7f", "rps": rps})
    read = settings(tomllib.loads(to_toml(given)))
    assert (read.choices, read.description) == (given.choices, given.description)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"poaa": {}}, "unknown key poaa; did you mean poa?"),
        ({"poa": {"fastlane": True}}, "unknown key poa.fastlane; did you mean fast_lane?"),
        ({"psa": {"nme": "random"}}, "unknown key psa.nme; did you mean name?"),
        ({"psa": {"name": "neares"}}, "psa.name: no psa rule named neares; did you mean"),
        ({"psa": {"name": 3}}, "psa.name: must be a string"),
        ({"rps": {"buffer_threshold": 1.5}}, "rps: buffer_threshold: "),
        ({"psa": {"name": "nowhere:Rule"}}, "nowhere:Rule: there is no module nowhere"),
        ({"psa": {"name": "rmfs.control.psa:P"}}, "is not a controller"),
        ({"psa": {"name": "rmfs.control.sa.all:AllStations"}}, "solves sa, not psa"),
        ({"pps": {"pick_pod": ["nearst"]}}, "pick_pod"),
        ({"format": "rmfs-controllers/9"}, "format"),
    ],
)
def test_mistakes_are_named(table, message) -> None:
    with pytest.raises(InputError) as error:
        settings({**HEAD, **table})
    assert message in str(error.value)
    assert "\n" not in str(error.value)


class TestOverrides:
    def test_a_parameter(self) -> None:
        chosen = control.load("default", [(["rps", "buffer_threshold"], 0.5)])
        assert chosen.choices[Problem.RPS].parameters.buffer_threshold == 0.5

    def test_another_rule_drops_the_parameters_of_the_former(self) -> None:
        chosen = control.load("default", [(["poa", "name"], "random")])
        assert chosen.choices[Problem.POA].name == "random"

    def test_the_same_rule_keeps_them(self) -> None:
        chosen = control.load("random", [(["rps", "name"], "random")])
        assert chosen.choices[Problem.RPS].parameters.buffer_threshold == 0.1

    def test_another_rule_with_parameters_in_any_order(self) -> None:
        overrides = [(["rps", "buffer_threshold"], 0.3), (["rps", "name"], "random")]
        chosen = control.load("default", overrides).choices[Problem.RPS]
        assert chosen.name == "random"
        assert chosen.parameters.buffer_threshold == 0.3

    def test_a_plain_name_for_a_problem(self) -> None:
        assert control.load("default", [(["psa"], "random")]).choices[Problem.PSA].name == "random"


class TestRegistry:
    @pytest.mark.parametrize("problem", list(Problem))
    def test_every_rule_says_what_it_does_and_explains_its_parameters(self, problem) -> None:
        for name in registry.names(problem):
            rule = registry.find(problem, name)
            assert rule.__doc__
            for field, described in rule.parameters_model.model_fields.items():
                assert described.description, f"{problem} {name} {field}"

    def test_a_class_by_module_and_name(self) -> None:
        name = f"{__name__}:FirstPlace"
        chosen = settings({**HEAD, "psa": {"name": name}})
        assert chosen.choices[Problem.PSA].controller.__name__ == "FirstPlace"

    def test_entry_points(self, monkeypatch) -> None:
        class Entry:
            name = "psa.first"
            value = f"{__name__}:FirstPlace"

        monkeypatch.setattr(registry, "entry_points", lambda group: [Entry])
        registry._installed.cache_clear()
        try:
            assert registry.names(Problem.PSA)[-1] == "first"
            assert registry.find(Problem.PSA, "first").__name__ == "FirstPlace"
        finally:
            registry._installed.cache_clear()


class TestCommands:
    def run(self, *arguments: str):
        return CliRunner().invoke(app, list(arguments))

    def test_list(self) -> None:
        assert "default" in self.run("list").output
        assert "pod-match" in self.run("list", "--rules").output

    def test_show(self) -> None:
        shown = self.run("show", "default", "--set", "controllers.psa.name=random").output
        assert 'name = "random"' in shown
        assert "prefer_same_tier = true  # Whether" in shown

    def test_show_refuses_other_keys(self) -> None:
        assert isinstance(self.run("show", "default", "--set", "psa.name=x").exception, InputError)

    def test_check(self, tmp_path) -> None:
        assert "ok" in self.run("check", "random").output
        file = tmp_path / "wrong.toml"
        file.write_text('format = "rmfs-controllers/1"\nname = "x"\n[psa]\nname = "neerest"\n')
        assert "did you mean nearest" in str(self.run("check", str(file)).exception)
