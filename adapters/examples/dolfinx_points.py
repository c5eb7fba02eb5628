"""grainlaw in DOLFINx: P and its tangent as functions on quadrature points, on any number of ranks."""
import basix
import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

import grainlaw


class Points:
    """The quadrature points of a two-dimensional mesh, of one material, or of that of several which
    layer(x) numbers, x (2, n) [m]; on each rank those of the cells that it owns, as forms are assembled
    over no others. The functions `P` (2, 2) and `A` (4, 4), which
    has a row for each P_iJ and a column for each F_kL in row-major order, are for forms over `dx` and
    hold what the last `evaluate` found."""

    def __init__(self, domain, material, degree, layer=None):
        cell = domain.ufl_cell()
        kind = {"degree": degree, "quad_scheme": "default"}
        self._P_space = fem.FunctionSpace(
            domain, ufl.TensorElement("Quadrature", cell, shape=(2, 2), **kind))
        self._A_space = fem.FunctionSpace(
            domain, ufl.TensorElement("Quadrature", cell, shape=(4, 4), **kind))
        self.P = fem.Function(self._P_space)
        self.A = fem.Function(self._A_space)
        self.dx = ufl.Measure("dx", domain, metadata={"quadrature_degree": degree,
                                                      "quadrature_scheme": "default"})
        self._where, _ = basix.make_quadrature(basix.cell.string_to_type(cell.cellname()), degree)
        self._cells = np.arange(domain.topology.index_map(domain.topology.dim).size_local,
                                dtype=np.int32)
        count = len(self._cells) * len(self._where)
        self._owned_P = self._P_space.dofmap.list.array[:count]
        self._owned_A = self._A_space.dofmap.list.array[:count]
        self.x = fem.Expression(ufl.SpatialCoordinate(domain), self._where).eval(
            self._cells).reshape(-1, 2)   # of the points [m]
        materials = [material] if layer is None else material
        self.layer = np.zeros(count, int) if layer is None else layer(self.x.T)
        self._order = np.argsort(self.layer, kind="stable")   # the states are by material
        self.states = grainlaw.States(materials[0], 0)        # agree on failures and commits
        for number, one in enumerate(materials):
            self.states.resize(len(self.states) + int(np.sum(self.layer == number)), one)
        operations = {"min": MPI.MIN, "sum": MPI.SUM}

        def reduce(values, operation):
            domain.comm.Allreduce(MPI.IN_PLACE, values, operations[operation])
            return values

        if domain.comm.size > 1:
            self.states.share(domain.comm.rank, reduce)
        self._gradients = {}
        self.gone = np.zeros(count, bool)
        self._last = self._tried = np.tile(np.eye(2), (count, 1, 1))   # F as committed
        self._committed = self.P.x.array.copy(), self.A.x.array.copy()

    def evaluate(self, u):
        """Evaluate all points at I + grad u in one call on each rank, with the exact tangent. P and A
        follow when all of them found an equilibrium. Raises grainlaw.Error on all ranks or none."""
        F = np.eye(2) + self._gradient(u)
        F[self.gone] = self._last[self.gone]
        self._tried = F
        answer = self.states.evaluate(F[self._order], grainlaw.Tangent.EXACT)
        if answer.ok:
            there = ~self.gone[self._order][:, None]
            self.P.x.array.reshape(-1, 4)[self._owned_P[self._order]] = (
                there * answer.P.reshape(-1, 4))
            self.A.x.array.reshape(-1, 16)[self._owned_A[self._order]] = (
                there * answer.A.reshape(-1, 16))
        return answer

    def largest_change(self, correction):
        """Largest change of F that a correction makes in a point of this rank, by its norm [-]."""
        changes = np.linalg.norm(self._gradient(correction), axis=(1, 2))
        return changes.max(initial=0.0)

    def _gradient(self, u):
        """grad u at the points (n, 2, 2); its form is compiled once for each function."""
        if u not in self._gradients:
            self._gradients[u] = fem.Expression(ufl.grad(u), self._where)
        return self._gradients[u].eval(self._cells).reshape(-1, 2, 2)

    def consolidate(self, sigma, **how):
        """Lead the points to Cauchy stresses (n, 2, 2) [Pa], as grainlaw.States.consolidate."""
        self.states.consolidate(sigma[self._order], **how)

    def measure(self, what):
        """Of each point (n,)."""
        values = np.empty(len(self.layer))
        values[self._order] = self.states.measure(what)
        return values

    def remove(self, points):
        """Points (n,) of bool leave: their P and A are 0 from now on."""
        self.gone = self.gone | points
        self.P.x.array.reshape(-1, 4)[self._owned_P[points]] = 0
        self.A.x.array.reshape(-1, 16)[self._owned_A[points]] = 0
        self._committed = self.P.x.array.copy(), self.A.x.array.copy()

    def set_time_step(self, step):
        """How long increments take from now on, for a material with solver.viscous_rate."""
        self.states.set_time_step(step)

    def commit(self):
        self.states.commit()
        self._last = self._tried
        self._committed = self.P.x.array.copy(), self.A.x.array.copy()

    def revert(self):
        """Back to the committed states; P and A are theirs again."""
        self.states.revert()
        self.P.x.array[:], self.A.x.array[:] = self._committed

    def stress_power(self, v):
        """P : grad v, for the residual."""
        return ufl.inner(self.P, ufl.grad(v)) * self.dx

    def stiffness(self, u, v):
        """grad v : A : grad u, for Newton's matrix."""
        return ufl.dot(_row_major(ufl.grad(v)), self.A * _row_major(ufl.grad(u))) * self.dx


def _row_major(G):
    return ufl.as_vector([G[i, J] for i in range(2) for J in range(2)])
