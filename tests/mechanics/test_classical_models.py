"""Classical equations go wherever models go: maps, tongues, labels, cells, sensitivity, replaced parameters."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import facegear as fg
from facegear.drives.cell import cell_detail
from facegear.floquet.labels import combination
from facegear.floquet.models import parameter_names
from facegear.maps.sensitivity import sensitivity
from facegear.mechanics.classical import Hill, Mathieu, Meissner, cosine_wave
from facegear.mechanics.classical_pairs import CoupledPair, GearPair
from tests.independent import classical as independent


@dataclass(frozen=True)
class Case:
    """A model, the same equations written out anew, and a tongue of it."""

    model: Any
    written_out: Any  # of frequency and the value of `parameter`
    parameter: str
    values: tuple[float, float]
    inside: float  # a frequency in the tongue
    outside: float
    window: tuple[float, float]
    label: str
    others: tuple[str, ...]


CASES = {
    "hill": Case(
        Hill(0.4, cosine_wave(), 0.02),
        lambda w, depth: independent.mathieu(w, depth, 0.02),
        *("depth", (0.2, 0.4), 2.0, 1.5, (1.6, 2.4), "(1+1)/1"),
        ("depth", "damping_ratio", "natural_frequency"),
    ),
    "mathieu": Case(
        Mathieu(0.4, 0.02),
        lambda w, zeta: independent.mathieu(w, 0.4, zeta),
        *("damping_ratio", (0.01, 0.02), 2.0, 1.5, (1.6, 2.4), "(1+1)/1"),
        ("depth", "damping_ratio", "natural_frequency"),
    ),
    "meissner": Case(
        Meissner(0.4, 0.3, 0.02),
        lambda w, duty: independent.meissner(w, 0.4, duty, 0.02),
        *("duty", (0.4, 0.3), 1.9, 1.4, (1.5, 2.3), "(1+1)/1"),
        ("depth", "duty", "damping_ratio", "natural_frequency"),
    ),
    "coupled pair": Case(
        CoupledPair(0.6, coupling=0.8, damping=0.02),
        lambda w, depth: independent.coupled_pair(w, depth, 0.8, 0.0, 0.02),
        *("depth", (0.3, 0.6), 2.82, 2.4, (2.6, 3.0), "(1+2)/1"),
        ("depth", "coupling", "circulation", "damping"),
    ),
    "gear pair": Case(
        GearPair(1.563, shaft_damping=0.01),
        lambda w, damping: independent.gear_pair(w, 1.563, 0.0, damping),
        *("shaft_damping", (0.02, 0.01), 1.45, 1.25, (1.3, 1.6), "(2+2)/2"),
        ("contact_ratio", "pair_stiffness", "pair_damping", "droop", "shaft_damping"),
    ),
}


@pytest.fixture(params=CASES, name="case")
def _case(request):
    return CASES[request.param]


def test_map(case):
    speeds = sorted((case.inside, case.outside))
    chart = fg.stability_map(case.model, speeds, case.parameter, case.values, jobs=1)
    expected = [
        [independent.growth_rate(case.written_out(w, value)) for w in speeds] for value in case.values
    ]
    np.testing.assert_allclose(chart.values, expected, atol=1e-8)
    growing = chart.sel(speed=case.inside)
    assert float(growing[-1]) > 1e-3 > 0.0 > float(chart.sel(speed=case.outside).max())


def test_tongue_and_its_label(case):
    (tongue,) = (t for t in fg.tongues(case.model, case.window) if t.lower < case.inside < t.upper)
    assert tongue.label == case.label

    def growth(frequency):
        return independent.growth_rate(case.written_out(frequency, case.values[-1]))

    low, high = case.window
    borders = brentq(growth, low, case.inside, xtol=1e-9), brentq(growth, case.inside, high, xtol=1e-9)
    assert (tongue.lower, tongue.upper) == pytest.approx(borders, abs=1e-6)


def test_cell(case):
    detail = cell_detail(case.model, case.inside)
    written_out = case.written_out(case.inside, case.values[-1])
    assert detail.growth_rate == pytest.approx(independent.growth_rate(written_out), abs=1e-8)
    assert detail.label == combination(case.model.system(case.inside)).label == case.label
    assert detail.tongue.lower < case.inside < detail.tongue.upper
    assert cell_detail(case.model, case.outside).tongue is None
    assert len(case.model.coordinates) == case.model.system(1.0).size
    assert [str(name) for name in detail.history["coordinate"].values] == [
        c.name for c in case.model.coordinates
    ]


def test_parameters_are_replaced_by_name(case):
    assert parameter_names(case.model) == case.others
    other = fg.replace_parameter(case.model, case.parameter, case.values[0])
    assert other == replace(case.model, **{case.parameter: case.values[0]}) != case.model
    expected = independent.growth_rate(case.written_out(case.inside, case.values[0]))
    assert fg.growth_rate(other.system(case.inside)) == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("case", [case for case in CASES.values() if case.parameter != "duty"])
def test_sensitivity(case):
    at = case.values[-1]
    found = sensitivity(case.model, case.inside, (case.parameter,))
    above, below = (
        independent.growth_rate(case.written_out(case.inside, factor * at)) for factor in (1.01, 0.99)
    )
    assert found.growth_rate_derivatives[0] == pytest.approx((above - below) / (0.02 * at), rel=1e-3)


def test_what_moves_a_jump_has_no_derivative_and_says_so():
    with pytest.raises(ValueError, match="depend on duty"):
        sensitivity(CASES["meissner"].model, 1.9, ("duty",))
