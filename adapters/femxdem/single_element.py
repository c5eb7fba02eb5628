#!/usr/bin/env python3
"""FEMxDEM's single element: drained compression of four points, in steps of 0.1 %.

    single_element.py STEPS [RTOL]     material: 0.toml of this folder, or 0.yade.gz where FEMxDEM's own modules are
"""
import sys

from esys.escript import Function, FunctionOnBoundary, integrate, whereZero
from esys.finley import Rectangle
from msFEM2D import MultiScale

rtol = float(sys.argv[2]) if len(sys.argv) > 2 else 1e-2
domain = Rectangle(l0=1, l1=1, n0=1, n1=1, order=1, integrationOrder=2)
prob = MultiScale(domain=domain, ng=4, np=2, rtol=rtol)
x, edge = domain.getX(), FunctionOnBoundary(domain).getX()
held = (whereZero(x[1]) + whereZero(x[1] - 1)) * [0, 1] + whereZero(x[0]) * whereZero(x[1]) * [1, 0]
moved = whereZero(x[1] - 1) * [0, -1e-3]
sides = (whereZero(edge[0]) - whereZero(edge[0] - 1)) * [1e5, 0]
for step in range(1, int(sys.argv[1]) + 1):
    prob.initialize(f=sides, specified_u_mask=held, specified_u_val=moved)
    prob.solve(iter_max=100)
    stress = integrate(prob.getCurrentStress(), Function(domain)) / integrate(1.0, Function(domain))
    print(f"strain {step * 0.1:.1f} %: axial stress {-stress[1, 1] / 1e3:.2f}, lateral {-stress[0, 0] / 1e3:.2f} kPa",
          flush=True)
prob.exitSimulation()
