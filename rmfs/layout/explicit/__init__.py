"""Explicit layouts as JSON: every waypoint, edge, station, pod and robot written out.

One list entry per line, so that two versions of a layout can be compared with ordinary tools.
"""

from rmfs.layout.explicit.reading import build as build
from rmfs.layout.explicit.reading import read_json as read_json
from rmfs.layout.explicit.writing import save_json as save_json
