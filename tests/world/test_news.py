"""Those who follow news are told of every change, also after they had to go."""

from __future__ import annotations

import pickle

from rmfs.world.news import Follower, News


def test_at_first_everything_counts_as_changed() -> None:
    follower = Follower(News(3))
    assert follower.take() == {0, 1, 2}
    assert follower.take() == set()


def test_all_followers_are_told_each_change_once() -> None:
    news = News(5)
    one, other = Follower(news), Follower(news)
    one.take()
    other.take()
    news.tell(4)
    news.tell(4)
    news.tell(1)
    assert one.take() == {1, 4}
    news.tell(0)
    assert one.take() == {0}
    assert other.take() == {0, 1, 4}


def test_who_had_to_go_is_told_of_everything() -> None:
    news = News(2)
    first = Follower(news)
    first.take()
    others = [Follower(news) for _ in range(40)]
    news.tell(1)
    assert first.take() == {0, 1}
    assert first.take() == set()
    assert others[-1].take() == {0, 1}


def test_who_has_forgotten_is_told_of_everything() -> None:
    follower = Follower(News(2))
    follower.take()
    follower.begin_anew()
    assert follower.take() == {0, 1}


def test_a_copy_follows_the_copy_of_its_news() -> None:
    news = News(2)
    follower = Follower(news)
    follower.take()
    copied_news, copied = pickle.loads(pickle.dumps((news, follower)))
    news.tell(0)
    copied_news.tell(1)
    assert (follower.take(), copied.take()) == ({0}, {1})
