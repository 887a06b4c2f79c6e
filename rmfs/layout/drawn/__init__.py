"""Layouts drawn as text, and grid maps with stations."""

from __future__ import annotations

from rmfs.layout.drawn.picture_file import read_picture as read_picture
from rmfs.layout.drawn.station_map import read_station_map as read_station_map
from rmfs.layout.drawn.station_map import stations_file as stations_file
