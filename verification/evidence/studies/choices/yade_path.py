"""A packing of tests/data led by YADE along the path of this study, for each number of steps to 1 % of strain that is named.

    yade -n -x -j1 yade_path.py DATA_DIRECTORY discs|spheres LOOK,LOOK,... STEPS [STEPS ...]

Prints a line for each: the steps, CPU time [s], and the Cauchy stress at every look [Pa], row by row.
"""

import math
import pathlib
import sys
import time

from yade import O
from yade.utils import getStress

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(sys.argv[0]).resolve().parent.parent))
from yade_packing import load, strain_at

WARM_UP = 20000
data, kind, looks = sys.argv[1], sys.argv[2], [float(text) for text in sys.argv[3].split(",")]
size = range(2 if kind == "discs" else 3)
for steps in map(int, sys.argv[4:]):
    O.reset()
    load(data, kind)
    O.run(WARM_UP, True)
    rate = -math.log(1 - 0.01) / (steps * O.dt)
    strain_at(rate, kind)
    done, spent, stresses = 0, 0.0, []
    for look in looks:
        until = round(-math.log(1 - look) / (rate * O.dt))
        start = time.process_time()
        O.run(until - done, True)
        spent += time.process_time() - start
        done = until
        stress = getStress(O.cell.volume)
        stresses += [stress[i, j] for i in size for j in size]
    print("yade_path", steps, spent, *stresses, flush=True)
