"""Runs a script and prints the core time that it and its processes took [s].  usage: core_time.py SCRIPT ARGUMENT..."""
import multiprocessing
import os
import resource
import sys

del sys.argv[0]
sys.path[:0] = os.environ["MODULES"].split(":")   # YADE has no PYTHONPATH
with open(sys.argv[0], encoding="utf-8") as file:
    exec(compile(file.read(), sys.argv[0], "exec"))   # pylint: disable=exec-used
for worker in multiprocessing.active_children():
    worker.join()
used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
print(f"core {sum(one.ru_utime + one.ru_stime for one in used):.4f}", flush=True)
os._exit(0)   # escript and YADE do not end well together
