"""Skips these tests where the extra `learning` is not installed."""

import pytest

pytest.importorskip("gymnasium")
pytest.importorskip("pettingzoo")
