"""Rule screening: which decisions matter (Merschformann, Lamballais, de Koster, Suhl 2019).

The cited study combined rules for five decision problems in 1620 ways. It found that pick order
assignment (POA) strongly affects the units picked per hour, and that the other four problems do
not. Here, 72 of these combinations are run with common seeds. They are chosen to estimate the main
effects as precisely as possible. An analysis of variance shows what share of the variation each
problem explains. To run all combinations on a cluster, use `--design rule-factorial`.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rmfs.experiments.papers.study import command, done, parser
from rmfs.experiments.plotting import draw
from rmfs.experiments.statistics import anova, per_arm
from rmfs.experiments.statistics.anova import POOLED, RESIDUAL, SEEDS
from rmfs.experiments.tables import effects, means

if TYPE_CHECKING:
    import pandas as pd

COLUMN = "units_per_h"
BEST = 10


def strongest(found: pd.DataFrame) -> str:
    """Return the factor that explains most of the variation; "none" if its effect has p >= 0.05."""
    others = [name for name in (SEEDS, POOLED, RESIDUAL) if name in found.index]
    factors = found.drop(index=others)
    first = factors.index[0]
    return str(first) if factors["p"][first] < 0.05 else "none"


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    study = done(parser("rule-screening", __doc__).parse_args(arguments))
    plan, frame = study.plan, study.frame
    found = anova(frame, COLUMN, plan.factors, names=plan.short_names)
    study.publish(effects(found, COLUMN), "rule-screening-anova", [COLUMN])
    order = per_arm(frame, COLUMN)["mean"].sort_values(ascending=False, kind="stable").index
    best = frame.set_index("arm").loc[list(order[:BEST])].reset_index()
    study.publish(means(best), "rule-screening-best", [COLUMN])
    path = study.published / "rule-screening.png"
    draw("effects", plan, frame, study.folder, [COLUMN], path)
    study.record(path, [COLUMN], kind="effects", confidence=0.95)
    print(f"strongest factor for {COLUMN}: {strongest(found)}")
    print(path)


if __name__ == "__main__":
    sys.exit(command(main))
