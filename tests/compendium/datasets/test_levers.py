"""Levers of the conclusions: columns, rows and what is not there."""

import numpy as np
import pytest

from compendium.datasets import levers as arrays
from facegear.design.changes import possible_changes
from facegear.floquet.models import replace_at
from facegear.maps.tracing import tongues
from facegear.mechanics.cases import EXAMPLE_B, FIGURES
from facegear.support.parameters import rad_per_s, rpm

PAIR = replace_at(EXAMPLE_B, ("pinion_angles",), (0.0, np.pi / 2))
ONE = replace_at(FIGURES["4.5a"].model(), ("load", "stiffness"), 0.25)
TEETH = arrays.of_the_teeth(("body", "drive"))


def test_each_model_has_its_own_variables_and_its_own_rows():
    table = arrays.levers({"one": ONE, "two": PAIR}, TEETH[:1], (120.0, 200.0))
    phase = table.change_name.values.tolist().index("phase of pinion 2")
    assert table.case_name.values.tolist() == ["one", "one", "two"]
    assert np.isnan(table.width_change.values[:2, phase]).all()
    assert np.isfinite(table.width_change.values[2]).all()
    assert table.change_name.values.tolist() == [
        *(change.name for change in possible_changes(ONE)), "module", "phase of pinion 2"
    ]  # fmt: skip


def test_relative_slopes_are_those_of_tongues_traced_anew():
    speeds = (120.0, 150.0)
    table = arrays.levers({"one": ONE}, TEETH, speeds)
    changes = (*possible_changes(ONE), *TEETH)
    step = 1e-3
    for column in (changes.index(change) for change in changes if change.name in ("module", "pinion mass")):
        ends = []
        for sign in (1, -1):
            model = changes[column].apply(ONE, sign * step)
            (tongue,) = tongues(model, [float(rad_per_s(limit)) for limit in speeds])
            ends.append((rpm(tongue.lower + tongue.upper), rpm(tongue.width), tongue.growth_rate))
        before = (
            float(table.lower[0] + table.upper[0]),
            float(table.upper[0] - table.lower[0]),
            float(table.growth[0]),
        )
        slopes = [(up - down) / (2 * step * at) for up, down, at in zip(*ends, before, strict=True)]
        found = [float(table[name][0, column]) for name in ("centre_change", "width_change", "growth_change")]
        assert found == pytest.approx(slopes, rel=2e-3)


def test_changes_of_the_teeth_keep_the_rest():
    module, angle, ratio = (change.apply(ONE, 0.01) for change in TEETH)
    drive = ONE.body.drive
    assert module.body.drive.module == pytest.approx(1.01 * drive.module)
    assert angle.body.drive.pressure_angle == pytest.approx(1.01 * drive.pressure_angle)
    assert ratio.contact.contact_ratio == pytest.approx(1.01 * drive.contact_ratio)
    assert ratio.body == ONE.body


def test_a_tongue_that_leaves_the_range_is_gone():
    # One tooth more at the same size is three percent slower.
    table = arrays.one_more_tooth({"one": ONE}, (127.0, 135.0))
    assert table.label.values.tolist() == ["(1+1)/1"]
    assert np.isnan(table.centre_change.values).all()


def test_a_change_in_earnest_tends_to_the_slope():
    speeds, small = (120.0, 150.0), 1e-4
    table = arrays.levers({"one": ONE}, (), speeds)
    changes = possible_changes(ONE)
    found = arrays.followed(ONE, changes, small, table, speeds)
    for what in ("centre_change", "width_change"):
        np.testing.assert_allclose(found[what], table[what], atol=2e-3)


def test_arrows_are_powers():
    def mass(model):
        return model.body.mass

    table = arrays.arrows(ONE, TEETH[:1], {"mass": mass, "radius": lambda model: model.body.outer_radius})
    inside = ONE.body.bore_ratio**2
    np.testing.assert_allclose(
        table.change_of.values, [[3.0 + 2.0 * inside / (1.0 - inside), 1.0]], rtol=1e-6
    )
