"""Import of RAWSim-O's files: what is kept, what is noted, what is refused."""

from __future__ import annotations

import pytest
from layout_reference import INSTANCES, needs_reference

from rmfs.errors import InputError
from rmfs.layout import load_with_notes, names

# An instance written by hand: a ring of six waypoints with ids that start anywhere, one lift
# between two tiers.
XINST = """<?xml version="1.0" encoding="utf-8"?>
<Instance Name="ring">
  <Bots>
    <Bot ID="5" X="0.6" Y="1.4" Radius="0.3" Orientation="1.5" Tier="7" PodTransferTime="3"
         MaxAcceleration="0.5" MaxDeceleration="0.6" MaxVelocity="1.5" TurnSpeed="2.5" />
  </Bots>
  <Pods><Pod ID="9" X="0.5" Y="0.5" Tier="7" Radius="0.4" Orientation="0" Capacity="500" /></Pods>
  <Elevators><Elevator ID="0">
    <Waypoints><Waypoint>103</Waypoint><Waypoint>200</Waypoint></Waypoints>
    <Timings><Timing>103/200/10</Timing><Timing>200/103/10</Timing></Timings>
    <Queues><Queues>103/103</Queues><Queues>200/200</Queues></Queues>
  </Elevator></Elevators>
  <InputStations>
    <InputStation ID="1" X="1.5" Y="0.5" Tier="7" Radius="0.4" Capacity="1000"
                  ItemBundleTransferTime="10" ActivationOrderID="1">
      <Queues><Queues>101/101</Queues></Queues>
    </InputStation>
  </InputStations>
  <OutputStations>
    <OutputStation ID="1" X="1.5" Y="1.5" Tier="7" Radius="0.4" Capacity="12"
                   ItemTransferTime="10" ActivationOrderID="1">
      <Queues><Queues>102/102</Queues></Queues>
    </OutputStation>
  </OutputStations>
  <Tiers>
    <Tier ID="7" Length="2" Width="2" RelativePositionZ="0" />
    <Tier ID="8" Length="2" Width="2" RelativePositionZ="4" />
  </Tiers>
  <Waypoints>
    <Waypoint ID="100" X="0.5" Y="0.5" Tier="7" Pod="9" InputStation="-1" OutputStation="-1"
              Elevator="-1" PodStorageLocation="true" IsQueueWaypoint="false">
      <Paths><Waypoint>101</Waypoint></Paths></Waypoint>
    <Waypoint ID="101" X="1.5" Y="0.5" Tier="7" Pod="-1" InputStation="1" OutputStation="-1"
              Elevator="-1" PodStorageLocation="false" IsQueueWaypoint="false">
      <Paths><Waypoint>102</Waypoint></Paths></Waypoint>
    <Waypoint ID="102" X="1.5" Y="1.5" Tier="7" Pod="-1" InputStation="-1" OutputStation="1"
              Elevator="-1" PodStorageLocation="false" IsQueueWaypoint="true">
      <Paths><Waypoint>103</Waypoint></Paths></Waypoint>
    <Waypoint ID="103" X="0.5" Y="1.5" Tier="7" Pod="-1" InputStation="-1" OutputStation="-1"
              Elevator="0" PodStorageLocation="false" IsQueueWaypoint="false">
      <Paths><Waypoint>100</Waypoint><Waypoint>200</Waypoint></Paths></Waypoint>
    <Waypoint ID="200" X="0.5" Y="1.5" Tier="8" Pod="-1" InputStation="-1" OutputStation="-1"
              Elevator="0" PodStorageLocation="false" IsQueueWaypoint="false">
      <Paths><Waypoint>103</Waypoint></Paths></Waypoint>
  </Waypoints>
  <Semaphores />
</Instance>
"""

XLAYO = """<?xml version="1.0"?>
<LayoutConfiguration>
  <NameLayout>small</NameLayout><BotCount>8</BotCount><MaxAcceleration>0.5</MaxAcceleration>
  <AisleLayoutType>HighwayHallway</AisleLayoutType><SingleLane>false</SingleLane>
  <NPickStationEast>2</NPickStationEast><NPickStationNorth>1</NPickStationNorth>
  <CollisionPenaltyTime>0.5</CollisionPenaltyTime>
</LayoutConfiguration>
"""


def read(text, tmp_path, suffix=".xinst"):
    path = tmp_path / f"file{suffix}"
    path.write_text(text, encoding="utf-8") if isinstance(text, str) else path.write_bytes(text)
    return load_with_notes(path)


def refused(text, tmp_path, suffix=".xinst"):
    with pytest.raises(InputError) as error:
        read(text, tmp_path, suffix)
    message = str(error.value)
    assert "\n" not in message
    assert message.startswith(str(tmp_path))
    return message


def test_instance_by_hand(tmp_path):
    layout, notes = read(XINST, tmp_path)
    assert (layout.name, layout.waypoints, layout.pods, layout.robots) == ("ring", 5, 1, 1)
    assert layout.pod_waypoint.tolist() == [0]
    assert layout.robot_waypoint.tolist() == [3]  # the nearest
    assert layout.robot_heading_rad.tolist() == [1.5]
    assert [tier.height_m for tier in layout.tiers] == [0.0, 4.0]
    assert layout.edge_target.tolist() == [1, 2, 3, 0]  # the lift is no edge
    assert layout.elevators[0].travel_s == {(3, 4): 10.0, (4, 3): 10.0}
    assert layout.elevators[0].queues == {3: (3,), 4: (4,)}
    station = layout.pick_stations[0]
    assert (station.waypoint, station.order_slots, station.activation) == (2, 12, 1)
    assert station.unit_pick_s == station.unit_transfer_s == 10.0
    assert notes == [
        "1 pick stations have no ItemPickTime: a unit occupies the robot as long as the station "
        "(ItemTransferTime)"
    ]


def test_unknown_elements_and_attributes_are_noted(tmp_path):
    text = XINST.replace('<Pod ID="9"', '<Pod ID="9" Colour="red"')
    text = text.replace("<Semaphores />", "<Batteries><Battery /></Batteries>")
    text = text.replace("<Timings>", "<Speed>3</Speed><Timings>")
    text = text.replace("<Paths><Waypoint>103", "<Paths><Path /><Waypoint>103")
    notes = read(text, tmp_path)[1]
    for name in ("Pod.Colour", "Instance/Batteries", "Elevator/Speed", "Paths/Path"):
        assert any(name in note and "left out" in note for note in notes), name


def test_what_has_no_meaning_here_is_noted(tmp_path):
    text = XINST.replace('TurnSpeed="2.5"', 'TurnSpeed="2.5" CollisionPenaltyTime="0.5"')
    text = text.replace(
        "<Semaphores />", '<Semaphores><Semaphore ID="0" Capacity="2" /></Semaphores>'
    )
    text = text.replace('Orientation="0"', 'Orientation="1"')
    text = text.replace('RelativePositionZ="4"', 'RelativePositionZ="4" RelativePositionX="9"')
    notes = " | ".join(read(text, tmp_path)[1])
    for part in ("CollisionPenaltyTime", "1 semaphores", "Pod.Orientation", "RelativePositionX"):
        assert part in notes


def test_what_is_filled_in_is_noted(tmp_path):
    text = XINST.replace(' ActivationOrderID="1"', "")
    text = text.replace('Pod="9"', 'Pod="-1"')  # the pod is found by its position
    text = text.replace("<Queues><Queues>101/101</Queues></Queues>", "")
    text = text.replace(
        'X="1.5" Y="1.5" Tier="7" Radius="0.4"', 'X="1.4" Y="1.5" Tier="7" Radius="0.4"'
    )
    layout, notes = read(text, tmp_path)
    assert layout.pod_waypoint.tolist() == [0]
    assert layout.replenishment_stations[0].queue == (1,)
    assert layout.x_m[2] == 1.4
    for part in (
        "InputStation.ActivationOrderID is missing",
        "1 pods are named by no waypoint",
        "InputStation 1: has no queue",
        "1 waypoints moved",
    ):
        assert any(part in note for note in notes), part


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('ID="100"', 'ID="101"', "Waypoint 101: the ID occurs twice"),
        ("<Waypoint>101</Waypoint>", "<Waypoint>999</Waypoint>", "there is no Waypoint 999"),
        ("<Waypoint>101</Waypoint>", "<Waypoint>x</Waypoint>", "expected the ID of a waypoint"),
        ('Tier="7" Pod="9"', 'Tier="6" Pod="9"', "Waypoint 100: there is no Tier 6"),
        ('Pod="9"', 'Pod="8"', "Waypoint 100: there is no Pod 8"),
        ('InputStation="1"', 'InputStation="-1"', "InputStation 1: no waypoint names it"),
        ('X="1.5" Y="0.5" Tier="7" Pod', 'X="" Y="0.5" Tier="7" Pod', "X expected a number"),
        ('MaxVelocity="1.5"', "", "Bot 5: MaxVelocity is missing"),
        ('MaxVelocity="1.5"', 'MaxVelocity="NaN"', "Bot 5: MaxVelocity expected a number"),
        ('MaxVelocity="1.5"', 'MaxVelocity="-1"', "robot_kinds.0.top_speed_m_s: "),
        ('Capacity="12"', 'Capacity="1.5"', "OutputStation 1: Capacity expected a whole number"),
        ('PodStorageLocation="true"', 'PodStorageLocation="yes"', "expected true or false"),
        ("103/200/10", "103/200", "Elevator 0: expected a timing FROM/TO/SECONDS"),
        ("102/102", "102", "OutputStation 1: expected a queue place KEY/PLACE"),
        ("102/102", "101/102", "OutputStation 1: one of its queues belongs to another waypoint"),
    ],
)
def test_wrong_instances_are_refused(old, new, expected, tmp_path):
    assert old in XINST
    assert expected in refused(XINST.replace(old, new), tmp_path)


def test_all_problems_of_an_instance_are_named(tmp_path):
    text = XINST.replace('MaxVelocity="1.5"', "").replace('Capacity="12"', 'Capacity="x"')
    message = refused(text, tmp_path)
    assert "MaxVelocity" in message
    assert "OutputStation 1: Capacity" in message


BOMB = """<?xml version="1.0"?>
<!DOCTYPE lolz [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>
<Instance Name="&b;" />"""
OUTSIDE = '<!DOCTYPE x [<!ENTITY f SYSTEM "file:///etc/passwd">]><Instance Name="&f;" />'


@pytest.mark.parametrize("suffix", [".xinst", ".xlayo"])
@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("", "empty"),
        ("  \n", "empty"),
        (XINST[: len(XINST) // 2], "not a complete XML file"),
        (b"\x00\x01\x02\xff\xfe" * 100, "not a complete XML file"),
        (b"PK\x03\x04" + bytes(200), "not a complete XML file"),
        ('<?xml version="1.0" encoding="none-such"?><a/>', "not a complete XML file"),
        ("<html></html>", "root element is <html>, expected <"),
        (BOMB, "declares a document type"),
        (OUTSIDE, "declares a document type"),
        ("<Instance>&undefined;</Instance>", "not a complete XML file"),
    ],
)
def test_broken_files_are_refused_in_one_line(content, expected, suffix, tmp_path):
    assert expected in refused(content, tmp_path, suffix)


def test_every_cut_of_a_file_is_an_input_error(tmp_path):
    for end in range(0, len(XINST.rstrip()) - 1, 97):
        refused(XINST[:end], tmp_path)


def test_parameters_by_hand(tmp_path):
    layout, notes = read(XLAYO, tmp_path, ".xlayo")
    assert layout.name == "small"
    assert layout.robots == 8
    assert len(layout.pick_stations) == 3
    assert len(layout.replenishment_stations) == 4
    assert layout.robot_kinds[0].acceleration_m_s2 == 0.5
    assert layout.robot_kinds[0].deceleration_m_s2 == 1.0
    assert "CollisionPenaltyTime is not used: robots never collide in rmfs" in notes
    assert "Seed is missing: 0 is used" in notes


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("<BotCount>8", "<BotCount>many", "BotCount: expected a whole number (given: 'many')"),
        ("<MaxAcceleration>0.5", "<MaxAcceleration>a", "MaxAcceleration: expected a number"),
        ("HighwayHallway", "Highway", "AisleLayoutType: expected Tim or HighwayHallway"),
        ("<SingleLane>false", "<SingleLane>no", "SingleLane: expected true or false"),
        ("<BotCount>8</BotCount>", "<BotCount>8</BotCount>" * 2, "BotCount occurs twice"),
        ("<NPickStationEast>2", "<NPickStationEast>9", "the east side has room for 4"),
    ],
)
def test_wrong_parameters_are_refused(old, new, expected, tmp_path):
    assert expected in refused(XLAYO.replace(old, new), tmp_path, ".xlayo")


def test_unknown_parameters_are_noted(tmp_path):
    text = XLAYO.replace("</LayoutConfiguration>", "<Colour>red</Colour></LayoutConfiguration>")
    notes = read(text, tmp_path, ".xlayo")[1]
    assert "LayoutConfiguration/Colour is unknown and was left out (1 times)" in notes


def test_missing_and_unknown_files(tmp_path):
    with pytest.raises(InputError, match="did you mean default"):
        load_with_notes("defalt")
    other = tmp_path / "layout.yaml"
    other.write_text("")
    endings = r"\.toml, \.json, \.txt, \.map, \.xlayo or \.xinst"
    with pytest.raises(InputError, match=f"must be {endings}"):
        load_with_notes(other)
    assert {"default", "basic"} <= set(names())


@needs_reference
@pytest.mark.parametrize(
    "path", sorted(INSTANCES.glob("*/*.xinst")), ids=lambda path: f"{path.parent.name}/{path.stem}"
)
def test_every_shipped_instance_is_imported(path):
    layout, notes = load_with_notes(path)
    assert layout.robots
    assert layout.pods
    assert all("unknown" not in note for note in notes)


@needs_reference
@pytest.mark.parametrize(
    "path", sorted(INSTANCES.glob("*/*.xlayo")), ids=lambda path: f"{path.parent.name}/{path.stem}"
)
def test_every_shipped_parameter_file_is_imported(path):
    layout, notes = load_with_notes(path)
    assert layout.robots
    assert all("unknown" not in note for note in notes)
