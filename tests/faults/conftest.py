from pathlib import Path

import pytest
from injection import Injector, built


@pytest.fixture(scope="session")
def shim(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = built(tmp_path_factory.mktemp("shim"))
    if made is None:
        pytest.skip("no C compiler")
    return made


@pytest.fixture
def injector(shim: Path, tmp_path: Path):
    """Return what makes an injector for a function, and the folder whose files it spoils."""
    below = tmp_path / "place"
    below.mkdir()
    made: list[Injector] = []

    def make(what: str) -> tuple[Injector, Path]:
        made.append(Injector(shim, below, what))
        return made[-1], below

    yield make
    for one in made:
        one.close()
