"""What a step costs in YADE on this machine: CPU time per particle [ns], on the packing of tests/data.

    yade -n -x -j1 yade_step.py DATA_DIRECTORY

The discs of rve400_*.csv strained by 0.1 % in a periodic cell at constant area, as in the increments
whose times scenes/reference/yade_cost.csv has: damping 0.1, linear contacts with friction, collisions by
sweep and prune. Prints one line; needs Debian's package yade.
"""

import csv
import math
import sys
import time

from yade import O, Vector3, Matrix3
from yade.utils import sphere
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    NewtonIntegrator,
)

WARM_UP, STEPS, ROUNDS = 300, 2000, 3
YOUNG, RATIO, FRICTION, DENSITY = 6e8, 0.8, 0.5, 2650.0


def rows(name):
    with open(f"{sys.argv[1]}/{name}", encoding="ascii") as file:
        return list(csv.DictReader(file))


cell = {key: float(value) for key, value in rows("rve400_cell.csv")[0].items()}
particles = rows("rve400_particles.csv")
thickness = cell["thickness"]
O.periodic = True
O.cell.hSize = Matrix3(cell["H00"], cell["H01"], 0, cell["H10"], cell["H11"], 0, 0, 0, thickness)
material = O.materials.append(
    FrictMat(young=YOUNG, poisson=RATIO, frictionAngle=FRICTION, density=DENSITY)
)
for particle in particles:
    radius = float(particle["r"])
    centre = (float(particle["x"]), float(particle["y"]), thickness / 2)
    body = O.bodies[O.bodies.append(sphere(centre, radius, material=material))]
    body.state.mass = DENSITY * math.pi * radius**2 * thickness
    body.state.inertia = Vector3(1, 1, 1) * body.state.mass * radius**2 / 2
    body.state.blockedDOFs = "zXY"
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()]),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_FrictPhys()],
        [Law2_ScGeom_FrictPhys_CundallStrack()],
    ),
    NewtonIntegrator(damping=0.1),
]
least = min(float(particle["r"]) for particle in particles)
O.dt = 0.3 * math.sqrt(DENSITY * math.pi * least**2 * thickness / (YOUNG * least))
O.run(WARM_UP, True)
rate = 1e-3 / (ROUNDS * STEPS * O.dt)
O.cell.velGrad = Matrix3(rate, 0, 0, 0, -rate, 0, 0, 0, 0)
best = math.inf
for _ in range(ROUNDS):
    start = time.process_time()
    O.run(STEPS, True)
    best = min(best, (time.process_time() - start) / STEPS)
touching = sum(1 for contact in O.interactions if contact.isReal)
print(f"yade_step_ns {1e9 * best / len(particles):.1f} contacts {touching}", flush=True)
