"""A stability map of a drive file over any number that it gives, named and measured as the file does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from facegear.drives import report_arrays
from facegear.drives.contacts import NAMES, torsional_under
from facegear.drives.drive_file import DriveFile
from facegear.drives.drive_keys import SECTIONS
from facegear.drives.keys import MOST_CELLS, OVER_SI, Key
from facegear.drives.refusals import told_of_a_model
from facegear.drives.verdict import driven
from facegear.floquet.models import Model, replace_parameter, system_at, value_of
from facegear.maps.parallel import parts_of
from facegear.mechanics.edge_stiffness import Following
from facegear.support.parameters import finite, integer_within, rad_per_s, rpm

_GEARBOX, _TOLERANCES = "gearbox", "tolerances"
# Part of its own value that a number is swept on either side.
_HALF = 0.5


@dataclass(frozen=True, eq=False)
class Sweep:
    """A map of a drive.

    Attributes
    ----------
    key : Key
        The number that is swept, of the drive file.
    own : float
        Its value in the drive file, in the file's unit.
    chart : xarray.Dataset
        From :func:`facegear.drives.report_arrays.growth_map`, in SI.
    """

    key: Key
    own: float
    chart: xr.Dataset

    @property
    def values(self) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        """Values of the number, in the file's unit, (V,)."""
        name = str(self.chart["growth_rate"].dims[0])
        return np.array([self.key.from_si(float(value)) for value in self.chart[name].values])


def models(file: DriveFile, contact: str, following: Following) -> dict[str, Model]:
    """Models of a drive whose numbers can be swept, by the section that is about them alone.

    Parameters
    ----------
    file : DriveFile
    contact : str
        One of :data:`facegear.drives.contacts.NAMES` that the teeth can have, or empty for that of the file.
    following : {"follower", "dead"}
        What the driving force does.

    Returns
    -------
    dict
        Of the body in the basis of the file under ``""``; of the gearbox, if there is one, under ``"gearbox"``.

    Raises
    ------
    ValueError
        If the teeth cannot have the contact.
    """
    possible = {short: file.contacts[long] for short, long in NAMES.items() if long in file.contacts}
    if contact and contact not in possible:
        raise ValueError(f"contact must be {' or '.join(possible)} for these teeth, got {contact!r}")
    chosen = possible[contact] if contact else next(iter(file.contacts.values()))
    transverse: Model = driven(file, following, chosen)
    if file.torsional is None:
        return {"": transverse}
    return {"": transverse, _GEARBOX: torsional_under(file.torsional, chosen, file.drive)}


def sweepable(found: Mapping[str, Model]) -> dict[str, tuple[Model, Key]]:
    """Keys of a drive file that are parameters of its models.

    Parameters
    ----------
    found : mapping
        From :func:`models`.

    Returns
    -------
    dict
        Name of the key to the model and the key.
    """
    keys: dict[str, tuple[Model, Key]] = {}
    for name, section in SECTIONS.items():
        if name == _TOLERANCES:
            # How far numbers may be off is none of a model, whatever it is called.
            continue
        model = found.get(_GEARBOX) if name == _GEARBOX else found[""]
        for key in section.keys if model is not None else ():
            # Damping of a gearbox is a time in the file and a coefficient in the model.
            plain = key.kind == "number" and key.unit not in OVER_SI
            if plain and not (name == _GEARBOX and "damping" in key.name) and _has(model, key.si_name):
                assert model is not None
                keys[key.name] = (model, key)
    return keys


def _has(model: Model | None, name: str) -> bool:
    try:
        value_of(model, name)
    except (TypeError, ValueError):
        return False
    return True


def sweep(
    file: DriveFile,
    key: str = "stiffness",
    *,
    lowest: float | None = None,
    highest: float | None = None,
    speeds_rpm: tuple[float, float] | None = None,
    cells: int = 60,
    contact: str = "",
    following: Following = "follower",
    jobs: int = 1,
) -> Sweep:
    """Compute growth rates over speed and one number of a drive file.

    Parameters
    ----------
    file : DriveFile
    key : str
        Name of a key, as ``"stiffness"``, ``"thickness_ratio"``, ``"power_kW"`` or, of the section `gearbox`,
        ``"input_stiffness_Nm_per_rad"``.
    lowest, highest : float, optional
        First and last value, in the unit of the key. Default: half and one and a half times that of the file, as far as
        the key goes; where these make no range, as of 0, they must be given.
    speeds_rpm : tuple of float, optional
        Lowest and highest speed of the face gear [rpm]; those of the file if left out.
    cells : int
        Number of values and of speeds, 2 to 1000.
    contact, following
        As for :func:`models`.
    jobs : int
        Number of processes, as joblib's ``n_jobs``.

    Returns
    -------
    Sweep
        In the basis of the file, nodal_circles and nodal_diameters.

    Raises
    ------
    ValueError
        If the key is none that can be swept, or its values or the speeds do not ascend or are out of range.
    """
    keys = sweepable(models(file, contact, following))
    cells = integer_within("cells", cells, 2, MOST_CELLS)
    if key not in keys:
        raise ValueError(f"parameter must be one of {', '.join(keys)}, got {key!r}")
    model, chosen = keys[key]
    own = chosen.from_si(value_of(model, chosen.si_name))
    low = _nearest(chosen, _HALF * own) if lowest is None else finite("from", lowest)
    high = _nearest(chosen, (1.0 + _HALF) * own) if highest is None else finite("to", highest)
    lacking = [flag for flag, value in (("--from", lowest), ("--to", highest)) if value is None]
    if lacking and not low < high:
        shown = f"{key} = {own:.6g} {chosen.unit}".rstrip()
        raise ValueError(
            f"{' and '.join(lacking)} must be given for {shown}: "
            "half and one and a half times the file's own value make no range"
        )
    if not (low < high and chosen.allows(low) and chosen.allows(high)):
        raise ValueError(
            f"from and to must ascend and be {chosen.valid_entry} for {key}, got {low:g} to {high:g}"
        )
    slow, fast = speeds_rpm or tuple(float(rpm(speed)) for speed in file.requirements.speeds)
    if not 0.0 < finite("speeds", slow) < finite("speeds", fast):
        raise ValueError(f"speeds must be greater than 0 and ascend, got {slow:g} to {fast:g}")
    values = [chosen.to_si(value) for value in np.linspace(low, high, cells).tolist()]
    provenance = (
        f"{report_arrays.describe(file)}, contact = {contact or 'as in the file'}, following = {following}"
    )
    _require_models(model, chosen, values, float(rad_per_s(fast)))
    chart = report_arrays.growth_map(
        model, chosen.si_name, values, np.linspace(slow, fast, cells), provenance, jobs=jobs
    )
    return Sweep(chosen, own, chart)


def _nearest(key: Key, value: float) -> float:
    """Return the value, or the end of the valid interval that is nearest to it."""
    return value if key.allows(value) else min(max(value, key.lowest), key.highest)


def _require_models(model: Model, key: Key, values: Sequence[float], speed: float) -> None:
    """Refuse values at which there is no such model, or that change nothing of it, before anything is computed."""
    systems = []
    # The second, too: what is a phase is the same again at the last.
    for value in (values[0], values[1], values[-1]):
        try:
            systems.append(system_at(replace_parameter(model, key.si_name, value), speed))
        except ValueError as problem:
            shown = f"{key.name} = {key.from_si(value):.6g} {key.unit}".rstrip()
            raise ValueError(f"with {shown}: {told_of_a_model(problem)}") from problem
    first, *others = (list(parts_of(system)) for system in systems)
    if all(len(first) == len(other) and all(map(np.array_equal, first, other)) for other in others):
        raise ValueError(
            f"parameter must be one that changes stability, got {key.name!r}: the model is the same at all its values"
        )
