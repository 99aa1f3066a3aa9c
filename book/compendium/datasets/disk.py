"""Arrays of chapter 4's figures that show the disk and the motion of its load, with units and tolerances."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.geometry.kinematics import ContactPath
from facegear.mechanics.disk import disk_stiffness, reference_stiffness
from facegear.mechanics.pinions_on_disk import nominal_pinion_mass
from facegear.mechanics.plate import Body
from facegear.support.labelled import variable
from facegear.support.parameters import rad_per_s


def stiffness_of_disk(body: Body, speeds_rpm: ArrayLike) -> xr.Dataset:
    """Stiffness of the disk against speed at the middle and the two ends of the teeth (4-16).

    Parameters
    ----------
    body : Body
    speeds_rpm : array_like
        Speeds of the face gear [rpm].

    Returns
    -------
    xarray.Dataset
        ``stiffness`` (place, speed_rpm) [N/m], ``place`` the fraction of the face width from R1; ``reference``
        [N/m], the denominator of (4-17); ``pinion_mass`` [kg], that of (4-19).
    """
    speeds = np.asarray(speeds_rpm, dtype=float)
    places = np.array([0.0, 0.5, 1.0])
    radii = body.drive.inner_radius + places * (body.drive.outer_radius - body.drive.inner_radius)
    values = [disk_stiffness(body, rad_per_s(speeds), float(radius)) for radius in radii]
    exact = {"rtol": 1e-9}
    return xr.Dataset(
        {
            "stiffness": variable(
                ("place", "speed_rpm"), values, "Transverse stiffness of the disk", "N/m", **exact
            ),
            "reference": variable((), reference_stiffness(body), "Reference stiffness", "N/m", **exact),
            "pinion_mass": variable((), nominal_pinion_mass(body), "Nominal pinion mass", "kg", **exact),
        },
        coords={"place": places, "speed_rpm": speeds},
        attrs={
            "parameters": f"outer_radius_mm = {1e3 * body.outer_radius:.8g}, "
            f"thickness_ratio = {body.thickness_ratio:.10g}"
        },
    )


def centroid_motion(body: Body, contact_ratios: Sequence[float], samples: int = 401) -> xr.Dataset:
    """Contact centroid over one mesh period on several clocks.

    Parameters
    ----------
    body : Body
    contact_ratios : sequence of float
        Mesh periods that a tooth pair stays in mesh.
    samples : int, optional
        Instants.

    Returns
    -------
    xarray.Dataset
        ``radius`` [m] and ``angle`` [rad] over (contact_ratio, time), time in mesh periods.
    """
    time = np.linspace(0.0, 1.0, samples)
    states = [ContactPath(body.drive, ratio).centroid(time) for ratio in contact_ratios]
    both = ("contact_ratio", "time")
    return xr.Dataset(
        {
            "radius": variable(both, [state.radius for state in states], "Radius", "m", atol=1e-11),
            "angle": variable(both, [state.angle for state in states], "Angle", "rad", atol=1e-10),
        },
        coords={"contact_ratio": list(contact_ratios), "time": time},
        attrs={
            "parameters": f"pinion_teeth = {body.drive.pinion_teeth}, gear_teeth = {body.drive.gear_teeth}"
        },
    )
