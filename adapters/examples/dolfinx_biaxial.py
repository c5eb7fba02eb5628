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
from grainlaw.files import write_whole
from grainlaw.steps import LoadSteps

WIDTH, HEIGHT = 0.05, 0.1   # m
SIDE_PRESSURE = 100e3       # Pa, dead load
SHORTENING = 1e-3           # m, at full load
TOLERANCE = 1e-10           # |force on the unknowns| / |nodal forces of P| [-]
MAX_ITERATIONS = 12


class Biaxial:
    def __init__(self, material):
        domain = mesh.create_rectangle(MPI.COMM_WORLD, [[0, 0], [WIDTH, HEIGHT]], [4, 8],
                                       mesh.CellType.triangle, diagonal=mesh.DiagonalType.right)
        V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
        self.u = fem.Function(V)
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

    def forces(self):
        """Force of P on the top in y, and |force on the unknowns| over |nodal forces of P|."""
        internal, residual = assemble(self.internal).array, assemble(self.residual).array
        top, free, whole = self.comm.allreduce(np.array([
            internal[self.top_y].sum(), (residual[self.free]**2).sum(), (internal**2).sum()]))
        return top, np.sqrt(free / whole)

    def advance(self, load):
        """Newton's method to a fraction of the load. Returns whether it got there, the residuals,
        and the factor on the step to try next."""
        start = self.u.x.array.copy()
        self.top_displacement.value = (0, -SHORTENING * load)
        residuals = []
        for _ in range(MAX_ITERATIONS):
            self.u.x.array[:self.owned] -= self.solve()
            self.u.x.scatter_forward()
            answer = self.points.evaluate(self.u)
            if not answer.ok:
                break
            residuals.append(self.forces()[1])
            if residuals[-1] <= TOLERANCE:
                self.points.commit()
                return True, residuals, 1.0
        reason = answer.message or "Newton did not converge"
        tell(f"load {load:.6g}: {reason}; the step is cut")
        self.points.revert()
        self.u.x.array[:] = start
        return False, residuals, 0.5 if answer.ok else answer.step_ratio

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


def main(material, prefix="biaxial", count="20"):
    problem = Biaxial(grainlaw.Material(material))
    steps = LoadSteps([k / int(count) for k in range(int(count) + 1)])
    force = "step[-],fraction[-],top_y_displacement[m],top_y_force[N/m]\n"
    newton = "step[-],iteration[-],relative_residual[-]\n"
    while steps:
        problem.points.set_time_step(steps.part)
        converged, residuals, ratio = problem.advance(steps.load)
        if not converged:
            steps.cut(ratio)
            continue
        top = problem.forces()[0]
        tell(f"load {steps.load:.6g}: force {top:.6g} N/m, residuals "
             + ", ".join(f"{residual:.1e}" for residual in residuals))
        force += (f"{steps.number},{steps.load:.17g},{-SHORTENING * steps.load:.17g},"
                  f"{top:.17g}\n")
        for iteration, residual in enumerate(residuals, 1):
            newton += f"{steps.number},{iteration},{residual:.17g}\n"
        if MPI.COMM_WORLD.rank == 0:
            write_whole(prefix + "_force.csv", force)  # on a full disk the steps before stay
            write_whole(prefix + "_newton.csv", newton)
        steps.accept()


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
