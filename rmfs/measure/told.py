"""The entries of `run.json` that are checked when a run is loaded; its other entries are not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import pydantic
from pydantic import Field

from rmfs.config import LARGEST, LARGEST_SEED
from rmfs.errors import InputError
from rmfs.measure.columns import DTYPES

if TYPE_CHECKING:
    from pathlib import Path

Index = Annotated[int, Field(ge=0)]
Seconds = Annotated[float, Field(ge=0, le=LARGEST, allow_inf_nan=False)]
Share = Annotated[float, Field(gt=0, le=1)]
SlowRobot = Annotated[tuple[Index, int, int, Share], Field(strict=False)]  # a list in JSON


class _Told(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(strict=True, frozen=True)


class Source(_Told):
    """The entry for the layout, scenario or controllers of a run; only its name is checked."""

    name: str


class OwnColumn(_Told):
    """The declaration of a column of a user-defined measure."""

    name: str
    dtype: str = Field(pattern="|".join(DTYPES))
    unit: str
    meaning: str
    measured: bool = False
    better: str = Field("neither", pattern="more|less|neither")


class OwnMeasure(_Told):
    """A user-defined measure."""

    columns: list[OwnColumn]


class Told(_Told):
    """The entries of `run.json` that are checked; those without a default are required.

    Attributes
    ----------
    slow_robots
        Periods in which a robot was slow. Each is a tuple of the robot, the start and end in us,
        and the robot's speed limit as a share of its top speed; see `rmfs.measure.checker.Slow`.
    """

    layout: Source
    scenario: Source
    controllers: Source
    seed: int = Field(ge=0, le=LARGEST_SEED)
    warmup_s: Seconds
    duration_s: Seconds
    slow_robots: list[SlowRobot] = []
    measures: list[OwnMeasure] = []

    @property
    def end_us(self) -> int:
        """End of the run in microseconds."""
        return round((self.warmup_s + self.duration_s) * 1e6)


def require_told(path: Path, parameters: dict[str, Any]) -> None:
    """Check the contents of a `run.json`, given as `parameters`.

    Raises
    ------
    InputError
        If something is missing or invalid; the message names it.
    """
    lacking = [key for key, field in Told.model_fields.items() if field.is_required()]
    lacking = [key for key in lacking if key not in parameters]
    if lacking:
        raise InputError(f"{path}: corrupted (missing: {', '.join(lacking)})")
    try:
        Told.model_validate(parameters)
    except pydantic.ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise InputError(f"{path}: corrupted ({where}: {first['msg']})") from None
