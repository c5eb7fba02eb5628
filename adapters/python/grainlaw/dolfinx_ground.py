# mypy: allow-untyped-calls
"""Ground in DOLFINx 0.5: horizontal layers under their weight, stages, supports and cells that leave. The
last axis goes up.

    layers = [Layer(-2, "loose.toml", 2650), Layer(-6, Elastic(50e6, 0.3), 2000)]
    ground = Ground(domain, 0, layers)
    ground.hold(lambda x: np.isclose(x[1], -6), 1)             # the supports
    ground.hold(lambda x: np.isclose(x[0], 0) | np.isclose(x[0], 4), 0)
    ground.geostatic()
    list(ground.to(0))                                         # in balance where nothing has moved
    ground.stage()                                             # changes from here on, over one more run
    ground.hold(lambda x: np.isclose(x[0], 2) & (x[1] > -1.01), 0)   # a smooth wall
    ground.excavate(lambda x: (x[0] < 2) & (x[1] > -1))
    for step in range(10):
        for part in ground.to((step + 1) / 10): ...

With water=PoreWater(1e-9) the pores are full of water, displacements are quadratic and ground.u is (u, p):

    ground.drain(lambda x: np.isclose(x[1], 0))                # the rest is sealed, also what is laid bare
    ground.step_time = 3600                                    # [s] of each load step from here; 0: undrained

Points are made by geostatic(), once layers, supports and loads have been checked. With rehearse=True every
layer is elastic: a script goes through its stages in seconds, and its mistakes are told, as ValueError.
Places x (d, n) [m] are those at first. All functions are calls of all ranks together, and raise on all.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

from .abi import Error
from .arguments import number, whole
from .arrays import Array
from .dolfinx import Elastic, Points, assembled, direct_solver
from .dolfinx_checks import Layer, Parts, check_layers, check_pores, place, tell_first
from .dolfinx_water import PoreFlow, PoreWater, check_time, water_space
from .march import March
from .material import AnyPath
from .names import Action, Measure, Status
from .ranks import read_material, together

_petsc: Any = fem.petsc
_REHEARSAL = Elastic(1e8, 0.3)
_LATER = ("points", "march", "unit_weights", "_unit", "_internal")   # once the points are made
Region = Callable[[Array], npt.NDArray[np.bool_]]

__all__ = ["Elastic", "Ground", "Layer"]


class Ground:
    """Horizontal layers, the uppermost first.

    surface   height of the ground [m]
    order     of the displacements, 1 or 2
    rehearse  whether all layers are elastic
    lend      whether ranks lend each other points, as of Points
    water     in the pores: densities are those of the grains less that of water
    degree    of the quadrature, by default 1 of linear displacements and 2 of quadratic ones
    march     options of March, as tolerance=1e-9: |force on the unknowns| / |nodal forces of P| [-]

    What is wrong with layers raises ValueError, or Error for a file."""

    u: Any                               #: displacements [m], with water (displacements, pressures [Pa])
    points: Points                       #: once geostatic() or load() has made them
    fraction: float                      #: of the run that is committed
    unit_weights: Array                  #: of the layers, from their void ratio [N/m3]
    step_time: float = 0                 #: in which water flows, of a load step [s]; 0: undrained

    def __init__(self, domain: Any, surface: float, layers: Sequence[Layer], gravity: float = 9.81,
                 order: int = 1, rehearse: bool = False, water: PoreWater | None = None,
                 degree: int | None = None, lend: bool = False, **march: float) -> None:
        check_layers(domain, surface, layers, gravity)
        whole("order", order, 1, 2)
        if not isinstance(water, PoreWater | None):
            raise ValueError(f"water {water!r}: expected PoreWater(permeability) or None")
        if water is not None and not rehearse:
            check_pores(layers)
        self.domain, self.comm, self.dimension = domain, domain.comm, domain.topology.dim
        self.layers, self.gravity, self._options = list(layers), gravity, {"tolerance": 1e-9, **march}
        self._tops = [surface] + [layer.bottom for layer in layers[:-1]]
        self._up, self.water = self.dimension - 1, water   #: in the pores, or None
        self._degree = degree or (1 if order == 1 and water is None else 2)
        self._lend = lend
        self._sand_on_top = not isinstance(layers[0].material, Elastic)
        laws: list[Any] = [layer.material if isinstance(layer.material, Elastic) else
                           read_material(self.comm, layer.material) for layer in layers]
        grains = [law for law in laws if not isinstance(law, Elastic)]
        if not grains:
            raise ValueError("every layer is elastic, expected one of grains")
        if rehearse:   # the last, of no point, is what a set of none is of
            laws = [law if isinstance(law, Elastic) else _REHEARSAL for law in laws] + grains[:1]
        self._laws = laws
        if water is None:
            self.V = fem.VectorFunctionSpace(domain, ("Lagrange", order))
        else:
            self.V = water_space(domain)
        blocks = self.V.dofmap.index_map_bs
        self.owned: int = self.V.dofmap.index_map.size_local * blocks   #: unknowns
        # Forces at all times, and those that come over the run; what is prescribed at its end; 1 where
        # unknowns are. Of each unknown: its place at first and its component, of a pressure the last.
        self.u, self._load, self._ramp, self._target, self._held = (fem.Function(self.V) for _ in range(5))
        self._places, self._component = _unknowns(self.V, self.dimension, water is not None)
        self.fraction, self._made = 0.0, False
        self._checked: bool | None = None   # whether water flowed when what is held was checked

    def __getattr__(self, name: str) -> Any:
        """Of what is not there."""
        later = ", geostatic() or load() has to come before" if name in _LATER else ""
        raise AttributeError(f"a Ground has no {name}{later}")

    def hold(self, where: Region, component: int, value: float = 0.0) -> None:
        """Nodes of a region are held, or moved by so much over the run [m]."""
        dofs = self._nodes(where, self._axis(component), "hold")
        self._held.x.array[dofs], self._target.x.array[dofs] = 1, number("hold: value", value)
        self._checked = None

    def release(self, where: Region, component: int) -> None:
        """Of a stage: what holds the nodes of a region goes, and its force fades over the run."""
        dofs = self._nodes(where, self._axis(component), "release")
        dofs = dofs[self._held.x.array[dofs] > 0]
        if self.comm.allreduce(len(dofs)) == 0:
            raise ValueError("release: nothing is held there")
        self._held.x.array[dofs] = self._target.x.array[dofs] = 0
        left = self._residual_function(self.fraction)
        self._load.x.array[dofs] -= left.x.array[dofs]
        self._ramp.x.array[dofs] += left.x.array[dofs]
        self._check_held()

    def drain(self, where: Region, value: float = 0.0) -> None:
        """The pore pressure at nodes of a region comes to a value over the run [Pa]; elsewhere, also where
        an excavation lays a side bare, nothing flows out."""
        dofs = self._nodes(where, self._pore(), "drain")
        self._target.x.array[dofs] = number("drain: value", value) - self.u.x.array[dofs]
        self._held.x.array[dofs] = 1
        self._checked = None
        if self._sand_on_top:
            lift = self._lift()
            later = lift + self._load.x.array + self._ramp.x.array
            largest = self.comm.allreduce(lift.max(initial=0.0), MPI.MAX)
            self._tell_pulled((lift > 0) & (self._held.x.array == 0) & (later > 1e-9 * largest), later)

    def seal(self, where: Region) -> None:
        """Of a stage: nothing flows out any more at nodes of a region that was drained."""
        dofs = self._nodes(where, self._pore(), "seal")
        dofs = dofs[self._held.x.array[dofs] > 0]
        if self.comm.allreduce(len(dofs)) == 0:
            raise ValueError("seal: nothing is drained there")
        self._held.x.array[dofs] = self._target.x.array[dofs] = 0
        self._checked = None

    def traction(self, side: Region, component: int, value: float) -> None:
        """Force per area of a side at first [Pa], which comes over the run of a stage, and before
        geostatic() acts from the start; with minus its value it goes."""
        facets = mesh.locate_entities_boundary(self.domain, self._up, lambda x: side(x[:self.dimension]))
        if self.comm.allreduce(len(facets)) == 0 or value == 0:
            raise ValueError("traction: no side lies there, or it is 0")
        tags = mesh.meshtags(self.domain, self._up, np.sort(facets), np.ones(len(facets), np.int32))
        ds = ufl.Measure("ds", self.domain, subdomain_data=tags)(1)
        v, normal = ufl.TestFunction(self.V), ufl.FacetNormal(self.domain)
        traction = fem.Constant(self.domain, number("traction: value", value))
        force = self._function(fem.form(traction * v[self._axis(component)] * ds))
        if component == self._up and self._sand_on_top:
            up = self._function(fem.form(
                ufl.max_value(traction * normal[self._up], 0.0) * v[component] * ds)).x.array
            later = force.x.array + self._load.x.array + self._ramp.x.array + self._lift()
            largest = self.comm.allreduce(up.max(initial=0.0), MPI.MAX)
            self._tell_pulled((up > 0) & (self._held.x.array == 0) & (later > 1e-9 * largest), later)
        (self._ramp if self._made else self._load).x.array[:] += force.x.array

    def geostatic(self, surcharge: float = 0.0, overconsolidation: float = 1.0) -> None:
        """Lead every point to the vertical stress of the weight above it, without lateral strain, and add
        that weight to the loads. The surcharge [Pa] is the script's to add, by traction()."""
        if not surcharge >= 0:
            raise ValueError(f"the surcharge is {surcharge} Pa, expected at least 0: the surface would be in "
                             "tension")
        if not overconsolidation >= 1:
            raise ValueError(f"overconsolidation is {overconsolidation}, expected at least 1")
        if self._made:
            raise ValueError("geostatic: the ground has its weight already, expected this call once")
        self._check_held()
        self._make()
        try:
            weights = self.unit_weights = self._weights_at_rest(surcharge, overconsolidation)
        except Exception:
            self._made = False   # another call begins anew
            raise
        self._unit.x.array[:] = self.points.scalars(weights[self.points.layer]).x.array
        self._load.x.array[:] += self._body(self._unit).x.array
        self._evaluate()

    def stage(self) -> None:
        """A new run begins here: loads so far stay, and what is prescribed from now on counts from here."""
        self.march.reached = 0.0
        self._load.x.array[:] += self.fraction * self._ramp.x.array
        self._ramp.x.array[:] = self._target.x.array[:] = 0
        self.fraction = 0.0

    def excavate(self, where: Region) -> None:
        """Of a stage: points of a region leave. Their forces and their weight fade over the run. A node that
        none is left around is held where it is."""
        points = self.points
        going = where(points.x.T) & ~points.gone
        if self.comm.allreduce(int(going.sum())) == 0:
            raise ValueError("nothing is excavated: no point lies there that has not left before")
        mark = points.scalars(going)
        v = ufl.TestFunction(self.V)
        exerted = self._function(fem.form(self._stress_power(v, mark))).x.array
        body = self._body(mark * self._unit).x.array
        alone = self._left_around(points.gone | going) == 0
        after = self._load.x.array - body
        largest = self.comm.allreduce(np.abs(self._load.x.array).max(initial=0), MPI.MAX)
        tell_first(self.comm, alone & (np.abs(after) > 1e-9 * max(largest, 1e-300)),
                   lambda k: f"the part that is excavated carries a load at {place(self._places[k])}, "
                             f"component {self._component[k]}")
        points.remove(going)
        self._gone.x.array[:] = points.scalars(points.gone).x.array
        self._load.x.array[:] -= exerted
        self._ramp.x.array[:] += exerted - body
        self._held.x.array[alone] = 1
        for function in (self._target, self._load, self._ramp):
            function.x.array[alone] = 0
        self._check_held()

    def to(self, fraction: float) -> Iterator[March]:
        """To a fraction of the run from where it stands, by Newton's method in as many parts as it takes;
        from 0 to 0 loads come to act. Yields the march at the end of each part. Raises StepError where the
        smallest part fails too."""
        check_time(self.step_time)
        if not 0 <= number("to: fraction", fraction) <= 1:
            raise ValueError(f"to: fraction {fraction!r}: expected a share of the run, from 0 to 1")
        flows = bool(self.step_time > 0 and fraction != self.fraction)
        if self._checked is not flows:   # held is what was since, or water flows from now on
            self._check_held(flows)
            self._checked = flows
        march, points, u = self.march, self.points, self.u.x.array
        committed, length = u.copy(), fraction - self.fraction
        farthest = committed
        for now in march.to(fraction):
            if march.keep:
                farthest = u.copy()
            if now == Action.SOLVE:
                if self._flow is not None and length:
                    self._flow.time.value = self.step_time * (march.load - self.fraction) / length
                wanted = committed + (march.load - self.fraction) * self._target.x.array - u
                correction = self._solve(march.load, wanted)
                share = march.share(points.largest_change(correction))
                if share > 0:   # else the stiffness is singular
                    u += share * correction.x.array
                    march.tell(points.evaluate(self.u), *self._norms(march.load))
            elif now == Action.CROSS:
                u[:] = farthest
                march.tell(points.evaluate(self.u))
            elif now == Action.ACCEPT:
                points.commit()
                committed, self.fraction = u.copy(), march.load
                if self._flow is not None:
                    self._flow.hold()
                yield march
            else:
                points.revert()
                u[:] = committed

    def save(self, path: AnyPath) -> None:
        """Write where the run stands to one file, also in the middle of a stage, as Points.save()."""
        self.points.save(path, *self._kept(), load=self.fraction)

    def load(self, path: AnyPath) -> None:
        """In place of geostatic() and the stages: go on from a file of save(), on any number of ranks. Mesh
        and layers have to be those of the file."""
        if not self._made:
            self._make()
        self.fraction = self.march.reached = self.points.load(path, *self._kept())
        self.points.remove(self.points.values(self._gone) > 0.5)
        if self._flow is not None:
            self._flow.hold()
        unit, layer = self.points.values(self._unit), self.points.layer
        self.unit_weights = np.array([unit[layer == k].max(initial=0) for k in range(len(self.layers))])
        self.comm.Allreduce(MPI.IN_PLACE, self.unit_weights, MPI.MAX)

    def pressure(self, height: Array) -> Array:
        """Of the weight above, as of geostatic() (n,) [Pa]."""
        return self._pressure(height, self.unit_weights)

    def weight(self) -> float:
        """Of all that has not left [N, 2D: N/m]."""
        there = self._unit * (1 - self._gone)
        own = self._body(there).x.array[:self.owned]
        return float(-self.comm.allreduce(own.sum()))

    def out_of_balance(self) -> float:
        """The largest force on a free unknown [N, 2D: N/m]."""
        free = (self._held.x.array == 0) & (self._component < self.dimension)
        left = np.abs(self._residual_function(self.fraction).x.array) * free
        return float(self.comm.allreduce(left.max(initial=0), MPI.MAX))

    def imbalance(self) -> float:
        """out_of_balance() over the largest nodal force of the stresses [-]."""
        largest = float(np.abs(assembled(self._internal)).max(initial=0))
        return self.out_of_balance() / float(self.comm.allreduce(largest, MPI.MAX))

    def displacement(self) -> Any:
        """A function of the displacements alone [m]."""
        return self.u if self.water is None else self.u.sub(0).collapse()

    def pore_pressure(self) -> Any:
        """A function of the pressures alone [Pa]."""
        self._pore()
        return self.u.sub(1).collapse()

    def moved(self, where: Region, component: int) -> Array:
        """Displacements of nodes of a region, of this rank and its ghosts, which may be none [m]."""
        moved: Array = self.u.x.array[self._nodes(where, component, "moved")]
        return moved

    def force(self, where: Region, component: int) -> float:
        """That holds the nodes of a region [N, 2D: N/m]."""
        dofs = self._nodes(where, component, "force")
        left = self._residual_function(self.fraction).x.array
        return float(-self.comm.allreduce(left[dofs[dofs < self.owned]].sum()))

    def _weights_at_rest(self, surcharge: float, overconsolidation: float) -> Array:
        """Lead points to the stress of the weights above them, which follow from void ratios there."""
        weights = self._weigh()
        self._lead(weights, surcharge, 0.5)
        self._lead(weights, surcharge, 1, route="k0", overconsolidation=overconsolidation)
        for _ in range(10):
            former, weights = weights, self._weigh()
            if np.abs(weights / former - 1).max() < 1e-9:
                break
            self._lead(weights, surcharge, 1, route="k0")
        return weights

    def _make(self) -> None:
        """Points of the layers, and what is assembled over them."""
        load = self._load.x.array
        largest = self.comm.allreduce(np.abs(load).max(initial=0.0), MPI.MAX)
        self._tell_pulled((load > 1e-9 * largest) & self._of_up(), load)
        bottoms = np.array([layer.bottom for layer in self.layers])
        self.points = Points(self.domain, self._laws, self._degree,
                             lambda x: np.asarray(np.sum(x[self._up] < bottoms[:-1, None], axis=0)),
                             lend=self._lend)
        self.march = March(self.points.states, **self._options)
        nothing = np.zeros(len(self.points.layer))
        self._unit, self._gone = self.points.scalars(nothing), self.points.scalars(nothing)
        self._flow = (None if self.water is None else
                      PoreFlow(self.points, self.u, self.water, there=1 - self._gone))
        v, du = ufl.TestFunction(self.V), ufl.TrialFunction(self.V)
        power, stiffness, volumes = self._stress_power(v), self.points.stiffness(du, v), None
        if self._flow is not None:
            volumes = self._flow.came(v)
            stiffness += ufl.derivative(self._flow.push(v) + volumes, self.u, du)
        self._internal, self._stiffness = fem.form(power), fem.form(stiffness)
        self._volumes = None if volumes is None else fem.form(volumes)
        self._matrix, self._correction = _petsc.create_matrix(self._stiffness), fem.Function(self.V)
        self._solver = direct_solver(self.comm, self._matrix)
        self._made = True

    def _kept(self) -> tuple[Any, ...]:
        kept = (self.u, self._load, self._ramp, self._target, self._held, self._unit, self._gone)
        return kept if self._flow is None else kept + (self._flow.solid, self._flow.scale)

    def _weigh(self) -> Array:
        """Unit weights of the layers [N/m3]."""
        points, count = self.points, len(self.layers)
        solid = np.ones(len(points.layer))
        solid[points.grains] = 1 / (1 + points.states.measure(Measure.VOID_RATIO))
        values = points.scalars(solid)
        integral = fem.form(values * points.dx)

        def integrate(of_points: Array) -> float:
            values.x.array[:] = points.scalars(of_points).x.array
            return float(fem.assemble_scalar(integral))

        sums = self.comm.allreduce(np.array([[integrate(solid * (points.layer == k)),
                                              integrate(points.layer == k)] for k in range(count)]))
        shares = np.divide(sums[:, 0], sums[:, 1], out=np.ones(count), where=sums[:, 1] > 0)
        weights: Array = self.gravity * np.array([layer.solid for layer in self.layers]) * shares
        return weights

    def _pressure(self, height: Array, weights: Array) -> Array:
        total: Array = sum((weight * np.clip(top - np.maximum(height, layer.bottom), 0, None)
                            for weight, top, layer in zip(weights, self._tops, self.layers)),
                           start=np.zeros(len(height)))
        return total

    def _lead(self, weights: Array, surcharge: float, share: float, **how: Any) -> None:
        points = self.points
        vertical = _alike(-share * (surcharge + self._pressure(points.x[:, self._up], weights)))
        lateral = np.ones(len(vertical))
        for k, law in enumerate(self._laws):
            if isinstance(law, Elastic):
                lateral[points.layer == k] = law.poisson / (1 - law.poisson)
        sigma = vertical[:, None, None] * np.eye(self.dimension)
        for axis in range(self._up):
            sigma[:, axis, axis] *= lateral
        points.consolidate(sigma, **how)

    def _evaluate(self) -> None:
        answer = self.points.evaluate(self.u)
        if not answer.ok:
            raise Error(Status.NOT_CONVERGED, f"no state to start from: {answer.message}")
        self.points.commit()
        if self._flow is not None:
            self._flow.weigh()
            self._flow.measure()

    def _axis(self, component: int) -> int:
        """A component of displacements."""
        return whole("component", component, 0, self._up)

    def _pore(self) -> int:
        """The component of pressures."""
        if self.water is None:
            raise ValueError("the ground has no pore water, expected water=PoreWater(...)")
        return int(self.dimension)

    def _stress_power(self, v: Any, mark: Any = 1) -> Any:
        """The form of the work of grains and water in a test function, of marked points."""
        test = ufl.as_vector([v[i] for i in range(self.dimension)])
        power = mark * ufl.inner(self.points.P, ufl.grad(test)) * self.points.dx
        return power if self._flow is None else power + self._flow.push(v, mark)

    def _lift(self) -> Array:
        """Nodal forces of the water that will stand at drained sides below the sky, upward [N]."""
        if self.water is None:
            return np.zeros(len(self._load.x.array))
        later = fem.Function(self.V)
        drained = (self._held.x.array > 0) & (self._component == self.dimension)
        later.x.array[drained] = (self.u.x.array + (1 - self.fraction) * self._target.x.array)[drained]
        up = ufl.split(later)[1] * ufl.FacetNormal(self.domain)[self._up]
        v = ufl.TestFunction(self.V)
        lift: Array = self._function(fem.form(ufl.max_value(up, 0.0) * v[self._up] * ufl.ds)).x.array
        return lift

    def _body(self, unit: Any) -> Any:
        """Nodal forces of unit weights [N/m3]."""
        return self._function(fem.form(-unit * ufl.TestFunction(self.V)[self._up] * self.points.dx))

    def _function(self, form: Any) -> Any:
        """The vector of a form, with ghosts."""
        function = fem.Function(self.V)
        function.x.array[:self.owned] = assembled(form)
        function.x.scatter_forward()
        return function

    def _residual_function(self, fraction: float) -> Any:
        """External minus internal forces, and the volume of water that did not come."""
        left = self._function(self._internal)
        if self._volumes is not None:
            left.x.array[:] += self._function(self._volumes).x.array
        left.x.array[:] = self._load.x.array + fraction * self._ramp.x.array - left.x.array
        return left

    def _norms(self, fraction: float) -> tuple[float, float]:
        left = self._residual_function(fraction).x.array[:self.owned]
        free = self._held.x.array[:self.owned] == 0
        return float(np.linalg.norm(left[free])), float(np.linalg.norm(assembled(self._internal)))

    def _solve(self, fraction: float, wanted: Array) -> Any:
        """Newton's correction, of held unknowns what is wanted."""
        self._matrix.zeroEntries()
        _petsc.assemble_matrix(self._matrix, self._stiffness)
        self._matrix.assemble()
        right, correction = self._residual_function(fraction), self._correction
        held = np.flatnonzero(self._held.x.array[:self.owned])
        correction.x.array[:] = 0
        correction.x.array[held] = wanted[held]
        first = self.V.dofmap.index_map.local_range[0] * self.V.dofmap.index_map_bs
        self._matrix.zeroRowsColumns((held + first).astype(PETSc.IntType), 1.0, correction.vector, right.vector)
        self._solver.solve(right.vector, correction.vector)
        correction.x.scatter_forward()
        return correction

    def _nodes(self, where: Region, component: int, what: str) -> npt.NDArray[np.int64]:
        """Unknowns of this rank, ghosts too, of a component in a region."""
        whole(f"{what}: component", component, 0, self._up + (self.water is not None))
        with together(self.comm):
            inside = np.asarray(where(self._places.T), bool)
        dofs = np.flatnonzero(inside & (self._component == component))
        if self.comm.allreduce(len(dofs)) == 0:
            raise ValueError(f"{what}: no node lies there")
        return dofs

    def _cells(self) -> npt.NDArray[np.int64]:
        """Unknowns of the own cells (n, k)."""
        dofmap, owned = self.V.dofmap, self.domain.topology.index_map(self.dimension).size_local
        blocks = dofmap.list.array.reshape(-1, dofmap.dof_layout.num_dofs)[:owned].astype(np.int64)
        unknowns: npt.NDArray[np.int64] = blocks[:, :, None] * dofmap.bs + np.arange(dofmap.bs)
        return unknowns.reshape(owned, -1)

    def _left(self) -> npt.NDArray[np.int64]:
        """Unknowns of the own cells that have a point left (n, k)."""
        cells = self._cells()
        if self._made and len(cells):
            cells = cells[~self.points.gone.reshape(len(cells), -1).all(axis=1)]
        return cells

    def _left_around(self, gone: npt.NDArray[np.bool_]) -> Array:
        """How many cells of all ranks are around each unknown of this one that have a point left (n,)."""
        cells, counts = self._cells(), fem.Function(self.V)
        there = ~gone.reshape(len(cells), -1).all(axis=1) if len(cells) else np.zeros(0, bool)
        np.add.at(counts.x.array, cells[there].ravel(), 1)
        counts.vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        counts.x.scatter_forward()
        around: Array = counts.x.array
        return around

    def _check_held(self, flows: bool = True) -> None:
        """That each part of the mesh that hangs together is held in every component, and that its pore
        pressure is determined: by a drained side if water flows, or by displacements that change the
        volume."""
        index, bs, own = self.V.dofmap.index_map, self.V.dofmap.index_map_bs, self.owned
        numbers = (index.local_to_global(np.arange(len(self._component) // bs, dtype=np.int32))[:, None] * bs
                   + np.arange(bs)).ravel()
        held, component = self._held.x.array[:own] > 0, self._component[:own]
        firm = held & (component == self.dimension) & flows   # determines the pressure around
        if self.water is not None:
            firm |= ~held & self._changes_volume()[:own]
        parts = Parts(self.comm, numbers[self._left()], self._places[:own])
        for k in range(self.dimension):
            parts.check(held & (component == k), f"nothing holds component {k} of what is around {{}}")
        if self.water is not None and math.isinf(self.water.bulk_modulus):
            parts.check(firm, "nothing determines the pore pressure around {}: no side is drained, water is "
                        "incompressible and no displacement changes the volume; expected drain(), and "
                        "step_time above 0")

    def _changes_volume(self) -> npt.NDArray[np.bool_]:
        """Which unknowns change the volume of what is left."""
        test = ufl.TestFunction(self.V)
        divergence = sum(test[i].dx(i) for i in range(self.dimension))
        there = 1 - self._gone if self._made else fem.Constant(self.domain, 1.0)
        forces = np.abs(self._function(fem.form(there * divergence * self._measure())).x.array)
        largest = self.comm.allreduce(forces.max(initial=0.0), MPI.MAX)
        changing: npt.NDArray[np.bool_] = forces > 1e-12 * largest
        return changing

    def _measure(self) -> Any:
        return self.points.dx if self._made else ufl.dx(domain=self.domain)

    def _of_up(self) -> npt.NDArray[np.bool_]:
        """Which unknowns are along the last axis, of a surface of sand."""
        along: npt.NDArray[np.bool_] = self._component == self._up
        return along & self._sand_on_top

    def _tell_pulled(self, pulled: npt.NDArray[np.bool_], force: Array) -> None:
        tell_first(self.comm, pulled,
                   lambda k: f"the node at {place(self._places[k])} is pulled up by {force[k]:g} N: the surface "
                             "would be in tension")


def _unknowns(V: Any, dimension: int, water: bool) -> tuple[Array, npt.NDArray[np.int64]]:
    """Places at first (n, d) and components (n,) of the unknowns of a rank, ghosts too; those of the pressure
    are the last component."""
    if not water:
        nodes = V.tabulate_dof_coordinates()[:, :dimension]
        return np.repeat(nodes, dimension, axis=0), np.tile(np.arange(dimension), len(nodes))
    map_ = V.dofmap.index_map
    count = map_.size_local + map_.num_ghosts
    places, component = np.zeros((count, dimension)), np.zeros(count, np.int64)
    for sub, first in ((V.sub(0), 0), (V.sub(1), dimension)):
        own, dofs = sub.collapse()
        nodes, bs = own.tabulate_dof_coordinates()[:, :dimension], own.dofmap.bs
        places[dofs], component[dofs] = np.repeat(nodes, bs, axis=0), np.tile(first + np.arange(bs), len(nodes))
    return places, component


def _alike(values: Array) -> Array:
    """With 12 digits: points at one depth have the same bits on any number of ranks, and are led once."""
    digits = 10.0**(11 - np.floor(np.log10(np.abs(np.where(values == 0, 1, values)))))
    rounded: Array = np.round(values * digits) / digits
    return rounded
