"""Every command begins by saying what its packing is like: mean pressure, stiffness over pressure, void ratio."""
import re
import unittest

from command import DNS, LATTICE, PERIODIC, POINT, SOLVE, WAVE, Place

SPHERES = """
dimension = 3
packing = { generator = "fcc", cells = [2, 2, 2], radius = 5e-3, pressure = 1e5 }
contact = { law = "frictional", young = 1e8, ratio = 0.8, friction = 0.5463 }
"""
SOLID_BODY = """
[mesh]
size = [1.0, 1.0, 1.0]
divisions = [1, 1, 2]
""" + "".join(f"[[displacement]]\non = '{side}'\ncomponent = '{axis}'\nvalue = {value}\n"
              for side, axis, value in (("left", "x", 0), ("right", "x", 0), ("front", "y", 0), ("back", "y", 0),
                                        ("bottom", "z", 0), ("top", "z", -1e-4)))


class Starts(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.addCleanup(self.place.temporary.cleanup)

    def start(self, command, text, *more):
        scene = self.place.write("s.toml", text)
        status, out, err = self.place.run(command, scene, "--output", "out", *more)
        self.assertEqual(status, 0, out + err)
        line = next(line for line in out.splitlines() if line.startswith("s: starts at "))
        found = re.fullmatch(r"s: starts at mean pressure (\S+) Pa, kn/p (\S+) \[-\], void ratio (\S+) \[-\]", line)
        self.assertTrue(found, line)
        return [float(number) for number in found.groups()]

    def check(self, found, pressure, stiffness, void_ratio):
        self.assertAlmostEqual(found[0] / pressure, 1, places=2)
        self.assertAlmostEqual(found[1] / stiffness, 1, delta=0.03)
        self.assertAlmostEqual(found[2], void_ratio, delta=0.005)

    def test_of_discs_are_told_by_every_command(self):
        # Equal discs on a triangular lattice: kn = young R; void ratio 2 sqrt(3) / pi - 1 without overlaps.
        wanted = 1e5, 6e8 * 5e-3 / (1e5 * 0.1), 0.103
        self.check(self.start("point", PERIODIC + POINT.format(steps=1, stretch=0.9999)), *wanted)
        self.check(self.start("solve", "steps = 1\n" + PERIODIC + SOLVE.format(value=-1e-5)), *wanted)
        self.check(self.start("wave", WAVE.format(repeat=3, duration=1e-4)), *wanted)
        self.check(self.start("pack", LATTICE), *wanted)
        pressure, stiffness, void_ratio = self.start("dns", DNS.format(steps=1))
        self.assertGreater(pressure, 0)
        self.assertAlmostEqual(pressure * stiffness / 1e7, 1, delta=0.01)  # kn / t
        self.assertTrue(0.1 < void_ratio < 0.4)

    def test_of_spheres_are_told_by_every_command_that_takes_them(self):
        # Face-centred cubic: void ratio 3 sqrt(2) / pi - 1; kn = young R over the diameter is young / 2.
        wanted = 1e5, 1e8 / 2 / 1e5, 0.350
        material = "[material]" + SPHERES
        self.check(self.start("point", material + "[[segment]]\nsteps = 1\nF33 = 0.9999\n"), *wanted)
        self.check(self.start("solve", "steps = 1\n" + material + SOLID_BODY), *wanted)
        self.check(self.start("pack", SPHERES), *wanted)
        self.assertTrue((self.place.path / "out/s_contacts.csv").exists())

    def test_what_is_unusual_is_told_by_every_command(self):
        def unusual(text):
            return text.replace("friction = 0.5463", "friction = 30").replace("friction = 0.4", "friction = 30")
        for command, text in (("point", PERIODIC + POINT.format(steps=1, stretch=0.9999)),
                              ("solve", "steps = 1\n" + PERIODIC + SOLVE.format(value=-1e-5)),
                              ("dns", DNS.format(steps=1)), ("wave", WAVE.format(repeat=3, duration=1e-4)),
                              ("pack", LATTICE)):
            with self.subTest(command):
                _, _, err = self.place.run(command, self.place.write("s.toml", unusual(text)), "--output", "out")
                self.assertIn("s: unusual: contact.friction = 30 is tan(88.1 degrees)", err)


if __name__ == "__main__":
    unittest.main()
