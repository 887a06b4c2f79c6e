"""How much storage places and the choice of robots matter at most: a clairvoyant experiment.

Models for PSA and TA can save no more than whoever knows all that is to come. Each run of the
default rules is looked at again after its end: with the same visits at the same moments, which
storage places would have led to the least loaded driving, and which robots to the least empty
driving? Both are solved to proven optimality. About 0.1 CPU hours.
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
