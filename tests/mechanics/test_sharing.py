"""Rules by which tooth pairs share the load: what they add up to, where they press, what any model makes of them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import facegear as fg
from facegear.floquet.fourier import fourier_series
from facegear.floquet.multipliers import multipliers
from facegear.geometry.kinematics import CentroidPath
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.sharing import RULES, shared_load

DRIVE = fg.Drive(26, 130, 3.175e-3)
CUT = fg.Drive(26, 130, 3.175e-3, shaper_teeth=27)
TIME = np.random.default_rng(8).uniform(0.0, 1.0, 200)
PATHS = {
    "Tregold": (fg.ContactPath, DRIVE),
    "line": (fg.line_contact, DRIVE),
    "loaded": (fg.loaded_contact(60.0), CUT),
}


@cache
def places(rule, path, sharing="each"):
    law, drive = PATHS[path]
    return fg.Contact(path=shared_load(rule, law), sharing=sharing).places(drive)


def weights(rule, path):
    return np.stack([place.weight(TIME)[:, 0] for place in places(rule, path)])


def lengths(path):
    law, drive = PATHS[path]
    return law(drive).pair_states(TIME).length


@pytest.mark.parametrize("path", PATHS)
class TestStiffness:
    @pytest.mark.parametrize("rule", RULES)
    def test_the_mesh_is_as_stiff_in_the_mean_by_every_rule(self, rule, path):
        law, drive = PATHS[path]
        total = 0.0
        for place in places(rule, path):
            weight = place.weight
            assert weight(TIME).min() > -1e-9
            total += float(
                fourier_series(lambda x, w=weight: w(x)[:, None], weight.breakpoints, 1).mean.item()
            )
        assert total == pytest.approx(law(drive).contact_ratio, rel=1e-9)

    def test_share_leaves_the_mesh_as_stiff_at_all_times(self, path):
        law, drive = PATHS[path]
        found = weights("length_share", path)
        np.testing.assert_allclose(found.sum(axis=0), law(drive).contact_ratio, rtol=1e-9)
        length = lengths(path)
        np.testing.assert_allclose(found / found.sum(axis=0), length / length.sum(axis=0), atol=1e-9)

    def test_length_is_in_proportion_to_each_line(self, path):
        found, length = weights("length", path), lengths(path)
        np.testing.assert_allclose(found, length * found.sum() / length.sum(), atol=1e-9 * found.max())

    def test_equal_counts_pairs(self, path):
        law, drive = PATHS[path]
        counted = law(drive).pair_states(TIME).in_contact.sum(axis=0)
        np.testing.assert_allclose(weights("equal", path).sum(axis=0), counted, atol=1e-12)

    @pytest.mark.parametrize("rule", RULES)
    def test_one_load_for_all_has_their_sum(self, rule, path):
        (place,) = places(rule, path, sharing="centroid")
        np.testing.assert_allclose(place.weight(TIME)[:, 0], weights(rule, path).sum(axis=0), atol=1e-9)


@pytest.mark.parametrize("path", PATHS)
def test_share_is_the_load_at_the_centroid_and_a_stiffness_against_tilting(path):
    """Exactly so on shapes that are planes: there the pairs' stiffness has one more part, which is not negative."""

    def planes(x, angle):
        return np.stack([np.ones_like(x), x, angle], axis=-1)

    def stiffness(place):
        shape = place.shape(planes)(TIME)
        return place.weight(TIME)[:, :, None] * shape[:, :, None] * shape[:, None, :]

    each = sum(stiffness(place) for place in places("length_share", path))
    (centroid,) = places("length_share", path, sharing="centroid")
    tilting = each - stiffness(centroid)
    size = np.abs(each).max()
    np.testing.assert_allclose(tilting[:, 0], 0.0, rtol=0, atol=1e-10 * size)
    values = np.linalg.eigvalsh(tilting[:, 1:, 1:])
    assert values.min() > -1e-10 * size
    assert values.max() > 1e-5 * size
    # Another rule is none of the kind: the centroid of the lengths is not that of its stiffness.
    other = sum(stiffness(place) for place in places("equal", path))
    (centroid,) = places("equal", path, sharing="centroid")
    assert np.abs((other - stiffness(centroid))[:, 0]).max() > 1e-4 * size


class TestTransmissionError:
    def error(self, rule):
        return shared_load(rule)(DRIVE).transmission_error(1e-5)(TIME)[:, 0]

    def test_share_has_none_but_the_constant(self):
        np.testing.assert_allclose(self.error("length_share"), 1e-5 / DRIVE.contact_ratio, rtol=1e-12)

    def test_equal_halves_it_while_two_pairs_are_in_mesh(self):
        two = DRIVE.contact_ratio - 1.0 > TIME
        assert 0.4 < two.mean() < 0.7
        np.testing.assert_allclose(self.error("equal"), np.where(two, 0.5e-5, 1e-5), rtol=1e-12)

    def test_length_gives_way_as_the_lines_are_short(self):
        total = lengths("Tregold").sum(axis=0)
        product = self.error("length") * total
        np.testing.assert_allclose(product, product[0], rtol=1e-10)

    @pytest.mark.parametrize("approach", [0.0, -1e-6, float("nan"), "1"])
    def test_bad_force(self, approach):
        with pytest.raises((TypeError, ValueError), match="approach"):
            shared_load("equal")(DRIVE).transmission_error(approach)


class TestInTorsion:
    model = FIGURES["7.9a"].model()

    def found(self, path, speed=60.0):
        contact = fg.Contact(path=path, sharing="each", rate="total")
        return np.sort(np.abs(multipliers(replace(self.model, contact=contact).system(speed))))

    def test_equal_is_what_each_pair_has_without_a_rule(self):
        np.testing.assert_allclose(
            self.found(shared_load("equal")), self.found(fg.ContactPath), rtol=0, atol=1e-11
        )

    def test_other_rules_are_others(self):
        equal, share, length = (self.found(shared_load(rule)) for rule in ("equal", "length_share", "length"))
        assert np.abs(equal - share).max() > 1e-4
        assert np.abs(length - share).max() > 1e-4


def test_it_goes_on_the_clock_of_its_path():
    assert (
        fg.Contact(path=shared_load("equal", fg.line_contact)).ratio(DRIVE) == DRIVE.geometric_contact_ratio
    )
    assert fg.Contact(path=shared_load("equal"), contact_ratio=2.2).ratio(DRIVE) == 2.2
    gathered = fg.Contact(path=shared_load("length_share", CentroidPath), sharing="each").places(DRIVE)
    (one,) = fg.Contact().places(DRIVE)
    early = TIME[DRIVE.contact_ratio - 1.0 > TIME]
    for place in gathered:
        np.testing.assert_allclose(place.position(early), one.position(early), atol=1e-11)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (("share",), ValueError, "rule must be"),
        ((1,), (TypeError, ValueError), "rule must be"),
        (("equal", 3.0), TypeError, "path must be a class of contact points"),
    ],
)
def test_bad_rule(arguments, error, message):
    with pytest.raises(error, match=message):
        shared_load(*arguments)


@pytest.mark.parametrize(
    ("path", "ratio", "message"),
    [
        (fg.SkewLine, None, "path must have contact lines to share the load by.*SkewLine"),
        (fg.ContactPath, 1.0, "contact_ratio must exceed 1 for pairs to share the load"),
        (fg.ContactPath, 27.0, "contact_ratio"),
        (fg.point_contact, None, "shaper_teeth"),
    ],
)
def test_contact_that_it_cannot_be_shared_by(path, ratio, message):
    contact = fg.Contact(path=shared_load("length", path), sharing="each", contact_ratio=ratio)
    with pytest.raises(ValueError, match=message):
        contact.require(DRIVE)


def test_too_few_teeth_cannot_be_followed():
    few = fg.Drive(18, 90, 3.175e-3)
    contact = fg.Contact(path=shared_load("length"), sharing="each", rate="total")
    with pytest.raises(ValueError, match="too few"):
        contact.require(few)
