"""What a step costs in YADE on this machine: CPU time per particle [ns], on the packing of tests/data.

    yade -n -x -j1 yade_step.py DATA_DIRECTORY discs|spheres

Strained by 0.1 %, as in the increments whose numbers of steps are known. Prints one line.
"""

import math
import pathlib
import sys
import time

from yade import O

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(sys.argv[0]).resolve().parent))
from yade_packing import load, strain_at

WARM_UP, STEPS, ROUNDS = 300, 2000, 3
count = load(sys.argv[1], sys.argv[2])
O.run(WARM_UP, True)
strain_at(1e-3 / (ROUNDS * STEPS * O.dt), sys.argv[2])
best = math.inf
for _ in range(ROUNDS):
    start = time.process_time()
    O.run(STEPS, True)
    best = min(best, (time.process_time() - start) / STEPS)
touching = sum(1 for contact in O.interactions if contact.isReal)
print(f"yade_step_ns {1e9 * best / count:.1f} contacts {touching}", flush=True)
