"""Forced response of the disk in words: how far it moves the force of a mesh, in which basis, or why not."""

from __future__ import annotations

import math
from collections.abc import Sequence

import xarray as xr

from facegear.drives.disk_response import EVEN, MOST_MOVED, RIGID, UNLOADED, DiskResponse, largest_departure
from facegear.drives.torsion_response import AT_BORDERS, parted
from facegear.support.parameters import rpm

# Significant digits of a force that two bases agree on, and of one that they do not.
_SETTLED_DIGITS, _OPEN_DIGITS = 3, 2


def sentences(found: Sequence[DiskResponse], static: float) -> tuple[str, ...]:
    """Say how far the force of a mesh departs from its static value [N], and of which models it does not, and why."""
    told = [_sentence(each, each.data, static) for each in found if each.data is not None]
    missing: dict[str, list[str]] = {}
    for each in found:
        if each.data is None:
            missing.setdefault(each.reason, []).append(f"{each.variant.teeth}; {each.variant.force}")
    if missing and not told:
        told.append("No model of the disk with the file's own contact has a forced response.")
    for reason, names in missing.items():
        told.append(f"No forced response of the disk ({'; '.join(dict.fromkeys(_joined(names)))}): {reason}.")
    return tuple(told)


def _joined(names: Sequence[str]) -> list[str]:
    """Name teeth without the direction of the force where both are there."""
    teeth = [name.partition("; ")[0] for name in names]
    return [
        kind if teeth.count(kind) > 1 else name.replace("; ", " and ")
        for kind, name in zip(teeth, names, strict=True)
    ]


def _sentence(found: DiskResponse, data: xr.Dataset, static: float) -> str:
    variant = found.variant
    known = data.dropna("speed", subset=["force_highest"])
    where = f"{variant.contact}; {variant.force}; {variant.teeth}"
    if not known.sizes["speed"]:
        return f"Forced response of the disk ({where}): unstable at all speeds looked at, nothing is steady."
    digits = _SETTLED_DIGITS if found.settled else _OPEN_DIGITS
    largest, speed = largest_departure(data)
    resonance = ""
    if data.sizes["peak"]:
        top = int(data["peak_force_rms"].values.argmax())
        place = rounded(float(rpm(data["peak_speed"].values[top])), digits + 1)
        resonance = f"; its strongest resonance is {data['peak_label'].values[top]} at {place} rpm"
    return (
        f"Forced response of the disk ({where}): a static transmission error of {1e6 * found.error:.3g} µm from peak "
        f"to peak, under the load of the drive, and as long as flanks do not part, moves the force of a "
        f"mesh by up to {rounded(largest, digits)} N, at {rounded(float(rpm(speed)), digits + 1)} rpm: "
        f"{rounded(largest / static, digits)} times the static {static:.4g} N{resonance}. "
        f"{_basis(found, digits)} {_parted(data, static)}"
    )


def _basis(found: DiskResponse, digits: int) -> str:
    """Say in which basis it is, and whether that suffices."""
    body = found.variant.model.gear.body
    here = (
        f"Computed with M = {body.nodal_circles} nodal circles and N = {body.nodal_diameters} nodal diameters"
    )
    if not math.isfinite(found.moved):
        return f"NOT SETTLED: {here[0].lower()}{here[1:]} alone, in no other basis to compare with."
    before = f"with two nodal diameters fewer it is {rounded(found.before, digits)} N"
    if found.settled:
        return f"{here}; {before}."
    return (
        f"NOT SETTLED: {here[0].lower()}{here[1:]}; {before}, {100 * found.moved:.3g} % off, where at most "
        f"{100 * MOST_MOVED:g} % count as settled: a larger basis may give another force."
    )


def _parted(data: xr.Dataset, static: float) -> str:
    """Say at how many speeds, and at how many peaks between them, flanks would part."""
    part = parted(data, static)
    words = f"Of {data.sizes['speed']} speeds it is stable at {part.known}, and flanks would part at {part.speeds}"
    rises = part.known < data.sizes["speed"] or data.attrs["at_borders"]
    last = AT_BORDERS if rises else ""
    if not (peaks := data.sizes["peak"]):
        return f"{words}.{last}"
    return f"{words}; of {peaks} {'peak' if peaks == 1 else 'peaks'} of resonances between them, at {part.peaks}.{last}"


def parting(found: Sequence[DiskResponse], static: float, in_torsion: xr.Dataset | None) -> str:
    """Say that flanks would part where the responses say so, of the disk in the model where it is worst.

    Parameters
    ----------
    found : sequence of DiskResponse
    static : float
        Force of a mesh at rest [N].
    in_torsion : xarray.Dataset or None
        Response of the gearbox, whose forces have the static one in them.

    Returns
    -------
    str
        A sentence; empty where none says so.
    """
    disk = [
        (parted(each.data, static), f"{each.variant.name}{'' if each.settled else ', NOT SETTLED'}")
        for each in found
        if each.data is not None
    ]
    places = []
    if disk:
        worst, name = max(disk, key=lambda each: (each[0].speeds, each[0].peaks))
        places.append((f"in the disk's motion ({name})", worst))
    if in_torsion is not None:
        places.append(("in torsion", parted(in_torsion)))
    told = [
        f"{where} at {part.speeds} of {part.known} speeds"
        + f" and {part.peaks} of the resonances between them" * bool(part.peaks)
        + f", where they are pulled by up to {rounded(part.pull / static, 2)} times the static force"
        for where, part in places
        if part.speeds or part.peaks
    ]
    if not told:
        return ""
    return (
        "It takes flanks to stay in contact, but under the load of the drive they WOULD PART: "
        f"{', and '.join(told)}; what becomes of the motion then it does not say."
    )


def steadiness_known(found: Sequence[DiskResponse]) -> bool:
    """Whether each model has a forced response, or nothing that could excite one."""
    return all(each.data is not None or each.reason in (RIGID, UNLOADED, EVEN) for each in found)


def rounded(number: float, digits: int) -> str:
    """Write a number to so many significant digits, without an exponent where others would be zeros.

    Examples
    --------
    >>> rounded(12345.6, 2), rounded(0.12345, 3)
    ('12000', '0.123')
    """
    return f"{float(f'{number:.{digits}g}'):.10g}"
