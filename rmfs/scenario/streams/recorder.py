"""Records the arrivals of a run, so that they can be published and replayed."""

from __future__ import annotations

from rmfs.scenario.streams.stream import BundleStreamBuilder, OrderStreamBuilder


class StreamRecorder:
    """Collects the orders and bundles of a run as they arrive.

    Passed to `order_intake` and `bundle_intake`, it records streams that depend on the run, such as
    the orders of a constant backlog. `orders.build()` is a stream: `write_stream` writes it to a
    file, which a scenario reads back with `mode = "stream"` in its table `demand`.

    Attributes
    ----------
    orders, bundles
        Arrivals so far.
    """

    def __init__(self) -> None:
        self.orders = OrderStreamBuilder()
        self.bundles = BundleStreamBuilder()
