"""Keeping what a run was asked for, so that it can be published and replayed."""

from __future__ import annotations

from rmfs.scenario.streams.stream import BundleStreamBuilder, OrderStreamBuilder


class StreamRecorder:
    """Collects the orders and bundles of a run as they come into being.

    Handed to `order_intake` and `bundle_intake`, it makes a stream of what depended on the run: the
    realised orders of a backlog, for example. `orders.build()` is a stream to be written with
    `write_stream` and read back with `mode = "stream"`.

    Attributes
    ----------
    orders, bundles
        What has come so far.
    """

    def __init__(self) -> None:
        self.orders = OrderStreamBuilder()
        self.bundles = BundleStreamBuilder()
