"""Notifications of changes, for code that updates lists instead of checking everything again."""

from __future__ import annotations

_MOST = 16


class News:
    """Tells its followers which things, such as stations, have changed; things are numbered from 0.

    A controller that is replaced during a run does not unsubscribe its follower, so the number of
    followers is limited: the oldest are dropped. If a dropped follower calls `Follower.take`, it is
    subscribed again, and all things count as changed.

    Parameters
    ----------
    count
        Number of things.
    """

    def __init__(self, count: int) -> None:
        self.count = count
        self._followers: list[Follower] = []

    def tell(self, number: int) -> None:
        """Notify all followers that the thing with this number has changed."""
        for follower in self._followers:
            follower.changed.add(number)

    def keeps(self, follower: Follower) -> bool:
        """Whether a follower is currently subscribed."""
        return follower in self._followers

    def keep(self, follower: Follower) -> None:
        """Subscribe a follower; if there are too many, drop the oldest."""
        self._followers = [*self._followers[-_MOST + 1 :], follower]


class Follower:
    """A subscriber to `News`: collects the changes since the last call of `take`.

    Parameters
    ----------
    news
        The notifications to follow; initially everything counts as changed.

    Attributes
    ----------
    changed
        Numbers of the things that have changed.
    """

    def __init__(self, news: News) -> None:
        self._news = news
        self.changed = set(range(news.count))
        news.keep(self)

    def begin_anew(self) -> None:
        """Mark everything as changed."""
        self.changed = set(range(self._news.count))

    def take(self) -> set[int]:
        """Return the numbers of the things that have changed since the last call."""
        if not self._news.keeps(self):
            self._news.keep(self)
            self.begin_anew()
        changed = self.changed
        if changed:
            self.changed = set()
        return changed
