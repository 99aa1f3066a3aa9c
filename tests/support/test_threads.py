"""Linear algebra of small matrices is not shared among threads."""

from dataclasses import dataclass

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import facegear as fg
from facegear.floquet.band_speeds import band_speeds
from facegear.maps.closing import largest_growth
from facegear.maps.sensitivity import sensitivity
from facegear.mechanics.classical_pairs import GearPair
from facegear.support.threads import one_thread


def threads() -> set[int]:
    """Return the number of threads of each BLAS library loaded."""
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


@pytest.fixture
def two_threads():
    with threadpool_limits(limits=2, user_api="blas"):
        if threads() != {2}:
            pytest.skip("this BLAS has one thread")
        yield


def test_within_the_block_alone(two_threads):
    with one_thread():
        assert threads() == {1}
    assert threads() == {2}


SEEN: list[set[int]] = []


@dataclass(frozen=True)
class Watched:
    """A model that notes with how many threads it is asked for its system."""

    own: GearPair

    @property
    def coordinates(self):
        return self.own.coordinates

    def system(self, speed):
        SEEN.append(threads())
        return self.own.system(speed)


SPEEDS = (1.0, 2.4)


@pytest.mark.parametrize(
    "work",
    [
        lambda model: band_speeds(model, SPEEDS, order=1, points=5),
        lambda model: fg.tongues(model, SPEEDS, progress=False),
        lambda model: sensitivity(model, 2.0, ("own.shaft_damping",)),
        lambda model: fg.campbell(model, np.linspace(*SPEEDS, 3)),
        lambda model: largest_growth(model, SPEEDS),
    ],
)
def test_functions_that_take_long_have_one_thread(two_threads, work):
    SEEN.clear()
    work(Watched(GearPair(contact_ratio=1.563, shaft_damping=0.02)))
    # What is asked for first may be whether there is a system at all.
    assert SEEN[-1] == {1}
    assert threads() == {2}
