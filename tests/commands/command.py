"""What the tests of the command `grainlaw` share: small scenes, a run of one, and its files."""
import os
import pathlib
import subprocess
import tempfile

GRAINLAW = os.environ["GRAINLAW"]

LATTICE = """
dimension = 2
thickness = 0.1
packing = { generator = "hexagonal", columns = 2, rows = 2, radius = 5e-3, pressure = 1e5, density = 2000 }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5463 }
"""
MATERIAL = "[material]" + LATTICE
PERIODIC = MATERIAL + 'boundary = { type = "periodic-cell" }\n'

POINT = "[[segment]]\nsteps = {steps}\nF22 = {stretch}\n"

SOLVE = """
[mesh]
size = [0.5, 1.0]
divisions = [1, 1]
element = "q4r"
[[displacement]]
on = "left"
component = "x"
value = 0.0
[[displacement]]
on = "bottom"
component = "y"
value = 0.0
[[displacement]]
on = "top"
component = "y"
value = {value}
[[pressure]]
on = "right"
value = 100e3
"""

DNS = """
repeat = [1, 2]
[[segment]]
steps = {steps}
stretch22 = 0.999
[material]
dimension = 2
thickness = 1e-3
packing = {{ generator = "lubachevsky-stillinger", count = 30, radii = [0.3e-3, 0.45e-3], seed = 3, pressure = 100e3 }}
contact = {{ law = "frictional", kn = 1e4, ratio = 0.2, friction = 0.4 }}
"""

WAVE = """
repeat = {repeat}
duration = {duration}
time_step = 1e-6
rows = 20
sections = [0.02]
pulse = {{ amplitude = 1e-6, period = 2e-5 }}
""" + PERIODIC.replace("{", "{{").replace("}", "}}") + """
[mesh]
divisions = [2]
time_step = 1e-6
"""


def toml(text):
    """A text as TOML writes it."""
    return '"' + "".join(c if c.isalnum() or c == " " else f"\\U{ord(c):08x}" for c in text) + '"'


class Place:
    """A directory to work in, with a home of its own, gone at the end."""

    def __init__(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.temporary.name)
        self.home = self.path / "home"
        self.home.mkdir()
        self.environment = dict(os.environ, HOME=str(self.home))

    def write(self, name, text):
        path = self.path / name
        path.write_text(text, encoding="utf-8")
        return str(path)

    def start(self, *arguments, **options):
        return subprocess.Popen([GRAINLAW, *arguments], cwd=self.path, env=self.environment,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                **options)

    def run(self, *arguments):
        """Exit status, standard output and standard error."""
        process = self.start(*arguments)
        out, err = process.communicate(timeout=300)
        return process.returncode, out, err

    def files(self, directory):
        return {path.name for path in (self.path / directory).iterdir()}


def written(line):
    """The files that `wrote STEM.csv, .svg` names; those with a word for many of them left out."""
    first, *ends = line.split("wrote ", 1)[1].split(", ")
    stem = first[:first.rindex(".csv")] if ".csv" in first else first
    for known in ("_particles", "_specimen_*", "_cost"):
        stem = stem.removesuffix(known)
    names = [first] + [stem + end for end in ends]
    return [name for name in names if not any(word in name for word in ("*", "STEP", "FIELD"))
            and not name.endswith(("_pointN.csv", "_packingN.pvd"))]
