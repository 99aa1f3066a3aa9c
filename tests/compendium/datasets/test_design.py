from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

from compendium.datasets import design as design_arrays
from compendium.datasets import design_variants
from compendium.plotting import design as draw
from facegear.design.body import BodyDesign
from facegear.design.teeth import constant_diametral_pitch, constant_pitch_radius, root_stress
from facegear.floquet.multipliers import growth_rate
from facegear.maps.lobes import CriticalThickness, Lobe
from facegear.mechanics.disk import disk_modes, shape_vector
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s

DRIVE = constant_diametral_pitch(25)
MODEL = Transverse(Body(DRIVE, 0.04), MeshLoad(stiffness=0.8, damping=1e-5, mass=1.0))


def test_roots_are_ordered_from_thin_to_thick():
    """Radial flanks below the base circle, then the involute, then straight flanks that spread."""
    for teeth in (22, 25):
        found = design_arrays.root_thicknesses(constant_diametral_pitch(teeth))
        assert tuple(found) == design_arrays.ROOTS
        dedendum, base, _, rack = found.values()
        assert dedendum < base < rack
    many = design_arrays.root_thicknesses(constant_diametral_pitch(35))
    assert many["chord at dedendum circle"] == many["chord at base circle"]


def test_family_of_teeth():
    drives = [constant_pitch_radius(teeth) for teeth in (22, 30)]
    data = design_arrays.family_of_teeth(drives, 4e5, 500.0)
    stresses = [root_stress(drive, 4e5, 500.0) for drive in drives]
    assert data["root_stress"].sel(root=0).values == pytest.approx(stresses, rel=1e-12)
    assert data["face_width"].values.tolist() == [drive.face_width for drive in drives]
    for variable in data.data_vars.values():
        assert variable.attrs["rtol"] + variable.attrs["atol"] > 0


def test_family_of_bodies():
    def designed(teeth, ratio, speed):
        drive = constant_diametral_pitch(teeth)
        critical = CriticalThickness((Lobe(ratio, speed, "(1+1)/1"),))
        return BodyDesign(Body(drive, ratio), critical, 1e8 + teeth, 3e8)

    rows = [
        (designed(25, 0.03, 10.0), designed(25, 0.04, 20.0)),
        (designed(30, 0.035, 11.0), designed(30, 0.045, 21.0)),
    ]
    data = design_arrays.family_of_bodies(rows, (300.0, 1000.0))
    assert float(data["critical_ratio"].sel(highest_rpm=1000.0, pinion_teeth=30)) == 0.045
    a, h = rows[0][0].body.outer_radius, rows[0][0].body.thickness
    expected = 7840 * np.pi * (a**2 - 0.05**2) * h
    assert float(data["nominal_mass"].sel(highest_rpm=300.0, pinion_teeth=25)) == pytest.approx(expected)
    assert data["tip_speed"].values == pytest.approx(np.array([[10.0, 11.0], [20.0, 21.0]]) * 30 / np.pi)
    assert data["label"].values.tolist() == [["(1+1)/1"] * 2] * 2


def test_variants_differ_where_they_say():
    found = design_variants.variants(MODEL)
    system = {name: model.system(50.0) for name, model in found.items()}
    own = system.pop("as in chapters 3 and 4").loads[0]
    mass = system["base radius in the nominal mass"].loads[0].mass
    assert mass == pytest.approx(own.mass * np.cos(DRIVE.pressure_angle) ** 2, rel=1e-12)
    x = np.linspace(0.01, 0.99, 23)
    radial = system["no motion around the axis"].loads[0].shape(x)
    sines = [number for number, each in enumerate(disk_modes(MODEL.body)) if each.wave == "sin"]
    assert not radial[:, sines].any()
    assert own.shape(x)[:, sines].all()
    long = found["pinion addendum 1.25 modules"].body.drive
    assert long.pinion_tip_radius == DRIVE.shaper_tip_radius
    assert long.outer_radius == DRIVE.outer_radius
    # (3-22) with one pair at a time: from R2 to R1.
    line = found["skew line"]
    (skew,) = replace(line, contact=replace(line.contact, contact_ratio=1.0)).shapes
    radii = DRIVE.outer_radius + (DRIVE.inner_radius - DRIVE.outer_radius) * x
    assert skew(x) == pytest.approx(shape_vector(MODEL.body, radii, 0.0), rel=1e-6, abs=1e-9)


def test_lobe_ends_like_a_parabola():
    """Near a smooth maximum of the growth rate the width goes as the root of the depth."""
    lobe = Lobe(0.0376134, 18.85, "(1+1)/1")
    speeds = tuple(rad_per_s([150.0, 210.0]).tolist())
    data = design_arrays.lobe_near_tip(MODEL, lobe, speeds, (0.005, 0.02))
    assert float(data["width"][1] / data["width"][0]) == pytest.approx(2.0, rel=0.03)


def test_critical_of_variants_and_tips():
    low, high = rad_per_s([150.0, 300.0]).tolist()
    data = design_variants.critical_of_variants({"own": MODEL}, low, [high], (0.036, 0.039), jobs=1)
    assert data["variant_name"].values.tolist() == ["own"]
    assert data["highest_rpm"].values == pytest.approx([300.0])
    assert float(data["critical_ratio"][0, 0]) == pytest.approx(0.0375, abs=1.5e-4)
    tipped = design_arrays.with_tips(data, [Lobe(0.03, 10.0, "(1+2)/1")])
    assert tipped["tip_label"].values.tolist() == ["(1+2)/1"]
    assert float(tipped["tip_speed"][0]) == pytest.approx(95.49297)


@pytest.mark.slow
def test_tips_in_windows_are_those_of_an_independent_route():
    # data/anchors/ch04_figure_4_10.yaml: complex exponentials and DOP853
    data = design_variants.tips_in_windows(
        {"printed": MODEL}, [(164.0, 192.0), (740.0, 860.0)], [0.0404], jobs=1
    )
    np.testing.assert_allclose(data["tip_ratio"], [[0.0376137, 0.0394525]], rtol=0, atol=2e-5)
    assert (int(data["circles"][0]), int(data["diameters"][0])) == (1, 3)
    assert data["variant_name"].values.tolist() == ["printed"]


@pytest.mark.slow
def test_thickness_figure_has_cells_tongues_and_tips_of_the_model():
    lobe = Lobe(0.03945, float(rad_per_s(834.0)), "(1+9)/1")
    data = design_arrays.thickness_figure(
        MODEL,
        [lobe],
        thickness_range=(0.03, 0.036),
        speeds_rpm=(600.0, 1000.0),
        cells=4,
        sections=2,
        traced_rpm=600.0,
        jobs=1,
    )
    assert data["speed_rpm"].values.tolist() == [700.0, 800.0, 900.0, 1000.0]
    assert data["thickness_ratio"].values == pytest.approx([0.0315, 0.033, 0.0345, 0.036])
    assert data["section"].values.tolist() == [0.03, 0.036]
    cell = replace(MODEL, body=Body(DRIVE, 0.033)).system(float(rad_per_s(800.0)))
    found = float(data["growth_rate"].sel(speed_rpm=800.0).sel(thickness_ratio=0.033, method="nearest"))
    assert found == pytest.approx(growth_rate(cell), abs=1e-5)
    assert float(data["tip_ratio"][0]) == lobe.thickness_ratio
    before = dict(mpl.rcParams)
    figure = draw.thickness_map(data)
    figure.canvas.draw()
    words = {text.get_text() for text in figure.axes[0].texts}
    widest = data["upper"] - data["lower"]
    label = data["label"].values[0, int(widest[0].argmax("tongue"))]
    assert {"no tongue found", "response-\nunsafe\nzone", "B (1+9)/1: 0.0394", f"C {label}"} <= words
    assert dict(mpl.rcParams) == before
