# mypy: allow-untyped-calls
"""The micro-scale classes of FEMxDEM (YADE and escript, Guo & Zhao 2014) over a set of points, for scripts
that have them. Debian: apt-get install python3-escript

    from grainlaw.femxdem import MultiScale2D as MultiScale, saveGauss2D

    prob = MultiScale(domain=domain, ng=512, np=2, rtol=1e-2)      # packing: the material file 0.toml
    prob.initialize(f=traction, specified_u_mask=mask, specified_u_val=values)
    u = prob.solve()

Geometry is updated by each step; stresses are Cauchy's [Pa], tension positive; d is 2 or 3. Newton's
method has the exact tangent, and a step that fails is cut. What the classes do not mention goes as in
FEMxDEM.
"""
from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from typing import Any

import esys.escript as escript
import numpy as np
from esys.escript import util
from esys.escript.linearPDEs import LinearPDE, SolverOptions

from .arguments import number, whole
from .arrays import Array
from .files import write_whole
from .march import March
from .material import AnyPath, Material
from .names import Action, Measure, Status, Tangent
from .points import Evaluation, States

__all__ = ["MultiScale2D", "MultiScale3D", "MultiScaleUP", "saveGauss2D", "saveGauss3D"]

Data = Any   # of escript

RANKS = ("OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK")   # what mpirun tells a process
FLOOR = 1e-12         # displacement that is none, over the size of the domain [-]
MOST_SPLITS = 200     # solves for the pressure in one correction
HISTORY = 8           # of them that the next one is made of


class _MultiScale:
    """Displacements in equilibrium with the packings of the integration points."""

    march: March | None   #: through the last step, with its solves and cuts

    def __init__(self, domain: Any, ng: int, useMPI: bool, np_: int, random: bool, rtol: float,
                 verbose: bool, material: AnyPath | Material | None, dimension: int) -> None:
        if useMPI and any(os.environ.get(name, "0") != "0" for name in RANKS):
            sys.exit(0)   # FEMxDEM's other ranks work for the first one; here its threads do
        if escript.getMPISizeWorld() > 1:
            raise ValueError(f"escript on {escript.getMPISizeWorld()} ranks: expected one, np tells the threads")
        if domain.getDim() != dimension:
            raise ValueError(f"a domain of dimension {domain.getDim()}: expected {dimension}")
        self._domain, self._space = domain, escript.Function(domain)
        count = self._space.getX().getNumberOfDataPoints()
        if whole("ng", ng, 1, sys.maxsize) != count:
            raise ValueError(f"ng {ng}: expected {count}, the integration points of the domain")
        self._threads = 0 if useMPI else whole("np", np_, 1, 2**15)
        self._rtol, self._verbose = _positive("rtol", rtol), verbose
        self._states = _states(material, count, random, dimension)
        self._pde = LinearPDE(domain, numEquations=dimension, numSolutions=dimension)
        self._pde.getSolverOptions().setSolverMethod(SolverOptions.DIRECT)
        self._strain = escript.Tensor(0.0, self._space)
        self._old: dict[str, Data] = {}
        self._new: dict[str, Data] = {}
        self._mask, self._values = escript.Data(), escript.Data()
        self.march = None
        self._start = np.tile(np.eye(dimension), (count, 1, 1))   # F where the step began
        answer = self._evaluate(self._start)
        if not answer.ok:
            raise ValueError(f"no state to start from: {answer.message}")
        self._states.commit()

    def getDomain(self) -> Any:
        """The domain, as it is deformed."""
        return self._domain

    def getRelTolerance(self) -> float:
        """rtol [-]"""
        return self._rtol

    def getCurrentPacking(self, pos: Sequence[int] = (), time: Any = 0, prefix: str = "") -> None:
        """Write the packings of the points `pos`, or of all, as PREFIXpacking_POINT_TIME_particles.csv,
        _contacts.csv and _cell.csv, which a material file can name, and .vtp for ParaView."""
        for point in pos if len(pos) else range(len(self._states)):
            name = f"{prefix}packing_{point}_{time}"
            self._states.write_packing(name, point)
            self._states.write_vtk(f"{name}.vtp", point)

    def getLocalVoidRatio(self) -> Data:
        """Volume of voids over that of particles, scalar [-]"""
        return self._measured(Measure.VOID_RATIO)

    def getLocalAvgRotation(self) -> Data:
        """Mean rotation of the particles since the start: scalar of discs, vector of spheres [rad]"""
        return self._measured(Measure.MEAN_ROTATION)

    def getLocalFabric(self) -> Data:
        """Mean of n n over the contacts, tensor [-]"""
        return self._measured(Measure.FABRIC)

    def getCurrentTangent(self) -> Data:
        """(1 / J) F_jJ F_lL dP_iJ/dF_kL, tensor of rank 4 [Pa]: with the stress in it, and not symmetric"""
        return _data(self._tangent(), self._space)

    def getCurrentStress(self) -> Data:
        """Cauchy stress, effective where there is water, tensor [Pa]"""
        return _data(self._stress(), self._space)

    def getCurrentStrain(self) -> Data:
        """Sum of the displacement gradients of all steps, tensor [-]"""
        return self._strain

    def exitSimulation(self) -> None:
        """Nothing is left to end: threads of the library are no pool of processes."""

    def _measured(self, what: Measure) -> Data:
        return _data(self._states.measure(what), self._space)

    def _loads(self, b: Data, **on_boundary: Data) -> None:
        """Loads of the next step; those of the first one act from its start."""
        boundary = escript.FunctionOnBoundary(self._domain)
        loads = {"b": _given("b", b, self._space)}
        loads |= {name: _given(name, data, boundary) for name, data in on_boundary.items()}
        self._old = self._new or loads
        self._new = loads

    def _load(self, name: str, share: float) -> Data:
        """A load on its way from the step before."""
        old, new = self._old[name], self._new[name]
        if old.isEmpty() and new.isEmpty():
            return new
        return (1 - share) * (0.0 if old.isEmpty() else old) + share * (0.0 if new.isEmpty() else new)

    def _prescribed(self, share: float, u: Data) -> dict[str, Data]:
        """What is left of the prescribed displacements, for a correction."""
        if self._mask.isEmpty():
            return {"q": self._mask, "r": self._mask}
        return {"q": self._mask, "r": (0.0 if self._values.isEmpty() else share * self._values) - u}

    def _stress(self) -> Array:
        volume = np.linalg.det(self._F)[:, None, None]
        return np.asarray(np.einsum("nij,nkj->nik", self._P, self._F) / volume)

    def _tangent(self) -> Array:
        volume = np.linalg.det(self._F)[:, None, None, None, None]
        return np.asarray(np.einsum("njJ,niJkL,nlL->nijkl", self._F, self._A, self._F, optimize=True) / volume)

    def _evaluate(self, F: Array) -> Evaluation:
        answer = self._states.evaluate(F, Tangent.EXACT, self._threads)
        if answer.ok:
            assert answer.A is not None
            self._F, self._P, self._A = F, answer.P, answer.A
        return answer

    def _gradient(self, u: Data) -> Array:
        """Of displacements, with respect to where the step began (n, d, d) [-]"""
        return np.array(util.grad(u).toListOfTuples())

    def _begin(self) -> list[Data]:
        """The unknowns at the start of a step, displacements first."""
        return [escript.Vector(0.0, escript.Solution(self._domain))]

    def _correct(self, share: float, at: list[Data]) -> list[Data]:
        """Newton's correction of the unknowns, on the deformed domain."""
        self._pde.setValue(A=_data(self._tangent(), self._space), X=-_data(self._stress(), self._space),
                           Y=self._load("b", share), y=self._load("f", share),
                           **self._prescribed(share, at[0]))
        return [self._pde.getSolution()]

    def _change(self, corrections: list[Data], parts: list[Data]) -> float:
        """Relative size of a correction, beside what the part has changed so far [-]"""
        floor = FLOOR * float(util.Lsup(self._domain.getX()))
        return self._norm(corrections[0]) / max(self._norm(parts[0]), floor)

    def _norm(self, data: Data) -> float:
        """Over the domain. Squares of nodes of order 2 have shapes below 0, so that points are taken."""
        return float(util.L2(util.interpolate(data, self._space)))

    def _lead(self, solves: int) -> Data:
        """Displacements of the step, led in as many parts as it takes [m]. Raises StepError where the
        smallest part fails too; all is then at the end of the last one that did not."""
        if not self._new:
            raise ValueError("solve before initialize: expected the loads of a step first")
        march = self.march = March(self._states, tolerance=self._rtol, max_iterations=solves)
        x, start = self._domain.getX(), self._start
        at = committed = farthest = self._begin()
        answers = self._F, self._P, self._A
        try:
            for now in march.to(1.0, 0.0):
                if march.keep:
                    farthest = at
                if now == Action.SOLVE:
                    try:
                        corrections = self._solved(march.load, at, x)
                    except RuntimeError as error:   # of escript's solvers too
                        march.tell(Status.NOT_CONVERGED, reason=str(error))
                        continue
                    change = np.linalg.norm(self._gradient(corrections[0]) @ start, axis=(1, 2)).max()
                    taken = march.share(float(change))
                    at = [a + taken * c for a, c in zip(at, corrections)]
                    answer = self._evaluate(start + self._gradient(at[0]) @ start)
                    parts = [a - c for a, c in zip(at, committed)]
                    march.tell(answer, self._change(corrections, parts))
                    self._tell(march)
                elif now == Action.CROSS:
                    at = farthest
                    march.tell(self._evaluate(start + self._gradient(at[0]) @ start))
                elif now == Action.ACCEPT:
                    self._states.commit()
                    committed, answers = at, (self._F, self._P, self._A)
                else:
                    self._tell(march)
                    self._states.revert()
                    at = committed
                    self._F, self._P, self._A = answers
        finally:
            self._states.revert()
            self._F, self._P, self._A = answers
            self._start = self._F
            self._strain = self._strain + util.grad(committed[0])
            self._end(committed)
            self._domain.setX(x + committed[0])
        if march.loose:
            warnings.warn(f"{march.loose} parts of the step ended out of balance, across jumps of the stress",
                          stacklevel=3)
        return committed[0]

    def _solved(self, share: float, at: list[Data], x: Data) -> list[Data]:
        """Corrections. Raises RuntimeError where the stiffness is singular, as of a body that moves freely."""
        self._domain.setX(x + at[0])
        try:
            corrections = self._correct(share, at)
        finally:
            self._domain.setX(x)
        if not util.Lsup(corrections[0]) <= util.Lsup(x - util.inf(x)):
            raise RuntimeError("the stiffness is singular: expected supports that hold the body")
        return corrections

    def _end(self, committed: list[Data]) -> None:
        """The step is over; the domain is still where it began."""

    def _tell(self, march: March) -> None:
        if march.message:
            self._say(f"part to {march.load:.6g} of the step: {march.message}; it is cut")
        elif march.residuals:
            self._say(f"part to {march.load:.6g} of the step: relative error {march.residuals[-1]:.3e}")

    def _say(self, text: str) -> None:
        if self._verbose:
            print(text, flush=True)


class MultiScale2D(_MultiScale):
    """FEMxDEM's msFEM2D.MultiScale.

    domain    of escript, plane
    ng        its integration points
    useMPI    True: as many threads as OMP_NUM_THREADS says; ranks of mpirun but the first end here
    np        threads of the library
    random    False: all points have the material file 0.toml; True: each its own, 0.toml, 1.toml, ...
    rtol      norm of a correction over that of the displacements of the step [-]
    usePert, pert    nothing: the tangent is exact
    verbose   print each correction
    material  a Material, or another name of its file

    Raises ValueError, and Error for a material file."""

    def __init__(self, domain: Any, ng: int = 1, useMPI: bool = False, np: int = 1, random: bool = False,
                 rtol: float = 1e-2, usePert: bool = False, pert: float = -2e-6, verbose: bool = False,
                 material: AnyPath | Material | None = None) -> None:
        super().__init__(domain, ng, useMPI, np, random, rtol, verbose, material, 2)

    def initialize(self, b: Data = escript.Data(), f: Data = escript.Data(),
                   specified_u_mask: Data = escript.Data(), specified_u_val: Data = escript.Data()) -> None:
        """The next step: body forces [N/m3] and tractions on the boundary [Pa] at its end, where
        displacements are prescribed, and what they are of this step [m]."""
        self._loads(b, f=f)
        nodes = escript.ContinuousFunction(self._domain)
        self._mask = _given("specified_u_mask", specified_u_mask, nodes)
        self._values = _given("specified_u_val", specified_u_val, nodes)

    def solve(self, iter_max: int = 100) -> Data:
        """Displacements of the step, vector [m]; `iter_max` corrections of a part. Raises StepError where
        the step fails however it is cut; all is then at the last equilibrium."""
        return self._lead(whole("iter_max", iter_max, 1, 10**6))


class MultiScale3D(MultiScale2D):
    """FEMxDEM's msFEM3D.MultiScale: as MultiScale2D, of a solid domain."""

    def __init__(self, domain: Any, ng: int = 1, useMPI: bool = False, np: int = 1, random: bool = False,
                 rtol: float = 1e-2, verbose: bool = False,
                 material: AnyPath | Material | None = None) -> None:
        _MultiScale.__init__(self, domain, ng, useMPI, np, random, rtol, verbose, material, 3)


class MultiScaleUP(_MultiScale):
    """FEMxDEM's msFEMup.MultiScale: a plane domain whose pores are full of water. Displacements have the
    order of the domain, pressures the reduced one. The others are as of MultiScale2D.

    pore0   pressure of the water at first [Pa]
    perm    d^2 / (180 mu), of which n^3 / (1 - n)^2 makes the permeability over the viscosity [m2/(Pa s)]
    kf      bulk modulus of the water [Pa]
    dt      time of a step [s]
    """

    def __init__(self, domain: Any, pore0: float = 0.0, perm: float = 1e-5, kf: float = 2.2e9,
                 dt: float = 0.001, ng: int = 1, useMPI: bool = False, np: int = 1, rtol: float = 1e-2,
                 verbose: bool = False, material: AnyPath | Material | None = None) -> None:
        super().__init__(domain, ng, useMPI, np, False, rtol, verbose, material, 2)
        self._pore = escript.Scalar(number("pore0", pore0), escript.ReducedSolution(domain))
        self._perm, self._bulk = _positive("perm", perm, 0.0), _positive("kf", kf)
        self.setTimeStep(dt)
        self._water = LinearPDE(domain, numEquations=1, numSolutions=1)
        self._water.setReducedOrderOn()
        self._water.getSolverOptions().setSolverMethod(SolverOptions.DIRECT)
        self._drains, self._pressures = escript.Data(), escript.Data()

    def initialize(self, b: Data = escript.Data(), f: Data = escript.Data(), umsk: Data = escript.Data(),
                   uvalue: Data = escript.Data(), flux: Data = escript.Data(), pmsk: Data = escript.Data(),
                   pvalue: Data = escript.Data()) -> None:
        """The next step: as of MultiScale2D with umsk and uvalue; water that enters through the boundary
        [m/s], where pressures are prescribed, and what they are [Pa]."""
        self._loads(b, f=f, flux=flux)
        nodes, corners = escript.ContinuousFunction(self._domain), escript.ReducedSolution(self._domain)
        self._mask, self._values = _given("umsk", umsk, nodes), _given("uvalue", uvalue, nodes)
        self._drains, self._pressures = _given("pmsk", pmsk, corners), _given("pvalue", pvalue, corners)

    def setTimeStep(self, dt: float = 1.0) -> None:
        """Time of the steps from now on [s]"""
        self._dt = _positive("dt", dt)

    def getEquivalentPorosity(self) -> Data:
        """Volume of voids over the whole, scalar [-]"""
        return _data(self._porosity(), self._space)

    def getCurrentPore(self) -> Data:
        """Pressure of the water, scalar at the nodes of the reduced order [Pa]"""
        return self._pore

    def getCurrentFlux(self) -> Data:
        """Darcy's velocity, vector [m/s]"""
        return -self._permeability() * util.grad(self._pore)

    def solve(self, globalIter: int = 10, solidIter: int = 50) -> Data:
        """Displacements of the step, vector [m]. Both equations are solved by each correction, of which a
        part takes at most globalIter * solidIter. Raises StepError as MultiScale2D.solve."""
        self._conducts = self._permeability()
        self._n = self.getEquivalentPorosity()
        self._before = self._pore
        return self._lead(min(10**6, whole("globalIter", globalIter, 1, 10**6)
                              * whole("solidIter", solidIter, 1, 10**6)))

    def _porosity(self) -> Array:
        e = self._states.measure(Measure.VOID_RATIO)
        return np.asarray(e / (1 + e))

    def _permeability(self) -> Data:
        n = self._porosity()
        return _data(self._perm * n**3 / (1 - n)**2, self._space)

    def _begin(self) -> list[Data]:
        return [*super()._begin(), self._pore]

    def _end(self, committed: list[Data]) -> None:
        self._pore = committed[1]

    def _correct(self, share: float, at: list[Data]) -> list[Data]:
        """Newton's correction of both: displacements by the pressure, which is found by fixed stress (Kim,
        Tchelepi & Juanes 2011), sped up by Anderson's method."""
        unit = util.kronecker(self._domain)
        tangent = self._tangent()
        known = util.interpolate(at[1], self._space)
        volume = _data(np.log(np.linalg.det(self._F) / np.linalg.det(self._start)), self._space)
        stress = _data(self._stress(), self._space)
        follows = util.swap_axes(util.outer(unit, unit), 1, 3) - util.outer(unit, unit)
        self._pde.setValue(A=_data(tangent, self._space) + known * follows, Y=self._load("b", share),
                           y=self._load("f", share), **self._prescribed(share, at[0]))
        bulk = np.einsum("niikk->n", tangent) / 4
        held = 1 / _data(np.maximum(bulk, 0.1 * np.abs(bulk).max()), self._space)
        step, stored = share * self._dt, self._n / self._bulk
        before = util.interpolate(self._before, self._space)
        self._water.setValue(A=self._conducts * unit, D=(stored + held) / step, y=self._load("flux", share),
                             **self._drained(share))
        scale = self._some_pressure()
        mixed = _Mixed()
        pressure = at[1]
        for _ in range(MOST_SPLITS):
            there = util.interpolate(pressure, self._space)
            self._pde.setValue(X=there * unit - stress)
            u = self._pde.getSolution()
            gained = volume + util.trace(util.grad(u))
            self._water.setValue(Y=(stored * before + held * there - gained) / step)
            found = self._water.getSolution()
            off = self._norm(found - pressure)
            if off <= 1e-3 * self._rtol * max(self._norm(found - self._before), 1e-3 * scale):
                return [u, pressure - at[1]]
            pressure = mixed.next(pressure, found)
        raise RuntimeError(f"no pressure of the water: the last change was {off / scale:.1e} of the stress")

    def _drained(self, share: float) -> dict[str, Data]:
        if self._drains.isEmpty():
            return {"q": self._drains, "r": self._drains}
        wanted = 0.0 if self._pressures.isEmpty() else self._pressures
        return {"q": self._drains, "r": (1 - share) * self._before + share * wanted}

    def _some_pressure(self) -> float:
        """What pressures are compared with: a mean stress, as a norm over the domain."""
        mean = float(np.abs(np.einsum("nii->n", self._stress())).mean()) / 2
        return max(mean, 1.0) * self._norm(escript.Scalar(1.0, self._space))

    def _change(self, corrections: list[Data], parts: list[Data]) -> float:
        """That of FEMxDEM: pressures ten times as exact."""
        there = self._norm(self._before + parts[1])
        pressures = self._norm(corrections[1]) / max(there, 1e-3 * self._some_pressure())
        return max(super()._change(corrections, parts), 10 * pressures)


class _Mixed:
    """Anderson's method for p = g(p): the next p of the last ones, so that the combined error is least."""

    def __init__(self) -> None:
        self._found: list[Data] = []
        self._errors: list[Array] = []

    def next(self, p: Data, g: Data) -> Data:
        self._found = [*self._found[-HISTORY:], g]
        self._errors = [*self._errors[-HISTORY:], np.array((g - p).toListOfTuples())]
        last = self._errors[-1]
        if len(self._errors) > 1:
            changes = np.array([last - one for one in self._errors[:-1]]).T
            shares = np.linalg.lstsq(changes, last, rcond=1e-12)[0]
            for share, one in zip(shares.tolist(), self._found[:-1]):
                g = g - share * (self._found[-1] - one)
        return g


def saveGauss2D(name: str = "", pos: Sequence[int] = (), **kwargs: Data) -> None:
    """Write tensors at the points `pos`, or at all, as FEMxDEM does: a line with its name and the number of
    points for each, then a line a point, row by row. The file is the old one or the whole new one."""
    lines = []
    for key, data in kwargs.items():
        rows = np.array(data.toListOfTuples())
        rows = rows[list(pos)] if len(pos) else rows
        lines.append(f"{key} {len(rows)}")
        lines += [" ".join(map(repr, row)) for row in rows.reshape(len(rows), -1).tolist()]
    write_whole(name, "\n".join([*lines, ""]))


saveGauss3D = saveGauss2D


def _data(values: Array, space: Any) -> Data:
    """Rows of values (n, ...) as Data. escript takes numbers 500 times as fast as tensors."""
    data = escript.Data(0.0, values.shape[1:], space, True)
    columns = values.reshape(len(values), -1).T.tolist()
    for index, column in zip(np.ndindex(*values.shape[1:]), columns):
        one = escript.Scalar(0.0, space, True)
        for point, value in enumerate(column):
            one.setValueOfDataPoint(point, value)
        if not index:
            return one
        data[index] = one
    return data


def _states(material: AnyPath | Material | None, count: int, random: bool, dimension: int) -> States:
    if random:
        if material is not None:
            raise ValueError("material and random: expected one of them, random points have 0.toml, 1.toml, ...")
        states = States(_material("0.toml", dimension), 1)
        for point in range(1, count):
            states.resize(point + 1, _material(f"{point}.toml", dimension))
        return states
    one = material if isinstance(material, Material) else "0.toml" if material is None else material
    return States(_material(one, dimension), count)


def _material(material: AnyPath | Material, dimension: int) -> Material:
    found = material if isinstance(material, Material) else Material(material)
    if found.dimension != dimension:
        raise ValueError(f"{material}: a material of dimension {found.dimension}, expected {dimension}, that of "
                         "the class")
    return found


def _given(name: str, value: Any, space: Any) -> Data:
    """Data as it is, or numbers as Data; escript takes either."""
    data = value if isinstance(value, escript.Data) else escript.Data(np.asarray(value, float), space)
    if not data.isEmpty() and (data.hasNaN() or data.hasInf()):
        raise ValueError(f"{name} has entries that are no numbers, expected a number in each")
    return data


def _positive(name: str, value: float, least: float | None = None) -> float:
    found = number(name, value)
    if not (found > 0 if least is None else found >= least):
        raise ValueError(f"{name} {value!r}: expected a number above 0"
                         if least is None else f"{name} {value!r}: expected at least {least:g}")
    return found
