"""Stability-based design of the face-gear body (section 4.7): critical thickness and weight, the flow of Fig. 4.6.

The critical thickness ratio of a drive is the smallest h/a above which it is stable at every operating speed. It is
the highest tip of all lobes of instability in the chart of speed and thickness (:mod:`facegear.maps.lobes`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from facegear.design.teeth import root_stress
from facegear.geometry.drive import Drive
from facegear.maps.lobes import CriticalThickness, highest_lobes
from facegear.maps.parallel import in_processes
from facegear.mechanics.contact import CENTROID, Contact
from facegear.mechanics.plate import THICKNESS_RATIO_RANGE, Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import ascending, keep, positive, within


def critical_thickness(
    drive: Drive,
    load: MeshLoad,
    speeds: tuple[float, float],
    *,
    thickness_range: tuple[float, float] = (0.025, 0.06),
    contact: Contact = CENTROID,
    contact_ratio: float | None = None,
    nodal_circles: int = 1,
    nodal_diameters: int = 3,
) -> CriticalThickness:
    """Critical thickness ratio h/a of a drive with one pinion (section 4.7.1).

    Parameters
    ----------
    drive : Drive
    load : MeshLoad
        μ, ζ, τ.
    speeds : tuple of float
        Operating speeds of the face gear, lowest and highest [rad/s]. The time it takes is nearly in inverse
        proportion to the lowest.
    thickness_range : tuple of float
        h/a between which the highest tip is looked for.
    contact : Contact
        How the teeth touch. Default as printed; a drive of a shaper with more teeth needs one of its own, such as
        ``fg.Contact(path=fg.loaded_contact(torque))``.
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh, in place of those of the contact.
    nodal_circles, nodal_diameters : int
        M and N of the body.

    Returns
    -------
    CriticalThickness
        To 1e-5 in h/a.

    Raises
    ------
    TypeError, ValueError
        As :func:`facegear.maps.lobes.highest_lobes`, or as :class:`Transverse` for what makes up the model.

    Examples
    --------
    >>> import facegear as fg
    >>> drive, load = fg.Drive(26, 130, 3.175e-3), fg.MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0)
    >>> speeds = fg.rad_per_s(950.0), fg.rad_per_s(1000.0)
    >>> found = fg.critical_thickness(drive, load, speeds, thickness_range=(0.03, 0.06))
    >>> f"{found.thickness_ratio:.4f}"
    '0.0336'
    """
    lowest, highest = ascending("speeds", speeds, "rad/s")
    body = Body(
        drive,
        within("thickness_range", thickness_range[1], *THICKNESS_RATIO_RANGE),
        nodal_circles=nodal_circles,
        nodal_diameters=nodal_diameters,
    )
    if contact_ratio is not None:
        contact = replace(contact, contact_ratio=contact_ratio)
    model = Transverse(body, load, contact=contact)
    (found,) = highest_lobes(_thickness_of(model), lowest, [highest], thickness_range)
    return found


def _thickness_of(model: Transverse) -> Callable[[float], Transverse]:
    """Return the model as a function of its thickness ratio."""

    def model_at(thickness_ratio: float) -> Transverse:
        return replace(model, body=replace(model.body, thickness_ratio=thickness_ratio))

    return model_at


@dataclass(frozen=True)
class Requirements:
    """What a design has to fulfil (Table 4.4).

    Parameters
    ----------
    power : float
        P [W].
    pinion_speed : float
        Ω1 at that power [rad/s].
    safety_factor : float
        SF of (4-22), 1 or greater.
    speeds : tuple of float
        Operating speeds of the face gear, lowest and highest [rad/s].

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or outside its range.
    """

    power: float
    pinion_speed: float
    safety_factor: float
    speeds: tuple[float, float]

    def __post_init__(self) -> None:
        keep(
            self,
            power=positive("power", self.power, "W"),
            pinion_speed=positive("pinion_speed", self.pinion_speed, "rad/s"),
            safety_factor=within("safety_factor", self.safety_factor, 1.0, 100.0),
            speeds=ascending("speeds", self.speeds, "rad/s"),
        )

    @property
    def pinion_torque(self) -> float:
        """Torque of a pinion P/Ω1 at its power [N m]."""
        return self.power / self.pinion_speed

    def root_stresses(self, body: Body) -> tuple[float, float]:
        """Bending stress at the root of the pinion's tooth (4-20, 4-21), and σ_Y/SF that is allowed (4-22) [Pa]."""
        stress = root_stress(body.drive, self.power, self.pinion_speed)
        return stress, body.material.yield_strength / self.safety_factor


@dataclass(frozen=True)
class BodyDesign:
    """Result of the design flow for one drive.

    Attributes
    ----------
    body : Body
        Face-gear body at the critical thickness.
    critical : CriticalThickness
        What decides it.
    root_stress : float
        σ_max [Pa] (4-20).
    allowable_stress : float
        σ_Y/SF [Pa] (4-22).
    """

    body: Body
    critical: CriticalThickness
    root_stress: float
    allowable_stress: float


def design_body(
    drive: Drive,
    load: MeshLoad,
    requirements: Requirements,
    thickness_range: tuple[float, float] = (0.025, 0.06),
    *,
    contact: Contact = CENTROID,
) -> BodyDesign:
    """Design a face-gear body for a drive: stress at the root, then thickness from stability (Fig. 4.6).

    Parameters
    ----------
    drive : Drive
    load : MeshLoad
        μ, ζ, τ.
    requirements : Requirements
    thickness_range, contact
        As for :func:`critical_thickness`.

    Returns
    -------
    BodyDesign
        Also where the stress is too high: a family of designs shows both.
    """
    speeds = requirements.speeds
    critical = critical_thickness(drive, load, speeds, thickness_range=thickness_range, contact=contact)
    return _design(drive, critical, requirements)


def _design(drive: Drive, critical: CriticalThickness, requirements: Requirements) -> BodyDesign:
    body = Body(drive, critical.thickness_ratio)
    return BodyDesign(body, critical, *requirements.root_stresses(body))


def design_family(
    drives: Sequence[Drive],
    load: MeshLoad,
    requirements: Requirements,
    highest_speeds: Sequence[float],
    thickness_range: tuple[float, float] = (0.025, 0.06),
    jobs: int = -1,
    *,
    contact: Contact = CENTROID,
) -> tuple[tuple[BodyDesign, ...], ...]:
    """Design bodies for many drives and several operating speed ranges, in parallel processes.

    Parameters
    ----------
    drives : sequence of Drive
    load : MeshLoad
    requirements : Requirements
        Its speed range gives the lowest speed.
    highest_speeds : sequence of float
        Upper ends of the operating speed ranges [rad/s].
    thickness_range, contact
        As for :func:`critical_thickness`.
    jobs : int
        Number of processes, as joblib's ``n_jobs``.

    Returns
    -------
    tuple of tuple of BodyDesign
        One row a drive, one entry a highest speed in the given order.
    """
    work = ((drive, load, requirements, tuple(highest_speeds), thickness_range, contact) for drive in drives)
    return tuple(in_processes(_designs, work, jobs))


def _designs(
    drive: Drive,
    load: MeshLoad,
    requirements: Requirements,
    highest_speeds: tuple[float, ...],
    thickness_range: tuple[float, float],
    contact: Contact,
) -> tuple[BodyDesign, ...]:
    """Designs of one drive."""
    model = Transverse(Body(drive, thickness_range[1]), load, contact=contact)
    found = highest_lobes(_thickness_of(model), requirements.speeds[0], highest_speeds, thickness_range)
    return tuple(_design(drive, critical, requirements) for critical in found)
