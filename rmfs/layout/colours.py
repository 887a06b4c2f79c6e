"""The colours of warehouse elements, the same in all figures and in the viewer.

They follow the usual convention: pick stations are red, replenishment stations yellow, robots green
and storage locations blue. Most colours are from the palette of Okabe and Ito, which people with
common kinds of colour blindness can distinguish.
"""

PICK_STATION = "#D55E00"
REPLENISHMENT_STATION = "#F0E442"
ELEVATOR = "#CC79A7"
ROBOT = "#009E73"
STORAGE = "#0072B2"
FREE_STORAGE = "#DCEBF5"
QUEUE_ZONE = "#555555"
HALLWAY = "#888888"
ROAD = "#D0D0D0"
ARROW = "#777777"
OUTLINE = "#222222"

STATES = {
    "driving": ROBOT,
    "turning": "#56B4E9",
    "lifting, setting down": "#CC79A7",
    "in an elevator": "#7B3294",
    "queueing": "#E69F00",
    "waiting": "#D55E00",
    "served": "#F0E442",
    "idle": "#999999",
}
"""Colours of robots by what they are doing."""

LOADS = {"without pod": ROBOT, "with pod": STORAGE}
"""Colours of robots by what they carry."""
