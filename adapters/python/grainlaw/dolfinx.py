# mypy: allow-untyped-calls
"""grainlaw in DOLFINx 0.5, on any number of ranks of MPI. Debian: apt-get install python3-dolfinx

    material = read_material(MPI.COMM_WORLD, "sand.toml")
    points = Points(domain, material, degree=1)
    newton = Newton(points, u, conditions, apply=set_load, external=lambda v: ...)
    for part in newton.to(1.0):
        print(part.load, newton.force(top))

All functions are calls of all ranks together, and raise on all of them.
"""
from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import basix
import numpy as np
import numpy.typing as npt
import ufl
from dolfinx import fem
from mpi4py import MPI
from petsc4py import PETSc

from .abi import Error
from .arrays import Array
from .checkpoint import Cells
from .lending import Lending
from .march import March
from .material import AnyPath, Material
from .names import Action, Measure, Status, Tangent
from .points import Evaluation, States
from .ranks import check_same, end_together, read_material, together

_MUMPS_MEMORY = (-5, -7, -9, -13, -19)   # its errors of memory that is too small or was refused
_basix: Any = basix       # whose types say less than they take
_petsc: Any = fem.petsc

__all__ = ["Elastic", "Newton", "Points", "end_together", "read_material", "together"]


class Elastic(NamedTuple):
    """A material in closed form, Saint Venant and Kirchhoff's, without packings."""

    young: float     #: modulus [Pa]
    poisson: float   #: ratio [-]


class Points:
    """The quadrature points of a mesh; a rank has those of the cells that it owns, which may be none: forms
    are assembled over no others. d is the dimension of materials and mesh.

    domain    a dolfinx.mesh.Mesh
    material  one, or several with `layer`, of which some may be Elastic
    degree    of the quadrature, basix' default scheme
    layer     the numbers (n,) of the materials of points at x (d, n) [m]
    lend      ranks that are done with their own points evaluate points of others; the same bits

    Raises Error for a material of another dimension than the mesh, where ranks have different ones, and
    where none has grains."""

    P: Any   #: quadrature function (d, d): first Piola-Kirchhoff stress [Pa], tension positive
    A: Any   #: quadrature function (d * d, d * d): dP_iJ/dF_kL [Pa], a row for each iJ, row-major
    dx: Any  #: measure of forms with P or A
    states: States                   #: of this rank, by cell and point; shared by the ranks
    grains: npt.NDArray[np.int64]    #: number of the point of each state; Elastic ones have none (m,)
    cells: npt.NDArray[np.int64]     #: number in the input mesh of each cell that this rank owns
    x: Array                         #: places of the points of this rank at first (n, d) [m]
    layer: npt.NDArray[np.int64]     #: number of the material of each point (n,)
    gone: npt.NDArray[np.bool_]      #: points that have left (n,)
    lending: Lending | None          #: where points are lent

    def __init__(self, domain: Any, material: Material | Sequence[Material | Elastic], degree: int,
                 layer: Callable[[Array], npt.ArrayLike] | None = None, lend: bool = False) -> None:
        self.comm, self.domain = domain.comm, domain
        materials: list[Material | Elastic] = (
            [material] if isinstance(material, Material) else list(material))
        of_grains = [each for each in materials if isinstance(each, Material)]
        if not of_grains:
            raise Error(Status.BAD_ARGUMENT, "every material is elastic, expected one of grains")
        for each in of_grains:
            check_same(self.comm, each)
        d = self.dimension = of_grains[0].dimension
        if not domain.geometry.dim == domain.topology.dim == d:
            raise Error(Status.BAD_ARGUMENT, f"a mesh of dimension {domain.topology.dim} in "
                        f"{domain.geometry.dim}D: expected {d}, as of the material")
        cell = domain.ufl_cell()
        rule = {"quadrature_degree": degree, "quadrature_scheme": "default"}
        self.dx = ufl.Measure("dx", domain, metadata=rule)
        self._where, _ = _basix.make_quadrature(_basix.cell.string_to_type(cell.cellname()), degree)
        owned = domain.topology.index_map(d).size_local   # ghosts come after
        self.cells = np.array(domain.topology.original_cell_index[:owned], np.int64)
        self._owned = np.arange(owned, dtype=np.int32)
        self._element = {"family": "Quadrature", "cell": cell, "degree": degree, "quad_scheme": "default"}
        self.P, self._P_rows = self._function(ufl.TensorElement(**self._element, shape=(d, d)))
        self.A, self._A_rows = self._function(ufl.TensorElement(**self._element, shape=(d * d, d * d)))
        count = owned * len(self._where)
        self.x = self.values(ufl.SpatialCoordinate(domain)).reshape(-1, d)
        with together(self.comm):
            numbers = np.zeros(count) if layer is None else layer(self.x.T)
            self.layer = np.asarray(numbers, np.int64)
            _check_layers(self.layer, len(materials))
            self._elastic = [(law, np.flatnonzero(self.layer == k))
                             for k, law in enumerate(materials) if isinstance(law, Elastic)]
            closed = [k for k, each in enumerate(materials) if isinstance(each, Elastic)]
            self.grains = np.flatnonzero(~np.isin(self.layer, closed))
            self.states = _states(of_grains[0], materials, self.layer[self.grains])
        self.gone = np.zeros(count, bool)
        self._resting = [self._function(ufl.TensorElement(**self._element, shape=(d, d)))[0]
                         for _ in closed[:1]]   # stress where nothing has moved [Pa]
        self._F = self._committed_F = np.tile(np.eye(d), (count, 1, 1))
        self.lending = None
        if lend:
            self.lending = _lending(self.comm, self.states, materials, self.layer[self.grains])
        elif self.comm.size > 1:
            self.states.share(self.comm.rank, self._reduce)
        self._gradients: dict[Any, Any] = {}
        self._keep()

    def evaluate(self, u: Any) -> Evaluation:
        """Evaluate all points at F = I + grad u, with the exact tangent. P and A follow where all points
        found an equilibrium. The answer's arrays are of this rank, its outcome is that of all."""
        with together(self.comm):
            self._F = np.eye(self.dimension) + self._gradient(u)
            self._F[self.gone] = self._committed_F[self.gone]
        F = self._F[self.grains]
        answer = (self.states.evaluate(F, Tangent.EXACT) if self.lending is None
                  else self.lending.evaluate(F, Tangent.EXACT))
        if answer.ok:
            self._set(answer)
        return answer

    def largest_change(self, correction: Any) -> float:
        """Largest change of F that a correction makes in a point of this rank, by its norm [-]."""
        changes = np.linalg.norm(self._gradient(correction), axis=(1, 2))
        return float(changes.max(initial=0.0))

    def set_time_step(self, step: float) -> None:
        """How long increments take from now on [unit of the host], as of States."""
        self.states.set_time_step(step)

    def commit(self) -> None:
        """Make the trials the committed states, of all ranks or none."""
        self.states.commit()
        self._committed_F = self._F
        self._keep()

    def revert(self) -> None:
        """Back to the committed states, with their P and A."""
        self.states.revert()
        self.P.x.array[:], self.A.x.array[:] = self._committed

    def consolidate(self, sigma: npt.ArrayLike, **how: Any) -> None:
        """Lead the points of this rank to Cauchy stresses (n, d, d) [Pa], as States.consolidate; their
        shapes there are F = I. Elastic ones have the stress at once."""
        stress = np.array(sigma, float)
        self.states.consolidate(stress[self.grains], **how)
        for resting in self._resting:
            resting.x.array.reshape(-1, self.dimension**2)[self._P_rows] = stress.reshape(len(stress), -1)
        self._F = self._committed_F = np.tile(np.eye(self.dimension), (len(self.gone), 1, 1))

    def remove(self, points: npt.NDArray[np.bool_]) -> None:
        """Points (n,) of this rank leave: their P and A are 0 from now on."""
        self.gone = self.gone | points
        self._clear_gone()
        self._keep()

    def save(self, path: AnyPath, *functions: Any, load: float = 0.0) -> None:
        """Write the committed states of all cells to one file, with the values of functions at their
        nodes, displacements first, and a load. The file is the old one or the whole new one. Raises
        Error."""
        self._cells((*functions, *self._resting)).save(path, load)

    def load(self, path: AnyPath, *functions: Any) -> float:
        """Go on from a file of save(), written by any number of ranks for this mesh, material, degree and
        these functions: states, P, A and functions have the bits that were saved. The load that was
        saved. Raises Error, and then nothing changed."""
        every = (*functions, *self._resting)
        saved = self._cells(every)
        load = saved.load(path)
        first = 0
        for function in every:
            nodes, block = self._nodes(function), function.function_space.dofmap.bs
            values = saved.unknowns[:, first:first + nodes.shape[1] * block]
            function.x.array.reshape(-1, block)[nodes.ravel()] = values.reshape(-1, block)
            function.x.scatter_forward()
            first += values.shape[1]
        F = self._F.copy()
        if self._resting:
            F = np.eye(self.dimension) + self._gradient(functions[0])
        F[self.grains] = self.states.measure(Measure.DEFORMATION_GRADIENT)
        self._F = self._committed_F = F
        self._set(self.states.answer(Tangent.EXACT))
        self._keep()
        return load

    def stress_power(self, v: Any) -> Any:
        """The form of P : grad v, for the residual."""
        return ufl.inner(self.P, self._grad(v)) * self.dx

    def stiffness(self, u: Any, v: Any) -> Any:
        """The form of grad v : A : grad u, for Newton's matrix."""
        return ufl.dot(self._row_major(v), self.A * self._row_major(u)) * self.dx

    def values(self, expression: Any) -> Array:
        """An expression of UFL at the own points, one after the other."""
        found: Array = fem.Expression(expression, self._where).eval(self._owned)
        return found.ravel()

    def scalars(self, values: npt.ArrayLike) -> Any:
        """A quadrature function of one value (n,) at each point of this rank."""
        function, rows = self._function(ufl.FiniteElement(**self._element))
        function.x.array[rows] = values
        return function

    def _cells(self, functions: Sequence[Any]) -> Cells:
        """The own cells with copies of the values of functions."""
        owned = len(self._owned)
        values = [np.empty((owned, 0))]
        for function in functions:
            nodes, block = self._nodes(function), function.function_space.dofmap.bs
            at_nodes = function.x.array.reshape(-1, block)[nodes.ravel()]
            values.append(at_nodes.reshape(owned, nodes.shape[1] * block))
        total = self.domain.topology.index_map(self.dimension).size_global
        return Cells(self.comm, self.states, self.cells, total, len(self._where),
                     np.concatenate(values, axis=1), self._state_of_point())

    def _state_of_point(self) -> npt.NDArray[np.int64]:
        """(cells, points of a cell); -1: Elastic."""
        states = np.full(len(self.layer), -1, np.int64)
        states[self.grains] = np.arange(len(self.grains))
        return states.reshape(len(self._owned), len(self._where))

    def _nodes(self, function: Any) -> npt.NDArray[np.int32]:
        """Numbers of the nodes of the own cells (n, k)."""
        dofmap = function.function_space.dofmap
        count = dofmap.dof_layout.num_dofs
        nodes: npt.NDArray[np.int32] = dofmap.list.array.reshape(-1, count)[:len(self._owned)]
        return nodes

    def _function(self, element: Any) -> tuple[Any, Any]:
        """A quadrature function, and where its values of the own points are."""
        space = fem.FunctionSpace(self.domain, element)
        return fem.Function(space), space.dofmap.list.array[:len(self._owned) * len(self._where)]

    def _gradient(self, u: Any) -> Array:
        """grad u at the own points (n, d, d); its form is compiled once for each function."""
        if u not in self._gradients:
            self._gradients[u] = fem.Expression(self._grad(u), self._where)
        found: Array = self._gradients[u].eval(self._owned)
        return found.reshape(-1, self.dimension, self.dimension)

    def _row_major(self, v: Any) -> Any:
        directions = range(self.dimension)
        return ufl.as_vector([self._grad(v)[i, J] for i in directions for J in directions])

    def _grad(self, u: Any) -> Any:
        """Of displacements, which of a mixed function are the first components."""
        d = self.dimension
        return ufl.grad(u if u.ufl_shape == (d,) else ufl.as_vector([u[i] for i in range(d)]))

    def _set(self, answer: Evaluation) -> None:
        assert answer.A is not None
        d = self.dimension
        self.P.x.array.reshape(-1, d**2)[self._P_rows[self.grains]] = answer.P.reshape(-1, d**2)
        self.A.x.array.reshape(-1, d**4)[self._A_rows[self.grains]] = answer.A.reshape(-1, d**4)
        for law, own in self._elastic:
            resting = self._resting[0].x.array.reshape(-1, d, d)[self._P_rows[own]]
            P, A = _elastic_answer(law, self._F[own], resting)
            self.P.x.array.reshape(-1, d**2)[self._P_rows[own]] = P.reshape(-1, d**2)
            self.A.x.array.reshape(-1, d**4)[self._A_rows[own]] = A.reshape(-1, d**4)
        self._clear_gone()

    def _clear_gone(self) -> None:
        d = self.dimension
        self.P.x.array.reshape(-1, d**2)[self._P_rows[self.gone]] = 0
        self.A.x.array.reshape(-1, d**4)[self._A_rows[self.gone]] = 0

    def _keep(self) -> None:
        self._committed = self.P.x.array.copy(), self.A.x.array.copy()

    def _reduce(self, values: Array, operation: str) -> Array:
        self.comm.Allreduce(MPI.IN_PLACE, values, MPI.MIN if operation == "min" else MPI.SUM)
        return values


def _check_layers(layer: npt.NDArray[np.int64], count: int) -> None:
    wrong = layer[(layer < 0) | (layer >= count)]
    if wrong.size:
        raise Error(Status.BAD_ARGUMENT, f"layer {wrong[0]}, expected a number from 0 to {count - 1}: a "
                    "missing material")


def _states(first: Material, materials: Sequence[Material | Elastic],
            layer: npt.NDArray[np.int64]) -> States:
    """States in the order of the points, of the materials that `layer` numbers."""
    if len(materials) == 1:
        return States(first, len(layer))
    states = States(first, 0)
    for end in range(1, len(layer) + 1):
        if end == len(layer) or layer[end] != layer[end - 1]:
            material = materials[layer[end - 1]]
            assert isinstance(material, Material)
            states.resize(end, material)
    return states


def _lending(comm: MPI.Intracomm, states: States, materials: Sequence[Material | Elastic],
             layer: npt.NDArray[np.int64]) -> Lending:
    """Of the materials of grains, which the states have as `layer` numbers all of them."""
    grains = [k for k, each in enumerate(materials) if isinstance(each, Material)]
    return Lending(comm, states, [each for each in materials if isinstance(each, Material)],
                   np.searchsorted(grains, layer))


def _elastic_answer(law: Elastic, F: Array, resting: Array) -> tuple[Array, Array]:
    """P = F S and its tangent, with S = S0 + lambda tr(E) I + 2 mu E and Green's strain E."""
    mu = law.young / (2 + 2 * law.poisson)
    bulk = 2 * mu * law.poisson / (1 - 2 * law.poisson)   # Lame's first
    unit = np.eye(F.shape[-1])
    E = 0.5 * (np.einsum("pki,pkj->pij", F, F) - unit)
    S = resting + bulk * np.einsum("pkk->p", E)[:, None, None] * unit + 2 * mu * E
    left = np.einsum("pik,pjk->pij", F, F)
    A = (np.einsum("ik,pJL->piJkL", unit, S) + bulk * np.einsum("piJ,pkL->piJkL", F, F)
         + mu * (np.einsum("JL,pik->piJkL", unit, left) + np.einsum("piL,pkJ->piJkL", F, F)))
    return np.einsum("pik,pkj->pij", F, S), A


def direct_solver(comm: MPI.Intracomm, matrix: Any) -> Any:
    """MUMPS, or what PETSc's options with the prefix grainlaw_ ask for."""
    solver = PETSc.KSP().create(comm)
    solver.setOperators(matrix)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    solver.setOptionsPrefix("grainlaw_")
    solver.setFromOptions()
    return solver


class Newton:
    """Equilibrium of displacements along a way of loads, by Newton's method; steps are cut and jumps
    crossed as a March decides. The start is evaluated and committed.

    u           displacements, a function of a vector space, or of a mixed one in which they come first [m]
    conditions  dolfinx' Dirichlet conditions on u
    apply       sets the constants of conditions and loads for a load
    external    the form of the work of external loads in a test function v; loads may follow u
    internal    that of further stresses, as of water
    tell        is told, on rank 0, why a step was cut
    march       options of March, as tolerance=1e-10: |force on the unknowns| / |nodal forces of P| [-]

    The linear solver is MUMPS; options of PETSc with the prefix grainlaw_ choose another one. Raises
    Error where the start has no equilibrium."""

    march: March
    correction: Any   #: of the last solve [m]

    def __init__(self, points: Points, u: Any, conditions: Sequence[Any],
                 apply: Callable[[float], None], external: Callable[[Any], Any] | None = None,
                 tell: Callable[[str], object] | None = None,
                 internal: Callable[[Any], Any] | None = None, **march: float) -> None:
        self.points, self.u, self.conditions, self.comm = points, u, list(conditions), points.comm
        self._apply, self._tell = apply, tell
        V = u.function_space
        self.owned: int = V.dofmap.index_map.size_local * V.dofmap.index_map_bs   #: unknowns
        fixed = [condition.dof_indices()[0] for condition in self.conditions]
        self._free = np.setdiff1d(np.arange(self.owned), np.concatenate(fixed) if fixed else [])
        v, du = ufl.TestFunction(V), ufl.TrialFunction(V)
        residual, stiffness = points.stress_power(v), points.stiffness(du, v)
        if internal is not None:
            residual += internal(v)
            stiffness += ufl.derivative(internal(v), u, du)
        self._internal = fem.form(residual)
        if external is not None:
            residual -= external(v)
            stiffness -= ufl.derivative(external(v), u, du)
        self._residual, self._stiffness = fem.form(residual), fem.form(stiffness)
        self._matrix = _petsc.create_matrix(self._stiffness)
        self._solver = direct_solver(self.comm, self._matrix)
        self.correction = fem.Function(V)
        self.march = March(points.states, **march)
        answer = points.evaluate(u)
        if not answer.ok:
            raise Error(Status.NOT_CONVERGED, f"no state to start from: {answer.message}")
        points.commit()

    def to(self, load: float) -> Iterator[March]:
        """To a load from where the last call ended, 0 at first, in as many parts as it takes; a way from
        0 to 0 brings the loads to act. Yields the march at the end of each part, with its load and
        residuals. Raises StepError where the smallest part fails too."""
        march, points, u = self.march, self.points, self.u.x.array
        committed = u.copy()
        for now in march.to(load):
            if march.keep:
                farthest = u.copy()
            if now == Action.SOLVE:
                self._apply(march.load)
                self.solve()
                share = march.share(points.largest_change(self.correction))
                if share > 0:   # else the stiffness is singular
                    u -= share * self.correction.x.array
                    march.tell(points.evaluate(self.u), *self.norms())
            elif now == Action.CROSS:
                u[:] = farthest
                march.tell(points.evaluate(self.u))
            elif now == Action.ACCEPT:
                points.commit()
                committed = u.copy()
                yield march
            else:
                if self._tell is not None and self.comm.rank == 0:
                    self._tell(f"load {march.load:.6g}: {march.message}; the step is cut")
                points.revert()
                u[:] = committed

    def save(self, path: AnyPath) -> None:
        """Write points, displacements and load to one file, as Points.save()."""
        self.points.save(path, self.u, load=self.march.reached)

    def load(self, path: AnyPath) -> None:
        """Go on from a file of save(), written by any number of ranks, as Points.load()."""
        self.march.reached = self.points.load(path, self.u)
        self._apply(self.march.reached)

    def solve(self) -> None:
        """Newton's correction, to be subtracted; prescribed values enter through the right side."""
        self._matrix.zeroEntries()
        _petsc.assemble_matrix(self._matrix, self._stiffness, self.conditions)
        self._matrix.assemble()
        right = _petsc.assemble_vector(self._residual)
        _petsc.apply_lifting(right, [self._stiffness], [self.conditions], [self.u.vector], -1.0)
        _to_owners(right)
        _petsc.set_bc(right, self.conditions, self.u.vector, -1.0)
        try:
            self._solver.solve(right, self.correction.vector)
        except PETSc.Error:       # of MUMPS, where it has factors already
            self._check_memory()
            raise
        if self._solver.getConvergedReason() < 0:
            self._check_memory()
        self.correction.x.scatter_forward()

    def _check_memory(self) -> None:
        """Raise Error where MUMPS failed for lack of it."""
        preconditioner = self._solver.getPC()
        if preconditioner.getFactorSolverType() == "mumps":
            told = preconditioner.getFactorMatrix().getMumpsInfog(1)
            if told in _MUMPS_MEMORY:
                raise Error(Status.OUT_OF_MEMORY, f"MUMPS ran out of memory (INFOG(1) = {told})")

    def norms(self) -> tuple[float, float]:
        """|force on the free unknowns| and |nodal forces of P|, of what this rank owns [N, 2D: N/m]."""
        residual, internal = assembled(self._residual), assembled(self._internal)
        return float(np.linalg.norm(residual[self._free])), float(np.linalg.norm(internal))

    def force(self, unknowns: npt.ArrayLike) -> float:
        """Sum of the nodal forces of P on unknowns over all ranks, which give them by their own numbers;
        those that others own are left out [N, 2D: N/m]."""
        wanted = np.asarray(unknowns, np.int64)
        own = assembled(self._internal)[wanted[wanted < self.owned]]
        return float(self.comm.allreduce(own.sum()))


def _to_owners(vector: Any) -> None:
    """Add what a rank assembled for unknowns of others to theirs."""
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)


def assembled(form: Any) -> Array:
    """The vector of a form, of the unknowns that this rank owns."""
    vector = _petsc.assemble_vector(form)
    _to_owners(vector)
    values: Array = vector.array
    return values
