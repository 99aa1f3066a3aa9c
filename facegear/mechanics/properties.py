"""What a face gear is made of, and what a pinion with its bearing is to it (section 4.4)."""

from dataclasses import dataclass, field

from facegear.support.parameters import designed, keep, nonnegative, within


@dataclass(frozen=True)
class Material:
    """Isotropic linear elastic material of the face-gear body.

    Parameters
    ----------
    density : float
        ρ [kg/m³], from 100 to 30000.
    youngs_modulus : float
        E [Pa], from 1e8 to 2e12.
    poissons_ratio : float
        ν, from 0 to 0.5.
    viscous_loss_factor : float
        ξ [s], from 0 to 0.01: damping stress over elastic stress rate.
    yield_strength : float
        σ_Y [Pa], from 1e6 to 1e10.

    Raises
    ------
    TypeError, ValueError
        A value is not a number or outside the range named above.
    """

    density: float
    youngs_modulus: float
    poissons_ratio: float
    viscous_loss_factor: float = field(metadata=designed("loss factor of the material"))
    yield_strength: float

    def __post_init__(self) -> None:
        keep(
            self,
            density=within("density", self.density, 100.0, 30e3, "kg/m³"),
            youngs_modulus=within("youngs_modulus", self.youngs_modulus, 1e8, 2e12, "Pa"),
            poissons_ratio=within("poissons_ratio", self.poissons_ratio, 0.0, 0.5),
            viscous_loss_factor=within("viscous_loss_factor", self.viscous_loss_factor, 0.0, 0.01, "s"),
            yield_strength=within("yield_strength", self.yield_strength, 1e6, 1e10, "Pa"),
        )


STEEL = Material(
    density=7840.0,
    youngs_modulus=200e9,
    poissons_ratio=0.3,
    viscous_loss_factor=5e-6,
    yield_strength=439.9e6,
)
"""Steel of the dissertation's face gears, its table 4.3.

Examples
--------
>>> import facegear as fg
>>> fg.STEEL.density, fg.STEEL.youngs_modulus, fg.STEEL.poissons_ratio
(7840.0, 200000000000.0, 0.3)
>>> from dataclasses import replace
>>> replace(fg.STEEL, viscous_loss_factor=1e-6).viscous_loss_factor  # less damping
1e-06
"""


@dataclass(frozen=True)
class MeshLoad:
    """Pinion and its bearing as the face gear feels them, dimensionless (4-17 to 4-19).

    Parameters
    ----------
    stiffness : float
        μ, bearing stiffness over the reference stiffness of the disk (4-17), 0 or greater.
    damping : float
        ζ [s], bearing damping over bearing stiffness (4-18), from 0 to 0.01.
    mass : float
        τ, pinion mass over its nominal mass (4-19), 0 or greater.

    Raises
    ------
    TypeError, ValueError
        A value is not a number or outside the range named above.

    Examples
    --------
    >>> import facegear as fg
    >>> fg.MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0)
    MeshLoad(stiffness=0.6, damping=3e-06, mass=1.0)
    """

    stiffness: float = field(metadata=designed("bearing stiffness"))
    damping: float = field(metadata=designed("bearing damping"))
    mass: float = field(metadata=designed("pinion mass"))

    def __post_init__(self) -> None:
        keep(
            self,
            stiffness=nonnegative("stiffness", self.stiffness),
            damping=within("damping", self.damping, 0.0, 0.01, "s"),
            mass=nonnegative("mass", self.mass),
        )
