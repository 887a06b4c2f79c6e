"""Import of packages that only some experiments need, with a clear error if one is missing."""

from __future__ import annotations

import importlib
from typing import Any

from rmfs.errors import InputError


def optional(module: str, extra: str, purpose: str) -> Any:
    """Import a module of an optional package.

    Parameters
    ----------
    extra
        The extra of rmfs (such as `dask` in `rmfs[dask]`) that contains the package.
    purpose
        What needs the module; the error message begins with this text.

    Raises
    ------
    InputError
        If the package is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise InputError(
            f"{purpose} needs {module.split('.')[0]}, which is not installed ({error}); "
            f"pip install 'rmfs[{extra}]'"
        ) from None


def statsmodels(module: str) -> Any:
    """Import a module of statsmodels, given its name without the prefix `statsmodels.`."""
    return optional(f"statsmodels.{module}", "experiments", "this statistic")
