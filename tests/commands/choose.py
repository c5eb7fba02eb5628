"""`grainlaw choose` measures on the material itself: what it prints holds on paths that it did not lead."""
import csv
import math
import re
import unittest

from command import Place

RECIPE = """
dimension = {dimension}
[packing]
generator = "compaction"
count = {count}
radii = {radii}
seed = {seed}
pressure = 100e3
friction = 0.2
[contact]
{contact}
"""
FRICTIONAL = 'law = "frictional"\nyoung = {young}\nratio = 0.8\nfriction = {friction}\n'
HERTZ = 'law = "hertz"\nshear_modulus = 1e9\npoisson = 0.3\nfriction = 0.4\n'


def discs(seed, contact):
    return RECIPE.format(dimension="2\nthickness = 0.1", count=150, radii="[2e-3, 4e-3]", seed=seed, contact=contact)


MATERIALS = {
    "soft": discs(31, FRICTIONAL.format(young=3e8, friction=0.5)),
    "stiff": discs(32, FRICTIONAL.format(young=3e9, friction=0.3)),
    "hertz": discs(33, HERTZ),
    "spheres": RECIPE.format(dimension=3, count=60, radii="[2e-3, 4e-3]", seed=34,
                             contact=FRICTIONAL.format(young=1e8, friction=0.5)),
}
STRAIN = 5e-3
FINE = {"tolerance": "1e-9", "viscous_number": "0"}


def held_out(strain, dimension):
    """End values of paths along axes between those that the command leads."""
    paths = []
    for degrees in (15, 45, 75, 105, 135, 165):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        short, lateral = 1 - strain, (1 - strain) ** (-1 / (dimension - 1))
        last = str(dimension)
        path = {"F11": c * c * short + s * s * lateral, f"F{last}{last}": s * s * short + c * c * lateral}
        path |= {f"F1{last}": c * s * (short - lateral), f"F{last}1": c * s * (short - lateral)}
        paths.append(path if dimension == 2 else path | {"F22": lateral})
    return paths


class Choose(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.addCleanup(self.place.temporary.cleanup)

    def choose(self, name, *options):
        return self.place.run("choose", f"{name}.toml", "--strain", str(STRAIN), *options, "--output", "out")

    def stresses(self, name, path, solver, steps):
        """Five looks along a path."""
        keys = "".join(f"solver.{key} = {value}\n" for key, value in solver.items() if key != "viscous_number" or value != "0")
        ends = "".join(f"{key} = {value!r}\n" for key, value in path.items())
        self.place.write("held.toml", f'figure = false\n[material]\nfile = "{name}.toml"\n{keys}[[segment]]\nsteps = {steps}\n{ends}')
        status, out, err = self.place.run("point", "held.toml", "--output", "held", "--force")
        self.assertEqual(status, 0, out + err)
        with open(self.place.path / "held/held.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        names = [key for key in rows[0] if re.match(r"sigma\d\d\[", key)]
        return [[float(row[key]) for key in names] for row in rows[steps // 5::steps // 5]]

    def error(self, name, solver, increment):
        errors = []
        for path in held_out(STRAIN, 3 if name == "spheres" else 2):
            found = self.stresses(name, path, solver, round(STRAIN / increment))
            exact = self.stresses(name, path, FINE, round(STRAIN / 2.5e-5))
            largest = max(math.hypot(*stress) for stress in exact)
            errors += [math.dist(a, b) / largest for a, b in zip(found, exact)]
        return sorted(errors)[len(errors) // 2]

    def test_the_error_that_it_prints_holds_within_a_factor_of_two_on_other_paths_of_four_materials(self):
        for name, text in MATERIALS.items():
            with self.subTest(name):
                self.place.write(f"{name}.toml", text)
                status, out, err = self.choose(name, "--error", "2e-3")
                self.assertEqual(status, 0, out + err)
                printed = float(re.search(r"error of the stress (\S+) in", out).group(1))
                self.assertLessEqual(printed, 2e-3)
                increment = float(re.search(r"load steps of (\S+) %", out).group(1)) / 100
                solver = dict(re.findall(r"^(tolerance|viscous_number) = (\S+)$", out, re.M))
                ratio = self.error(name, solver, increment) / printed
                print(f"{name}: found over printed {ratio:.2f}")
                self.assertTrue(0.5 <= ratio <= 2, (printed, ratio))

    def test_a_budget_alone_asks_for_the_least_error_and_what_cannot_be_had_is_told_with_the_nearest(self):
        self.place.write("soft.toml", MATERIALS["soft"])
        status, out, err = self.choose("soft", "--budget", "1e9")
        self.assertEqual(status, 0, out + err)
        with open(self.place.path / "out/soft_choices.csv", newline="") as file:
            least = min(float(row["error[-]"]) for row in csv.DictReader(file) if row["error[-]"] != "failed")
        self.assertIn(f"error of the stress {least:.1e} in", out)
        for options, words in ((("--error", "1e-9"), "no choice has an error of 1e-09: the least is"),
                               (("--budget", "1e-6"), "no choice takes 1e-06 ms or less"),
                               (("--error", "1e-2", "--budget", "1e-6"), "within 1e-06 ms: the fastest takes")):
            status, _, err = self.choose("soft", *options)
            self.assertEqual(status, 1)
            self.assertIn(words, err)

    def test_bad_input_is_refused_before_any_work(self):
        self.place.write("soft.toml", MATERIALS["soft"])
        for options, words in (((), "found neither --error nor --budget"), (("--error", "-1"), "found -1, expected a number > 0"),
                               (("--error", "1", "--strain", "0.5"), "in [0.001, 0.1]"),
                               (("--error", "1", "--strain", "1e-4"), "in [0.001, 0.1]")):
            status, out, err = self.place.run("choose", "soft.toml", *options)
            self.assertEqual((status, out), (2, ""), err)
            self.assertIn(words, err)
        self.place.write("moving.toml", MATERIALS["soft"] + "[solver]\ninertia = true\n")
        status, out, err = self.place.run("choose", "moving.toml", "--error", "1e-2")
        self.assertEqual((status, out), (2, ""), err)
        self.assertIn("moving.toml: solver.inertia: found true, expected a material that is in equilibrium", err)


if __name__ == "__main__":
    unittest.main()
