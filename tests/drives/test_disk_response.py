"""Forced response of the disk: against another integrator, closed forms, balance; what is said where there is none."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from facegear.drives.assessment import Assessment
from facegear.drives.assessment_files import write_assessment
from facegear.drives.basis import with_basis
from facegear.drives.disk_response import (
    EVEN,
    RIGID,
    UNLOADED,
    DiskResponse,
    Shaken,
    disk_response,
    normal_forces,
    transmission_error,
)
from facegear.drives.disk_response_table import peaks_table, response_table
from facegear.drives.disk_response_words import parting, sentences
from facegear.drives.drive_file import parse_drive, read_drive_file
from facegear.drives.outcome import Outcome
from facegear.drives.variants import Variant, other_teeth, own_teeth, plain_contacts, with_own_teeth
from facegear.drives.verdict import FORCES, driven
from facegear.floquet.labels import Combination
from facegear.maps.tracing import Tongue
from facegear.mechanics.disk import modal_mass
from facegear.mechanics.loaded_contact import LoadedContact
from facegear.support.parameters import rad_per_s

DRIVES = Path(__file__).resolve().parents[2] / "data" / "drives"
CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
LOCALIZED = read_drive_file(DRIVES / "localized.yaml")
TWO_GEARS = read_drive_file(DRIVES / "two_gears.yaml")


def variants(file, contact=""):
    """All kinds of teeth of a drive under one contact, in the smallest basis, by name."""
    contacts = plain_contacts(file)
    name = contact or next(iter(contacts))
    model = driven(file, "dead", with_own_teeth(file, contacts[name]))
    own = Variant(name, FORCES["dead"], own_teeth(file), with_basis(model, 0, 1))
    found, *_ = other_teeth(file, own, contacts[name])
    return {each.teeth: each for each in (own, *found)}


def static_force(file):
    duty = file.requirements
    return duty.power / duty.pinion_speed / file.drive.base_radius


def flexible(file, rule, contact=""):
    return variants(file, contact)[f"flexible teeth, load sharing {rule}"]


# --- the excitation ---------------------------------------------------------------------------------------------


def test_pairs_alike_give_way_by_half_as_much_where_two_are_in_mesh():
    """Tregold's 1.5532 periods: two pairs for 0.5532 of a period and one for the rest, each with k_m."""
    variant = flexible(CASE_1, "equal")
    force = static_force(CASE_1)
    alone = force / variant.model.mesh_stiffness
    error = transmission_error(variant, force)
    part = CASE_1.drive.contact_ratio - 1.0
    mean = alone * (part / 2.0 + (1.0 - part))
    assert_allclose(error([0.5 * part, part + 0.2])[:, 0], [alone / 2.0 - mean, alone - mean], rtol=1e-10)
    found = disk_response(Outcome(variant, (), True), force, np.array(rad_per_s([300.0, 305.0, 310.0])))
    assert found.error == pytest.approx(alone / 2.0, rel=1e-10)


def test_what_a_loaded_contact_gives_way_is_under_the_torque_of_the_file():
    contact = LoadedContact(
        LOCALIZED.drive, LOCALIZED.requirements.power / LOCALIZED.requirements.pinion_speed
    )
    at = np.linspace(0.0, 1.0, 4001)[:-1] + 0.5 / 4000
    departs = contact.transmission_error(at)
    for rule in ("centroid", "compliance"):
        error = transmission_error(flexible(LOCALIZED, rule), static_force(LOCALIZED))
        assert_allclose(error(at)[:, 0], departs - departs.mean(), atol=1e-7 * departs.max())


@pytest.mark.parametrize(
    ("file", "contact", "teeth", "reason"),
    [
        (CASE_1, "", "rigid teeth, frozen rate", RIGID),
        (CASE_1, "true sweep", "rigid teeth, total rate", RIGID),
        (CASE_1, "", "flexible teeth, load sharing centroid", EVEN),
        (CASE_1, "", "flexible teeth, load sharing length_share", EVEN),
        (LOCALIZED, "point contact", "flexible teeth, load sharing centroid", UNLOADED),
        (LOCALIZED, "point contact", "flexible teeth, load sharing compliance", UNLOADED),
    ],
)
def test_where_nothing_shakes_the_disk_it_is_said_why(file, contact, teeth, reason):
    assert transmission_error(variants(file, contact)[teeth], static_force(file)) == reason


def test_two_gears_are_named_as_not_computed():
    model = driven(TWO_GEARS, "dead", next(iter(TWO_GEARS.contacts.values())))
    said = transmission_error(Variant("true sweep", FORCES["dead"], own_teeth(TWO_GEARS), model), 1.0)
    assert said.startswith("between two gears")


def test_each_pinion_has_its_error_in_the_phase_of_its_mesh():
    """At every instant what the pairs of a mesh give way, times how stiff they are together, is the static force."""
    text = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
    file = parse_drive(text.replace("  mass: 1.0", "  mass: 1.0\n  angles_deg: [0, 101]"))
    variant = flexible(file, "length")
    model, force = variant.model, static_force(file)
    alone, along_axis = force / model.mesh_stiffness, math.sin(file.drive.pressure_angle)
    rule = model.contact.path(file.drive, model.contact.contact_ratio)
    at = np.linspace(0.0, 1.0, 3001)[:-1] + 0.5 / 3000
    mean = float(rule.transmission_error(alone)(at).mean())
    shaken = Shaken(model, transmission_error(variant, force).transformed([[1.0 / along_axis]]))
    loads = shaken.system(50.0).loads
    assert [list(mesh) for mesh in shaken.meshes(len(loads))] == [[0, 1], [2, 3]]
    stiffness = []
    for mesh in shaken.meshes(len(loads)):
        weights = sum(loads[number].weight(at)[:, 0] for number in mesh)
        for number in mesh:
            give = along_axis * loads[number].transmission_error(at)[:, 0] + mean
            assert_allclose(give * weights, alone, rtol=1e-5)
        stiffness.append(weights)
    # The phases differ, or the test would tell nothing.
    assert np.abs(stiffness[0] - stiffness[1]).max() > 0.1


# --- the response -----------------------------------------------------------------------------------------------


def transient(variant, contact, speed, periods):
    """Force of all pairs along the normal [N] over the last two of some periods from rest, by DOP853.

    Equations of the disk's modes and of the pinion in newtons, with the stiffness and the approach of the loaded
    contact and the place of its centre of force: no load of the package, no series of a response.
    """
    model = variant.model
    body, drive = model.body, model.body.drive
    sine, mass, period = (
        math.sin(drive.pressure_angle),
        modal_mass(body),
        2 * math.pi / (drive.gear_teeth * speed),
    )
    damping, stiffness = model.disk_matrices(speed)
    shape = model.system(speed).loads[0].shape
    slope, count = shape.derivative(), len(stiffness)
    error = contact.excitation
    error_slope = error.derivative()

    def force(x, q, v):
        place, moving = shape(x)[..., :count], slope(x)[..., :count] / period
        w, rate = (place * q[..., :-1]).sum(-1), (place * v[..., :-1] + moving * q[..., :-1]).sum(-1)
        closing = sine * (w - q[..., -1]) - error(x)[..., 0]
        closing_rate = sine * (rate - v[..., -1]) - error_slope(x)[..., 0] / period
        return contact.mesh_stiffness(x) * (closing + model.mesh_damping * closing_rate)

    def rates(x, state):
        q, v = state[: count + 1], state[count + 1 :]
        axial = sine * float(force(np.array(x), q, v))
        disk = -damping @ v[:-1] - stiffness @ q[:-1] - shape(x)[:count] * axial / mass
        pinion = (axial - model.bearing_damping * v[-1] - model.bearing_stiffness * q[-1]) / model.pinion_mass
        return period * np.concatenate([v, disk, [pinion]])

    at = np.linspace(periods - 2.0, periods, 1601)
    done = solve_ivp(
        rates, (0.0, periods), np.zeros(2 * count + 2), method="DOP853", rtol=1e-7, atol=1e-12, t_eval=at
    )
    assert done.success
    return force(at, done.y[: count + 1].T, done.y[count + 1 :].T)


def test_the_force_of_a_mesh_is_that_of_a_long_transient_by_another_integrator():
    text = (DRIVES / "localized.yaml").read_text(encoding="utf-8")
    # Damped so that what is not forced is soon gone.
    file = parse_drive(
        text.replace("damping_us: 3", "damping_us: 300") + "\nmaterial:\n  viscous_loss_factor_us: 100\n"
        "teeth:\n  tooth_damping_us: 30\n"
    )
    variant = flexible(file, "centroid")
    force = static_force(file)
    contact = variant.model.contact.path.of(file.drive)
    speeds = np.array(rad_per_s([400.0, 401.0]))
    row = normal_forces(variant.model, transmission_error(variant, force), speeds).isel(speed=0, load=0)
    both = transient(variant, contact, float(speeds[0]), 15)
    before, last = both[:800], both[800:1600]
    swing = np.ptp(last)
    assert swing > 0.01 * force
    assert np.abs(last - before).max() < 1e-4 * swing
    ends = (float(row.force_lowest), float(row.force_highest))
    assert_allclose(ends, (last.min(), last.max()), atol=2e-4 * swing)
    assert_allclose(float(row.force_rms), last.std(), rtol=2e-4)


def test_half_the_torque_of_pairs_alike_moves_the_force_by_half_as_much():
    variant = flexible(CASE_1, "equal")
    speeds = np.array(rad_per_s([300.0, 310.0, 320.0]))
    whole, half = (
        normal_forces(variant.model, transmission_error(variant, part * static_force(CASE_1)), speeds)
        for part in (1.0, 0.5)
    )
    assert_allclose(half.force_highest, 0.5 * whole.force_highest, rtol=1e-9)


# --- what is said -----------------------------------------------------------------------------------------------


def responses(file, contact=""):
    """Responses of all kinds of teeth, taken as stable."""
    speeds = np.linspace(*file.requirements.speeds, 31)
    found = [Outcome(each, (), True) for each in variants(file, contact).values()]
    return [disk_response(each, static_force(file), speeds) for each in found]


def test_an_assessment_says_of_every_model_how_it_moves_or_why_not():
    found = responses(CASE_1)
    assert [bool(each.reason) for each in found] == [each.data is None for each in found]
    static = static_force(CASE_1)
    said = sentences(found, static)
    assert sum(sentence.startswith("Forced response of the disk (Tregold") for sentence in said) == 2
    for each in found:
        assert any(each.variant.teeth in sentence for sentence in said)
        if each.data is None:
            assert any(each.variant.teeth in sentence and each.reason in sentence for sentence in said)
    table = response_table(found, "as given")
    assert dict(table.sizes) == {"model": 6, "speed": 31, "pinion": 1}
    assert table.none_because.values.tolist() == [each.reason for each in found]
    shaken = table.isel(model=[i for i, each in enumerate(found) if each.data is not None])
    assert float(shaken.force_highest.min()) > 0.0
    largest = max(abs(float(shaken[f"force_{end}"].isel(model=1).max())) for end in ("lowest", "highest"))
    assert f"{largest / static:.2g}"[0] in said[1]


def forced(before, parted=-50.0, peak=-120.0):
    """Make a response whose forces are known, of 1234.5 N at most between its speeds; static is 100 N."""
    variant = flexible(CASE_1, "equal")
    numbers = {"rms": 300.0, "lowest": parted, "highest": 60.0}
    forces = {f"force_{name}": (("speed", "load"), [[value], [value]]) for name, value in numbers.items()}
    ends = {"speed": [31.0, 32.0], "load": [0, 0], "force_rms": [700.0, 20.0]}
    ends |= {"force_lowest": [peak, -40.0], "force_highest": [1234.5, 30.0], "label": ["4/1", "5/2"]}
    peaks = {f"peak_{name}": ("peak", values) for name, values in ends.items()}
    return DiskResponse(
        variant, 1e-6, xr.Dataset(forces | peaks, {"speed": [30.0, 33.0]}, {"at_borders": 0}), "", before
    )


def test_a_force_that_another_basis_does_not_confirm_is_not_settled():
    """A tenth of 1234.5 N is the most that two bases may differ by; open forces have two digits."""
    close, off, alone = forced(1112.0), forced(1110.0), forced(math.nan)
    assert [each.settled for each in (close, off, alone)] == [True, False, False]
    assert off.moved == pytest.approx(124.5 / 1234.5, rel=1e-12)
    said = sentences((close, off, alone), 100.0)
    assert "by up to 1230 N" in said[0]
    assert "12.3 times the static 100 N" in said[0]
    assert "NOT SETTLED" not in said[0]
    assert "two nodal diameters fewer it is 1110 N." in said[0]
    assert "by up to 1200 N" in said[1]
    assert "12 times the static" in said[1]
    assert "NOT SETTLED: computed with M = 0 nodal circles and N = 1 nodal diameters" in said[1]
    assert "1100 N, 10.1 % off, where at most 10 % count as settled" in said[1]
    assert "NOT SETTLED: computed with M = 0 nodal circles and N = 1 nodal diameters alone" in said[2]
    table = response_table((close, off, alone), "as given")
    assert table["settled"].values.tolist() == [1.0, 0.0, 0.0]
    assert (table["nodal_circles"].values.tolist(), table["nodal_diameters"].values.tolist()) == (
        [0.0] * 3,
        [1.0] * 3,
    )


def test_flanks_that_part_at_a_resonance_between_the_speeds_are_told():
    said = sentences((forced(1234.0),), 100.0)[0]
    assert said.endswith(
        "Of 2 speeds it is stable at 2, and flanks would part at 0; of 2 peaks of resonances between them, at 1."
    )
    quiet = sentences((forced(1234.0, peak=-99.0),), 100.0)[0]
    assert quiet.endswith("at 0; of 2 peaks of resonances between them, at 0.")


def test_a_forced_response_stands_once_on_the_page_and_its_rms_is_of_what_varies(tmp_path):
    response = forced(1234.0)
    found = Assessment(CASE_1, (Outcome(response.variant, (), True),), {}, {}, None, "", (), (response,))
    page = write_assessment(found, tmp_path).read_text(encoding="utf-8")
    assert page.count("a static transmission error of 1 µm") == 1
    assert "rms of what varies of the force [N]" in page
    for name in ("disk_response.csv", "disk_response_peaks.csv"):
        heading = (tmp_path / name).read_text(encoding="utf-8-sig").partition("\n")[0]
        assert "force_rms_of_what_varies_N,force_lowest_less_static_N" in heading


def test_where_flanks_would_part_is_said_right_behind_the_verdict(tmp_path):
    """As of the model that is worst of those of the disk, and of torsion, where the static force is in the response."""
    static = 100.0
    worst, better = forced(1.0, parted=-101.0), forced(1.0, parted=-50.0)
    assert parting((better, worst), static, None).endswith(
        f"in the disk's motion ({worst.variant.name}, NOT SETTLED) at 2 of 2 speeds and 1 of the resonances between "
        "them, where they are pulled by up to 0.2 times the static force; what becomes of the motion then it does not "
        "say."
    )
    # With a basis that confirms it.
    assert "NOT SETTLED" not in parting((forced(1234.0, parted=-101.0),), static, None)
    box = forced(1.0, parted=-1.0, peak=-5.0).data
    assert "PART: in torsion at 2 of 2 speeds and 2 of the resonances" in parting((), static, box)
    assert "pulled by up to 0.4 times the static force" in parting((), static, box)
    assert "resonances" not in parting((forced(1.0, parted=-101.0, peak=-1.0),), static, None)
    assert parting((forced(1.0, peak=-99.0),), static, None) == parting((), static, None) == ""
    stable = Outcome(worst.variant, (), True)
    held, shaken = (
        Assessment(CASE_1, (stable,), {}, {}, None, "", (), (forced(1.0, part, peak),))
        for part, peak in ((-50.0, -99.0), (-1e5, -1e5))
    )
    assert held.verdict == shaken.verdict == "safe under all"
    assert "PART" not in held.headline
    assert shaken.headline.startswith(
        "Safe under all: from 100 to 1000 rpm, of 1 models of the disk's motion none is unstable at any speed. "
        "It takes flanks to stay in contact, but under the load of the drive they WOULD PART: in the disk's motion"
    )
    green = "#2e7d32"
    for name, found, shown in (("held", held, True), ("shaken", shaken, False)):
        page = write_assessment(found, tmp_path / name).read_text(encoding="utf-8")
        assert (green in page[: page.index("Speeds at which every model is known to be stable")]) is shown


def test_peaks_are_kept_with_their_ends_and_the_model_they_are_of():
    rigid = replace(forced(1.0), data=None, reason=RIGID)
    found = peaks_table((rigid, forced(1234.0)), "as given")
    assert found["peak_speed"].values.tolist() == [31.0, 32.0]
    assert found["force_highest"].values.tolist() == [1234.5, 30.0]
    assert found["force_lowest"].values.tolist() == [-120.0, -40.0]
    assert found["label"].values.tolist() == ["4/1", "5/2"]
    assert found["teeth"].values.tolist() == [forced(1.0).variant.teeth] * 2
    assert peaks_table((rigid,), "as given") is None


def test_without_any_response_the_first_sentence_says_so():
    found = responses(LOCALIZED, "point contact")
    assert response_table(found, "") is None
    said = sentences(found, static_force(LOCALIZED))
    assert said[0] == "No model of the disk with the file's own contact has a forced response."
    assert any(UNLOADED in sentence for sentence in said)


def test_a_model_that_is_unstable_at_most_speeds_has_none():
    low, high = CASE_1.requirements.speeds
    tongue = Tongue(low, 0.7 * high, 0.5 * high, 2.0, Combination(1, 8, "sum", 1))
    variant = flexible(CASE_1, "equal")
    found = disk_response(Outcome(variant, (tongue,), True), 1e4, np.linspace(low, high, 5))
    assert found.data is None
    assert found.reason == "nothing is steady at 66.7 % of the speeds, where it is unstable"
    assert found.error > 0.0


def test_a_model_whose_contact_cannot_be_computed_says_so():
    variant = flexible(CASE_1, "equal")
    gear = replace(variant.model, contact=replace(variant.model.contact, contact_ratio=1.2))
    found = disk_response(Outcome(replace(variant, model=gear), (), True), -1.0, np.array([30.0, 31.0]))
    assert found.data is None
    assert found.reason.startswith("approach must be greater than 0")
