"""How much driving could be saved if PSA and TA had perfect foresight.

No PSA or TA rule can save more than decisions made with perfect knowledge of the future. After each
run of the default rules, two problems are therefore solved in retrospect, for the same visits at
the same times: which storage locations would have minimised loaded driving, and which choice of
robots would have minimised empty driving? For each of these problems, an upper bound on the saving
is proven. The study takes about 0.1 CPU hours.
"""

from __future__ import annotations

import sys

from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.tables import means

COLUMNS = (
    "units_per_h",
    "distance_per_unit_m",
    "stays",
    "foresight_storage_s",
    "foresight_storage_share",
    "lifts",
    "foresight_tasks_s",
    "foresight_tasks_share",
)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("foresight", __doc__).parse_args(arguments))
    study.publish(means(study.frame, COLUMNS, by="demand"), "foresight", COLUMNS)


if __name__ == "__main__":
    sys.exit(command(main))
