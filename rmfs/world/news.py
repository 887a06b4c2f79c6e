"""News: which things have changed, for those who keep lists of their own and do not look at all."""

from __future__ import annotations

_MOST = 16


class News:
    """Tells followers the numbers of what has changed.

    A controller that is exchanged does not say goodbye, so that only so many followers are kept;
    one that was dropped and takes news again is told of everything.

    Parameters
    ----------
    count
        How many things there are.
    """

    def __init__(self, count: int) -> None:
        self.count = count
        self._followers: list[Follower] = []

    def tell(self, number: int) -> None:
        """Let all followers know that something has changed."""
        for follower in self._followers:
            follower.changed.add(number)

    def keeps(self, follower: Follower) -> bool:
        """Whether a follower is told at present."""
        return any(one is follower for one in self._followers)

    def keep(self, follower: Follower) -> None:
        """Tell a follower from now on; the one that has followed for longest may have to go."""
        self._followers = [*self._followers[-_MOST + 1 :], follower]


class Follower:
    """What has changed since somebody looked.

    Parameters
    ----------
    news
        What is followed; at first everything counts as changed.

    Attributes
    ----------
    changed
        Numbers of what has changed.
    """

    def __init__(self, news: News) -> None:
        self._news = news
        self.changed = set(range(news.count))
        news.keep(self)

    def begin_anew(self) -> None:
        """Let everything count as changed: who follows has forgotten what it knew."""
        self.changed = set(range(self._news.count))

    def take(self) -> set[int]:
        """Hand over the numbers of what has changed since the last time."""
        if not self._news.keeps(self):
            self._news.keep(self)
            self.begin_anew()
        changed = self.changed
        if changed:
            self.changed = set()
        return changed
