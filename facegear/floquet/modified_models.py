"""Models made of another one: without its rigid-body motions, or under forces."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from facegear.floquet.models import Coordinate, Model, require_model, system_at
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.rigid_motion import without_rigid_motion
from facegear.support.kinds import named


@dataclass(frozen=True)
class WithoutRigidMotion:
    """A model whose rigid-body motions are taken out at each speed.

    See :func:`facegear.floquet.rigid_motion.without_rigid_motion`.

    Parameters
    ----------
    model : Model
        Such as a train of gears on shafts that hang on nothing.

    Examples
    --------
    Two masses on one spring, which nothing holds: of two coordinates one is left.

    >>> from dataclasses import dataclass
    >>> import numpy as np
    >>> import facegear as fg
    >>> @dataclass(frozen=True)
    ... class Pair:
    ...     coordinates = ()
    ...
    ...     def system(self, speed):
    ...         spring = np.array([[1.0, -1.0], [-1.0, 1.0]])
    ...         return fg.PeriodicSystem(np.eye(2), 0.01 * spring, spring, (), period=1.0 / speed)
    >>> fg.WithoutRigidMotion(Pair()).system(2.0).size
    1
    """

    model: Model

    def __post_init__(self) -> None:
        require_model(self.model)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """One for each motion that is left, by number: they mix the coordinates of the model."""
        # Rigid-body motions meet no spring at any speed.
        return tuple(Coordinate(f"motion {k + 1}", "") for k in range(self.system(1.0).size))

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of what is left, at a constant speed [rad/s]."""
        return without_rigid_motion(system_at(self.model, speed))


@dataclass(frozen=True)
class Excited:
    """A model under forces and transmission errors of the mesh period: what makes a stable drive vibrate.

    Stability does not hang on them; :func:`facegear.floquet.response.steady_response` and
    :func:`facegear.maps.response_map.frequency_response` have what they cause.

    Parameters
    ----------
    model : Model
    force : PiecewiseChebyshev, optional
        Generalised forces against t/T0, one component a coordinate: torques and their ripple, for example. Default:
        those that the model has by itself.
    transmission_error : PiecewiseChebyshev, optional
        Static transmission error e of the unloaded mesh against t/T0 [m] (or an angle, as u has it), the same at all
        loads. Default: those of the model.

    Raises
    ------
    TypeError
        If an argument is of the wrong kind.

    Examples
    --------
    >>> import facegear as fg
    >>> import numpy as np
    >>> from facegear.mechanics.classical import Mathieu
    >>> wave = fg.PiecewiseChebyshev.fit(lambda x, piece: 1e-6 * np.cos(2.0 * np.pi * x), [0.0])
    >>> (load,) = fg.Excited(Mathieu(depth=0.2), transmission_error=wave).system(0.7).loads
    >>> load.transmission_error is wave
    True
    """

    model: Model
    force: PiecewiseChebyshev | None = None
    transmission_error: PiecewiseChebyshev | None = None

    def __post_init__(self) -> None:
        require_model(self.model)
        for name in ("force", "transmission_error"):
            value = getattr(self, name)
            if value is not None and not isinstance(value, PiecewiseChebyshev):
                raise TypeError(f"{name} must be a PiecewiseChebyshev or None, got {named(value)}")
        if self.transmission_error is not None and self.transmission_error.components != 1:
            raise ValueError(
                f"transmission_error must have one component, got {self.transmission_error.components}"
            )

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Those of the model."""
        return self.model.coordinates

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of the model at a constant speed [rad/s], forces put in.

        Raises
        ------
        TypeError, ValueError
            If the model's loads do not take them, see :class:`facegear.floquet.loads.ContactLoad`, or there are no
            loads.
        """
        system = system_at(self.model, speed)
        if self.force is not None:
            system = dataclasses.replace(system, force=self.force)
        if self.transmission_error is not None:
            if not system.loads:
                raise ValueError(
                    "transmission_error must be None for a model without loads that would feel it"
                )
            loads = (dataclasses.replace(x, transmission_error=self.transmission_error) for x in system.loads)
            system = dataclasses.replace(system, loads=tuple(loads))
        return system
