import numpy as np
import pytest

from rmfs.view.container import pack, unpack


def test_what_is_packed_comes_back() -> None:
    arrays = {
        "a": np.arange(5, dtype=np.uint8),
        "none": np.zeros(0, np.int32),
        "b": np.array([-1.5, np.pi]),
        "c": np.array([1.5], np.float32),
    }
    header, back = unpack(pack({"title": "Größe"}, arrays))
    assert header["title"] == "Größe"
    assert header["format"] == "rmfs-scene/1"
    assert list(back) == list(arrays)
    for name, array in arrays.items():
        assert back[name].dtype == array.dtype
        np.testing.assert_array_equal(back[name], array)


def test_arrays_are_aligned_whatever_the_header_says() -> None:
    for length in range(12):
        header, _ = unpack(pack({"t": "x" * length}, {"a": np.ones(3, np.uint8), "b": np.ones(2)}))
        assert [offset % 8 for _, offset, _ in header["arrays"].values()] == [0, 0]


@pytest.mark.parametrize(("content", "reason"), [(b"", "not a"), (b"PAR1" * 9, "not a")])
def test_strangers_are_refused(content: bytes, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        unpack(content)


def test_a_missing_end_is_noticed() -> None:
    with pytest.raises(ValueError, match="cut off"):
        unpack(pack({}, {"a": np.ones(100)})[:-8])
