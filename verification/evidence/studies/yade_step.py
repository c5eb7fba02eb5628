"""What a step costs in YADE on this machine: CPU time per particle [ns], on the packing of tests/data.

    yade -n -x -j1 yade_step.py DATA_DIRECTORY discs|spheres

The 400 discs of rve400_*.csv or the spheres of spheres500_*.csv strained by 0.1 % in a periodic cell at
constant area or volume, as in the increments whose numbers of steps are known: damping 0.1, linear contacts
with friction, collisions by sweep and prune. Prints one line; needs Debian's package yade.
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
RATIO, FRICTION, DENSITY = 0.8, 0.5, 2650.0
discs = sys.argv[2] == "discs"
name, YOUNG = ("rve400", 6e8) if discs else ("spheres500", 1e8)


def rows(name):
    with open(f"{sys.argv[1]}/{name}", encoding="ascii") as file:
        return list(csv.DictReader(file))


cell = {key: float(value) for key, value in rows(f"{name}_cell.csv")[0].items()}
particles = rows(f"{name}_particles.csv")
thickness = cell["thickness"] if discs else 0
O.periodic = True
if discs:
    cell |= {"H02": 0, "H12": 0, "H20": 0, "H21": 0, "H22": thickness}
O.cell.hSize = Matrix3(*(cell[f"H{i}{j}"] for i in range(3) for j in range(3)))
material = O.materials.append(
    FrictMat(young=YOUNG, poisson=RATIO, frictionAngle=FRICTION, density=DENSITY)
)


def mass_of(radius):
    return DENSITY * math.pi * radius**2 * (thickness if discs else 4 / 3 * radius)


for particle in particles:
    radius = float(particle["r"])
    z = thickness / 2 if discs else float(particle["z"])
    centre = (float(particle["x"]), float(particle["y"]), z)
    body = O.bodies[O.bodies.append(sphere(centre, radius, material=material))]
    body.state.mass = mass_of(radius)
    body.state.inertia = Vector3(1, 1, 1) * body.state.mass * radius**2 * (0.5 if discs else 0.4)
    if discs:
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
O.dt = 0.3 * math.sqrt(mass_of(least) / (YOUNG * least))
O.run(WARM_UP, True)
rate = 1e-3 / (ROUNDS * STEPS * O.dt)
lateral = rate if discs else rate / 2
O.cell.velGrad = Matrix3(lateral, 0, 0, 0, -rate if discs else lateral, 0, 0, 0, 0 if discs else -rate)
best = math.inf
for _ in range(ROUNDS):
    start = time.process_time()
    O.run(STEPS, True)
    best = min(best, (time.process_time() - start) / STEPS)
touching = sum(1 for contact in O.interactions if contact.isReal)
print(f"yade_step_ns {1e9 * best / len(particles):.1f} contacts {touching}", flush=True)
