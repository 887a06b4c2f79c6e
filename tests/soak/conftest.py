from pathlib import Path

import pytest

INSTANCES = Path(__file__).resolve().parents[2] / "../shared/reference/instances"


@pytest.fixture
def reference():
    """Path of a file of the reference system, or skip."""

    def path(name):
        file = INSTANCES / name
        if not file.is_file():
            pytest.skip(f"{file} is not here")
        return str(file)

    return path
