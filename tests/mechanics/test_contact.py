"""Places of loads against the paths they come from, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import CentroidPath, ContactPath
from facegear.geometry.skew_line import SkewLine
from facegear.mechanics.contact import CENTROID, SKEW_LINE, Contact

DRIVE = Drive(26, 130, 3.175e-3)
X = np.linspace(0.003, 0.997, 41)


def position(place, x):
    ratio, angle = np.moveaxis(place.position(x), -1, 0)
    return ratio * DRIVE.outer_radius, angle


@pytest.mark.parametrize("ratio", [None, 2.0, DRIVE.geometric_contact_ratio])
def test_centroid_is_that_of_the_path(ratio):
    (place,) = Contact(contact_ratio=ratio).places(DRIVE)
    radius, angle = position(place, X)
    centroid = ContactPath(DRIVE, ratio).centroid(X)
    np.testing.assert_allclose(radius, centroid.radius, rtol=1e-11)
    np.testing.assert_allclose(angle, centroid.angle, atol=1e-11)


@given(st.floats(1.05, 4.0))
@settings(deadline=None, derandomize=True, max_examples=10)
def test_equal_weights_are_the_mean_of_the_pairs_in_mesh(ratio):
    for kind in (SkewLine, ContactPath):
        (place,) = Contact(path=kind, sharing="mean", contact_ratio=ratio).places(DRIVE)
        states = kind(DRIVE, ratio).pair_states(X)
        radius, angle = position(place, X)
        count = states.in_contact.sum(axis=0)
        # Beside an instant at which a pair leaves, which side counts is a matter of rounding.
        clear = np.abs(X - ratio % 1.0) > 1e-9
        np.testing.assert_allclose(radius[clear], (states.radius.sum(axis=0) / count)[clear], rtol=1e-10)
        np.testing.assert_allclose(angle[clear], (states.angle.sum(axis=0) / count)[clear], atol=1e-10)


def test_each_pair_has_a_load_while_it_is_in_mesh():
    places = Contact(path=ContactPath, sharing="each", contact_ratio=2.4).places(DRIVE)
    states = ContactPath(DRIVE, 2.4).pair_states(X)
    assert len(places) == 3
    for pair, place in enumerate(places):
        there = place.shape(lambda x, angle: np.ones((x.size, 1)))(X)[:, 0]
        assert ((there == 1.0) == states.in_contact[pair]).all()
        inside = states.in_contact[pair]
        radius, angle = position(place, X[inside])
        np.testing.assert_allclose(radius, states.radius[pair, inside], rtol=1e-11)
        np.testing.assert_allclose(angle, states.angle[pair, inside], atol=1e-11)


def test_shapes_are_not_asked_for_where_there_is_no_load():
    """Out of contact there is no radius: a shape that divides by it must not be called there."""
    for place in SKEW_LINE.places(DRIVE):

        def shape(x, angle):
            assert (x > 0.5).all()
            return 1.0 / x[:, np.newaxis]

        place.shape(shape)


def test_on_the_centroid_path_all_pairs_are_where_the_centroid_is():
    gathered, centroid = CentroidPath(DRIVE).pair_states(X), ContactPath(DRIVE).centroid(X)
    for pair, inside in enumerate(gathered.in_contact):
        np.testing.assert_allclose(gathered.radius[pair, inside], centroid.radius[inside], rtol=1e-14)
        np.testing.assert_allclose(gathered.angle[pair, inside], centroid.angle[inside], atol=1e-15)
        assert not gathered.radius[pair, ~inside].any()


def test_a_path_of_one_s_own():
    class Still(ContactPath):
        angular_travel = 0.0

    (place,) = Contact(path=Still).places(DRIVE)
    radius, angle = position(place, X)
    assert not angle.any()
    # Lengths weight as before: the radius is that of the centroid.
    np.testing.assert_allclose(radius, ContactPath(DRIVE).centroid(X).radius, rtol=1e-11)


def test_default_ratio_is_that_of_the_drive_and_a_given_one_stays():
    other = Drive(30, 150, 3.175e-3)
    assert CENTROID.ratio(DRIVE) == DRIVE.contact_ratio != other.contact_ratio == CENTROID.ratio(other)
    given = Contact(contact_ratio=np.float32(1.5))
    assert type(given.contact_ratio) is float
    assert given.ratio(DRIVE) == given.ratio(other) == 1.5


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"path": "skew line"}, TypeError, "path must be a class of contact points"),
        ({"sharing": "length"}, ValueError, "sharing must be"),
        ({"rate": "convective"}, ValueError, "rate must be"),
        ({"travel": "against"}, ValueError, "travel must be"),
        ({"contact_ratio": "1.5"}, TypeError, "contact_ratio must be a real number"),
        ({"contact_ratio": float("nan")}, ValueError, "contact_ratio must be finite"),
        (
            {"contact_ratio": 0.9},
            ValueError,
            r"contact_ratio must lie in .*\(below 1 there are instants without",
        ),
    ],
)
def test_bad_input(change, error, message):
    with pytest.raises(error, match=message):
        Contact(**change)


@pytest.mark.parametrize(
    ("contact", "message"),
    [
        (Contact(contact_ratio=27.0), r"contact_ratio must lie in \[1, 26\]"),
        (Contact(path=SkewLine), 'sharing must be "mean" or "each" for SkewLine'),
        (
            Contact(contact_ratio=1.0, rate="total"),
            r"contact_ratio must be at least 1\.001 for rate = 'total'",
        ),
    ],
)
def test_what_does_not_suit_a_drive_is_refused_with_the_reason(contact, message):
    with pytest.raises(ValueError, match=message):
        contact.require(DRIVE)


@pytest.mark.parametrize("path", [str, len, Drive, lambda drive, ratio: 3, lambda drive: 3], ids=range(5))
def test_what_makes_no_contact_points_is_no_path(path):
    with pytest.raises(TypeError, match="path must be a class of contact points"):
        Contact(path=path).require(DRIVE)


def test_few_teeth_have_no_total_rate_on_their_contact_lines_but_on_the_skew_line():
    few = Drive(18, 90, 3.175e-3)
    with pytest.raises(ValueError, match="pinion_teeth = 18 is too few for rate = 'total'"):
        Contact(sharing="each", rate="total").require(few)
    SKEW_LINE.require(few)


@given(st.floats(-2.0, 2.0), st.floats(-1.0, 1.0))
@settings(deadline=None, derandomize=True, max_examples=10)
def test_places_elsewhere_mirrored_later_and_backwards(angle, phase):
    for contact in (Contact(contact_ratio=1.6), Contact(path=ContactPath, sharing="each", contact_ratio=1.6)):
        for place in contact.places(DRIVE):
            radius, theta = position(place, X)
            there = _loaded(place, X)
            np.testing.assert_allclose(position(place.rotated(angle), X)[1], theta + angle, atol=1e-12)
            np.testing.assert_allclose(position(place.mirrored(), X), (radius, -theta), atol=1e-12)
            for moved, x in (
                (place.shifted(phase), X - phase),
                (place.backwards(), -X),
                (place.shifted(phase).backwards(), phase - X),
            ):
                np.testing.assert_allclose(position(moved, x), (radius, theta), atol=1e-9)
                assert (_loaded(moved, x) == there).all()
                # What is said of each piece has moved with it.
                assert moved.tolerances.sum() == pytest.approx(place.tolerances.sum())


def _loaded(place, x):
    return place.shape(lambda r, angle: np.ones((r.size, 1)))(x)[:, 0] == 1.0
