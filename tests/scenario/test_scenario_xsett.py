"""RAWSim-O's scenarios: element by element, as published, and broken."""

from __future__ import annotations

from pathlib import Path

import pytest
from rawsimo_files import XGENC
from rawsimo_files import xsett as xsett_file
from scenario_tools import DAY_US, SITE, FakeState, drive

from rmfs.errors import InputError
from rmfs.rawsimo.scenario import read_xsett
from rmfs.rawsimo.scenario.arrivals import down_periods, steps
from rmfs.scenario import Scenario, bundle_intake, order_intake, sku_set
from rmfs.scenario.loading import load_with_notes


def pairs(tag: str, values: dict[object, object]) -> str:
    rows = "".join(f"<P><Key>{key}</Key><Value>{v}</Value></P>" for key, v in values.items())
    return f"<{tag}>{rows}</{tag}>"


def read(folder: Path, inventory: str = "", general: str = "") -> tuple[Scenario, list[str]]:
    """Write a settings file with its SKUs, words and order list beside it, and read it."""
    return load_with_notes(xsett_file(folder, general=general, inventory=inventory))


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
    assert noted(notes, "limits the load in space units")


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
    assert noted(notes, "change exactly at the start of a step")
    assert noted(notes, "orders that stock cannot serve wait")
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
    assert [tuple(bundle) for bundle in bundles] == [(1_500_000, 1, 3, 6.0, 0)]
    assert noted(notes, "fixed orders have no due times")
    assert noted(notes, "BufferBundlesUntilInventoryLoad") is False
    with pytest.raises(InputError, match="OrderFile: is empty, but required if OrderMode is Fixed"):
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
    assert "Seed not used: the seed is an option of rmfs run" in notes
    assert noted(notes, "HeatMode not used: RAWSim-O no longer supports it")
    assert noted(notes, "OrderTimestampDueDateOffsetMean not used: RAWSim-O no longer supports it")
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
    "</SimpleItemConfiguration>": "names the file gone.xgenc, which is neither in the same folder",
    "<SimpleItemConfiguration><GeneratorConfigFile>/etc/passwd</GeneratorConfigFile>"
    "</SimpleItemConfiguration>": "names the file '/etc/passwd', which must end in .xgenc",
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
