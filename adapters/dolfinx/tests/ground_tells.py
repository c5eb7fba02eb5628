#!/usr/bin/python3
"""What is wrong with layers is told before any point is made:  ground_tells.py MATERIAL.toml"""
import pathlib
import sys

from mpi4py import MPI
from dolfinx import mesh

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import grainlaw  # pylint: disable=wrong-import-position
from ground import Ground, Layer  # pylint: disable=wrong-import-position

SAND = sys.argv[1]
domain = mesh.create_rectangle(MPI.COMM_WORLD, [[0, -4], [2, 0]], [1, 2])
for surface, layers, gravity, text in (
        (0, [Layer(-2, SAND, 2650), Layer(-2, SAND, 2650)], 9.81, "layer 1 from -2 m down to -2 m"),
        (0, [Layer(-5, SAND, 0)], 9.81, "layer 0: the density is 0 kg/m3"),
        (0, [Layer(-3, SAND, 2650)], 9.81, "the mesh reaches from -4.0 to 0.0 m"),
        (-1, [Layer(-4, SAND, 2650)], 9.81, "the mesh reaches from -4.0 to 0.0 m"),
        (0, [Layer(-4, SAND, 2650)], -9.81, "gravity is -9.81 m/s2"),
        (0, [Layer(-2, SAND, 2650), Layer(-4, "nowhere.toml", 2650)], 9.81, "nowhere.toml")):
    try:
        Ground(domain, surface, layers, gravity)
    except (ValueError, grainlaw.Error) as error:
        assert text in str(error), error
    else:
        sys.exit(f"not told: {text}")
ground = Ground(domain, 0, [Layer(-4, SAND, 2650)])
try:
    ground.excavate(lambda x: x[1] > 1)
except ValueError as error:
    assert "nothing is excavated" in str(error)
else:
    sys.exit("not told: nothing is excavated")
