"""What bedded.py writes is one packing, turned:  bedded_test.py BEDDED.py MATERIAL.toml"""
import subprocess
import sys
import tempfile

import numpy as np

import grainlaw

TURN = np.radians(30)
R = np.array([[np.cos(TURN), -np.sin(TURN)], [np.sin(TURN), np.cos(TURN)]])


def led(path, turned):
    """Stresses and fabric on one path, as seen from the packing."""
    state = grainlaw.State(grainlaw.Material(path))
    state.set_time_step(1)
    stresses = []
    for share in (1, 2, 3):
        F = np.eye(2) + share * np.array([[2e-4, 1e-4], [0, -6e-4]])
        answer = state.evaluate(turned @ F @ turned.T)
        assert answer.ok, answer.message
        state.commit()
        stresses.append(turned.T @ answer.P @ turned)
    return np.array(stresses), turned.T @ state.measure(grainlaw.Measure.FABRIC) @ turned


bedded, material = sys.argv[1:3]
with tempfile.TemporaryDirectory() as folder:
    told = subprocess.run([sys.executable, bedded, material, "0", "30"], cwd=folder, check=True,
                          capture_output=True, text=True).stdout
    print(told, end="")
    (flat, fabric), (steep, turned_fabric) = led(f"{folder}/bedded_0.toml", np.eye(2)), led(f"{folder}/bedded_30.toml", R)
    gap = np.abs(flat - steep).max() / np.abs(flat).max()
    print(f"turned by 30 degrees: stress to {gap:.1e}, fabric to {np.abs(fabric - turned_fabric).max():.1e}")
    assert gap < 1e-6 and np.abs(fabric - turned_fabric).max() < 1e-6
    assert fabric[1, 1] > 1.03 * fabric[0, 0]   # most contacts across the bedding
