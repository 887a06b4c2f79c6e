"""RAWSim-O's scenarios: element by element, as published, and broken."""

from __future__ import annotations

import tomllib
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scenario_tools import DAY_US, SITE, FakeState, drive
from typer.testing import CliRunner

from rmfs.config import validate
from rmfs.errors import InputError
from rmfs.scenario import Scenario, bundle_intake, initial_stock, load, order_intake, sku_set
from rmfs.scenario.commands import app
from rmfs.scenario.loading import load_with_notes
from rmfs.scenario.parameters import SkuFile, StreamDemand
from rmfs.scenario.rawsimo import read_xitem, read_xsett, xsett
from rmfs.scenario.rawsimo.arrivals import down_periods, steps
from rmfs.scenario.sources import order_stream

XGENC = (
    "<SimpleItemGeneratorConfiguration><ItemDescriptions>"
    + "".join(f"<A><Key>{k}</Key><Value>1</Value></A>" for k in range(9))
    + "</ItemDescriptions></SimpleItemGeneratorConfiguration>"
)
XITEM = """<OrderList Type="Letter">
  <ItemDescriptions>
    <ItemDescription ID="4" Type="Letter" Weight="5" Letter="97" Color="Blue" />
    <ItemDescription ID="9" Type="Letter" Weight="2" Letter="98" Color="Red" />
  </ItemDescriptions>
  <ItemBundles><ItemBundle TimeStamp="1.5" ItemDescription="9" Size="3" /></ItemBundles>
  <Orders>
    <Order TimeStamp="2"><Positions>
      <Position ItemDescriptionID="9" Count="2" /><Position ItemDescriptionID="4" Count="1" />
    </Positions></Order>
    <Order TimeStamp="3.25"><Positions>
      <Position ItemDescriptionID="9" Count="1" />
    </Positions></Order>
  </Orders>
</OrderList>"""


def pairs(tag: str, values: dict[object, object]) -> str:
    rows = "".join(f"<P><Key>{key}</Key><Value>{v}</Value></P>" for key, v in values.items())
    return f"<{tag}>{rows}</{tag}>"


def read(folder: Path, inventory: str = "", general: str = "") -> tuple[Scenario, list[str]]:
    """Write a settings file with its SKUs, words and order list beside it, and read it."""
    (folder / "Mu-1000.xgenc").write_text(XGENC)
    (folder / "Small.txt").write_text("ab\nba\n")
    (folder / "list.xitem").write_text(XITEM)
    path = folder / "test.xsett"
    path.write_text(
        f"<SettingConfiguration>{general}<InventoryConfiguration>{inventory}"
        "</InventoryConfiguration></SettingConfiguration>"
    )
    return load_with_notes(path)


def noted(notes: list[str], text: str) -> bool:
    return any(text in note for note in notes)


def test_an_empty_file_is_all_defaults(tmp_path: Path):
    scenario, _ = read(tmp_path)
    assert scenario.name == "test"
    assert (scenario.duration_s, scenario.warmup_s) == (172800, 0)
    assert scenario.skus.file == (tmp_path / "Mu-1000.xgenc").resolve()
    assert scenario.skus.space_per_unit.value == 5
    assert (scenario.skus.bundle_units.min, scenario.skus.bundle_units.max) == (6, 6)
    lines, units = scenario.orders.lines, scenario.orders.units_per_line
    assert (lines.mean, lines.sd, lines.min, lines.max) == (1, 1, 1, 4)
    assert (units.mean, units.sd, units.min, units.max) == (1, 0.3, 1, 3)
    assert scenario.orders.due.mode == "priority"
    assert scenario.stock.initial_share == 0.7
    demand, replenishment = scenario.demand, scenario.replenishment
    assert (demand.mode, demand.orders, demand.pause_by_stock) == ("backlog", 200, True)
    assert (demand.pause_below_share, demand.resume_above_share) == (0.1, 0.6)
    assert (replenishment.bundles, replenishment.load_limit_share) == (200, 1.1)
    assert (replenishment.resume_below_share, replenishment.pause_above_share) == (0.65, 0.85)
    assert replenishment.return_share == 0.0


def test_every_general_value_and_the_backlogs(tmp_path: Path):
    fill = "".join(
        f"<{tag}>{value}</{tag}>"
        for tag, value in {
            "OrderCount": 7,
            "BundleCount": 8,
            "InventoryLevelDrivenBundleGeneration": "false",
            "InventoryLevelBundleStopThreshold": 0.9,
            "InventoryLevelBundleRestartThreshold": 0.8,
            "InventoryLevelDrivenOrderGeneration": "false",
            "InventoryLevelOrderStopThreshold": 0.2,
            "InventoryLevelOrderRestartThreshold": 0.3,
        }.items()
    )
    inventory = (
        "<InitialInventory>0.5</InitialInventory><ReturnOrderProbability>0.2"
        "</ReturnOrderProbability><ItemWeightMin>2</ItemWeightMin><ItemWeightMax>8</ItemWeightMax>"
        "<BundleSizeMin>4</BundleSizeMin><BundleSizeMax>12</BundleSizeMax>"
        "<BufferBundlesUntilInventoryLoad>1.3</BufferBundlesUntilInventoryLoad>"
        "<OrderPositionCountMax>3</OrderPositionCountMax><PositionCountMean>2</PositionCountMean>"
        "<DueTimePriorityMode>false</DueTimePriorityMode><DueTimeOffsetMean>9000"
        f"</DueTimeOffsetMean><DemandInventoryConfiguration>{fill}</DemandInventoryConfiguration>"
    )
    general = (
        "<Name>N</Name><SimulationWarmupTime>10</SimulationWarmupTime><SimulationDuration>600"
        "</SimulationDuration><CommentTag1>why</CommentTag1><CommentTag2 />"
    )
    scenario, notes = read(tmp_path, inventory, general)
    assert (scenario.name, scenario.description) == ("N", "why")
    assert (scenario.warmup_s, scenario.duration_s) == (10, 600)
    assert (scenario.skus.space_per_unit.min, scenario.skus.space_per_unit.max) == (2, 8)
    # the upper end is excluded there
    assert (scenario.skus.bundle_units.min, scenario.skus.bundle_units.max) == (4, 11)
    assert (scenario.orders.lines.max, scenario.orders.units_per_line.mean) == (3, 2)
    assert (scenario.orders.due.mode, scenario.orders.due.mean_s) == ("normal", 9000)
    assert (scenario.demand.orders, scenario.demand.pause_by_stock) == (7, False)
    assert (scenario.demand.pause_below_share, scenario.demand.resume_above_share) == (0.2, 0.3)
    replenishment = scenario.replenishment
    assert (replenishment.bundles, replenishment.pause_by_stock) == (8, False)
    assert (replenishment.resume_below_share, replenishment.pause_above_share) == (0.8, 0.9)
    assert (replenishment.load_limit_share, replenishment.return_share) == (1.3, 0.2)
    assert noted(notes, "compares space with space")


def test_down_periods_and_batches(tmp_path: Path):
    night = pairs("OrderList", {0: "true", 21600: "false", 79200: "true"})
    down = f"<DownPeriodConfiguration>{night}</DownPeriodConfiguration>"
    batches = (
        "<BatchInventoryConfiguration>"
        + pairs("OrderBatches", {36000: 400, 100: 3})
        + "<MaxTimeForBundleSubmissions>43200</MaxTimeForBundleSubmissions>"
        "</BatchInventoryConfiguration>"
    )
    inventory = (
        f"<SubmitBatches>true</SubmitBatches>{batches}"
        f"<DemandInventoryConfiguration>{down}</DemandInventoryConfiguration>"
    )
    scenario, notes = read(tmp_path, inventory)
    assert scenario.demand.down.periods_s == ((0, 21600), (79200, 86400))
    assert scenario.replenishment.down is None
    assert scenario.demand.batches.fill_to == ((100, 3), (36000, 400))
    assert scenario.replenishment.batches.fill_to == ((25200, 0.9),)
    assert scenario.replenishment.batches.cycle_s == 43200
    assert not noted(notes, "unknown")
    scenario, notes = read(tmp_path, inventory.replace("true</SubmitB", "false</SubmitB"))
    assert scenario.demand.batches is None
    assert noted(notes, "BatchInventoryConfiguration not used: SubmitBatches is not true")


def test_changes_become_periods():
    day = 86400.0
    assert down_periods([(21600, False), (79200, True)], day) == [[0, 21600], [79200, day]]
    assert down_periods([(0, True), (10, False), (20, True), (30, False)], 40) == [
        [0, 10],
        [20, 30],
    ]
    assert down_periods([(10, True), (20, True), (30, False)], 40) == [[10, 20], [20, 30]]
    assert steps([(10.0, 1.0), (20.0, 2.0)]) == {"starts_s": [0, 10, 20], "weights": [2, 1, 2]}


def poisson(folder: Path, body: str) -> tuple[Scenario, list[str]]:
    block = f"<PoissonInventoryConfiguration>{body}</PoissonInventoryConfiguration>"
    return read(folder, f"<OrderMode>Poisson</OrderMode>{block}")


def test_poisson_modes(tmp_path: Path):
    scenario, notes = poisson(tmp_path, "")
    assert (scenario.demand.orders_per_h, scenario.demand.initial_orders) == (160, 30)
    assert (scenario.replenishment.bundles_per_h, scenario.replenishment.initial_bundles) == (
        45,
        30,
    )
    assert scenario.demand.profile.kind == scenario.replenishment.profile.kind == "steps"
    assert scenario.demand.profile.weights != scenario.replenishment.profile.weights
    assert noted(notes, "hold exactly at the borders of steps")
    assert noted(notes, "what stock cannot serve waits")
    scenario, _ = poisson(
        tmp_path,
        "<PoissonMode>Simple</PoissonMode><AverageOrdersPerHourAndStation>12"
        "</AverageOrdersPerHourAndStation><DistortOrderRateParameter>PickStationsActivated"
        "</DistortOrderRateParameter><DistortBundleRateParameter>ReplenishmentStationsActivated"
        "</DistortBundleRateParameter>",
    )
    assert (scenario.demand.orders_per_h, scenario.demand.profile.kind) == (12, "constant")
    assert scenario.demand.tied_to == "pick-stations"
    assert scenario.replenishment.tied_to == "replenishment-stations"
    scenario, notes = poisson(
        tmp_path,
        "<PoissonMode>HighLow</PoissonMode><LowToHighSwitchesPerHour>3</LowToHighSwitchesPerHour>"
        "<HighAverageOrdersPerHourAndStation>99</HighAverageOrdersPerHourAndStation>",
    )
    profile = scenario.demand.profile
    assert (profile.high_per_h, profile.low_to_high_per_h, profile.high_to_low_per_h) == (99, 3, 2)
    assert scenario.replenishment.profile.kind == "constant"
    assert not noted(notes, "unknown")


def test_poisson_steps(tmp_path: Path):
    scenario, _ = poisson(
        tmp_path,
        "<MaxTimeForTimeDependentOrderRates>100</MaxTimeForTimeDependentOrderRates>"
        + pairs("TimeDependentOrderWeights", {50: 2, 0: 1}),
    )
    profile = scenario.demand.profile
    assert (profile.cycle_s, profile.starts_s, profile.weights) == (100, (0, 50), (1, 2))


def test_letters(tmp_path: Path):
    words = (
        "<ColoredWordConfiguration><WordFile>Small.txt</WordFile>"
        + pairs("ColorProbabilities", {"Blue": 0.5, "Red": 0.5, "Green": 0})
        + "</ColoredWordConfiguration>"
    )
    scenario, notes = read(
        tmp_path,
        "<ItemType>Letter</ItemType><OrderPositionCountMean>1</OrderPositionCountMean>" + words,
    )
    assert scenario.orders.content == "words"
    assert (scenario.replenishment.mode, scenario.replenishment.bundles) == ("needed", 200)
    assert not scenario.demand.pause_by_stock
    assert sku_set(scenario.skus).names == ("a blue", "a red", "b blue", "b red")
    assert noted(notes, "OrderPositionCountMean not used: a word has a line for each letter")


def test_fixed_orders(tmp_path: Path):
    fixed = "<FixedInventoryConfiguration><OrderFile>{}</OrderFile></FixedInventoryConfiguration>"
    inventory = "<OrderMode>Fixed</OrderMode><ItemType>Letter</ItemType>" + fixed
    scenario, notes = read(tmp_path, inventory.format("list.xitem"))
    skus = sku_set(scenario.skus)
    assert skus.ids.tolist() == [4, 9]
    assert skus.names == ("a blue", "b red")
    assert skus.popularity.tolist() == [1, 3]
    assert skus.space_per_unit.tolist() == [5, 2]
    orders = drive(order_intake(scenario, skus, SITE, 1), FakeState(2), DAY_US)
    assert [(o.time_us, o.skus, o.units) for o in orders] == [
        (2_000_000, (1, 0), (2, 1)),
        (3_250_000, (1,), (1,)),
    ]
    bundles = drive(bundle_intake(scenario, skus, SITE, 1), FakeState(2), DAY_US)
    assert [tuple(bundle) for bundle in bundles] == [(1_500_000, 1, 3, 6.0)]
    assert noted(notes, "fixed orders have no due times")
    assert noted(notes, "BufferBundlesUntilInventoryLoad") is False
    with pytest.raises(InputError, match="OrderFile: is empty, but OrderMode is Fixed"):
        read(tmp_path, inventory.format(""))


def test_overrides_of_the_layout_are_handed_on(tmp_path: Path):
    body = (
        "<OverrideBotMaxVelocity>true</OverrideBotMaxVelocity>"
        "<OverrideBotMaxVelocityValue>2.5</OverrideBotMaxVelocityValue>"
        "<OverrideOutputStationCapacity>true</OverrideOutputStationCapacity>"
        "<OverrideOutputStationCapacityValue>9</OverrideOutputStationCapacityValue>"
        "<OverrideBotCountPerOStation>true</OverrideBotCountPerOStation>"
        "<OverrideBotCountPerOStationValue>6</OverrideBotCountPerOStationValue>"
        "<OverridePodCapacity>false</OverridePodCapacity>"
        "<OverridePodCapacityValue>100</OverridePodCapacityValue>"
    )
    _, notes = read(tmp_path, general=f"<OverrideConfig>{body}</OverrideConfig>")
    imported = read_xsett(tmp_path / "test.xsett")
    assert imported.layout == [
        (["layout", "top_speed_m_s"], 2.5),
        (["layout", "order_slots"], 9),
        (["layout", "robots_per_pick_station"], 6),
    ]
    assert noted(notes, "--set layout.top_speed_m_s=2.5")
    assert noted(notes, "--set layout.robots_per_pick_station=6")
    assert noted(notes, "OverridePodCapacityValue not used: OverridePodCapacity is not true")
    assert not noted(notes, "unknown")


def test_what_is_dead_or_unknown_is_named(tmp_path: Path):
    _, notes = read(
        tmp_path,
        "<OrderTimestampDueDateOffsetMean>1</OrderTimestampDueDateOffsetMean><Colour>3</Colour>"
        "<PoissonInventoryConfiguration><Mode/></PoissonInventoryConfiguration>",
        "<HeatMode>NumItemsHandled</HeatMode><Seed>3</Seed><Moon>full</Moon>",
    )
    assert "Seed not used: the seed is given with the run" in notes
    assert noted(notes, "HeatMode not used: RAWSim-O itself has dropped it")
    assert noted(notes, "OrderTimestampDueDateOffsetMean not used: RAWSim-O itself")
    assert noted(notes, "PoissonInventoryConfiguration not used: belongs to another OrderMode")
    assert noted(notes, "Moon unknown")
    assert noted(notes, "Colour unknown")


WRONG = {
    "<OrderMode>Fancy</OrderMode>": "OrderMode: must be one of Fill, Poisson, Fixed (given: "
    "'Fancy')",
    "<InitialInventory>x</InitialInventory>": "InitialInventory: must be a finite number",
    "<InitialInventory>INF</InitialInventory>": "InitialInventory: must be a finite number",
    "<InitialInventory>2</InitialInventory>": "stock.initial_share: Input should be less",
    "<BundleSizeMin>1.5</BundleSizeMin>": "BundleSizeMin: must be a whole number (given: 1.5)",
    "<DueTimePriorityMode>yes</DueTimePriorityMode>": "must be true or false (given: 'yes')",
    "<SubmitBatches/><SubmitBatches/>": "SubmitBatches: occurs twice",
    "<SimpleItemConfiguration><GeneratorConfigFile>gone.xgenc</GeneratorConfigFile>"
    "</SimpleItemConfiguration>": "names the file gone.xgenc, which is not beside it",
    "<SimpleItemConfiguration><GeneratorConfigFile>/etc/passwd</GeneratorConfigFile>"
    "</SimpleItemConfiguration>": "names the file '/etc/passwd', expected a .xgenc file",
}


@pytest.mark.parametrize(("inventory", "problem"), WRONG.items())
def test_wrong_values_are_one_clear_error(tmp_path: Path, inventory: str, problem: str):
    with pytest.raises(InputError) as caught:
        read(tmp_path, inventory)
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'test.xsett'}: ")
    assert problem in message
    assert "\n" not in message


def test_files_are_looked_for_as_rawsimo_does(tmp_path: Path):
    (tmp_path / "Resources").mkdir()
    (tmp_path / "Resources/Own.xgenc").write_text(XGENC)
    folder = tmp_path / "a/b"
    folder.mkdir(parents=True)
    named = (
        "<SimpleItemConfiguration><GeneratorConfigFile>..\\c\\Own.xgenc</GeneratorConfigFile>"
        "</SimpleItemConfiguration>"
    )
    scenario, _ = read(folder, named)
    assert scenario.skus.file == (tmp_path / "Resources/Own.xgenc").resolve()
    (tmp_path / "a/c").mkdir()
    (tmp_path / "a/c/Own.xgenc").write_text(XGENC)
    scenario, _ = read(folder, named)
    assert scenario.skus.file == (tmp_path / "a/c/Own.xgenc").resolve()


# --- .xitem -------------------------------------------------------------------------------------

BROKEN_LISTS = [
    ('Count="2"', 'Count="-2"', "order 1: quantity must be from 1"),
    ('ItemDescriptionID="4"', 'ItemDescriptionID="5"', "order 1: sku 5 is unknown"),
    ('ItemDescriptionID="4"', 'ItemDescriptionID="9"', "order 1: sku 9 comes twice in order 1"),
    ('TimeStamp="3.25"', 'TimeStamp="1"', "order 2: time 1 is before that of the order before"),
    ('TimeStamp="3.25"', "", "order 2: time must be a number (empty)"),
    ('<Position ItemDescriptionID="9" Count="1" />', "", "order 2: sku must be a number (empty)"),
    ('Weight="2"', 'Weight="0"', "ItemDescription 9: Weight must be a positive number"),
    ('ID="9" Type', 'ID="4" Type', "ItemDescription 4 comes twice"),
    ('ID="9" Type', 'ID="x" Type', "ItemDescription: ID must be a whole number (given: 'x')"),
]


@pytest.mark.parametrize(("old", "new", "problem"), BROKEN_LISTS)
def test_broken_order_lists(tmp_path: Path, old: str, new: str, problem: str):
    assert old in XITEM
    path = tmp_path / "list.xitem"
    path.write_text(XITEM.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        order_stream(StreamDemand(file=path), sku_set(SkuFile(file=path)))
    assert str(caught.value).startswith(f"{path}: {problem}")


# --- all published files ------------------------------------------------------------------------

PUBLISHED = {
    "basic/BasicInstance": ("backlog", 1000),
    "core/jenPP": ("backlog", 100),
    "core/jenkinsObsolete": ("backlog", 18),
    "core/jenkinssetting1": ("backlog", 100),
    "core/jenkinssetting2": ("poisson", 100),
    "core/jenkinssetting3": ("backlog", 100),
    "demonstrator/steadysetting": ("backlog", 2),
    "fastlane/SimpleItem-Fill-200-200-172800": ("backlog", 1000),
    "mati/MaTi-SKU10": ("backlog", 10),
    "mati/MaTi-SKU100": ("backlog", 100),
    "mati/MaTi-SKU1000": ("backlog", 1000),
    "pp/PPMinimal": ("backlog", 1000),
}
DEAD = {
    "core/jenkinsObsolete": "HeatMode",
    "demonstrator/steadysetting": "HeatMode",
    "fastlane/SimpleItem-Fill-200-200-172800": "OrderTimestampDueDateOffsetMean",
    "pp/PPMinimal": "PPInstanceDumpFrequency",
}


def test_all_published_scenarios_are_imported(reference: Path):
    found = {}
    for path in sorted(reference.glob("*/*.xsett")):
        name = f"{path.parent.name}/{path.stem}"
        scenario, notes = load_with_notes(path)
        skus = sku_set(scenario.skus)
        found[name] = (scenario.demand.mode, len(skus))
        assert not noted(notes, "unknown"), name
        assert name not in DEAD or noted(notes, DEAD[name])
        initial_stock(skus, np.full(20, 500.0), scenario.stock.initial_share, seed=1)
        state = FakeState(len(skus))
        assert drive(order_intake(scenario, skus, SITE, 1), state, 7200 * 10**6), name
        bundle_intake(scenario, skus, SITE, 1)
    assert found == PUBLISHED


LISTS = ("ColorProbabilities", "TimeDependentOrderWeights", "TimeDependentBundleWeights")


def test_no_element_of_the_published_scenarios_is_dropped_silently(
    reference: Path, monkeypatch: pytest.MonkeyPatch
):
    """An element more in any block that is used is noted as unknown, so all others are known."""
    for path in sorted(reference.glob("*/*.xsett")):
        root = ElementTree.parse(path).getroot()
        monkeypatch.setattr(xsett, "read_root", lambda _path, _tag, given=root: given)
        for block in [block for block in root.iter() if len(block) and block.tag not in LISTS]:
            if block[0].tag == "Key":
                continue
            added = ElementTree.SubElement(block, "Unheard")
            notes = read_xsett(path).notes
            block.remove(added)
            used = not any(note.startswith(f"{block.tag} not used") for note in notes)
            assert noted(notes, "Unheard unknown") == used, (path, block.tag)


def test_the_published_order_list(reference: Path):
    path = reference / "resources/Letter-18-34-100-3518.56.xitem"
    order_list = read_xitem(path)
    assert order_list.notes == ()
    skus = sku_set(SkuFile(file=path))
    assert (len(skus), len(order_list.orders(skus)), len(order_list.bundles(skus))) == (18, 100, 34)
    assert skus.names[0] == "r blue"


# --- from the command line ----------------------------------------------------------------------


def run(*arguments: object) -> str:
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    assert result.exit_code == 0
    return result.output


def test_import_writes_a_scenario_that_needs_no_other_files(tmp_path: Path):
    source, target = tmp_path / "source", tmp_path / "target/mine.toml"
    source.mkdir()
    fixed = "<FixedInventoryConfiguration><OrderFile>list.xitem</OrderFile>"
    cases = {
        "simple": "",
        "letters": "<ItemType>Letter</ItemType><ColoredWordConfiguration><WordFile>Small.txt"
        "</WordFile></ColoredWordConfiguration>",
        "fixed": f"<OrderMode>Fixed</OrderMode>{fixed}</FixedInventoryConfiguration>",
        "poisson": "<OrderMode>Poisson</OrderMode>",
    }
    for name, inventory in cases.items():
        imported, _ = read(source, inventory, "<Moon>full</Moon>")
        output = run("import", source / "test.xsett", "--out", target, "--force")
        assert f"{target}: written" in output
        assert "note: Moon unknown" in output
        again = load(target)
        assert tomllib.loads(target.read_text())["name"] == "test"
        skus = sku_set(imported.skus)
        assert sku_set(again.skus).digest() == skus.digest(), name
        for intake_of in (order_intake, bundle_intake):
            come = [
                drive(intake_of(given, skus, SITE, 1), FakeState(len(skus)), DAY_US)
                for given in (imported, again)
            ]
            assert come[0] == come[1], name
    with pytest.raises(InputError, match="exists already; --force replaces it"):
        run("import", source / "test.xsett", "--out", target)
    with pytest.raises(InputError, match=r"expected a \.xsett file"):
        run("import", target)


def test_a_settings_file_serves_wherever_a_scenario_does(tmp_path: Path):
    read(tmp_path)
    path = tmp_path / "test.xsett"
    shown = run("show", path, "--set", "scenario.duration_s=60")
    table = tomllib.loads(shown[shown.index("format") :])
    assert validate(Scenario, table, "shown").duration_s == 60
    assert "ok, 9 SKUs" in run("check", path)


def test_sku_sets_from_the_command_line(tmp_path: Path):
    (tmp_path / "list.xitem").write_text(XITEM)
    out, picture = tmp_path / "skus.json", tmp_path / "curve.svg"
    told = run("sku-set", tmp_path / "list.xitem", "--out", out, "--picture", picture)
    assert "2 SKUs" in told
    assert picture.read_text().startswith("<?xml")
    assert run("sku-set", out).split("digest ")[1] == told.split("digest ")[1].split("\n")[0] + "\n"
    assert "1000 SKUs" in run("sku-set", "default", "--set", "scenario.skus.seed=4")
    with pytest.raises(InputError, match="exists already"):
        run("sku-set", "default", "--out", out)
    with pytest.raises(InputError, match=r"none\.json: no such file"):
        run("sku-set", tmp_path / "none.json")


def test_export_from_the_command_line(tmp_path: Path):
    path = tmp_path / "orders.csv"
    told = run("export", "poisson", path, "--seed", 3, "--set", "scenario.duration_s=60")
    digest = told.rsplit(" ", 1)[1].strip()
    replay = ["--set", f"scenario.demand={{mode='stream', file='{path}', digest='{digest}'}}"]
    assert f"orders, digest {digest}" in run("check", "default", *replay)
    bundles = tmp_path / "bundles.parquet"
    poisson = "scenario.replenishment={mode='poisson'}"
    assert "bundles, digest" in run(
        "export", "default", bundles, "--what", "bundles", "--set", poisson
    )
    stream = f"scenario.replenishment={{mode='stream', file='{bundles}'}}"
    assert "bundles, digest" in run("check", "default", "--set", stream)
    with pytest.raises(InputError, match="default: demand: its orders depend"):
        run("export", "default", tmp_path / "none.csv")
