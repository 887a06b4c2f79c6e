"""The picture: written, non-empty, repeatable, and with the colours people expect."""

from __future__ import annotations

import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

import rmfs.layout
from rmfs.errors import InputError
from rmfs.layout import LayoutParameters, colours, draw, generate, load, save_picture


def faces(ax):
    """Return how many patches there are of each face colour."""
    counts = {}
    for collection in ax.collections:
        found = collection.get_facecolor()
        if len(found):
            key = tuple(found[0])
            counts[key] = counts.get(key, 0) + len(collection.get_paths())
    return counts


def drawn(layout, **options):
    ax = Figure().add_subplot()
    assert draw(layout, ax, **options) is None
    return ax


@pytest.mark.parametrize("suffix", [".svg", ".png", ".pdf"])
def test_picture_is_written_whole(suffix, tmp_path):
    path = tmp_path / f"layout{suffix}"
    save_picture(load("default"), path, arrows=True)
    assert path.stat().st_size > 10_000
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_same_layout_same_file(tmp_path):
    for name in ("a.svg", "b.svg"):
        save_picture(load("default"), tmp_path / name)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_colours_and_counts():
    counts = faces(drawn(load("default")))
    assert counts[to_rgba(colours.PICK_STATION)] == 4
    assert counts[to_rgba(colours.REPLENISHMENT_STATION)] == 4
    assert counts[to_rgba(colours.ROBOT)] == 16
    assert counts[to_rgba(colours.STORAGE)] == 428
    assert counts[to_rgba(colours.FREE_STORAGE)] == 504 - 428


def test_pods_and_robots_can_be_left_out():
    counts = faces(drawn(load("default"), pods=False, robots=False, legend=False))
    assert counts[to_rgba(colours.FREE_STORAGE)] == 504
    assert to_rgba(colours.ROBOT) not in counts


def test_queue_zones_are_dotted_and_the_hallway_dashed():
    styles = {str(c.get_linestyle()) for c in drawn(load("default")).collections}
    assert len(styles) >= 3


def test_arrows_stand_on_one_way_edges_only():
    one_way = drawn(load("default"), arrows=True)
    layout = load("default", [(["two_directional_aisles"], True)])
    two_way = drawn(layout, arrows=True)

    def arrows(ax):
        return next(c.N for c in ax.collections if type(c).__name__ == "Quiver")

    assert arrows(one_way) > 1000
    assert arrows(two_way) < 200


def test_axes_are_in_metres_and_tiers_stand_side_by_side():
    layout = generate(
        LayoutParameters(
            tiers=2,
            elevators={"north": 1},
            pick_stations={"east": 1},
            robots=2,
            replenishment_stations={"west": 1},
        )
    )
    ax = drawn(layout)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x (m)", "y (m)")
    assert [text.get_text() for text in ax.texts] == ["tier 0", "tier 1"]
    assert [label.get_text() for label in ax.get_xticklabels()].count("0") == 2
    assert ax.get_xlim()[1] > 2 * layout.tiers[0].length_m


def test_unknown_picture_format(tmp_path):
    with pytest.raises(InputError, match=r"supported formats: \.svg, \.png, \.pdf"):
        save_picture(load("default"), tmp_path / "layout.gif")
    assert list(tmp_path.iterdir()) == []


def test_unknown_names_are_attribute_errors():
    with pytest.raises(AttributeError, match="has no attribute 'drow'"):
        rmfs.layout.drow  # noqa: B018
