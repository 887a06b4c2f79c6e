"""Types of the files to which a scenario refers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import pydantic


def existing(*suffixes: str) -> pydantic.AfterValidator:
    """Return a validator that requires a file to exist and to have one of the suffixes.

    Parameters
    ----------
    suffixes
        Allowed suffixes, such as `.csv`; if none are given, any suffix is allowed.
    """

    def check(path: Path) -> Path:
        if suffixes and path.suffix.lower() not in suffixes:
            raise ValueError(f"must end in {' or '.join(suffixes)}")
        if not path.is_file():
            raise ValueError("no such file")
        return path

    return pydantic.AfterValidator(check)


StreamFile = Annotated[Path, pydantic.Strict(strict=False), existing(".csv", ".parquet", ".xitem")]
"""A file of orders or bundles with their arrival times."""

SkuSetFile = Annotated[
    Path,
    pydantic.Strict(strict=False),
    existing(".json", ".csv", ".parquet", ".xgenc", ".xitem"),
]

WordFile = Annotated[Path, pydantic.Strict(strict=False), existing()]
