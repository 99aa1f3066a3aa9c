"""Gearboxes in torsional vibration: as printed, with shafts that have mass, with parts that lose stiffness."""

from __future__ import annotations

from dataclasses import replace

from facegear.drives.studies.controls import (
    parameter_control,
    speed_control,
    with_parameters,
)
from facegear.drives.studies.study import Quantity, Settings, Study
from facegear.floquet.models import Model, value_of
from facegear.mechanics import gearboxes
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.torsional import Torsional
from facegear.support.kinds import require_kind


def gearbox_study(
    model: Torsional | None = None, highest_speed_rpm: float = gearboxes.HIGHEST_SPEED_RPM
) -> Study:
    """Torsional vibration of the gearbox of table 7.1: inertias, shafts, mesh.

    Parameters
    ----------
    model : Torsional, optional
        With a :class:`facegear.mechanics.gearboxes.ProportionalGearbox`, where the controls stand at first; that of
        Fig. 7.12(a) if left out.
    highest_speed_rpm : float
        End of the speed axis [rpm of the face gear].

    Returns
    -------
    Study
    """
    start = gearboxes.FIGURES["7.12a"].model() if model is None else model
    require_kind("model", start, Torsional, why="for this study")
    require_kind("gearbox of the model", start.gearbox, gearboxes.ProportionalGearbox, why="for this study")
    controls = (
        parameter_control(start, "gear_inertia", "gear inertia J₂/J₁", 1.0, 100.0, 1.0),
        parameter_control(start, "load_inertia", "load inertia Jₒ/J₁", 1.0, 100.0, 1.0),
        *_springs_and_dampers(start),
        parameter_control(
            start, "correction_factor", "correction of the mesh stiffness c_f", 0.05, 1.0, 0.05
        ),
    )

    def build(settings: Settings) -> Model:
        return with_parameters(start, controls, settings)

    return Study(
        controls,
        build,
        "input_damping",
        speed_control(highest_speed_rpm),
    )


def shafts_study(model: HeavyShafts | None = None, highest_speed_rpm: float = 1000.0) -> Study:
    """Torsional vibration with shafts that have mass: their lengths, their modes, stiffness and damping (chapter 8).

    Parameters
    ----------
    model : HeavyShafts, optional
        With both lengths, and a :class:`facegear.mechanics.gearboxes.ProportionalGearbox`, where the controls stand at
        first; that of Fig. 7.12(a) with shafts of 0.3 m if left out.
    highest_speed_rpm : float
        End of the speed axis [rpm of the face gear].

    Returns
    -------
    Study
    """
    start = HeavyShafts(gearboxes.FIGURES["7.12a"].model(), 0.3, 0.3, modes=1) if model is None else model
    require_kind("model", start, HeavyShafts, why="for this study")
    require_kind("gearbox of the model", start.gearbox, gearboxes.ProportionalGearbox, why="for this study")
    controls = (
        parameter_control(start, "input_length", "length of the input shaft [mm]", 50.0, 1000.0, 5.0, 1e-3),
        parameter_control(start, "output_length", "length of the output shaft [mm]", 50.0, 1000.0, 5.0, 1e-3),
        Quantity("modes", "modes of each shaft", 0, 3, max(start.modes_of_each), 1, whole=True),
        *_springs_and_dampers(start),
    )

    def build(settings: Settings) -> Model:
        return replace(with_parameters(start, controls, settings), modes=settings["modes"])

    return Study(controls, build, "output_length", speed_control(highest_speed_rpm), columns=40, rows=20)


def damage_study(model: Torsional | None = None, highest_speed_rpm: float = 1000.0) -> Study:
    """Torsional vibration of a gearbox that loses stiffness: what is left of shafts and teeth (chapter 8).

    Parameters
    ----------
    model : Torsional, optional
        The intact gearbox; that of Fig. 7.12(b) if left out.
    highest_speed_rpm : float
        End of the speed axis [rpm of the face gear].

    Returns
    -------
    Study
        Its damping coefficients stay what they are.
    """
    intact = gearboxes.FIGURES["7.12b"].model() if model is None else model
    require_kind("model", intact, Torsional, why="for this study")
    # In SI, where no damping is a multiple of a stiffness.
    start = replace(intact, gearbox=intact.gearbox.in_si)
    parts = {"input_stiffness": "input shaft", "output_stiffness": "output shaft", "mesh_stiffness": "teeth"}
    controls = tuple(
        Quantity(
            name,
            f"stiffness left, {part} [%]",
            20.0,
            100.0,
            100.0,
            1.0,
            value_of(start, name) / 100.0,
            parameter=name,
        )
        for name, part in parts.items()
    )

    def build(settings: Settings) -> Model:
        return with_parameters(start, controls, settings)

    return Study(controls, build, "mesh_stiffness", speed_control(highest_speed_rpm))


def _springs_and_dampers(start: Torsional | HeavyShafts) -> tuple[Quantity, ...]:
    """Shafts and dampings in the ratios of the captions."""
    return (
        parameter_control(start, "input_stiffness", "input shaft k₁/k_m [m²/rad]", 0.005, 0.5, 0.001),
        parameter_control(start, "output_stiffness", "output shaft k₂/k_m [m²/rad]", 0.005, 0.5, 0.001),
        parameter_control(start, "mesh_damping", "mesh damping c_m/k_m [µs]", 0.0, 50.0, 0.5, 1e-6),
        parameter_control(start, "input_damping", "input damping c₁/k₁ [µs]", 0.0, 100.0, 0.5, 1e-6),
        parameter_control(start, "output_damping", "output damping c₂/k₂ [µs]", 0.0, 100.0, 0.5, 1e-6),
    )
