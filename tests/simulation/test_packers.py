"""Packers by themselves: what queueing theory says of Poisson arrivals."""

from __future__ import annotations

from math import factorial, sqrt
from types import SimpleNamespace

import numpy as np
import pytest

from rmfs.observer import Observer
from rmfs.scenario.parameters import Packing
from rmfs.simulation.agenda import Agenda
from rmfs.simulation.packing.packers import Packers
from rmfs.world.put_wall import PutWall

SERVICE_S, CUSTOMERS, BATCHES = 30.0, 20_000, 40


def waits(load, seed, **given):
    """Waits of orders that arrive at random, in s, after the first tenth."""
    packing = Packing(order_s=SERVICE_S, **given)
    agenda, rng = Agenda(), np.random.default_rng(seed)
    world = SimpleNamespace(now_s=0.0, put_wall=PutWall(None, slot_per_part=True))
    packers = Packers(packing, agenda=agenda, world=world, events=Observer(), rng=rng)
    mean_s = SERVICE_S / (load * packing.packers)
    arrivals = np.cumsum(np.random.default_rng(seed + 1).exponential(mean_s, CUSTOMERS))
    parcels = []

    def arrive(index):
        tote = world.put_wall.release(SimpleNamespace(index=index), 0, world.now_s, last=True)
        world.put_wall.arrive(tote, world.now_s)
        parcels.append(tote.parcel)
        packers.add(tote.parcel)

    for index, time_s in enumerate(arrivals.tolist()):
        agenda.at(round(time_s * 1e6), lambda index=index: arrive(index))
    while len(agenda):
        agenda.now_us = agenda.next_us
        world.now_s = agenda.now_us / 1e6
        agenda.run_due()
    assert (packers.busy, len(packers.waiting)) == (0, 0)
    assert world.put_wall.orders_packed == CUSTOMERS
    told = np.array([parcel.packing_s - parcel.consolidated_s for parcel in parcels])
    return told[CUSTOMERS // 10 :]


def erlang_c(servers, offered):
    """Probability that a customer of M/M/c waits (Erlang's second formula)."""
    top = offered**servers / factorial(servers) * servers / (servers - offered)
    return top / (sum(offered**k / factorial(k) for k in range(servers)) + top)


def interval(values):
    """Mean, and half of a 99.9 % interval, by batch means."""
    means = values[: len(values) // BATCHES * BATCHES].reshape(BATCHES, -1).mean(axis=1)
    return means.mean(), 3.56 * means.std(ddof=1) / sqrt(BATCHES)


@pytest.mark.parametrize(("servers", "load"), [(1, 0.5), (2, 0.7), (4, 0.8)])
def test_exponential_times_are_m_m_c(servers, load):
    mean, half = interval(waits(load, 5, packers=servers, variation=1.0))
    expected = erlang_c(servers, load * servers) * SERVICE_S / (servers * (1 - load))
    assert abs(mean - expected) < half
    assert half < 0.35 * expected


@pytest.mark.parametrize(("load", "variation"), [(0.6, 0.0), (0.8, 0.0), (0.6, 0.5), (0.6, 1.5)])
def test_one_packer_is_pollaczek_and_khinchine(load, variation):
    """M/G/1, M/D/1 among it: the mean wait has load x time x (1 + variation²) / (2 (1 - load))."""
    mean, half = interval(waits(load, 9, packers=1, variation=variation))
    expected = load * SERVICE_S * (1 + variation**2) / (2 * (1 - load))
    assert abs(mean - expected) < half
    assert half < 0.35 * expected
