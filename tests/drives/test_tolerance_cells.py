"""Search in a box by cells: Mathieu's equation whose modulation is best tuned somewhere inside the box."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from facegear.drives import tolerance_cells as module
from facegear.drives.intervals import cut, united
from facegear.drives.tolerance_cells import BoxSearch, Cell
from facegear.floquet.labels import Combination
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.classical import Mathieu

DAMPING_RATIO = 0.01
# The first tongue is open where ε > 4 ϑ, to first order in both.
OPENS = 4.0 * DAMPING_RATIO
RANGE = (1.9, 2.2)


@dataclass(frozen=True)
class Tuned:
    """Strength of the first tongue over what opens it: `peak` at one stiffness, less beside."""

    peak: float
    tuned_at: float = 1.05
    width: float = 0.06
    stiffness_factor: float = 1.0
    damping_factor: float = 1.0

    contact_ratio = 1.5

    def system(self, frequency):
        away = (self.stiffness_factor - self.tuned_at) / self.width
        # Damping keeps its value in N s/m.
        ratio = DAMPING_RATIO * self.damping_factor / math.sqrt(self.stiffness_factor)
        own = math.sqrt(self.stiffness_factor)
        return Mathieu(self.peak * OPENS * math.exp(-(away**2)), ratio, own).system(frequency)


def searched(model, stiffness=0.1, damping=0.0, speeds=RANGE):
    search = BoxSearch(model, {"stiffness": stiffness, "damping": damping}, speeds)
    search.run()
    return search, *(cut(united(part), speeds) for part in (search.swept, search.possible))


def test_a_tongue_open_at_no_corner_of_a_coarse_cell_is_found_inside_it():
    model = Tuned(peak=1.15)
    assert not any(tongues(Tuned(1.15, stiffness_factor=f), RANGE) for f in (0.9, 1.0, 1.1))
    search, swept, possible = searched(model)
    assert swept
    unstable = [f for f, found in search.points.items() if found]
    assert all(abs(f - 1.05) < 0.03 for f, _ in unstable)
    # Wherever it is open, with every stiffness between: it moves with the root of that.
    for f in np.linspace(0.9, 1.1, 41).tolist():
        for tongue in tongues(Tuned(1.15, stiffness_factor=f), RANGE):
            assert any(low <= tongue.lower and tongue.upper <= high for low, high in possible)


def test_what_is_far_from_open_is_stable_and_what_is_nearly_open_is_not_known():
    _, swept, possible = searched(Tuned(peak=0.6))
    assert (swept, possible) == ((), ())
    _, swept, possible = searched(Tuned(peak=0.97))
    assert swept == ()
    assert possible
    # 2 √k at the best tuned stiffness.
    assert any(low < 2.0 * math.sqrt(1.05) < high for low, high in possible)


def test_it_is_not_missed_where_it_comes_into_the_range_from_outside():
    low = 2.0 * math.sqrt(1.08)
    speeds = (low, 1.02 * low)
    model = Tuned(peak=1.6, tuned_at=1.1, width=0.05)
    assert not tongues(model, speeds)
    _, _, possible = searched(model, speeds=speeds)
    for f in np.linspace(1.0, 1.1, 21).tolist():
        for tongue in tongues(Tuned(1.6, 1.1, 0.05, f), speeds):
            assert any(a <= tongue.lower and tongue.upper <= b for a, b in possible)


def test_less_damping_opens_it():
    search, swept, _ = searched(Tuned(peak=0.9, width=1.0), damping=0.3)
    assert swept
    assert {damping for (_, damping), found in search.points.items() if found} == {0.7}
    # Without a range of damping nothing is halved: all is known.
    assert searched(Tuned(peak=0.9, width=1.0), stiffness=0.0)[1:] == ((), ())


def test_what_work_does_not_reach_is_left_open(monkeypatch):
    monkeypatch.setattr(module, "_SECONDS", 0.0)
    search, swept, possible = searched(Tuned(peak=1.15))
    assert swept == ()
    assert any(low < 2.0 * math.sqrt(1.05) < high for low, high in possible)
    assert {f for f, _ in search.points} == {0.9, 1.0, 1.1}


@dataclass(frozen=True)
class UnderLoad(Tuned):
    """Strength like that of the fourth harmonic of a pair that stays in mesh for 5.5 periods, longer if softer."""

    @property
    def contact_ratio(self):
        return 5.5 - 1.24 * (self.stiffness_factor - 1.0)

    def system(self, frequency):
        strength = self.peak * OPENS * abs(math.sin(4.0 * math.pi * self.contact_ratio))
        ratio = DAMPING_RATIO * self.damping_factor / math.sqrt(self.stiffness_factor)
        return Mathieu(strength, ratio, math.sqrt(self.stiffness_factor)).system(frequency)


def test_a_contact_ratio_that_changes_with_the_teeth_hides_no_harmonic():
    """It vanishes near both ends of the range and at the values of the file, and stands between."""
    speeds = (1.85, 2.15)
    assert all(tongues(UnderLoad(1.1, stiffness_factor=factor), speeds) for factor in (0.9, 1.1))
    for factor in (0.8, 1.0, 1.2):
        half = UnderLoad(1.1, stiffness_factor=factor, damping_factor=0.5)
        assert not tongues(half, (1.7, 2.3))
    _, swept, possible = searched(UnderLoad(1.1), stiffness=0.2, speeds=speeds)
    assert swept
    for factor in np.linspace(0.8, 1.2, 41).tolist():
        for tongue in tongues(UnderLoad(1.1, stiffness_factor=factor), speeds):
            assert any(low <= tongue.lower and tongue.upper <= high for low, high in possible)


def test_two_that_are_weak_alone_and_meet_inside_a_fine_cell_are_left_open():
    """Their strengths may add where they share a mode; apart, both are far from open."""
    cell = Cell((1.0,), (1.02,), (1.0, 2.0))
    search = BoxSearch(Tuned(0.0), {"stiffness": 0.02, "damping": 0.0}, (1.0, 2.0))
    corners = [module._Corner(springs, (0.5, 3.0), {}, ()) for springs in cell.corners]
    meeting = [(tongue(1.500, "a"), tongue(1.505, "b")), (tongue(1.512, "a"), tongue(1.507, "b"))]
    assert len(united(search._left(cell, cell.around, corners, meeting))) == 1
    apart = [(tongue(1.500, "a"), tongue(1.520, "b")), (tongue(1.512, "a"), tongue(1.530, "b"))]
    assert search._left(cell, cell.around, corners, apart) == []


def tongue(at, label):
    return Labelled(at, at + 1e-3, label)


@dataclass(frozen=True)
class Labelled:
    lower: float
    upper: float
    label: str


def test_half_the_damping_is_looked_at_only_where_nothing_stands_in_any_case():
    """All corners of the first cells are unstable around 2, and nothing else is within their reach."""
    search = searched(Tuned(peak=3.0, width=1.0), speeds=(1.99, 2.01))[0]
    assert search._weakly == {}
    partly = searched(Tuned(peak=3.0, width=1.0), speeds=(2.0, 2.3))[0]
    looked_at = [around for found in partly._weakly.values() for around, _ in found]
    upper = max(stop for _, stop in partly.swept)
    assert looked_at
    assert all(2.0 < low < upper < 2.3 < high for low, high in looked_at)


@pytest.mark.parametrize("part", [0.1, 0.4])
def test_cells_are_halved_at_the_values_of_the_file_first(part):
    cell = Cell((1.0 - part, 0.95), (1.0 + part, 1.05), RANGE)
    lower, upper = cell.halves(cell.longest)
    assert (lower.lower, lower.upper) == ((1.0 - part, 0.95), (1.0, 1.05))
    assert (upper.lower, upper.upper) == ((1.0, 0.95), (1.0 + part, 1.05))
    assert cell.reach == pytest.approx(math.sqrt((1.0 + part) / (1.0 - part)), rel=1e-15)


def test_a_value_that_was_looked_at_in_a_part_of_the_range_says_so():
    search = BoxSearch(None, {"stiffness": 0.1}, (10.0, 20.0))
    one, other = (Tongue(low, low + 1.0, low, 1.0, Combination(1, 1, "sum", 1)) for low in (12.0, 17.0))
    search._keep((1.1,), (one,), (11.0, 14.0))
    search._keep((1.1,), (other,), (16.0, 25.0))
    assert search.points[1.1,] == (one, other)
    assert search.looked_at[1.1,] == ((11.0, 14.0), (16.0, 20.0))
    search._keep((0.9,), (one,), (9.0, 21.0))
    assert search.looked_at[0.9,] == ((10.0, 20.0),)
