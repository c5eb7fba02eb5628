#!/usr/bin/python3
"""The biaxial test of adapters/biaxial/biaxial.toml in DOLFINx 0.5.

    dolfinx_biaxial.py ../biaxial/material.toml [PREFIX [STEPS]]
    OMP_NUM_THREADS=1 mpirun -n 2 dolfinx_biaxial.py ../biaxial/material.toml

Prints the residuals of Newton's method, and writes PREFIX_force.csv and PREFIX_newton.csv.
"""
import sys
import traceback

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

import grainlaw
from dolfinx_points import Points
from grainlaw import Action
from grainlaw.files import write_whole

WIDTH, HEIGHT = 0.05, 0.1   # m
SIDE_PRESSURE = 100e3       # Pa, dead load
SHORTENING = 1e-3           # m, at full load
TOLERANCE = 1e-10           # |force on the unknowns| / |nodal forces of P| [-]


class Biaxial:
    def __init__(self, material):
        domain = mesh.create_rectangle(MPI.COMM_WORLD, [[0, 0], [WIDTH, HEIGHT]], [4, 8],
                                       mesh.CellType.triangle, diagonal=mesh.DiagonalType.right)
        V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
        self.u, self.correction = fem.Function(V), fem.Function(V)
        self.owned = 2 * V.dofmap.index_map.size_local   # unknowns; those of other ranks come after
        self.comm = domain.comm
        self.points = Points(domain, material, degree=1)
        self.top_displacement = fem.Constant(domain, np.zeros(2))

        def nodes(side):
            return fem.locate_dofs_geometrical(V, side)

        top = nodes(lambda x: np.isclose(x[1], HEIGHT))
        bottom = nodes(lambda x: np.isclose(x[1], 0))
        self.conditions = [
            fem.dirichletbc(np.zeros(2), bottom, V),
            fem.dirichletbc(self.top_displacement, top, V)]
        self.top_y = 2 * top[2 * top < self.owned] + 1
        fixed = np.concatenate([top, bottom])
        self.free = np.setdiff1d(np.arange(self.owned), [2 * fixed, 2 * fixed + 1])

        sides = mesh.locate_entities_boundary(
            domain, 1, lambda x: np.isclose(x[0], 0) | np.isclose(x[0], WIDTH))
        tags = mesh.meshtags(domain, 1, np.sort(sides), np.ones(len(sides), np.int32))
        ds = ufl.Measure("ds", domain, subdomain_data=tags)
        v, du = ufl.TestFunction(V), ufl.TrialFunction(V)
        outward = ufl.FacetNormal(domain)
        load = -SIDE_PRESSURE * ufl.inner(outward, v) * ds(1)
        self.internal = fem.form(self.points.stress_power(v))
        self.residual = fem.form(self.points.stress_power(v) - load)
        self.stiffness = fem.form(self.points.stiffness(du, v))

        answer = self.points.evaluate(self.u)
        if not answer.ok:
            sys.exit(f"no state to start from: {answer.message}")
        self.points.commit()

    def top_force(self):
        """Force of P on the top in y."""
        return self.comm.allreduce(assemble(self.internal).array[self.top_y].sum())

    def norms(self):
        """|force on the unknowns| and |nodal forces of P|, of what this rank owns."""
        residual, internal = assemble(self.residual).array, assemble(self.internal).array
        return np.linalg.norm(residual[self.free]), np.linalg.norm(internal)

    def advance(self, march, load):
        """To a load, in as many parts as it takes; yields the residuals of each."""
        committed = self.u.x.array.copy()
        for now in march.to(load):
            if march.keep:
                farthest = self.u.x.array.copy()
            if now == Action.SOLVE:
                self.top_displacement.value = (0, -SHORTENING * march.load)
                self.solve()
                share = march.share(self.points.largest_change(self.correction))
                if share > 0:   # else the stiffness is singular
                    self.u.x.array[:] -= share * self.correction.x.array
                    march.tell(self.points.evaluate(self.u), *self.norms())
            elif now == Action.CROSS:
                self.u.x.array[:] = farthest
                march.tell(self.points.evaluate(self.u))
            elif now == Action.ACCEPT:
                self.points.commit()
                committed = self.u.x.array.copy()
                yield march.residuals
            else:
                tell(f"load {march.load:.6g}: {march.message}; the step is cut")
                self.points.revert()
                self.u.x.array[:] = committed

    def solve(self):
        """Newton's correction; the increment of the boundary values enters through its right side.
        """
        matrix = fem.petsc.assemble_matrix(self.stiffness, self.conditions)
        matrix.assemble()
        right = fem.petsc.assemble_vector(self.residual)
        fem.petsc.apply_lifting(right, [self.stiffness], [self.conditions], [self.u.vector], -1.0)
        add_ghosts(right)
        fem.petsc.set_bc(right, self.conditions, self.u.vector, -1.0)
        solver = PETSc.KSP().create(self.comm)
        solver.setOperators(matrix)
        solver.setType("preonly")
        solver.getPC().setType("lu")
        solver.getPC().setFactorSolverType("mumps")
        solver.solve(right, self.correction.vector)
        self.correction.x.scatter_forward()


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


def main(material, prefix="biaxial", count="20"):
    problem = Biaxial(grainlaw.Material(material))
    march = grainlaw.March(problem.points.states, tolerance=TOLERANCE)
    force = "step[-],fraction[-],top_y_displacement[m],top_y_force[N/m]\n"
    newton = "step[-],iteration[-],relative_residual[-]\n"
    for step in range(int(count) + 1):
        for residuals in problem.advance(march, step / int(count)):
            top = problem.top_force()
            tell(f"load {march.load:.6g}: force {top:.6g} N/m, residuals "
                 + ", ".join(f"{residual:.1e}" for residual in residuals))
            force += f"{step},{march.load:.17g},{-SHORTENING * march.load:.17g},{top:.17g}\n"
            for iteration, residual in enumerate(residuals, 1):
                newton += f"{step},{iteration},{residual:.17g}\n"
            if MPI.COMM_WORLD.rank == 0:
                write_whole(prefix + "_force.csv", force)  # on a full disk the steps before stay
                write_whole(prefix + "_newton.csv", newton)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
    except Exception as error:  # of one rank: the others would wait for it
        if MPI.COMM_WORLD.size > 1:
            traceback.print_exc()
            MPI.COMM_WORLD.Abort(1)
        if isinstance(error, grainlaw.Error):
            sys.exit(f"grainlaw: {error}")
        raise
