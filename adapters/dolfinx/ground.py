#!/usr/bin/python3
"""Layers of sand under their weight in DOLFINx 0.5, and an excavation in stages.

    ground.py UPPER.toml LOWER.toml
    OMP_NUM_THREADS=1 mpirun -n 2 ground.py UPPER.toml LOWER.toml

Prints the force out of balance before anything moves, after ten steps of nothing, and the heave of the
pit. Ends with a status that is not 0 where the ground does not rest, or a row does not carry the weight
above it.
"""
import sys
from typing import NamedTuple

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

import grainlaw
from grainlaw import Action, Measure
from grainlaw.dolfinx import Points, end_together, read_material


class Layer(NamedTuple):
    bottom: float   # height of its lower side [m]
    material: str   # file
    solid: float    # density of the grains [kg/m3]


class Ground:
    """Horizontal layers, the uppermost first, on supports: smooth sides and a base that holds y.
    What is wrong with them raises ValueError or grainlaw.Error before any point is made."""

    def __init__(self, domain, surface, layers, gravity=9.81):
        tops = [surface] + [layer.bottom for layer in layers[:-1]]
        for number, (top, layer) in enumerate(zip(tops, layers)):
            if not layer.bottom < top:
                raise ValueError(f"layer {number} from {top} m down to {layer.bottom} m, expected a "
                                 "depth above 0")
            if not layer.solid > 0:
                raise ValueError(f"layer {number}: the density is {layer.solid} kg/m3, expected above 0")
        heights = domain.geometry.x[:, 1]
        if heights.size and (heights.min() < layers[-1].bottom - 1e-9 or heights.max() > surface + 1e-9):
            raise ValueError(f"the mesh reaches from {heights.min()} to {heights.max()} m, expected "
                             f"within {layers[-1].bottom} and {surface} m: no material")
        if not gravity > 0:
            raise ValueError(f"gravity is {gravity} m/s2, expected above 0")
        self.comm, self.gravity, self.tops, self.layers = domain.comm, gravity, tops, layers
        bottoms = np.array([layer.bottom for layer in layers])
        self.points = Points(domain, [read_material(domain.comm, layer.material) for layer in layers], 1,
                             lambda x: np.sum(x[1] < bottoms[:-1, None], axis=0))
        V = self.V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
        Q = fem.FunctionSpace(domain, ("DG", 0))
        self.u, self.owned = fem.Function(V), 2 * V.dofmap.index_map.size_local
        self.weight, self.gone_weight = fem.Function(Q), fem.Function(Q)   # [N/m3]
        self.there, self.gone_P = fem.Function(Q), self.points.P.copy()    # 1 or 0; [Pa]
        self.there.x.array[:] = 1
        self.gone_P.x.array[:] = 0
        self.left = fem.Constant(domain, 0.0)   # share of what has left that is still there
        v, du, points = ufl.TestFunction(V), ufl.TrialFunction(V), self.points
        self.body = fem.form(-(self.weight + self.left * self.gone_weight) * v[1] * points.dx)
        self.residual = fem.form(
            points.stress_power(v) + self.left * ufl.inner(self.gone_P, ufl.grad(v)) * points.dx
            + (self.weight + self.left * self.gone_weight) * v[1] * points.dx)
        self.stiffness = fem.form(points.stiffness(du, v))
        self.touched = fem.form(self.there * (v[0] + v[1]) * points.dx)
        self.volume = assemble(fem.form(ufl.TestFunction(Q) * points.dx)).array   # of each point

        def on(axis, side):
            dofs = fem.locate_dofs_geometrical((V.sub(axis), V.sub(axis).collapse()[0]), side)
            return fem.dirichletbc(fem.Function(V.sub(axis).collapse()[0]), dofs, V.sub(axis))

        low, high = (self.comm.allreduce(bound, op) for bound, op in (
            (domain.geometry.x[:, 0].min(), MPI.MIN), (domain.geometry.x[:, 0].max(), MPI.MAX)))
        self.supports = [on(1, lambda x: np.isclose(x[1], layers[-1].bottom)),
                         on(0, lambda x: np.isclose(x[0], low) | np.isclose(x[0], high))]

    def pressure(self, height, unit_weights):
        """Of the weight above (n,) [Pa]."""
        return sum(weight * np.clip(top - np.maximum(height, layer.bottom), 0, None)
                   for weight, top, layer in zip(unit_weights, self.tops, self.layers))

    def unit_weights(self):
        """Of each layer, from the void ratio of its points [N/m3]."""
        solid = 1 / (1 + self.points.states.measure(Measure.VOID_RATIO))
        layers = [self.points.layer == k for k in range(len(self.layers))]
        sums = self.comm.allreduce(np.array([[solid[of] @ self.volume[of], self.volume[of].sum()]
                                             for of in layers]))
        return self.gravity * np.array([layer.solid for layer in self.layers]) * sums[:, 0] / sums[:, 1]

    def geostatic(self, overconsolidation=1.0):
        """Lead every point to the vertical stress of the weight above it, without lateral strain. The
        unit weights of the layers [N/m3]."""
        def lead(weights, share, **how):
            self.points.consolidate(-share * self.pressure(self.points.x[:, 1], weights)[:, None, None]
                                    * np.eye(2), **how)
        weights = self.unit_weights()
        lead(weights, 0.5)
        lead(weights, 1, route="k0", overconsolidation=overconsolidation)
        for _ in range(10):
            former, weights = weights, self.unit_weights()
            if np.abs(weights / former - 1).max() < 1e-9:
                break
            lead(weights, 1, route="k0")
        self.weight.x.array[:len(self.points.layer)] = weights[self.points.layer]
        self.weight.x.scatter_forward()
        self.points.evaluate(self.u)
        self.points.commit()
        return weights

    def excavate(self, leaves):
        """The cells where leaves(x), x (2, n) [m], leave over the steps that follow."""
        going = leaves(self.points.x.T) & ~self.points.gone
        if self.comm.allreduce(int(going.sum())) == 0:
            raise ValueError("nothing is excavated: no point lies there that has not left before")
        cells = np.flatnonzero(going)
        self.gone_P.x.array[:] = 0
        self.gone_weight.x.array[:] = 0
        P = self.points.P.x.array.reshape(-1, 4)
        self.gone_P.x.array.reshape(-1, 4)[cells] = P[cells]
        self.gone_weight.x.array[cells] = self.weight.x.array[cells]
        self.weight.x.array[cells] = self.there.x.array[cells] = 0
        self.points.remove(going)
        self.left.value = 1
        nowhere = fem.petsc.create_vector(self.touched)
        fem.petsc.assemble_vector(nowhere, self.touched)
        add_ghosts(nowhere)
        nowhere.ghostUpdate(addv=PETSc.InsertMode.INSERT, mode=PETSc.ScatterMode.FORWARD)
        with nowhere.localForm() as local:
            alone = np.flatnonzero(np.abs(local.array) < 1e-14)[::2] // 2
        held = fem.Function(self.V)
        held.x.array[:] = self.u.x.array
        self.supports.append(fem.dirichletbc(held, alone.astype(np.int32)))

    def out_of_balance(self):
        """|force on the unknowns|, and the weight that is left."""
        right = fem.petsc.assemble_vector(self.residual)
        add_ghosts(right)
        fem.petsc.set_bc(right, self.supports, scale=0.0)
        return right.norm(PETSc.NormType.NORM_INFINITY), -self.comm.allreduce(
            assemble(self.body).array[:self.owned].sum())

    def advance(self, steps):
        """Newton over steps of equal shares, in which what has left fades; yields after each."""
        march = grainlaw.March(self.points.states, tolerance=1e-9)
        had = float(self.left.value)
        committed = farthest = self.u.x.array.copy()
        for step in range(1, steps + 1):
            for now in march.to(step / steps):
                if march.keep:
                    farthest = self.u.x.array.copy()
                if now == Action.SOLVE:
                    self.left.value = had * (1 - march.load)
                    self.u.x.array[:self.owned] -= self.solve()
                    self.u.x.scatter_forward()
                    answer = self.points.evaluate(self.u)
                    march.tell(answer, *self.out_of_balance())
                elif now == Action.CROSS:
                    self.u.x.array[:] = farthest
                    march.tell(self.points.evaluate(self.u))
                elif now == Action.ACCEPT:
                    self.points.commit()
                    committed = self.u.x.array.copy()
                else:
                    self.points.revert()
                    self.u.x.array[:] = committed
            yield step

    def solve(self):
        matrix = fem.petsc.assemble_matrix(self.stiffness, self.supports)
        matrix.assemble()
        right = fem.petsc.assemble_vector(self.residual)
        add_ghosts(right)
        fem.petsc.set_bc(right, self.supports, scale=0.0)
        solver = PETSc.KSP().create(self.comm)
        solver.setOperators(matrix)
        solver.setType("preonly")
        solver.getPC().setType("lu")
        solver.getPC().setFactorSolverType("mumps")
        correction = right.duplicate()
        solver.solve(right, correction)
        return correction.array.copy()


def add_ghosts(vector):
    """What a rank assembled for unknowns of others goes to them."""
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)


def assemble(form):
    """A vector of the unknowns that this rank owns."""
    vector = fem.petsc.assemble_vector(form)
    add_ghosts(vector)
    return vector


def tell(text):
    """On one rank."""
    if MPI.COMM_WORLD.rank == 0:
        print(text, flush=True)


def main(upper, lower):
    domain = mesh.create_rectangle(MPI.COMM_WORLD, [[0, -4], [2, 0]], [2, 4],
                                   mesh.CellType.triangle, diagonal=mesh.DiagonalType.right)
    ground = Ground(domain, 0, [Layer(-2, upper, 2650), Layer(-4, lower, 2600)])
    weights = ground.geostatic()
    force, weight = ground.out_of_balance()
    tell(f"weight {weight / 1e3:.6g} kN/m, out of balance {force / weight:.1e} of it")
    worst = force / weight
    for _ in ground.advance(10):   # nothing happens, ten times
        worst = max(worst, ground.out_of_balance()[0] / weight)
    moved = domain.comm.allreduce(np.abs(ground.u.x.array).max(), MPI.MAX)
    tell(f"after ten steps of nothing: {worst:.1e} of it, moved by {moved:.1e} m")
    assert worst < 1e-6 and moved < 1e-9
    ground.excavate(lambda x: x[1] > -1)
    for step in ground.advance(4):
        heave = domain.comm.allreduce(ground.u.x.array[1::2].max(), MPI.MAX)
        tell(f"excavated by {25 * step} %: heave {1e3 * heave:.6g} mm")
    P, there = ground.points.P.x.array.reshape(-1, 4)[:len(ground.points.gone)], ~ground.points.gone
    sums = np.array([P[there, 3].sum(),
                     (ground.pressure(ground.points.x[there, 1], weights) - weights[0]).sum()])
    stress, pressure = domain.comm.allreduce(sums)
    tell(f"mean vertical stress against the weight above: {abs(stress / pressure + 1):.1e}")
    assert abs(stress / pressure + 1) < 1e-6


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with end_together(MPI.COMM_WORLD):
        main(*sys.argv[1:])
