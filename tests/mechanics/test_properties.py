"""Material of a face gear, and what a pinion with its bearing is to it."""

import dataclasses
import math

import pytest

from facegear.mechanics.properties import STEEL, Material, MeshLoad


def test_steel_is_table_4_3():
    values = dataclasses.astuple(STEEL)
    assert values == (7840.0, 200e9, 0.3, 5e-6, 439.9e6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"density": 7.84}, r"density.*7\.84.*1000.*7840"),
        ({"density": -7840.0}, "density"),
        ({"youngs_modulus": 200.0}, "youngs_modulus"),
        ({"poissons_ratio": 0.6}, "poissons_ratio"),
        ({"viscous_loss_factor": -5e-6}, "viscous_loss_factor"),
        ({"viscous_loss_factor": math.nan}, "viscous_loss_factor"),
        ({"yield_strength": 439.9}, "yield_strength"),
    ],
)
def test_material_refuses(change, message):
    with pytest.raises(ValueError, match=message):
        dataclasses.replace(STEEL, **change)
    with pytest.raises(TypeError, match="density"):
        Material("steel", 200e9, 0.3, 5e-6, 439.9e6)


@pytest.mark.parametrize(
    "change", [{"stiffness": -1.0}, {"damping": 3.0}, {"damping": -1e-6}, {"mass": math.inf}]
)
def test_mesh_load_refuses(change):
    (name,) = change
    with pytest.raises(ValueError, match=name):
        dataclasses.replace(MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0), **change)
