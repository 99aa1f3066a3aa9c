"""Shafts and inertias that a drive file describes: in torsion, with play of the teeth, with a damaged tooth."""

from __future__ import annotations

from typing import Any

from facegear.drives.contacts import in_torsion
from facegear.drives.file_values import FileValues
from facegear.drives.refusals import built, built_following
from facegear.drives.shaft_modes import with_enough_modes
from facegear.geometry.drive import Drive
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.contact import Contact
from facegear.mechanics.heavy_shafts import HeavyShafts
from facegear.mechanics.properties import Material
from facegear.mechanics.tooth_damage import DamagedTooth
from facegear.mechanics.torsional import Gearbox, Torsional


def gearbox_models(
    found: FileValues, drive: Drive, contact: Contact, material: Material, torque: float, fastest: float
) -> tuple[Torsional | HeavyShafts | None, Backlash | None, DamagedTooth | None]:
    """Build a gearbox: in torsion, with play of its teeth, with a damaged tooth; None for what the file has not.

    Parameters
    ----------
    found : FileValues
    drive : Drive
    contact : Contact
        That of the transverse model.
    material : Material
    torque : float
        That of one pinion on the face gear [N m].
    fastest : float
        Highest speed of the face gear, its tolerance included [rad/s], which shafts with mass have modes enough for.
    """
    gearbox = found.values["gearbox"]
    if gearbox is None:
        return None, None, None
    torsional = built_following(
        found, "gearbox", lambda: _torsional(drive, gearbox, in_torsion(contact, drive), material, fastest)
    )
    play = built(found, "gearbox", lambda: _play(gearbox, torsional, torque))
    return torsional, play, built(found, "gearbox", lambda: _cracked(gearbox, torsional, torque))


def _torsional(
    drive: Drive, gearbox: dict[str, Any], contact: Contact, material: Material, fastest: float
) -> Torsional | HeavyShafts:
    values = {name: value for name, value in gearbox.items() if name not in ("gap", "loss")}
    arm = values.pop("arm")
    lengths = {name: values.pop(name) for name in ("input_length", "output_length")}
    for part in ("mesh", "input", "output"):
        # The file gives damping as a time.
        values[f"{part}_damping"] *= values[f"{part}_stiffness"]
    massless = Torsional(Gearbox(drive, **values), contact, arm)
    if not any(lengths.values()):
        return massless
    return with_enough_modes(HeavyShafts(massless, **lengths, material=material), fastest)


def _play(gearbox: dict[str, Any], torsional: Any, torque: float) -> Backlash | None:
    """Give the gearbox the play of its teeth, if there is any."""
    if gearbox["gap"] == 0.0:
        return None
    _require_massless_shafts("gap", 1e6, "µm", gearbox, "play")
    if gearbox["gap"] > (module := torsional.drive.module):
        raise ValueError(
            f"gap must be at most the module, {1e6 * module:.6g} µm, got {1e6 * gearbox['gap']:.6g} µm"
        )
    return Backlash(torsional, torque, gearbox["gap"])


def _cracked(gearbox: dict[str, Any], torsional: Any, torque: float) -> DamagedTooth | None:
    """Damage one tooth of the gearbox, if the file does."""
    if gearbox["loss"] == 0.0:
        return None
    _require_massless_shafts("loss", 1e2, "%", gearbox, "damage")
    return DamagedTooth(torsional, gearbox["loss"], torque=torque)


def _require_massless_shafts(name: str, per_si: float, unit: str, gearbox: dict[str, Any], what: str) -> None:
    """Refuse lengths of shafts beside what is computed without their mass."""
    lengths = {end: gearbox[end] for end in ("input_length", "output_length") if gearbox[end]}
    if lengths:
        beside = " and ".join(f"{end} = {1e3 * length:.6g} mm" for end, length in lengths.items())
        raise ValueError(
            f"{name} must be 0 beside {beside}: {what} is computed with massless shafts, got "
            f"{per_si * gearbox[name]:.6g} {unit}"
        )
