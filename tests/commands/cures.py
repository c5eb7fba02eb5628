"""Messages of steps that fail: each provoked by its cause, and the cure that it names followed."""
import os
import re
import unittest

from command import LATTICE, Place

RANDOM = """
dimension = 2
thickness = 0.1
packing = { generator = "compaction", count = 30, radii = [4e-3, 9e-3], seed = 3, pressure = 1e5, friction = 0.3 }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5 }
"""
SOLVER = "solver = { tolerance = 1e-6 }\n"


def point(segment, scene="", material=RANDOM, solver=SOLVER):
    return f"figure = false\n{scene}\n[material]{material}{solver}[[segment]]\n{segment}"


BODY = """
[mesh]
size = [0.5, 1.0]
divisions = [1, 1]
"""


def held(on, component, value=0.0):
    return f'[[displacement]]\non = "{on}"\ncomponent = "{component}"\nvalue = {value}\n'


def solve(conditions, scene="steps = 4\n", material=LATTICE, solver=""):
    return f"{scene}[material]{material}{solver}{BODY}{conditions}"


SMOOTH = held("left", "x") + held("bottom", "y")
SIDES = "".join(f'[[pressure]]\non = "{side}"\nvalue = 100e3\n' for side in ("left", "right"))
PRESSED = SMOOTH + '[[pressure]]\non = "right"\nvalue = 100e3\n'

DATA = os.environ.get("TEST_DATA", "")
FILES = f"""
dimension = 2
[packing]
particles = "{DATA}/rve400_particles.csv"
contacts = "{DATA}/rve400_contacts.csv"
cell = "{DATA}/rve400_cell.csv"
[contact]
law = "frictional"
young = 6e8
ratio = 0.8
friction = 0.5463
"""

# Command, scene, message, and what the cure puts in the place of what.
CASES = {
    "a_step_too_large_for_friction": (
        "point", point("steps = 2\ndF22 = -0.02\nsigma11 = -100e3\n", "max_cuts = 0"),
        r"try (?P<steps>\d+) steps or more instead of 2: each strains by 0.01",
        [("steps = 2", "steps = {steps}")]),
    "a_stress_beyond_the_strength": (
        "point", point("steps = 4\nsigma22 = -1000e3\nsigma11 = -100e3\n", "max_cuts = 4"),
        "the packing may not carry this stress: prescribe F22, not sigma22",
        [("sigma22 = -1000e3", "dF22 = -0.05"), ("steps = 4", "steps = 50")]),
    "a_shear_beyond_the_strength": (
        "point", point("steps = 4\nsigma12 = 80e3\nsigma22 = -100e3\nsigma11 = -100e3\n", "max_cuts = 4"),
        "the packing may not carry this stress: prescribe F12, not sigma12",
        [("sigma12 = 80e3", "dF12 = 0.05"), ("steps = 4", "steps = 50")]),
    "contacts_that_are_lost": (
        "point", point("steps = 20\ndF22 = 0.1\n", solver='solver = { contacts_lost = "error" }\n'),
        "the packing lost its contacts; it carries no stress",
        [('"error"', '"stress_free"')]),
    "a_stretch_in_one_step": (
        "point", point("steps = 1\ndF11 = -0.31\ndF22 = -0.31\n", "max_cuts = 0"),
        r"the stretch since the committed state is more than 30 %.*; try (?P<steps>\d+) steps or more",
        [("steps = 1\n", "steps = {steps}\n")]),
    "an_inverted_cell": (
        "point", point("steps = 1\nF12 = 2.0\nF21 = 2.0\n", "max_cuts = 0"),
        "det F = .*, expected > 0", [("F12 = 2.0\nF21 = 2.0", "F12 = 0.02\nF21 = 0.02")]),
    "a_jump_after_the_peak": (
        "point", point("test = 'drained'\nstrain = 0.1\nsteps = 20\n", "max_cuts = 0"),
        "solver.viscous_number = 1e-3",
        [("tolerance = 1e-6", "viscous_number = 1e-3")]),
    "a_void_ratio_without_contacts": (
        "point", point("steps = 1\nF22 = 0.9999\n", material=RANDOM.replace("pressure = 1e5", "void_ratio = 0.5")),
        "the discs bear no load at void_ratio = 0.5, expected a lower one", [("void_ratio = 0.5", "void_ratio = 0.2")]),
    "an_anisotropy_of_few_discs": (
        "pack", RANDOM.replace("seed = 3", "anisotropy = 0.17, seed = 3"),
        "anisotropy = 0.17 was not met, found .* more discs", [("count = 30", "count = 100")]),
    "a_void_ratio_and_a_pressure_that_no_friction_gives": (
        "pack", RANDOM.replace("friction = 0.3", "void_ratio = 0.4"),
        r"void_ratio = 0.4, expected \S+ to (?P<most>0.\d+) at 100000 Pa", [("void_ratio = 0.4", "void_ratio = {most}")]),
    "overlaps_that_rounding_makes": (
        "point", point("steps = 1\nF22 = 0.9999\n", material=RANDOM.replace("6e8", "6e19")),
        "at least .* Pa", [("6e19", "6e8")]),
    "a_stiffness_that_is_not_the_one_of_the_contacts": (
        "pack", FILES.replace("6e8", "1e8"),
        "expected the same within 1 %: the stiffness the packing was made with", [("1e8", "6e8")]),
    "a_cell_that_is_not_the_one_of_the_particles": (
        "pack", re.sub("contacts = .*\n", "", FILES).replace(
            f"{DATA}/rve400_cell.csv", "other.csv"),
        "contacts carry no more at F = I than rounding makes of them", [("other.csv", f"{DATA}/rve400_cell.csv")]),
    "a_body_under_a_load_beyond_its_strength": (
        "solve", solve(PRESSED + '[[pressure]]\non = "top"\nvalue = 100e3\n[[traction]]\non = "top"\ncomponent = "y"\nvalue = -500e3\n',
                       material=RANDOM),
        "displacement in place of a load that the body may not carry",
        [('[[pressure]]\non = "top"\nvalue = 100e3\n', ""), ('[[traction]]', '[[displacement]]'),
         ("value = -500e3", "value = -0.02"), ("steps = 4", "steps = 20")]),
    "a_line_search_that_finds_nothing": (
        "solve", solve(PRESSED + held("top", "y", -0.03), "steps = 1\n", material=RANDOM)
        + "[newton]\nline_search = 1\nmax_cuts = 0\n",
        "halvings of a correction did not lower the residual", [("line_search = 1", "line_search = 0"), ("max_cuts = 0", "")]),
    "few_iterations_of_relaxation": (
        "solve", solve(PRESSED + held("top", "y", -1e-3), 'steps = 1\nsolver = "relaxation"\n')
        + "[relaxation]\nmax_iterations = 2\nmax_cuts = 1\n",
        r"dynamic relaxation did not converge in 2 iterations", [("max_iterations = 2", "max_iterations = 20000")]),
    "every_displacement_prescribed": (
        "solve", solve("".join(held(side, c) for side in ("bottom", "top") for c in "yx")),
        "every displacement is prescribed: nothing to solve", [(held("top", "x"), SIDES)]),
    "a_body_that_is_pulled_apart": (
        "solve", solve(SMOOTH + held("right", "x") + held("top", "y", 0.1)).replace("[1, 1]", "[1, 2]"),
        "the stiffness is singular", [("value = 0.1", "value = 1e-4")]),
}


class Cures(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.place.write("other.csv", "H00,H01,H10,H11,thickness,rho\n400,0,0,400,0.1,2650\n")
        self.addCleanup(self.place.temporary.cleanup)

    def check(self, command, scene, message, cure):
        status, out, err = self.place.run(command, self.place.write("s.toml", scene), "--output", "out")
        self.assertNotEqual(status, 0, out)
        found = re.search(message, err)
        self.assertTrue(found, err)
        self.assertNotIn(found.group(), out, "told twice")
        for old, new in cure:
            self.assertIn(old, scene)
            scene = scene.replace(old, new.format(**found.groupdict()))
        status, out, err = self.place.run(command, self.place.write("s.toml", scene), "--output", "out")
        self.assertEqual(status, 0, out + err)


for case_name, case in CASES.items():
    setattr(Cures, "test_of_" + case_name, lambda self, case=case: self.check(*case))

if __name__ == "__main__":
    unittest.main()
