from pathlib import Path

import pytest

from rmfs.layout import load

INSTANCES = Path(__file__).resolve().parents[2] / "../shared/reference/instances"


@pytest.fixture
def reference():
    """Loads a layout of the reference system, or skips."""

    def load_reference(name, **overrides):
        path = INSTANCES / name
        if not path.is_file():
            pytest.skip(f"{path} is not here")
        return load(str(path), [([key], value) for key, value in overrides.items()])

    return load_reference
