"""Models of one drive that could change the answer: which there are, and that they are what they are called."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from facegear.drives.drive_file import parse_drive, read_drive_file
from facegear.drives.flexible_teeth import COMPLIANCE
from facegear.drives.variants import (
    ASSUMED_TOOTH_DAMPING,
    RIGID,
    RIGID_TOTAL,
    Variant,
    other_teeth,
    own_teeth,
    plain_contacts,
    with_own_teeth,
)
from facegear.drives.verdict import driven
from facegear.floquet.multipliers import growth_rate
from facegear.mechanics.sharing import RULES
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.support.parameters import rad_per_s

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1, LOCALIZED, BOTH, TWO, GEARBOX = (
    read_drive_file(DRIVES / f"{name}.yaml")
    for name in ("case_1", "localized", "both_faces", "two_gears", "gearbox_table_7_1")
)
SPEED = float(rad_per_s(600.0))


def own_variant(file, name=None):
    contacts = plain_contacts(file)
    name = next(iter(contacts)) if name is None else name
    model = driven(file, "dead", with_own_teeth(file, contacts[name]))
    return Variant(name, "dead", own_teeth(file), model), contacts[name]


@pytest.mark.parametrize("file", [CASE_1, LOCALIZED, BOTH, TWO, GEARBOX])
def test_the_first_one_is_that_of_the_file(file):
    own, _ = own_variant(file)
    told = next(iter(file.contacts))
    assert own.contact == told
    expected = driven(file, "dead", file.contacts[told])
    assert growth_rate(own.model.system(SPEED)) == pytest.approx(
        growth_rate(expected.system(SPEED)), abs=1e-9
    )


def test_contacts_under_load_are_looked_at_at_parts_of_the_torque():
    contacts = plain_contacts(LOCALIZED)
    assert list(contacts) == [
        "contact under load",
        "point contact",
        "contact under load, 50 % of the torque",
        "contact under load, 25 % of the torque",
    ]
    ratios = {name: contact.ratio(LOCALIZED.drive) for name, contact in contacts.items()}
    assert min(ratios, key=ratios.get) == "point contact"
    torques = [contact.path.torque for name, contact in contacts.items() if name != "point contact"]
    duty = LOCALIZED.requirements
    whole = duty.power / duty.pinion_speed
    assert torques == pytest.approx([whole, 0.5 * whole, 0.25 * whole], rel=1e-12)


def test_teeth_along_lines_share_by_every_rule():
    own, plain = own_variant(CASE_1)
    found, refused, failed = other_teeth(CASE_1, own, plain)
    assert [variant.teeth for variant in found] == [
        RIGID_TOTAL,
        *(f"flexible teeth, load sharing {rule}" for rule in ("centroid", *RULES)),
    ]
    assert refused == failed == []
    assert all((v.contact, v.force) == (own.contact, own.force) for v in found)
    flexible = found[1].model
    assert flexible.mesh_stiffness == pytest.approx(mesh_stiffness(CASE_1.drive, 0.5), rel=1e-12)
    assert flexible.mesh_damping == ASSUMED_TOOTH_DAMPING
    assert all(variant.model.gear.force == own.model.gear.force for variant in found)
    rates = {growth_rate(variant.model.system(SPEED)) for variant in (own, *found)}
    assert len(rates) == 1 + len(found)


def test_stiff_flexible_teeth_are_rigid_ones_with_total_rate():
    own, plain = own_variant(CASE_1)
    total, centroid, *_ = other_teeth(CASE_1, own, plain)[0]
    apart = []
    for factor in (30.0, 300.0):
        stiff = replace(centroid.model, mesh_stiffness=factor * centroid.model.mesh_stiffness)
        apart.append(abs(growth_rate(stiff.system(SPEED)) - growth_rate(total.model.system(SPEED))))
    assert apart[1] < 0.2 * apart[0]


def test_teeth_at_a_point_share_as_the_load_presses_them():
    own, plain = own_variant(LOCALIZED)
    found, *_ = other_teeth(LOCALIZED, own, plain)
    assert f"flexible teeth, load sharing {COMPLIANCE}" in [variant.teeth for variant in found]


@pytest.mark.parametrize("file", [BOTH, TWO])
def test_what_there_is_not_is_named(file):
    own, plain = own_variant(file)
    found, refused, failed = other_teeth(file, own, plain)
    assert failed == []
    assert RIGID not in [variant.teeth for variant in found]
    assert [reason.endswith("on the back face or between two gears") for reason in refused] == [True, True]
    sizes = {variant.model.system(SPEED).size for variant in found}
    assert sizes == {own.model.system(SPEED).size}


def test_stiffness_and_damping_of_a_gearbox_are_those_of_its_teeth():
    own, plain = own_variant(GEARBOX)
    flexible = other_teeth(GEARBOX, own, plain)[0][1].model
    box = GEARBOX.torsional.gearbox.in_si
    assert flexible.mesh_stiffness == box.mesh_stiffness
    assert flexible.mesh_damping == pytest.approx(box.mesh_damping / box.mesh_stiffness, rel=1e-12)


def test_flexible_teeth_of_a_file_are_made_rigid():
    text = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    file = parse_drive(text + "\nteeth:\n  tooth_damping_us: 10\n  sharing: length\n")
    own, plain = own_variant(file)
    assert own.teeth == "flexible teeth, load sharing length"
    rigid = next(v for v in other_teeth(file, own, plain)[0] if v.teeth == RIGID)
    expected = driven(CASE_1, "dead", CASE_1.contacts["Tregold"])
    assert growth_rate(rigid.model.system(SPEED)) == pytest.approx(
        growth_rate(expected.system(SPEED)), abs=1e-9
    )
    assert np.isclose(rigid.model.system(SPEED).size, expected.system(SPEED).size)
