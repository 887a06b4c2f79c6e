"""Streams of orders and bundles: arrays that can be read, written, recorded and exported."""

from rmfs.scenario.streams.order_file import OrderFile as OrderFile
from rmfs.scenario.streams.reading import first_moment as first_moment
from rmfs.scenario.streams.reading import read_bundles as read_bundles
from rmfs.scenario.streams.reading import read_orders as read_orders
from rmfs.scenario.streams.recorder import StreamRecorder as StreamRecorder
from rmfs.scenario.streams.stream import BundleStream as BundleStream
from rmfs.scenario.streams.stream import BundleStreamBuilder as BundleStreamBuilder
from rmfs.scenario.streams.stream import OrderStream as OrderStream
from rmfs.scenario.streams.stream import OrderStreamBuilder as OrderStreamBuilder
from rmfs.scenario.streams.writing import digest as digest
from rmfs.scenario.streams.writing import write_stream as write_stream
from rmfs.scenario.streams.writing import write_streams as write_streams
