"""What the server has heard, across a kill."""

import pytest

from rmfs.demonstrator.server.journal import Journal
from rmfs.errors import InputError

SETTINGS = {"seed": 1}
HEARD = [(0, {"type": "tag", "tag": "W1"})]


def test_what_was_noted_is_known_again(tmp_path):
    path = tmp_path / "journal"
    first = Journal(path, SETTINGS)
    assert first.begins_us == -1
    first.note(50_000, HEARD, frozenset({2}))
    first.note(150_000, [], frozenset())
    # killed: not closed
    again = Journal(path, SETTINGS)
    assert again.begins_us == 150_000
    assert again.heard_at(50_000) == (HEARD, frozenset({2}))
    assert again.heard_at(100_000) == ([], frozenset())
    again.note(200_000, HEARD, frozenset())
    assert Journal(path, SETTINGS).begins_us == 200_000


def test_a_line_cut_off_by_the_kill_is_dropped(tmp_path):
    path = tmp_path / "journal"
    Journal(path, SETTINGS).note(50_000, HEARD, frozenset())
    whole = path.read_bytes()
    for cut in range(1, 20):
        path.write_bytes(whole + whole.splitlines(keepends=True)[1][:-cut])
        journal = Journal(path, SETTINGS)
        assert journal.begins_us == 50_000
        journal.close()
        assert path.read_bytes() == whole


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "is not a journal of this demonstration"),
        (
            '{"format": "rmfs-journal/1", "settings": {"seed": 2}}\n',
            "is not a journal of this demonstration",
        ),
        ('{"format": "rmfs-journal/1", "settings": {"seed": 1}}\n{}\n', "line 2 is damaged"),
    ],
)
def test_another_journal_is_refused_and_left_alone(tmp_path, text, why):
    path = tmp_path / "journal"
    path.write_text(text)
    with pytest.raises(InputError, match=why):
        Journal(path, SETTINGS)
    assert path.read_text() == text
