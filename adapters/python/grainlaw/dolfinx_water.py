# mypy: allow-untyped-calls
"""Pore water in DOLFINx 0.5: displacements and pore pressure (u-p) at finite strain, with Darcy's flow and
backward Euler in time. Grains do not change their volume.

    water = PoreWater(permeability=1e-9)            # refused before any point is made
    w = fem.Function(water_space(domain))           # (u, p): P2 beside P1
    points = Points(domain, material, degree=2)
    newton = WaterNewton(points, w, conditions, apply=set_load, water=water, external=lambda v: ...)
    for part in newton.to(0): ...                   # loads that act at once: nothing drains
    newton.step_time = 3600                         # [s] of each load step from here
    for part in newton.to(1): ...

The pressure p is that above water at rest. With J = det F, s the volume of the grains over that of the
point at F = I, and h the values at the end of the last part of a step:

    stress           P - p J F^-T                  of packing and water
    volume of water  J - s - (h.J - s) exp((h.p - p) / bulk_modulus)   that came in a part
    flow             k J F^-1 F^-T grad p          [m/s], against it
"""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from .abi import Error
from .arguments import number
from .arrays import Array
from .dolfinx import Newton, Points, assembled
from .march import March
from .material import AnyPath
from .names import Measure, Status

_ELASTIC_SHARE = 0.5   # solid share of points in closed form, as of a rehearsal

__all__ = ["PoreFlow", "PoreWater", "WaterNewton", "check_drainage", "water_space"]


@dataclasses.dataclass(frozen=True)
class PoreWater:
    """What flows in the pores. Raises Error where it cannot."""

    permeability: float             #: hydraulic conductivity over unit weight, at F = I [m2/(Pa s)]
    bulk_modulus: float = math.inf  #: of water [Pa]; inf: incompressible
    kozeny_carman: bool = False     #: permeability by void ratio e: k e^3 / (1 + e), over that at F = I

    def __post_init__(self) -> None:
        if not 0 < number("permeability", self.permeability, finite=False) < math.inf:
            raise Error(Status.BAD_ARGUMENT, f"the permeability is {self.permeability} m2/(Pa s), expected "
                        "above 0; a step_time of 0 is undrained")
        if not number("bulk modulus", self.bulk_modulus, finite=False) > 0:
            raise Error(Status.BAD_ARGUMENT,
                        f"the bulk modulus of water is {self.bulk_modulus} Pa, expected above 0")


def water_space(domain: Any) -> Any:
    """Of displacements and pressures: quadratic and linear (Taylor-Hood)."""
    cell = domain.ufl_cell()
    return fem.FunctionSpace(domain, ufl.MixedElement(ufl.VectorElement("Lagrange", cell, 2),
                                                      ufl.FiniteElement("Lagrange", cell, 1)))


class PoreFlow:
    """The forms of water in the pores of points, and what they count from.

    w      a function of water_space(), with ghosts
    there  1 where points are, a quadrature function"""

    former: Any   #: w at the end of the last part of a step
    time: Any     #: that passes in this one, a constant [s]
    solid: Any    #: volume of the grains over that of each point at F = I, a quadrature function [-]
    scale: Any    #: stress that an error of volume counts as, the same at all points [Pa/m]

    def __init__(self, points: Points, w: Any, water: PoreWater, there: Any = 1) -> None:
        self._points, self._w, self._water, self._there = points, w, water, there
        self.former, self.time = fem.Function(w.function_space), fem.Constant(points.domain, 0.0)
        nothing = np.zeros(len(points.layer))
        self.solid, self.scale = points.scalars(nothing), points.scalars(nothing)
        self.hold()

    def hold(self) -> None:
        """What comes from now on counts from w."""
        self.former.x.array[:] = self._w.x.array

    def weigh(self) -> None:
        """Take the solid shares from the committed points, at w."""
        self.solid.x.array[:] = self._points.scalars(_solid_shares(self._points, self._w)).x.array

    def measure(self) -> None:
        """Take the scale from the tangents of the points."""
        points = self._points
        scale = _modulus(points) / _size(points)
        self.scale.x.array[:] = points.scalars(np.full(len(points.layer), scale)).x.array

    def push(self, test: Any, mark: Any = 1) -> Any:
        """The work of the pressure, of marked points."""
        F, p = _gradient(self._w), ufl.split(self._w)[1]
        cofactor = ufl.det(F) * ufl.inv(F).T
        return -mark * self._there * p * ufl.inner(cofactor, ufl.grad(ufl.split(test)[0])) * self._points.dx

    def came(self, test: Any) -> Any:
        """The volume of water that came and flowed, as the stress that it makes."""
        F, s, k = _gradient(self._w), self.solid, self._water.permeability
        J, p, q = ufl.det(F), ufl.split(self._w)[1], ufl.split(test)[1]
        former_J, former_p = ufl.det(_gradient(self.former)), ufl.split(self.former)[1]
        if self._water.kozeny_carman:
            k *= ((J - s) / (1 - s))**3 / J
        left = former_J - s
        if math.isfinite(self._water.bulk_modulus):
            left *= ufl.exp((former_p - p) / self._water.bulk_modulus)
        f = ufl.inv(F)
        flow = k * J * f * f.T * ufl.grad(p)
        return self._there * self.scale * ((J - s - left) * q
                                           + self.time * ufl.inner(flow, ufl.grad(q))) * self._points.dx


class WaterNewton(Newton):
    """Newton with pore water. A side without a condition on the pressure is sealed.

    w           a function of water_space()
    conditions  on w.sub(0), displacements, and w.sub(1), pressures; at least one part is drained, or
                displacements leave the volume free, or water is compressible
    external    the form of the work of external loads in a test displacement

    The others are those of Newton. residuals and force() count the stress of packing and water. Raises
    Error as it does, and where nothing determines the pressure."""

    step_time: float = 0   #: that passes in a load step [s], in a part of it so much less; 0: undrained
    flow: PoreFlow

    def __init__(self, points: Points, w: Any, conditions: Sequence[Any], apply: Callable[[float], None],
                 water: PoreWater, external: Callable[[Any], Any] | None = None,
                 tell: Callable[[str], object] | None = None, **march: float) -> None:
        self.flow = PoreFlow(points, w, water)
        self._set_load, self._length = apply, 0.0
        self.flow.weigh()
        check_drainage(w, conditions, water)
        super().__init__(points, w, conditions, self._apply_with_time, external=lambda test:
                         (external(ufl.split(test)[0]) if external else 0) - self.flow.came(test),
                         internal=self.flow.push, tell=tell, **march)
        self.flow.measure()

    def to(self, load: float) -> Iterator[March]:
        """As Newton.to, in step_time; from 0 to 0 no time passes."""
        check_time(self.step_time)
        self._length = load - self.march.reached
        for part in super().to(load):
            self.flow.hold()
            yield part

    def load(self, path: AnyPath) -> None:
        """As Newton.load."""
        super().load(path)
        self.flow.weigh()
        self.flow.hold()

    def _apply_with_time(self, load: float) -> None:
        passed = (load - self.march.reached) / self._length if self._length else 0
        self.flow.time.value = self.step_time * passed
        self._set_load(load)


def check_time(step_time: float) -> None:
    """Raises Error for a time that does not pass."""
    if not 0 <= number("step_time", step_time, finite=False) < math.inf:
        raise Error(Status.BAD_ARGUMENT, f"step_time is {step_time} s, expected at least 0")


def _gradient(w: Any) -> Any:
    u = ufl.split(w)[0]
    return ufl.Identity(len(u)) + ufl.grad(u)


def _solid_shares(points: Points, w: Any) -> Array:
    """Volume of the grains over that of each point at F = I [-]."""
    solid = np.full(len(points.layer), _ELASTIC_SHARE)
    J = points.values(ufl.det(_gradient(w)))[points.grains]
    solid[points.grains] = J / (1 + points.states.measure(Measure.VOID_RATIO))
    return solid


def check_drainage(w: Any, conditions: Sequence[Any], water: PoreWater) -> None:
    """Raises Error where nothing determines the pressure. WaterNewton calls it; a script may before it makes
    points."""
    V = w.function_space
    own = V.dofmap.index_map.size_local * V.dofmap.index_map_bs
    fixed = np.zeros(own, bool)
    for condition in conditions:
        dofs = condition.dof_indices()[0]
        fixed[dofs[dofs < own]] = True
    of_pressure = np.asarray(V.sub(1).collapse()[1])
    drained = fixed[of_pressure[of_pressure < own]].any()
    test = ufl.split(ufl.TestFunction(V))[0]
    forces = np.abs(assembled(fem.form(ufl.div(test) * ufl.dx)))
    free = forces[~fixed].max(initial=0)
    drained, free, largest = (V.mesh.comm.allreduce(value, MPI.MAX)
                              for value in (bool(drained), free, forces.max(initial=0)))
    if not drained and math.isinf(water.bulk_modulus) and free <= 1e-12 * largest:
        raise Error(Status.BAD_ARGUMENT, "nothing determines the pore pressure: no side is drained, water is "
                    "incompressible and no displacement changes the volume; expected a condition on it")


def _modulus(points: Points) -> float:
    """Mean stiffness of one component of F of the points of all ranks [Pa]."""
    square = points.dimension**2
    diagonal = np.abs(points.values(ufl.as_vector([points.A[k, k] for k in range(square)])))
    total, count = points.comm.allreduce(np.array([diagonal.sum(), diagonal.size]))
    return float(total / count)


def _size(points: Points) -> float:
    """Mean distance of points [m]."""
    one = fem.form(fem.Constant(points.domain, 1.0) * points.dx)
    volume = points.comm.allreduce(np.array([fem.assemble_scalar(one), len(points.layer)]))
    return float((volume[0] / volume[1])**(1 / points.dimension))
