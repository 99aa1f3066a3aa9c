"""Thickness that parts stable bodies from unstable ones."""

from dataclasses import replace

import pytest

from facegear.drives import critical_thickness, report_rows
from facegear.drives.drive_file import read_drive_file
from facegear.drives.verdict import driven
from facegear.maps.tracing import tongues
from facegear.support.parameters import rad_per_s
from tests.drives.drive_files import DRIVES

CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
RANGE = (float(rad_per_s(500.0)), float(rad_per_s(720.0)))
FOUND = tongues(CASE_1.transverse, RANGE)


def values(rows):
    return {row.quantity: row.value for row in rows}


RATIO = "critical power over power of a pinion, force follows the rim"


@pytest.mark.slow
@pytest.mark.parametrize("force", ["follower", "dead"])
def test_critical_thickness_parts_stable_from_unstable(force):
    model = driven(CASE_1, force, CASE_1.contacts["Tregold"])
    critical = critical_thickness.thickness_verdict(model, RANGE).critical.thickness_ratio
    for factor, stable in ((1.004, True), (0.996, False)):
        body = replace(model.body, thickness_ratio=factor * critical)
        assert bool(tongues(replace(model, body=body), RANGE)) != stable


@pytest.mark.slow
def test_flutter_decides_the_thickness_where_the_force_follows():
    """P_c goes with the fourth power of the thickness: ω³ and one more for the mass that the force moves."""
    narrow = (float(rad_per_s(900.0)), float(rad_per_s(905.0)))
    model = driven(CASE_1, "follower", CASE_1.contacts["true sweep"])
    critical = critical_thickness.thickness_verdict(model, narrow).critical
    ratio = values(report_rows.flutter(model, CASE_1.requirements))[RATIO]
    assert critical.thickness_ratio == pytest.approx(0.03 * ratio**-0.25, rel=0.02)
    assert critical.lobe.label.startswith("mean")


def test_no_critical_thickness_is_told_with_the_reason_in_rpm():
    narrow = (float(rad_per_s(600.0)), float(rad_per_s(601.0)))
    # 0.001 of the thickness up or down: stable there.
    verdict = critical_thickness.thickness_verdict(CASE_1.transverse, narrow, widest=1.001)
    assert verdict.critical is None
    assert verdict.reason == "stable down to h/a = 0.02997"
    inside = (FOUND[0].lower, FOUND[0].upper)
    verdict = critical_thickness.thickness_verdict(CASE_1.transverse, inside, widest=1.001)
    assert verdict.critical is None
    assert "still unstable at h/a = 0.03003, at 5" in verdict.reason
    assert verdict.reason.endswith("rpm")
