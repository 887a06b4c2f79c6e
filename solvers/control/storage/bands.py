"""Division of storage locations into zones by distance, and of pods into classes by visits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def bands(values: NDArray[np.float64], count: int) -> NDArray[np.int64]:
    """Sort things by value, lowest first, and divide them into bands of about equally many things.

    Parameters
    ----------
    values
        Value of each thing, shape (N,).
    count
        Maximum number of bands, positive.

    Returns
    -------
    Number of the band of each thing, from 0 without gaps, shape (N,); ties are broken by index.
    """
    band = np.empty(len(values), np.int64)
    order = np.argsort(values, kind="stable")
    band[order] = np.arange(len(values)) * min(count, len(values)) // max(len(values), 1)
    return band


def means(values: NDArray[np.float64], band: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the mean value of the things in each band.

    Parameters
    ----------
    values, band
        Value and band of each thing, shape (N,).

    Returns
    -------
    The mean of each band, shape (bands,).
    """
    mean: NDArray[np.float64] = np.bincount(band, weights=values) / np.bincount(band)
    return mean
