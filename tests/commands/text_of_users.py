"""Names that are code in another language stay text in what the command `grainlaw` writes, and names
that would lead elsewhere are refused."""
import csv
import unittest
import xml.etree.ElementTree as ElementTree

from command import DNS, LATTICE, PERIODIC, POINT, SOLVE, WAVE, Place, toml

CODE = "a'b\"c `touch hacked` $(touch hacked) & <x]]> ,; {_e^2} @x %d \\ | é"
REFUSED = ["", ".", "..", "../x", "a/b", "/x", "a\nb", "a\x1b[31mb", "a\x7fb", "a\u0085b"]
HOSTILE_HOME = 'set title "changed"\nset label 9 "changed" at screen 0.5,0.5\nsystem("touch hacked")\n'


def text_of(path):
    """All text of a picture, parts of a line joined."""
    return "\n".join("".join(node.itertext()) for node in ElementTree.parse(path).iter()
                     if node.tag.endswith("}text"))


class TextOfUsers(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        (self.place.home / ".gnuplot").write_text(HOSTILE_HOME, encoding="utf-8")
        self.output = "out " + CODE

    def tearDown(self):
        self.assertEqual(list(self.place.path.rglob("hacked")), [])
        self.place.temporary.cleanup()

    def run_well(self, *arguments):
        status, out, err = self.place.run(*arguments, "--output", self.output)
        self.assertEqual(status, 0, out + err)
        return self.place.path / self.output

    def pictures(self, directory, count, named=False):
        """The name of a file is no title: it stands in a picture where a user named a curve by it."""
        pictures = sorted(directory.glob("*.svg"))
        self.assertEqual(len(pictures), count)
        for picture in pictures:
            self.assertEqual(CODE in " ".join(text_of(picture).split()), named)
            self.assertNotIn("changed", picture.read_text(encoding="utf-8"))
            self.assertTrue(picture.with_suffix(".png").read_bytes().endswith(b"IEND\xaeB`\x82"))

    def test_solve(self):
        probe = "p,\"q\" [m] 'r'"
        scene = self.place.write("s.toml", f"name = {toml(CODE)}\nsteps = 2\nvtk_every = 1\n"
                                 f'packings = [0]\n{PERIODIC}{SOLVE.format(value=-1e-5)}'
                                 '[picture]\nfields = ["void_ratio"]\npackings = [0]\n'
                                 f'extremes = ["coordination"]\n[[probe]]\nname = {toml(probe)}\non = "top"\n')
        directory = self.run_well("solve", scene)
        self.pictures(directory, 4)
        series = list(directory.glob("*.pvd"))
        self.assertEqual(len(series), 3)
        for path in series:
            sets = ElementTree.parse(path).findall("./Collection/DataSet")
            self.assertEqual(len(sets), 3)
            for entry in sets:
                ElementTree.parse(directory / entry.get("file"))
        with open(directory / (CODE + "_probes.csv"), encoding="utf-8", newline="") as file:
            header, *rows = csv.reader(file)
        self.assertEqual(header, ["step[-]", "time[s]", probe + "_x[m]", probe + "_y[m]"])
        self.assertEqual([len(row) for row in rows], [4, 4, 4])
        # What was written is read again, names included.
        status, out, err = self.place.run("solve", scene, "--output", self.output, "--stop-after", "1")
        self.assertEqual(status, 0, err)
        status, out, err = self.place.run("solve", scene, "--output", self.output, "--restart")
        self.assertEqual(status, 0, err)
        self.assertIn("goes on after step 1", out)

    def test_point(self):
        scene = self.place.write("p.toml", f'name = {toml(CODE)}\npictures = [0.0]\n{PERIODIC}'
                                 + POINT.format(steps=1, stretch=0.9999)
                                 + f"[[case]]\nname = {toml('1,' + CODE)}\n[[case]]\nname = 'two'\n")
        directory = self.run_well("point", scene)
        self.pictures(directory, 4)
        with open(directory / (CODE + "_cases.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["case"] for row in rows], [f"{CODE}_1,{CODE}", CODE + "_two"])
        self.assertEqual([row["end"] for row in rows], ["done", "done"])

    def test_dns(self):
        scene = self.place.write("d.toml", f'name = {toml(CODE)}\npictures = [0.0]\n'
                                 + DNS.format(steps=1))
        self.pictures(self.run_well("dns", scene), 2)

    def test_wave(self):
        scene = self.place.write("w.toml", f'name = {toml(CODE)}\n'
                                 + WAVE.format(repeat=3, duration=1e-4))
        self.pictures(self.run_well("wave", scene), 1)

    def test_pack(self):
        recipe = self.place.write("r.toml", LATTICE)
        self.pictures(self.run_well("pack", recipe, "--name", CODE), 1)

    def test_compare(self):
        table = self.place.write("t.csv", "axial_strain,axial_stress,lateral_stress,volumetric_strain,"
                                 "coordination\n0,1,1,0,4\n0.02,3,1,0.01,4\n")
        self.pictures(self.run_well("compare", f"{CODE}={table}", f"b={table}", "--name", CODE), 1, named=True)
        # What XML cannot hold is shown as something else.
        status, _, err = self.place.run("compare", f"a={table}", f"b={table}", "--output", "bytes",
                                        "--title", b"x \x01 \xff y")
        self.assertEqual((status, err), (0, ""))
        self.assertIn("x \ufffd \\xff y", text_of(self.place.path / "bytes" / "comparison.svg"))
        for name in REFUSED:
            self.refuses("--name: found", "compare", f"a={table}", f"b={table}", "--name", name)
        self.assertEqual(self.place.files("."), {"home", "t.csv", "bytes", "out " + CODE})

    def test_refused_probes(self):
        for name in [*REFUSED, "a\0b"]:
            scene = self.place.write("s.toml", "steps = 1\n" + PERIODIC + SOLVE.format(value=-1e-5)
                                     + f'[[probe]]\nname = {toml(name)}\non = "top"\n')
            self.refuses("probe[1].name: found", "solve", scene)
        scene = self.place.write("s.toml", "steps = 1\n" + PERIODIC + SOLVE.format(value=-1e-5)
                                 + 2 * '[[probe]]\nname = "a"\non = "top"\n')
        status, _, err = self.place.run("solve", scene, "--output", "out")
        self.assertEqual(status, 2, err)
        self.assertIn('probe[2].name: found "a", expected a name that no other probe has', err)

    def test_refused_names(self):
        self.output = "out"
        scenes = {"solve": "steps = 1\n" + PERIODIC + SOLVE.format(value=-1e-5),
                  "point": PERIODIC + POINT.format(steps=1, stretch=0.9999),
                  "dns": DNS.format(steps=1), "wave": WAVE.format(repeat=3, duration=1e-4)}
        for name in REFUSED:
            for command, text in scenes.items():
                scene = self.place.write("s.toml", f"name = {toml(name)}\n{text}")
                self.refuses(f"{scene}:1: name: found", command, scene)
            for command in ("point", "dns", "wave"):
                scene = self.place.write("s.toml", scenes[command] + f"\n[[case]]\nname = {toml(name)}\n")
                self.refuses(".name: found", command, scene)
            recipe = self.place.write("r.toml", LATTICE)
            if name:
                self.refuses(f"{recipe}: --name: found", "pack", recipe, "--name", name)
        named = self.place.write("a..b.toml", scenes["point"])
        self.refuses(f"{named}:1: name: found nothing", "point", named)
        self.assertEqual(self.place.files("."), {"home", "s.toml", "r.toml", "a..b.toml"})

    def refuses(self, words, *arguments):
        status, out, err = self.place.run(*arguments, "--output", "out")
        self.assertEqual((status, out), (2, ""), err)
        self.assertIn(words, err)
        self.assertIn("a name for files", err)
        self.assertNotIn("\x1b", err)


if __name__ == "__main__":
    unittest.main()
