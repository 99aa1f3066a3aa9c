"""A model that no module has heard of, with a coordinate and loads of its own, goes wherever the built-in ones go."""

from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from itertools import pairwise

import numpy as np
import plotly.graph_objects as go
import pytest
from scipy.integrate import solve_ivp

from facegear.design.changes import effects_of_changes, possible_changes
from facegear.drives import explore, explorer, report_arrays
from facegear.drives.cell import cell_detail
from facegear.drives.cell_figure import cell_figure
from facegear.drives.studies.study import Quantity, Study
from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate, replace_parameter
from facegear.floquet.multipliers import growth_rate, multipliers
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.timed_pairs import mesh_period
from facegear.maps.sensitivity import sensitivity
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import borders, tongues
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import disk_coordinates, disk_matrices, modal_mass, unit_shape
from facegear.mechanics.plate import Body
from facegear.support.parameters import designed
from tests.figures import texts


@dataclass(frozen=True)
class SpringyTeeth:
    """A disk whose tooth pairs are springs to a pinion of its own mass: one more coordinate, two weighted loads."""

    body: Body
    tooth_stiffness: float = field(metadata=designed("tooth stiffness"))
    bearing_stiffness: float = field(metadata=designed("bearing of the pinion"))
    pinion_mass: float = field(metadata=designed("mass of the pinion"))
    contact: Contact = Contact(sharing="each")  # noqa: RUF009

    @property
    def coordinates(self):
        return (*disk_coordinates(self.body), Coordinate("pinion", "m kg^½", "pinion"))

    def system(self, speed):
        body, drive = self.body, self.body.drive
        damping, stiffness = (np.pad(matrix, (0, 1)) for matrix in disk_matrices(body, speed))
        stiffness[-1, -1] = self.bearing_stiffness / self.pinion_mass
        damping[-1, -1] = 1e-6 * stiffness[-1, -1]
        return PeriodicSystem(np.eye(len(damping)), damping, stiffness, self.loads, mesh_period(drive, speed))

    @cached_property
    def loads(self):
        """The two of them, which do not depend on speed: fits of positions and weights are made once."""
        body, drive = self.body, self.body.drive
        scale = np.sqrt(modal_mass(body))

        def both(x, angle):
            disk = unit_shape(body.modes, x, angle) / drive.outer_radius / scale
            return np.concatenate([disk, np.full((*x.shape, 1), -1 / np.sqrt(self.pinion_mass))], axis=-1)

        def share(pair):
            def weight(x, piece):
                return 1.0 + 0.3 * np.sin(2 * np.pi * x) if pair == 0 else 0.4 * np.ones_like(x)

            return PiecewiseChebyshev.fit(weight, [0.0])

        return [
            ContactLoad(
                place.shape(both),
                stiffness=self.tooth_stiffness,
                damping=1e-6 * self.tooth_stiffness,
                rate="total",
                weight=share(pair),
            )
            for pair, place in enumerate(self.contact.places(drive))
        ]


BODY = Body(Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=1)
MODEL = SpringyTeeth(BODY, tooth_stiffness=2e6, bearing_stiffness=5e5, pinion_mass=0.5)
SPEEDS = (30.0, 45.0)
FOUND = tongues(MODEL, SPEEDS)


@cache
def by_integration(model, speed):
    """Largest multiplier by an integrator that knows neither pieces of Chebyshev series nor methods of the package."""
    system = model.system(speed)
    state = np.eye(2 * system.size)
    edges = np.append(system.breakpoints, 1.0)
    for start, end in pairwise(edges):
        solution = solve_ivp(
            lambda x, y, end=end: (
                system.period
                * system.state_matrix(x, "left" if x >= end else "right")
                @ y.reshape(2 * system.size, -1)
            ).ravel(),
            (start, end),
            state.ravel(),
            method="DOP853",
            rtol=1e-11,
            atol=1e-13,
        )
        state = solution.y[:, -1].reshape(state.shape)
    return np.abs(np.linalg.eigvals(state)).max()


def test_it_has_two_weighted_loads_and_a_coordinate_of_its_own():
    system = MODEL.system(40.0)
    assert len(system.loads) == 2
    assert all(load.weight is not None for load in system.loads)
    assert system.size == len(MODEL.coordinates) == 4
    assert [coordinate.part for coordinate in MODEL.coordinates] == ["face gear"] * 3 + ["pinion"]


def test_tongues_and_labels():
    assert FOUND
    for tongue in FOUND:
        assert by_integration(MODEL, tongue.peak) > 1.0
        width = tongue.upper - tongue.lower
        for outside in (tongue.lower - 0.05 * width, tongue.upper + 0.05 * width):
            if SPEEDS[0] < outside < SPEEDS[1] and not any(t.lower <= outside <= t.upper for t in FOUND):
                assert by_integration(MODEL, outside) <= 1.0 + 1e-9
        combination = tongue.combination
        assert 1 <= combination.k <= combination.j <= 4
        assert tongue.label.endswith(f")/{combination.order}")


@pytest.mark.parametrize("parameter", ["tooth_stiffness", "pinion_mass", "thickness_ratio", "contact_ratio"])
def test_map_over_any_parameter(parameter):
    start = {"tooth_stiffness": 2e6, "pinion_mass": 0.5, "thickness_ratio": 0.03, "contact_ratio": 1.5}
    values = start[parameter] * np.array([0.9, 1.0, 1.1])
    chart = stability_map(MODEL, SPEEDS, parameter, values, jobs=1, progress=False)
    for value, row in zip(values.tolist(), chart.values, strict=True):
        changed = replace_parameter(MODEL, parameter, value)
        for speed, growth in zip(SPEEDS, row, strict=True):
            period = changed.system(speed).period
            assert growth == pytest.approx(np.log(by_integration(changed, speed)) / period, abs=1e-5)


def test_borders_over_a_parameter():
    (section,) = borders(MODEL, "tooth_stiffness", [2e6], SPEEDS, jobs=1, progress=False)
    assert [tongue.label for tongue in section.tongues] == [tongue.label for tongue in FOUND]


def test_sensitivity_to_its_parameters():
    tongue = max(FOUND, key=lambda t: t.growth_rate)
    names = ("tooth_stiffness", "bearing_stiffness", "pinion_mass")
    found = sensitivity(replace(MODEL, contact=Contact(sharing="each")), tongue.peak, names[:2])
    for name, derivative in zip(names[:2], found.growth_rate_derivatives, strict=True):
        value = getattr(MODEL, name)
        ends = [
            growth_rate(replace(MODEL, **{name: value * (1 + s)}).system(tongue.peak)) for s in (-1e-4, 1e-4)
        ]
        assert derivative == pytest.approx((ends[1] - ends[0]) / (2e-4 * value), rel=1e-4)


def test_cell_shows_the_disk_and_the_pinion():
    tongue = max(FOUND, key=lambda t: t.growth_rate)
    detail = cell_detail(MODEL, tongue.peak)
    assert list(detail.deflections) == ["face gear"]
    assert detail.history["coordinate"].values.tolist() == ["pinion"]
    assert detail.label == tongue.label
    assert np.abs(detail.multipliers) == pytest.approx(
        np.abs(multipliers(MODEL.system(tongue.peak))), abs=1e-9
    )
    figure = cell_figure(detail)
    figure.canvas.draw()
    assert "critical motion, real part" in texts(figure)
    assert "time [periods]" in texts(figure)


def test_report_ranks_what_can_be_changed():
    names = [change.name for change in possible_changes(MODEL)]
    assert "tooth stiffness" in names
    assert "thickness of the body" in names
    table = effects_of_changes(MODEL, FOUND, SPEEDS, "own model", followed=1)
    assert sorted(table["change_name"].values) == sorted(names)
    assert np.isfinite(table["growth_slope"].values).all()
    tongue_table = report_arrays.tongue_table(FOUND, "own model")
    assert tongue_table["label"].values.tolist() == [tongue.label for tongue in FOUND]
    chart = report_arrays.combinations(MODEL, FOUND, [300.0, 400.0], "own model")
    assert chart.sizes["mode"] == 4
    grown = report_arrays.growth_map(MODEL, "tooth_stiffness", [1e6, 2e6], [300.0, 400.0], "own model")
    assert grown["growth_rate"].shape == (2, 2)


def test_explorer():
    controls = (
        Quantity(
            "tooth_stiffness", "tooth stiffness [MN/m]", 1.0, 3.0, 2.0, 0.1, 1e6, parameter="tooth_stiffness"
        ),
    )
    speed = Quantity("highest_speed", "speed [rad/s]", 10.0, 100.0, 45.0, 1.0)
    study = Study(
        controls,
        lambda settings: replace(MODEL, tooth_stiffness=settings["tooth_stiffness"]),
        "tooth_stiffness",
        speed,
        columns=6,
        rows=4,
    )
    shown = explore.view(study, 40.0, 2.0)
    drawn = explorer.picture(shown)
    drawn.canvas.draw()
    assert "tooth stiffness [MN/m]" in texts(drawn)
    live = explorer.MapExplorer(study)
    assert isinstance(live.figure, go.FigureWidget)
    live.controls["tooth_stiffness"].value = 1.5
    assert "Not possible" not in live.message.value
    assert "data:image/png" in live.picture.value
