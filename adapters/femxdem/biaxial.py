#!/usr/bin/env python3
"""Biaxial compression between smooth ends, as a script of FEMxDEM: the material is 0.toml of this folder."""
import os

from esys.escript import (FunctionOnBoundary, Solution, Vector, integrate, interpolate, matrix_mult, symmetric,
                          whereZero)
from esys.escript.pdetools import Projector
from esys.finley import Rectangle
from esys.weipa import saveVTK
from msFEM2D import MultiScale
from saveGauss import saveGauss2D

width, height, elements, steps = 0.05, 0.1, (2, 4), 5
pressure, strain = 1e5, 1e-3                                     # Pa; of a step
domain = Rectangle(l0=width, l1=height, n0=elements[0], n1=elements[1], order=2, integrationOrder=2)
prob = MultiScale(domain=domain, ng=4 * elements[0] * elements[1], np=2, rtol=1e-2)

x, edge = domain.getX(), FunctionOnBoundary(domain).getX()
below, above = whereZero(x[1]), whereZero(x[1] - height)
held = (below + above) * [0, 1] + below * whereZero(x[0] - width / 2) * [1, 0]
sides = (whereZero(edge[0]) - whereZero(edge[0] - width)) * [pressure, 0]
top = whereZero(edge[1] - height)


def force(stress):
    """On the top, along axis 2, and its length."""
    there = interpolate(Projector(domain)(stress), FunctionOnBoundary(domain))
    traction = matrix_mult(there, domain.getNormal()) * top
    return integrate(traction)[1], integrate(top)


os.makedirs("result", exist_ok=True)
u = Vector(0.0, Solution(domain))
with open("result/force.dat", "w", encoding="ascii") as file:
    print(0, *force(prob.getCurrentStress()), file=file)
    for step in range(1, steps + 1):
        prob.initialize(f=sides, specified_u_mask=held, specified_u_val=above * [0, -strain * height])
        u += prob.solve(iter_max=100)
        print(-step * strain, *force(prob.getCurrentStress()), file=file)
        saveVTK(f"result/biaxial_{step}.vtu", u=u, strain=symmetric(prob.getCurrentStrain()),
                void_ratio=prob.getLocalVoidRatio(), rotation=prob.getLocalAvgRotation())
saveGauss2D("result/gauss.dat", stress=prob.getCurrentStress(), fabric=prob.getLocalFabric())
prob.getCurrentPacking(pos=[0], time=steps, prefix="result/")
on_top, length = force(prob.getCurrentStress())
print(f"strain {steps * strain:.3f}: mean axial stress {-on_top / length / 1e3:.2f} kPa")
prob.exitSimulation()
