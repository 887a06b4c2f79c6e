"""Records the arrivals of a run, so that they can be published and replayed."""

from __future__ import annotations

from rmfs.scenario.streams.stream import BundleStreamBuilder, OrderStreamBuilder


class StreamRecorder:
    """Collects the orders and bundles of a run as they arrive.

    If it is passed to `order_intake` and `bundle_intake`, it records all arrivals, including those
    that depend on the run, such as the orders of a constant backlog. `orders.build()` and
    `bundles.build()` return streams, which `write_stream` writes to files. A scenario can read such
    a file if its table `demand` (for bundles: `replenishment`) contains `mode = "stream"`.

    Attributes
    ----------
    orders, bundles
        Arrivals so far.
    """

    def __init__(self) -> None:
        self.orders = OrderStreamBuilder()
        self.bundles = BundleStreamBuilder()
