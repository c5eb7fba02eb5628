"""Packings of other programs are imported by one command and written back; what is wrong in them is told by file,
line and column. Round trips through YADE and LAMMPS run where these are installed."""
import csv
import os
import pathlib
import shutil
import subprocess
import time
import unittest

from command import Place

DATA = pathlib.Path(os.environ["TEST_DATA"])
FRICTION = ["--friction", "0.5463024898437905"]
CELL = "0.19808721074789126,0.19661172131892471"
CONTACT = ["--young", "6e8", "--ratio", "0.8", *FRICTION]


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def printed(out, what):
    """The number in a line of what was printed."""
    line = next(line for line in out.splitlines() if line.strip().startswith(what))
    return float(line[44:].split()[0])


def stress(out, dimension=2):
    return [printed(out, f"stress {i}{j}") for i in range(1, dimension + 1) for j in range(1, dimension + 1)]


class Imports(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.addCleanup(self.place.temporary.cleanup)
        self.discs = rows(DATA / "rve400_particles.csv")

    def run_import(self, *arguments, status=0):
        found, out, err = self.place.run("import", *arguments, "--name", "out", "--output", "result")
        self.assertEqual(found, status, out + err)
        return out if status == 0 else err

    def text(self, name, header="", line="{x}\t{y}\t0.05\t{r}\n", digits=None):
        def number(text):
            return text if digits is None else f"{float(text):.{digits}g}"
        body = "".join(line.format(**{k: v if k == "id" else number(v) for k, v in disc.items()})
                       for disc in self.discs)
        return self.place.write(name, header + body)

    def assert_stress_of_yade(self, out, bound):
        of_yade = rows(DATA / "rve400_cell.csv")[0]
        wanted = [float(of_yade["sigma_" + k]) for k in ("xx", "xy", "yx", "yy")]
        size = sum(s * s for s in wanted) ** 0.5
        found = stress(out)
        difference = sum((a - b) ** 2 for a, b in zip(found, wanted)) ** 0.5 / size
        self.assertLess(difference, bound, f"{found} against {wanted}")

    def test_a_packing_of_yade_with_its_forces_has_the_stress_of_yade(self):
        out = self.run_import(str(DATA / "rve400_particles.csv"), *FRICTION)
        self.assert_stress_of_yade(out, 1e-4)
        self.assertLess(printed(out, "its difference from the forces"), 1e-6)
        self.assertIn("read 400 discs", out)
        self.assertIn("read 831 contacts", out)
        self.assertIn("young = 6e+08 Pa, from the contacts", out)
        self.assertAlmostEqual(printed(out, "void ratio"), 0.174999, places=5)
        self.assertAlmostEqual(printed(out, "coordination, all"), 4.155, places=3)

    def test_the_material_that_is_written_has_the_recommended_law_or_that_of_material(self):
        particles = str(DATA / "rve400_particles.csv")
        self.run_import(particles, *FRICTION)
        written = (self.place.path / "result/out.toml").read_text()
        self.assertRegex(written, r"\[solver\]\nviscous_number = 0\.001\n")
        self.run_import(particles, "--material", str(DATA / "rve400.toml"))
        self.assertNotIn("viscous_number", (self.place.path / "result/out.toml").read_text())

    def test_the_material_that_is_written_runs(self):
        self.run_import(str(DATA / "rve400_particles.csv"), *FRICTION)
        scene = self.place.write("scene.toml", 'material = "result/out.toml"\nfigure = false\n[[segment]]\nsteps = 1\n'
                                               "dF22 = -1e-4\nsigma11 = -1e5\n")
        status, out, err = self.place.run("point", scene)
        self.assertEqual(status, 0, out + err)

    def test_spheres_with_their_forces_keep_their_stress(self):
        out = self.run_import(str(DATA / "spheres500_particles.csv"), *FRICTION)
        self.assertIn("read 500 spheres", out)
        self.assertLess(printed(out, "its difference from the forces"), 1e-6)
        self.assertAlmostEqual(printed(out, "mean pressure") / 1e5, 1, places=4)

    def test_total_forces_on_either_particle_are_split_along_the_branch(self):
        cell = [float(rows(DATA / "rve400_cell.csv")[0][k]) for k in ("H00", "H11")]
        place = {d["id"]: (float(d["x"]), float(d["y"])) for d in self.discs}
        lines = ["id1;id2;fx;fy"]
        for c in rows(DATA / "rve400_contacts.csv"):
            shift = float(c["shift_x"]), float(c["shift_y"])
            l = [place[c["j"]][k] - place[c["i"]][k] + cell[k] * shift[k] for k in (0, 1)]
            d = (l[0] ** 2 + l[1] ** 2) ** 0.5
            f = [float(c["fn"]) * l[k] / d + float(c[name]) for k, name in ((0, "ftx_on_j"), (1, "fty_on_j"))]
            lines.append(f"{c['i']};{c['j']};{-f[0]!r};{-f[1]!r}")
        forces = self.place.write("forces.txt", "\n".join(lines) + "\n")
        particles = self.text("discs.txt", "# id, x, y, r\n", "{id} {x} {y} {r}\n")
        out = self.run_import(particles, "--contacts", forces, "--cell", CELL, "--thickness", "0.1", *FRICTION)
        self.assert_stress_of_yade(out, 1e-4)
        self.assertIn("forces in the file act on the first particle", out)

    def test_exports_of_yade_are_read_in_each_format(self):
        bodies = {
            "x_y_z_r": ("", "{x}\t{y}\t0.05\t{r}\n"),
            "x_y_z_r_matId": ("# made by hand\n", "{x}\t{y}\t0.05\t{r}\t0\n"),
            "id_x_y_z_r_matId": ("", "{id}\t{x}\t{y}\t0.05\t{r}\t0\n"),
            "x_y_z_r_attrs": ("some text# x y z r vel_x vel_y vel_z\n", "{x}\t{y}\t0.05\t{r}\t0\t0\t0\n"),
        }
        for form, (comment, line) in bodies.items():
            with self.subTest(form):
                path = self.text(form + ".txt", f"#format {form}\n{comment}", line)
                out = self.run_import(path, "--cell", CELL, "--thickness", "0.1", *CONTACT)
                self.assertIn(f"a text export of YADE, format {form}", out)
                self.assertAlmostEqual(printed(out, "mean pressure") / 1e5, 1, places=4)
        path = self.text("pack.txt", "##PERIODIC:: 0.19808721074789126 0.19661172131892471 0.1\n",
                         "{x} {y} 0.05 {r} -1\n")
        self.assertIn("a sphere pack of YADE", self.run_import(path, *CONTACT))

    def test_six_digits_are_brought_to_equilibrium(self):
        path = self.text("six.txt", "#format x_y_z_r\n", digits=6)
        out = self.run_import(path, "--cell", CELL, "--thickness", "0.1", *CONTACT)
        self.assertAlmostEqual(printed(out, "mean pressure") / 1e5, 1, places=2)

    def test_particles_that_do_not_press_get_the_cure_that_helps(self):
        path = self.text("apart.txt", "#format x_y_z_r\n")
        arguments = [path, "--thickness", "0.1", "--pressure", "2e5", *FRICTION]
        wide = ",".join(str(1.01 * float(side)) for side in CELL.split(","))
        told = self.run_import(*arguments, "--cell", wide, status=2)
        self.assertIn("found particles that do not press on each other, expected overlaps; --young with a smaller --cell", told)
        self.run_import(*arguments[:3], *CONTACT, "--cell", CELL)

    def test_a_pressure_tells_the_stiffness(self):
        path = self.text("pressed.txt", "#format x_y_z_r\n")
        out = self.run_import(path, "--cell", CELL, "--thickness", "0.1", "--pressure", "2e5", *FRICTION)
        self.assertAlmostEqual(printed(out, "mean pressure") / 2e5, 1, places=6)

    def test_tables_with_other_separators_names_and_units_are_read(self):
        for separator in (";", ",", " ", "\t"):
            with self.subTest(separator):
                names = separator.join(("nr", "Radius[mm]", "cx", "cy"))
                body = "".join(separator.join((d["id"], repr(1e3 * float(d["r"])), repr(1e3 * float(d["x"])),
                                               repr(1e3 * float(d["y"])))) + "\n" for d in self.discs)
                path = self.place.write("table.txt", names + "\n" + body)
                out = self.run_import(path, "--columns", "id=nr,x=3,y=cy", "--length-unit", "1e-3", "--cell",
                                      "198.08721074789126,196.61172131892471", "--thickness", "0.1", *CONTACT)
                self.assertAlmostEqual(printed(out, "mean pressure") / 1e5, 1, places=4)

    def test_what_is_written_for_others_is_read_again(self):
        for material in ("rve400", "spheres500"):
            for form, end in (("yade", "txt"), ("lammps", "data"), ("dump", "dump")):
                with self.subTest(material + " " + form):
                    status, out, err = self.place.run("export", str(DATA / f"{material}.toml"), "--format", form)
                    self.assertEqual(status, 0, out + err)
                    young = "6e8" if material == "rve400" else "1e8"
                    out = self.run_import(str(self.place.path / f"{material}.{end}"), "--young", young, *FRICTION)
                    self.assertAlmostEqual(printed(out, "mean pressure") / 1e5, 1, places=3)

    def test_a_tilted_box_keeps_its_lattice(self):
        lattice = 'dimension = 2\nthickness = 0.1\n[packing]\nparticles = "p.csv"\ncell = "c.csv"\n' \
                  '[contact]\nlaw = "compressive"\nyoung = 6e8\n'
        self.place.write("p.csv", "id,x,y,r\n0,0,0,0.01\n1,0.0195,0,0.01\n")
        self.place.write("c.csv", "H00,H01,H10,H11,thickness\n0.039,0.00975,0,0.0169,0.1\n")
        status, out, err = self.place.run("export", self.place.write("tilted.toml", lattice), "--format", "dump")
        self.assertEqual(status, 0, out + err)
        self.run_import(str(self.place.path / "tilted.dump"), "--young", "6e8")
        cell = rows(self.place.path / "result/out_cell.csv")[0]
        for name, wanted in (("H00", 0.039), ("H01", 0.00975), ("H11", 0.0169)):
            self.assertAlmostEqual(float(cell[name]), wanted, places=12)

    def test_a_cell_that_lammps_has_not_is_refused_with_a_format_that_takes_it(self):
        self.place.write("p.csv", "id,x,y,r\n0,0,0,0.01\n1,0.0195,0,0.01\n")
        self.place.write("c.csv", "H00,H01,H10,H11,thickness\n0.039,0,0.00975,0.0169,0.1\n")
        material = self.place.write("tilted.toml", 'dimension = 2\n[packing]\nparticles = "p.csv"\ncell = "c.csv"\n'
                                    '[contact]\nlaw = "compressive"\nyoung = 6e8\n')
        status, _, err = self.place.run("export", material, "--format", "lammps")
        self.assertEqual(status, 2, err)
        for form in err.split("expected ")[1].strip().split(" or "):
            status, out, err = self.place.run("export", material, "--format", form)
            self.assertEqual(status, 0, out + err)

    def test_options_are_finite_numbers(self):
        path = self.place.write("good.txt", "x,y,r\n0.1,0.1,0.05\n0.2,0.1,0.05\n")
        for option in ("--length-unit", "--force-unit", "--thickness", "--density", "--young", "--kn", "--pressure", "--ratio", "--friction"):
            for value in ("nan", "inf", "-1"):
                self.assertIn(f"found {value}, expected a number >", self.run_import(path, option, value, status=2))

    def test_what_is_wrong_is_told_by_file_line_and_column(self):
        good = "x,y,r\n0.1,0.1,0.05\n0.2,0.1,0.05\n"
        cases = (
            (good.replace("0.2,0.1,0.05", "0.2,abc,0.05"), [], "bad.txt:3: column 2 (y): found 'abc', expected a finite"),
            (good.replace("0.2,0.1,0.05", "0.2,0.1,-5"), [], "bad.txt:3: column 3 (r): found '-5', expected a number > 0"),
            (good.replace("0.2,0.1,0.05", "0.2,0.1"), [], "bad.txt:3: found 2 fields, expected 3 as in line 1"),
            (good.replace("x,y,r", "x,y,q"), [], "bad.txt:2: found no column 'r' among x, y, q"),
            (good, ["--cell", "none.csv"], "--cell: found 'none.csv', which is no file and no number"),
            (good, [], "bad.txt: found no periodic cell in it, expected --cell: LX,LY"),
            (good, ["--cell", "0.2,0.1"], "bad.txt: found discs without a thickness, expected --thickness"),
            (good, ["--cell", "20,10", "--thickness", "1"], "fill 7.85e-05 of the cell"),
            (good, ["--cell", "0.2,0.1", "--thickness", "1"], "expected how stiff contacts are: --young"),
            (good, ["--columns", "q=1"], "--columns: found 'q', expected one of id, x, y"),
            (good, ["--columns", "x=7"], "bad.txt:2: x: found no column '7', expected one of x, y, r"),
            ("", [], "bad.txt: found no line of numbers"),
            ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n", [], "bad.txt: found no line of numbers in its last step"),
            ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 q\n", [],
             "bad.txt:7: column 2: found 'q', expected a number"),
            ("a\n\n2 atoms\n\n0 1 xlo xhi\n\nAtoms # atomic\n\n1 1 0 0 0\n", [], "bad.txt:9: found atoms of style 'atomic'"),
        )
        for text, options, told in cases:
            with self.subTest(told):
                path = self.place.write("bad.txt", text)
                begin = time.monotonic()
                err = self.run_import(path, *options, status=2)
                self.assertIn(told, err)
                self.assertEqual(err.count("\n"), 1, err)
                self.assertLess(time.monotonic() - begin, 5)

    def test_nothing_that_was_read_is_written_over(self):
        (self.place.path / "result").mkdir()
        shutil.copy(DATA / "rve400_particles.csv", self.place.path / "result/out_particles.csv")
        err = self.run_import(str(self.place.path / "result/out_particles.csv"), "--cell", CELL, "--thickness", "0.1",
                              *CONTACT, status=2)
        self.assertIn("would be written over", err)

    @unittest.skipUnless(shutil.which("lmp"), "lammps is not installed")
    def test_a_round_trip_through_lammps_keeps_places_and_finds_its_forces(self):
        self.place.run("export", str(DATA / "rve400.toml"), "--format", "lammps")
        script = self.place.write("in.lmp", """
units si
newton off
dimension 2
atom_style sphere
read_data rve400.data
change_box all triclinic
pair_style gran/hooke/history 1e6 8e5 0 0 0.5 0
pair_coeff * *
comm_modify vel yes
neighbor 0.001 bin
timestep 1e-5
compute pair all property/local patom1 patom2 cutoff radius
compute force all pair/local force fx fy p1 p2 cutoff radius
fix 1 all nve/sphere disc
fix 2 all enforce2d
fix 3 all viscous 20
fix 4 all deform 1 xy erate 0.1 remap x
thermo_style custom step pxx pyy pxy
run 2000
unfix 4
run 6000
dump one all custom 1 out.dump id type x y z radius
dump two all local 1 out.local c_pair[*] c_force[*]
dump_modify one format float %.16g
dump_modify two format float %.16g
dump_modify one units yes time yes
run 0
print "$(pxx) $(pyy) $(pxy)" file pressure.txt
write_data out.data
""")
        done = subprocess.run(["lmp", "-in", script], cwd=self.place.path, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout[-500:])
        pxx, pyy, pxy = (float(word) / -0.1 for word in (self.place.path / "pressure.txt").read_text().split())
        contact = ["--kn", "1e6", "--ratio", "0.8", "--friction", "0.5"]
        for end in ("dump", "data"):
            self.run_import(str(self.place.path / f"out.{end}"), *contact)
            for columns in ("fn=3,ftx=6,fty=7", "fx=4,fy=5,ftx=6,fty=7"):
                out = self.run_import(str(self.place.path / f"out.{end}"), "--contacts", str(self.place.path / "out.local"),
                                      "--contact-columns", "i=1,j=2," + columns, *contact)
                found, size = stress(out), (pxx**2 + pyy**2 + 2 * pxy**2)**0.5
                off = sum((a - b)**2 for a, b in zip(found, (pxx, pxy, pxy, pyy)))**0.5 / size
                self.assertLess(off, 1e-3, f"{found} against {pxx, pxy, pyy}")

    @unittest.skipUnless(shutil.which("yade"), "yade is not installed")
    def test_a_round_trip_through_yade_has_its_stress(self):
        self.place.run("export", str(DATA / "rve400.toml"), "--format", "yade")
        script = self.place.write("trip.py", """
from yade import export, pack, ymport
O.periodic = True
sp = pack.SpherePack(); sp.load('rve400.txt')
O.materials.append(FrictMat(young=6e8, poisson=0.8, frictionAngle=0.5, density=2650))
sp.toSimulation()
O.cell.hSize = Matrix3(sp.cellSize[0], 0, 0, 0, sp.cellSize[1], 0, 0, 0, sp.cellSize[2])
assert len(ymport.textExt('rve400.txt')) == 400
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0), InteractionLoop(
    [Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()])]
O.dt = 0; O.step()
s = utils.getStress()
open('stress.txt', 'w').write(' '.join(repr(s[i, j]) for i in (0, 1) for j in (0, 1)))
export.text('six.txt')
sp = pack.SpherePack(); sp.fromSimulation(); sp.save('pack.txt')
import os; os._exit(0)
""")
        subprocess.run(["yade", "-n", "-x", script], cwd=self.place.path, capture_output=True, text=True, timeout=200,
                       env=self.place.environment)
        of_yade = [float(word) for word in (self.place.path / "stress.txt").read_text().split()]
        out = self.run_import(str(self.place.path / "rve400.txt"), *CONTACT)
        found = stress(out)
        size = sum(s * s for s in of_yade) ** 0.5
        self.assertLess(sum((a - b) ** 2 for a, b in zip(found, of_yade)) ** 0.5 / size, 1e-4)
        self.assertIn("400 discs", self.run_import(str(self.place.path / "pack.txt"), *CONTACT))


if __name__ == "__main__":
    unittest.main()
