"""Explicit layouts as JSON: every waypoint, edge, station, pod and robot is listed.

Each list entry is on a line of its own, so that two versions can be compared with diff tools.
"""

from rmfs.layout.explicit.reading import build as build
from rmfs.layout.explicit.reading import read_json as read_json
from rmfs.layout.explicit.writing import save_json as save_json
