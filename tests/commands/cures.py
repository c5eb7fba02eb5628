"""Messages of steps that fail: each provoked by its cause, and the cure that it names followed."""
import os
import re
import unittest

from command import LATTICE, PERIODIC, WAVE, Place

RANDOM = """
dimension = 2
thickness = 0.1
packing = { generator = "compaction", count = 30, radii = [4e-3, 9e-3], seed = 3, pressure = 1e5, friction = 0.3 }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5 }
"""
SOLVER = "solver = { tolerance = 1e-6 }\n"
TOUCHING = LATTICE.replace("pressure = 1e5", "overlap = 0.0")
STRESS_FREE = 'solver = { contacts_lost = "stress_free" }\n'


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

BETWEEN_PLATES = """
[boundary]
type = "mixed"
left = {{ x = "P", y = "P" }}
right = {{ x = "P", y = "P" }}
bottom = {{ x = "D", y = "D", row = "rigid" }}
top = {{ x = "D", y = "T", row = "rigid" }}
stress = {{ P22 = {} }}
"""
CELL = "H00,H01,H10,H11,thickness,rho\n{0},0,0,{0},0.1,2650\n"
APART = "id,x,y,r\n0,0.01,0.01,0.004\n1,0.03,0.03,0.004\n"
OWN = """
dimension = 2
packing = { particles = "apart.csv", cell = "small.csv" }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5 }
"""
DYNAMICS = "[dynamics]\ndensity = 2000\nduration = 0.2\ntime_step = 1e-2\n"
RANDOM_WAVE = WAVE.format(repeat=3, duration=1e-4).replace(PERIODIC, "[material]" + RANDOM).replace("[0.02]", "[0.05]")


def dynamics(conditions, steps, material=LATTICE, solver=""):
    return solve(conditions, f'steps = {steps}\nsolver = "dynamics"\n', material, solver)


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
        "point", point("test = 'drained'\nstrain = 0.05\nsteps = 50\n", "max_cuts = 1",
                       RANDOM.replace("count = 30", "count = 100").replace("seed = 3", "seed = 9")),
        "try more steps, or solver.viscous_number = 1e-3 with viscous_rate, the strain of a step",
        [("tolerance = 1e-6", "tolerance = 1e-6, viscous_number = 1e-3, viscous_rate = 1e-3")]),
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
        "particles fill .* of the cell; expected their own cell, in m", [("other.csv", f"{DATA}/rve400_cell.csv")]),
    "a_cell_a_little_too_large": (
        "pack", re.sub("contacts = .*\n", "", FILES).replace(f"{DATA}/rve400_cell.csv", "large.csv"),
        "expected the cell of these particles, softer contacts or a packing under more load",
        [("large.csv", f"{DATA}/rve400_cell.csv")]),
    "a_cell_a_little_too_large_for_the_contacts": (
        "pack", FILES.replace(f"{DATA}/rve400_cell.csv", "large.csv"),
        "these do not touch; expected .* with the cell H of this packing", [("large.csv", f"{DATA}/rve400_cell.csv")]),
    "a_cell_that_is_too_small": (
        "pack", FILES.replace(f"{DATA}/rve400_cell.csv", "small_for_400.csv"),
        "m apart; expected all lengths in m, and the cell of these particles",
        [("small_for_400.csv", f"{DATA}/rve400_cell.csv")]),
    "discs_that_are_too_stiff_for_their_generator": (
        "pack", RANDOM.replace("count = 30", "count = 4").replace(", friction = 0.3", "")
        .replace("6e8", "6e15"),
        "generator: no packing at rest was found on unloading; .*; try another seed", [("seed = 3", "seed = 1")]),
    "discs_that_touch_and_bear_nothing": (
        "point", point("steps = 1\nF22 = 0.9999\n", material=TOUCHING), "or a packing under more load",
        [("overlap = 0.0", "pressure = 1e5")]),
    "discs_that_do_not_touch": (
        "pack", OWN, "the packing has no contacts at F = I; expected one that carries stress, or solver.contacts_lost",
        [("contact =", 'solver = {{ contacts_lost = "stress_free" }}\ncontact =')]),
    "a_pull_that_no_packing_carries": (
        "pack", RANDOM + BETWEEN_PLATES.format(1e5),
        r"boundary.stress: no state of the packing carries P22 = 100000 Pa \(reached .* Pa\): contacts are lost", [("100000.0", "-100000.0")]),
    "a_frame_that_carries_no_uniform_stress": (
        "point", point("steps = 2\nF22 = 0.9999\n", material=RANDOM + 'boundary = { type = "frame-t" }\n'),
        "the packing carries no uniform stress at F = I", [("frame-t", "frame-p")]),
    "a_frame_that_no_longer_carries_uniform_stress": (
        "point", point("steps = 20\ndF22 = 0.05\n", "max_cuts = 2",
                       re.sub(r"\[(packing|contact)\]", r"[material.\1]", FILES) + '[material.boundary]\ntype = "frame-t"\n',
                       "[material.solver]\ntolerance = 1e-6\n"),
        'no longer carries a uniform stress on its boundary; try boundary.type = "frame-p", or more particles',
        [("frame-t", "frame-p"), ("steps = 20\ndF22 = 0.05", "steps = 20\ndF22 = 0.01")]),
    "a_void_ratio_and_a_pressure_of_few_discs": (
        "pack", RANDOM.replace("friction = 0.3", "void_ratio = 0.28").replace("count = 30", "count = 8"),
        "void_ratio = 0.28 at 100000 Pa was not met, found .*; try another seed or more discs", [("count = 8", "count = 60")]),
    "a_step_with_drag_that_is_too_large": (
        "point", point("steps = 6\ndF22 = -0.2\nsigma11 = -100e3\n", "max_cuts = 0",
                       solver="solver = { viscous_number = 1e-2, viscous_rate = 1e-3, tolerance = 1e-9 }\n"),
        r"Newton did not converge: best relative residual .*, expected 1.0e-08 \[-\]; try more steps$", [("steps = 6", "steps = 200")]),
    "a_tangent_by_differences_beside_the_loss_of_contacts": (
        "point", point("steps = 14\nF11 = 1.00403\nF22 = 1.00403\n[[segment]]\nsteps = 5\ndF22 = -5e-4\nsigma11 = -1e3\n",
                       "tangent = 'perturbed'", RANDOM.replace("count = 30", "count = 20").replace("seed = 3", "seed = 1")
                       .replace(", friction = 0.3", "").replace("friction = 0.5 ", "friction = 0.01 "), ""),
        "evaluating the tangent at the start of a segment, after step 14, failed: a perturbed increment found no equilibrium; extend it less",
        [("F11 = 1.00403\nF22 = 1.00403", "F11 = 1.0035\nF22 = 1.0035")]),
    "numbers_that_overflow": (
        "point", point("steps = 1\nF11 = 1e200\nF22 = 1e200\n", "max_cuts = 0"), "det F overflows",
        [("1e200", "1.0001")]),
    "a_body_under_a_load_beyond_its_strength": (
        "solve", solve(PRESSED + '[[pressure]]\non = "top"\nvalue = 100e3\n[[traction]]\non = "top"\ncomponent = "y"\nvalue = -500e3\n',
                       material=RANDOM),
        "displacement in place of a load that the body may not carry",
        [('[[pressure]]\non = "top"\nvalue = 100e3\n', ""), ('[[traction]]', '[[displacement]]'),
         ("value = -500e3", "value = -0.02"), ("steps = 4", "steps = 20")]),
    "a_band_whose_packings_lose_their_contacts": (
        "solve", solve("".join(held(on, c) for on, c in (("bottom", "x"), ("bottom", "y"), ("top", "x")))
                       + held("top", "y", -7.2e-3) + SIDES, "steps = 20\n",
                       RANDOM.replace("[4e-3, 9e-3], seed = 3", "[2e-3, 4e-3], seed = 10")
                       .replace(", friction = 0.3", "").replace("friction = 0.5 ", "friction = 0.5463 "),
                       "solver = { tolerance = 1e-8 }\n")
        .replace("[0.5, 1.0]", "[0.06, 0.12]").replace("[1, 1]", '[2, 4]\nelement = "q4r"'),
        "the packing lost its contacts; it carries no stress; try more particles, displacement in place",
        [("count = 30", "count = 60")]),
    "a_newton_iteration_of_few_iterations": (
        "solve", solve(PRESSED + held("top", "y", -1e-2), "steps = 1\n", material=RANDOM)
        + "[newton]\nmax_iterations = 1\nmax_cuts = 0\n",
        r"Newton did not converge: best relative residual .*, expected 1.0e-0\d \[-\]; .*; try more load steps",
        [("max_iterations = 1\nmax_cuts = 0\n", ""), ("steps = 1", "steps = 10")]),
    "a_tolerance_below_rounding": (
        "solve", solve(PRESSED + held("top", "y", -1e-3), "steps = 1\n", material=RANDOM) + "[newton]\ntolerance = 1e-16\n",
        r"the tolerance is below rounding: residual .*, expected 1.0e-16 \[-\]; ask for (?P<least>[\d.e-]+);",
        [("tolerance = 1e-16", "tolerance = {least}")]),
    "a_line_search_that_finds_nothing": (
        "solve", solve(PRESSED + held("top", "y", -0.03), "steps = 1\n", material=RANDOM).replace("[1, 1]", '[1, 1]\nelement = "q4"')
        + "[newton]\nline_search = 1\nmax_cuts = 0\n",
        "halvings of a correction did not lower the residual", [("line_search = 1", "line_search = 0"), ("max_cuts = 0", "")]),
    "few_iterations_of_relaxation": (
        "solve", solve(PRESSED + held("top", "y", -1e-3), 'steps = 1\nsolver = "relaxation"\n')
        + "[relaxation]\nmax_iterations = 2\nmax_cuts = 1\n",
        r"dynamic relaxation did not converge in 2 iterations", [("max_iterations = 2", "max_iterations = 20000")]),
    "packings_that_bear_nothing_in_relaxation": (
        "solve", solve(PRESSED + held("top", "y", -1e-3), 'steps = 1\nsolver = "relaxation"\n', TOUCHING, STRESS_FREE),
        "the packings have no stiffness", [("overlap = 0.0", "pressure = 1e5")]),
    "packings_that_bear_nothing_in_dynamics": (
        "solve", dynamics(SMOOTH + held("top", "y", -1e-4), 2, TOUCHING, STRESS_FREE)
        + DYNAMICS.replace("time_step = 1e-2\n", "").replace("0.2", "1e-3"),
        "the packings have no stiffness at F = I, .*: give time_step", [("duration", "time_step = 1e-4\nduration")]),
    "dynamics_whose_time_step_is_unstable": (
        "solve", dynamics(PRESSED + held("top", "y", -1e-4), 10) + DYNAMICS,
        r"the time step of .* s is unstable .*; leave out dynamics.time_step, or shorten it$", [("time_step = 1e-2\n", "")]),
    "dynamics_whose_points_refuse": (
        "solve", dynamics(PRESSED + held("top", "y", -1e-4), 4) + DYNAMICS.replace("1e-2", "5e-3"),
        r"step \d failed at time .* s with a time step of .*; leave out dynamics.time_step, or shorten it$",
        [("time_step = 5e-3\n", "")]),
    "a_tolerance_below_that_of_points_that_start_from_trials": (
        "solve", solve(PRESSED + held("top", "y", -1e-4), "steps = 1\n", LATTICE,
                       'solver = { start = "trial", tolerance = 1e-6 }\n') + "[newton]\ntolerance = 1e-9\n",
        "expected solver.tolerance of the material, 1e-06, or more; or a smaller one there",
        [("tolerance = 1e-6", "tolerance = 1e-9")]),
    "a_time_step_of_particles_that_is_unstable": (
        "wave", RANDOM_WAVE.replace("time_step = 1e-6\nrows", "time_step = 1e-2\nrows"),
        r"time_step: found .* s, expected at most (?P<most>\S+) s, beyond which", [("time_step = 1e-2", "time_step = {most}")]),
    "particles_that_do_not_come_to_rest": (
        "wave", RANDOM_WAVE.replace("time_step = 1e-6\nrows", "time_step = 1e-9\nrows"),
        "the specimen did not come to rest before the wave: .*; try a longer time_step$",
        [("time_step = 1e-9", "time_step = 1e-6")]),
    "a_pulse_beyond_all_bounds": (
        "wave", RANDOM_WAVE.replace("amplitude = 1e-6", "amplitude = 1e160"),
        "a particle has left all bounds; try a smaller pulse.amplitude$", [("1e160", "1e-6")]),
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
        self.place.write("other.csv", CELL.format(400))
        self.place.write("small.csv", CELL.format(0.04))
        self.place.write("apart.csv", APART)
        self.place.write("large.csv", CELL.format(0.22))
        self.place.write("small_for_400.csv", CELL.format(0.15))
        self.addCleanup(self.place.temporary.cleanup)

    def check(self, command, scene, message, cure):
        status, out, err = self.place.run(command, self.place.write("s.toml", scene), "--output", "out")
        self.assertNotEqual(status, 0, out)
        found = re.search(message, err, re.M)
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
