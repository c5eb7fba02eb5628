"""The 400 discs of tests/data as 0.yade.gz, as FEMxDEM reads it.

    yade -n -x -j1 yade_packing.py DATA_DIRECTORY
"""
import csv
import math
import sys

from yade import Matrix3, O, Vector3, utils
from yade.wrapper import (Bo1_Sphere_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom, InsertionSortCollider,
                          InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack,
                          NewtonIntegrator)

DENSITY = 2650.0


def rows(name):
    with open(f"{sys.argv[1]}/rve400_{name}.csv", encoding="ascii") as file:
        return list(csv.DictReader(file))


cell = {key: float(value) for key, value in rows("cell")[0].items()}
thickness = cell["thickness"]
O.periodic = True
O.cell.hSize = Matrix3(cell["H00"], cell["H01"], 0, cell["H10"], cell["H11"], 0, 0, 0, thickness)
O.cell.trsf = Matrix3.Identity
grains = O.materials.append(FrictMat(young=6e8, poisson=0.8, frictionAngle=0.5, density=DENSITY))
for row in rows("particles"):
    radius = float(row["r"])
    centre = (float(row["x"]), float(row["y"]), thickness / 2)
    body = O.bodies[O.bodies.append(utils.sphere(centre, radius, material=grains))]
    body.state.blockedDOFs = "zXY"
    body.state.mass = DENSITY * thickness * math.pi * radius**2
    inertia = body.state.mass * radius**2 / 2
    body.state.inertia = (inertia / 2, inertia / 2, inertia)
O.dt = utils.PWaveTimeStep()
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                             [Law2_ScGeom_FrictPhys_CundallStrack()]),
             NewtonIntegrator(damping=0.1)]
O.run(1, True)   # which finds the contacts
for row in rows("contacts"):
    contact = O.interactions[int(row["i"]), int(row["j"])]
    sign = 1 if contact.id1 == int(row["j"]) else -1   # YADE's force is on the first
    contact.phys.shearForce = sign * Vector3(float(row["ftx_on_j"]), float(row["fty_on_j"]), 0)
for body in O.bodies:
    body.state.vel = body.state.angVel = Vector3.Zero
print(f"YADE: time step {O.dt:.3g} s, axial stress {-utils.getStress()[1, 1] / 1e3:.2f} kPa", flush=True)
O.save("0.yade.gz")
