"""A packing of tests/data in YADE's periodic cell, with the contact law of the reference: linear contacts with friction,
damping 0.1, collisions by sweep and prune. Needs Debian's package yade."""

import csv
import math

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

RATIO, FRICTION, DENSITY = 0.8, 0.5, 2650.0
NAMES = {"discs": ("rve400", 6e8), "spheres": ("spheres500", 1e8)}  # files, Young's modulus of a contact [Pa]


def load(data, kind):
    """The 400 discs or 500 spheres at rest with three tenths of the critical time step; their number."""
    name, young = NAMES[kind]
    discs = kind == "discs"

    def rows(what):
        with open(f"{data}/{name}_{what}.csv", encoding="ascii") as file:
            return list(csv.DictReader(file))

    cell = {key: float(value) for key, value in rows("cell")[0].items()}
    particles = rows("particles")
    thickness = cell["thickness"] if discs else 0
    O.periodic = True
    if discs:
        cell |= {"H02": 0, "H12": 0, "H20": 0, "H21": 0, "H22": thickness}
    O.cell.hSize = Matrix3(*(cell[f"H{i}{j}"] for i in range(3) for j in range(3)))
    material = O.materials.append(FrictMat(young=young, poisson=RATIO, frictionAngle=FRICTION, density=DENSITY))

    def mass_of(radius):
        return DENSITY * math.pi * radius**2 * (thickness if discs else 4 / 3 * radius)

    for particle in particles:
        radius = float(particle["r"])
        z = thickness / 2 if discs else float(particle["z"])
        body = O.bodies[O.bodies.append(sphere((float(particle["x"]), float(particle["y"]), z), radius, material=material))]
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
    O.dt = 0.3 * math.sqrt(mass_of(least) / (young * least))
    return len(particles)


def strain_at(rate, kind):
    """Compression along the last axis of the packing at constant area or volume, by this rate of the logarithmic strain [1/s]."""
    discs = kind == "discs"
    lateral = rate if discs else rate / 2
    O.cell.velGrad = Matrix3(lateral, 0, 0, 0, -rate if discs else lateral, 0, 0, 0, 0 if discs else -rate)
