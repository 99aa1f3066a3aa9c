"""Where a torque presses the flank of a tooth while it goes through the mesh: its contact pattern."""

from __future__ import annotations

from functools import partial

import numpy as np
import xarray as xr

from facegear.mechanics.loaded_contact import LoadedContact
from facegear.support.labelled import variable
from facegear.support.parameters import integer_at_least


def loaded_contact_pattern(contact: LoadedContact, *, lines: int = 121, points: int = 121) -> xr.Dataset:
    """Load per length of face on a flank, all the way through the mesh.

    Parameters
    ----------
    contact : LoadedContact
        Of a law by which the flank gives way along its lines; for `pair`, which has no such law, that of `slice`.
    lines : int, optional
        Lines of contact, from the first to the last that there may be, at least 2.
    points : int, optional
        Along each line, from its inner to its outer end, at least 2.

    Returns
    -------
    xarray.Dataset
        ``pressure`` (age, point) [N/m], 0 where nothing presses, and where: ``position`` u along the face and
        ``height`` below the gear's tooth top (age, point) [m]; ``age`` in mesh periods, from the first line, and
        ``torque`` at the pinion [N m] beside them.

    Raises
    ------
    TypeError, ValueError
        Naming the argument.

    Examples
    --------
    >>> import facegear as fg
    >>> drive = fg.Drive(26, 130, 3.175e-3, shaper_teeth=27)
    >>> pattern = loaded_contact_pattern(fg.LoadedContact(drive, torque=30.0), lines=41, points=41)
    >>> print(f"{float(pattern.pressure.max()) / 1e3:.0f} N/mm at most")
    33 N/mm at most
    """
    lines, points = integer_at_least("lines", lines, 2), integer_at_least("points", points, 2)
    slices, drive = contact.slices, contact.drive
    age = np.linspace(0.0, slices.sweep, lines + 2)[1:-1]
    inner, outer = slices.ends(age)
    s = inner[:, np.newaxis] + (outer - inner)[:, np.newaxis] * np.linspace(0.0, 1.0, points)
    q = slices.pressure_angle(s)
    rolls = slices.roll(q, slices.limits[0] - age[:, np.newaxis] * slices.pitch)
    height = drive.contact_region.depth(q, rolls) - drive.generating.tooth_top_distance
    both = ("age", "point")
    length = partial(variable, both, units="m", atol=1e-10)
    return xr.Dataset(
        {
            "pressure": variable(
                both, contact.line_load(age, s), "Load per length", "N/m", rtol=1e-8, atol=1e-3
            ),
            "position": length(slices.position(s), "Along the face"),
            "height": length(height, "Below the tooth top"),
        },
        {"torque": contact.torque, "age": age, "point": np.arange(points)},
    )
