"""Scenes of `grainlaw point` drawn at random: each ends, told or with the stresses that it asks for.

    random_scenes.py [FIRST COUNT]
"""
import csv
import math
import random
import sys
import unittest

from command import Place

SCENES = range(100, 150)


def law(draw):
    kind = draw.choice(["frictional", "frictional", "compressive", "bonded", "hertz"])
    young = 10**draw.uniform(8, 9.5)
    if kind == "compressive":
        return f'law = "compressive", young = {young:.3g}'
    stiffness = (f"shear_modulus = {50 * young:.3g}, poisson = 0.2" if kind == "hertz" else
                 f"young = {young:.3g}, ratio = 0.8")
    text = f'law = "{kind}", {stiffness}, friction = {draw.choice([0, 0.1, 0.3, 0.5, 1.0])}'
    if kind == "bonded":
        strength = draw.choice([0.5, 1, 100])
        text += f", bond = {{ normal_strength = {strength}, tangential_strength = {strength} }}"
    if kind == "frictional" and draw.random() < 0.3:
        text += ", rolling = { ratio = 1.0, friction = 0.1 }"
    return text


def segment(draw, d):
    axial = f"dF{d}{d}"
    stress = {f"sigma{k}{k}": -10**draw.uniform(3, 6.3) for k in range(1, d + 1)}
    held = dict(list(stress.items())[:-1])
    led = draw.choice([{axial: draw.uniform(-0.1, 0.1)}, {"dF12": draw.uniform(-0.2, 0.2)},
                       {"dF11": 0.08, "dF22": 0.08}, stress, {axial: draw.uniform(-0.1, 0.05), **held}])
    return {"steps": draw.choice([1, 3, 10]), **led}


def scene(number):
    """Its text, the segments, the tolerance of the packing and the dimension."""
    draw = random.Random(number)
    d = draw.choice([2, 2, 3])
    tolerance = draw.choice([1e-3, 1e-4, 1e-6, 1e-8, 1e-10])
    solver = [f"tolerance = {tolerance}"] + [
        key for key in ('start = "trial"', 'contacts_lost = "stress_free"', "viscous_number = 1e-3")
        if draw.random() < 0.5]
    frame = draw.choice(["frame-p", "frame-d"]) if d == 2 and draw.random() < 0.4 else "periodic-cell"
    segments = [segment(draw, d) for _ in range(draw.choice([1, 2, 3]))]
    led = "".join("[[segment]]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())
                  for keys in segments)
    text = f"""
figure = false
max_cuts = 3
max_iterations = 8
may_end = {draw.choice(["true", "false"])}
tangent = "{draw.choice(["exact", "elastic"])}"
[material]
dimension = {d}
{"thickness = 0.1" if d == 2 else ""}
packing = {{ generator = "compaction", count = {draw.choice([12, 20, 30])}, radii = [4e-3, \
{draw.choice([5e-3, 9e-3])}], seed = {draw.randint(1, 50)}, pressure = {draw.choice([1e4, 1e5])}, \
friction = {draw.choice([0.0, 0.1, 0.3, 0.5])} }}
contact = {{ {law(draw)} }}
boundary = {{ type = "{frame}" }}
solver = {{ {", ".join(solver)} }}
{led}"""
    return text, segments, tolerance, d


class RandomScenes(unittest.TestCase):
    def check(self, number, place):
        text, segments, tolerance, d = scene(number)
        path = place.write("scene.toml", text)
        status, out, err = place.run("point", path, "--force", "--output", "out")
        self.assertIn(status, (0, 1, 2), text + err)   # no signal
        if status != 0:
            self.assertIn("grainlaw: ", err, text)
            return "failed"
        if "ended: " in out and not (place.path / "out" / "scene.csv").exists():
            return "ended"   # before the first row
        with open(place.path / "out" / "scene.csv", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        for name in ("P11[Pa]", "sigma11[Pa]", f"F{d}{d}[-]", "void_ratio[-]", "external_work[J]"):
            self.assertTrue(all(math.isfinite(float(row[name])) for row in rows), text + name)
        if "ended: " in out:
            return "ended"
        if "out of balance" in err:
            return "loose"
        self.assertEqual(len(rows) - 1, sum(keys["steps"] for keys in segments), text)
        stresses = [abs(float(row[f"sigma{k}{k}[Pa]"])) for row in rows[-2:] for k in range(1, d + 1)]
        for name, asked in segments[-1].items():
            if name.startswith("sigma"):
                found = float(rows[-1][name + "[Pa]"])
                self.assertLess(abs(found - asked), max(4 * tolerance, 1e-6) * max(stresses), text + out)
        return "reached"

    def test_end_as_they_are_told_to(self):
        place, ends = Place(), []
        for number in SCENES:
            with self.subTest(number):
                ends.append(self.check(number, place))
        print({end: ends.count(end) for end in sorted(set(ends))})
        self.assertGreater(ends.count("reached"), len(SCENES) / 4)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        SCENES = range(int(sys.argv[1]), int(sys.argv[1]) + int(sys.argv[2]))
    unittest.main(argv=sys.argv[:1])
