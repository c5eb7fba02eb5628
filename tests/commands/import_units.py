"""Forces, steps, units, boxes, bonds and clumps of other programs are read as they mean them, or refused by name."""
import csv
import math
import os
import pathlib
import unittest

from command import Place

DATA = pathlib.Path(os.environ["TEST_DATA"])
FRICTION = ["--friction", "0.5463024898437905"]
STIFFNESS = ["--kn", "1e6", "--ratio", "0.8", "--friction", "0.5"]
# LAMMPS's own pressure of this step, over a thickness of 0.1 m [Pa].
LAMMPS_STRESS = [-73760.289, 19380.363, 19380.363, -123854.41]
PAIRS = "fn=c_pl[1],ftx=c_pl[2],fty=c_pl[3]"


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def printed(out, what):
    line = next(line for line in out.splitlines() if line.strip().startswith(what))
    return float(line[44:].split()[0])


def stress(out):
    return [printed(out, f"stress {i}{j}") for i in (1, 2) for j in (1, 2)]


def numbers(path, first, last=None):
    return [[float(word) for word in line.split()] for line in path.read_text().splitlines()[first:last]]


class Imports(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.addCleanup(self.place.temporary.cleanup)
        self.atoms = numbers(DATA / "lammps60.dump", 9)
        self.pairs = numbers(DATA / "lammps60.local", 9)
        (xlo, xhi, xy), (ylo, yhi, _), _ = numbers(DATA / "lammps60.dump", 5, 8)
        self.cell = [[xhi - xlo - xy, xy], [0, yhi - ylo]]
        self.corner = [xlo, ylo]

    def run_import(self, *arguments, status=0):
        found, out, err = self.place.run("import", *map(str, arguments), "--name", "out", "--output", "result")
        self.assertEqual(found, status, out + err)
        return out if status == 0 else err

    def refused(self, told, *arguments):
        err = self.run_import(*arguments, status=2)
        self.assertIn(told, err)
        self.assertEqual(err.count("\n"), 1, err)

    def assert_stress(self, out, wanted=LAMMPS_STRESS, bound=3e-4):
        size = math.hypot(*wanted)
        self.assertLess(math.dist(stress(out), wanted) / size, bound, f"{stress(out)} against {wanted}")

    def dump(self, name="d.dump", header="", length=1, turn=0.0, line=lambda atom: atom):
        """The atoms of LAMMPS in other units, or turned as a general triclinic box has them."""
        c, s = math.cos(turn), math.sin(turn)
        text = header + "ITEM: TIMESTEP\n140000\nITEM: NUMBER OF ATOMS\n60\n"
        if turn:
            a, b = [[c * v[0] - s * v[1], s * v[0] + c * v[1]] for v in zip(*self.cell)]
            text += "ITEM: BOX BOUNDS abc origin pp pp pp\n" + "".join(
                f"{v[0]!r} {v[1]!r} {v[2]!r} {o!r}\n" for v, o in ((a + [0], 0), (b + [0], 0), ([0, 0, 0.1], -0.05)))
        else:
            bounds = numbers(DATA / "lammps60.dump", 5, 8)
            text += "ITEM: BOX BOUNDS xy xz yz pp pp pp\n" + "".join(
                " ".join(repr(length * value) for value in bound) + "\n" for bound in bounds)
        text += "ITEM: ATOMS id type x y z radius\n"
        for atom in self.atoms:
            x, y, z, r = (length * value for value in atom[2:])
            text += f"{atom[0]:.0f} 1 {c * x - s * y!r} {s * x + c * y!r} {z!r} {r!r}\n"
        return self.place.write(name, text)

    def local(self, line=None, step=140000, columns="i j fn ftx fty", keep=lambda pair: True, header=""):
        line = line or (lambda p: (int(p[0]), int(p[1]), *p[2:5]))
        pairs = [pair for pair in self.pairs if keep(pair)]
        text = header + f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ENTRIES\n{len(pairs)}\n"
        text += "\n".join((DATA / "lammps60.local").read_text().splitlines()[4:8]) + f"\nITEM: ENTRIES {columns}\n"
        return self.place.write("d.local", text + "".join(" ".join(map(repr, line(p))) + "\n" for p in pairs))

    def with_pairs(self, local, *more, dump=DATA / "lammps60.dump"):
        return dump, "--contacts", local, *STIFFNESS, *more

    def normal_part(self, pair):
        """On the first atom, as fx, fy of LAMMPS have it."""
        place = {atom[0]: atom[2:4] for atom in self.atoms}
        (lx, xy), (_, ly) = self.cell
        d = [a - b for a, b in zip(place[pair[0]], place[pair[1]])]
        images = [[d[0] + m * lx + n * xy, d[1] + n * ly] for m in (-1, 0, 1) for n in (-1, 0, 1)]
        x, y = min(images, key=lambda image: math.hypot(*image))
        return [pair[2] * x / math.hypot(x, y), pair[2] * y / math.hypot(x, y)]

    def test_the_balance_of_forces_decides_on_which_particle_tangential_forces_act(self):
        for first, second in ((1, 2), (2, 1)):
            out = self.run_import(*self.with_pairs(DATA / "lammps60.local", "--contact-columns",
                                                   f"i=c_pa[{first}],j=c_pa[{second}],{PAIRS}"))
            self.assert_stress(out)
            self.assertLess(printed(out, "its difference from the forces"), 1e-4)
            self.assertEqual("act on the first particle" in out, first == 1)

    def test_tables_with_forces_on_either_particle_have_one_stress(self):
        for sign in (1, -1):
            table = "i,j,fn,ftx,fty\n" + "".join(
                f"{p[0]:.0f},{p[1]:.0f},{p[2]!r},{sign * p[3]!r},{sign * p[4]!r}\n" for p in self.pairs)
            self.assert_stress(self.run_import(*self.with_pairs(self.place.write("c.csv", table))))

    def test_normal_part_and_tangential_part_in_columns_of_their_own_are_added(self):
        local = self.local(lambda p: (int(p[0]), int(p[1]), *self.normal_part(p), *p[3:5]), columns="i j fx fy p1 p2")
        for names in ((), ("--contact-columns", "ftx=p1,fty=p2")):
            self.assert_stress(self.run_import(*self.with_pairs(local, *names)))
        self.assert_stress(self.run_import(*self.with_pairs(self.local(columns="patom1 patom2 force p1 p2"))))

    def test_forces_that_do_not_balance_are_refused_with_both_remainders(self):
        self.refused("on a particle 0.", *self.with_pairs(self.local(keep=lambda p: p[0] % 4)))
        self.refused("of it with the tangential ones on the other particle",
                     *self.with_pairs(self.local(keep=lambda p: p[0] % 4)))
        alone = self.local(lambda p: (int(p[0]), int(p[1]), *self.normal_part(p)), columns="i j fx fy")
        self.refused("of LAMMPS p1, p2, p3", *self.with_pairs(alone))
        self.refused("of LAMMPS p1, p2, p3", *self.with_pairs(self.local(lambda p: p[:3], columns="i j fn")))

    def test_contacts_of_another_step_or_box_are_refused(self):
        self.refused("d.local: found contacts of step 130000, expected those of step 140000 as in",
                     *self.with_pairs(self.local(step=130000)))
        self.refused("d.local: found another box than that of",
                     *self.with_pairs(self.local(), dump=self.dump(length=1.01)))

    def test_units_and_times_of_a_dump_are_read(self):
        header = "ITEM: UNITS\n{}\nITEM: TIME\n1.4\n"
        self.assert_stress(self.run_import(*self.with_pairs(self.local(), dump=self.dump(header=header.format("si")))))
        self.refused("d.dump:2: found the units 'real', expected si, cgs, micro, nano or lj",
                     self.dump(header=header.format("real")), *STIFFNESS)
        self.refused("found the units 'lj', which are none of SI, expected --length-unit",
                     self.dump(header=header.format("lj"), length=100), *STIFFNESS)
        self.run_import(self.dump(header=header.format("lj"), length=100), "--length-unit", "cm", *STIFFNESS)
        self.refused("found the units 'si' and another --length-unit",
                     self.dump(header=header.format("si")), "--length-unit", "mm", *STIFFNESS)
        cgs = self.dump(header=header.format("cgs"), length=100)
        out = self.run_import(cgs, *STIFFNESS)
        self.assertIn("H = [0.0450287, 0.000366128; 0, 0.0453998] m", out)
        text = pathlib.Path(self.local(lambda p: (int(p[0]), int(p[1]), *(1e5 * f for f in p[2:5])))).read_text().splitlines()
        text[5:8] = [" ".join(repr(100 * float(value)) for value in bound.split()) for bound in text[5:8]]
        local = self.place.write("d.local", "\n".join(text) + "\n")
        self.assert_stress(self.run_import(*self.with_pairs(local, dump=cgs)))
        other = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF BONDS\n1\nITEM: BONDS a b\n1 2\n"
        self.refused("expected ITEM: ATOMS or ITEM: ENTRIES", self.place.write("other.dump", other), *STIFFNESS)

    def test_a_data_file_says_its_units_and_step_in_its_first_line(self):
        atoms = "".join(f"{a[0]:.0f} 1 {2 * a[5]!r} 2650 {a[2]!r} {a[3]!r} 0\n" for a in self.atoms)
        (lx, xy), (_, ly) = self.cell
        x, y = self.corner
        box = f"{x!r} {x + lx!r} xlo xhi\n{y!r} {y + ly!r} ylo yhi\n-0.05 0.05 zlo zhi\n{xy!r} 0 0 xy xz yz\n"
        for title, told in (("timestep = 140000, units = si", None), ("timestep = 5", "step 140000, expected those of step 5"),
                            ("timestep = 140000, units = metal", "found the units 'metal'")):
            data = self.place.write("d.data", f"LAMMPS data file via write_data, {title}\n\n60 atoms\n1 atom types\n{box}\n"
                                              f"Atoms # sphere\n\n{atoms}")
            if told:
                self.refused(told, *self.with_pairs(self.local(), dump=data))
            else:
                self.assert_stress(self.run_import(*self.with_pairs(self.local(), dump=data)))
        general = f"{lx!r} 0 0 avec\n{xy!r} {ly!r} 0 bvec\n0 0 0.1 cvec\n{x!r} {y!r} -0.05 abc origin\n"
        data = self.place.write("d.data", f"LAMMPS\n\n60 atoms\n1 atom types\n{general}\nAtoms # sphere\n\n{atoms}")
        self.assert_stress(self.run_import(*self.with_pairs(self.local(), dump=data)))
        bonds = self.place.write("d.data", f"LAMMPS\n\n60 atoms\n12 bonds\n1 atom types\n{box}\nAtoms # sphere\n\n{atoms}")
        self.refused("d.data:4: found 12 bonds, expected none", bonds, *STIFFNESS)

    def test_a_general_triclinic_box_turns_the_forces_of_its_pairs(self):
        turn = 0.5
        out = self.run_import(*self.with_pairs(self.local(), dump=self.dump(turn=turn)))
        c, s = math.cos(turn), math.sin(turn)
        a, b, _, d = LAMMPS_STRESS
        self.assert_stress(out, [c * c * a - 2 * c * s * b + s * s * d, c * s * (a - d) + (c * c - s * s) * b,
                                 c * s * (a - d) + (c * c - s * s) * b, s * s * a + 2 * c * s * b + c * c * d])

    def test_a_sheared_cell_finds_its_images(self):
        """Any basis of the lattice has the same contacts."""
        cell = rows(DATA / "rve400_cell.csv")[0]
        wanted = [float(cell["sigma_" + k]) for k in ("xx", "xy", "yx", "yy")]
        lines = "i,j,fn,ftx_on_j,fty_on_j\n" + "".join(
            ",".join(c[k] for k in ("i", "j", "fn", "ftx_on_j", "fty_on_j")) + "\n"
            for c in rows(DATA / "rve400_contacts.csv"))
        contacts = self.place.write("c.csv", lines)
        for times in (0, -3, 8):
            sheared = f"{cell['H00']},{times * float(cell['H00'])!r},0,{cell['H11']}"
            out = self.run_import(DATA / "rve400_particles.csv", "--contacts", contacts, "--cell", sheared, "--thickness",
                                  "0.1", *FRICTION)
            self.assert_stress(out, wanted, 1e-4)

    def test_a_pair_that_touches_through_two_images_needs_its_distance(self):
        """Two columns of two discs, the upper on the lower through both sides of the cell."""
        particles = self.place.write("p.csv", "id,x,y,r\n0,0,0,0.01\n1,0.0001,0.0199,0.01\n")
        lines = {"i,j,fn": ["0,1,99.75", "0,1,99.75"], "i,j,fn,dx,dy": ["0,1,99.75,-0.0001,-0.0199", "0,1,99.75,-0.0001,0.0199"]}
        cell = ["--cell", "0.021,0.0398", "--thickness", "0.1", *STIFFNESS]
        for header, body in lines.items():
            contacts = self.place.write("c.csv", "\n".join([header, *body]) + "\n")
            if "dx" in header:
                self.assertIn("read 2 contacts", self.run_import(particles, "--contacts", contacts, *cell))
            else:
                self.refused("c.csv:2: found a contact of 0 and 1, which touch through 2 images", particles, "--contacts",
                             contacts, *cell)

    def test_particles_at_the_walls_of_a_box_need_no_balance(self):
        """Three rows of three discs that walls press together: the middle one balances, the outer ones do not."""
        discs = [(k, 0.01 + 0.0199 * (k % 3), 0.01 + 0.02 * (k // 3)) for k in range(9)]
        particles = self.place.write("p.csv", "id,x,y,r\n" + "".join(f"{k},{x},{y},0.01\n" for k, x, y in discs))
        for pushed, told in ((100, None), (300, "on a particle 1 of the force of a contact")):
            contacts = self.place.write("c.csv", "i,j,fn\n" + "".join(
                f"{row},{row + 1},100\n{row + 1},{row + 2},{pushed}\n" for row in (0, 3, 6)))
            box = [particles, "--contacts", contacts, "--cell", "box", "--thickness", "0.1", *STIFFNESS]
            if told:
                self.refused(told, *box)
            else:
                self.run_import(*box)
                box[box.index("box")] = "0.0598,0.06"
                self.refused("that leave on a particle 0.667", *box)

    def test_bonds_and_clumps_are_read_or_refused_by_name(self):
        clump = self.place.write("pack.txt", "##PERIODIC:: 0.05 0.05 0.1\n0.01 0.01 0.05 0.01 -1\n0.03 0.03 0.05 0.01 4\n"
                                             "0.04 0.03 0.05 0.01 4\n")
        self.refused("pack.txt:4: found another particle of clump 4", clump, *STIFFNESS)
        clump = self.place.write("clumps.txt", "#format x_y_z_r_clumpId\n" + "0.01 0.01 0.05 0.01 0\n" * 2)
        self.refused("clumps.txt:3: found another particle of clump 0", clump, "--cell", "0.05,0.05,0.1", *STIFFNESS)
        self.dump()
        dump = (self.place.path / "d.dump").read_text().replace("id type", "id mol")
        self.assertIn("note: particles share molecules", self.run_import(self.place.write("m.dump", dump), *STIFFNESS))
        bonded = [DATA / "string_particles.csv"]
        self.refused("found bonds, expected --material with law = \"bonded\"", *bonded, *STIFFNESS)
        self.run_import(*bonded, "--material", DATA / "string.toml")
        self.assertEqual([c["bonded"] for c in rows(self.place.path / "result/out_contacts.csv")], ["1", "1"])

    def millimetres(self, header="x [mm],y [mm],r [mm]", length=1e3):
        body = "".join(f"{length * a[2]!r},{length * a[3]!r},{length * a[5]!r}\n" for a in self.atoms)
        return self.place.write("discs.csv", header + "\n" + body)

    def test_units_in_a_header_count(self):
        (lx, xy), (_, ly) = self.cell
        cell = ["--cell", f"{lx!r},{xy!r},0,{ly!r}", "--thickness", "0.1", *STIFFNESS]
        wanted = self.run_import(self.millimetres("x,y,r", 1), *cell)
        for header, length in (("x [mm],y [mm],r [mm]", 1e3), ("x[m],y[m],r[m]", 1), ('"x (cm)",y[cm],r [cm]', 1e2)):
            out = self.run_import(self.millimetres(header, length), *cell)
            self.assertAlmostEqual(printed(out, "mean pressure") / printed(wanted, "mean pressure"), 1, places=5)
            self.assertIn("m], y [", out)
        for header in ("# x [mm] y [mm] r [mm]", "x [ mm ] y [mm] r[mm]"):
            path = pathlib.Path(self.millimetres(header))
            path.write_text(path.read_text().replace(",", " "))
            out = self.run_import(path, *cell)
            self.assertAlmostEqual(printed(out, "mean pressure") / printed(wanted, "mean pressure"), 1, places=5)
        for unit in ("inch", "N", "furlong"):
            self.refused(f"column 1 (x): found the unit [{unit}], expected a length, as m or mm",
                         self.millimetres(f"x [{unit}],y [mm],r [mm]"), *cell)

    def test_one_option_says_the_unit_of_lengths_and_one_that_of_forces(self):
        (lx, xy), (_, ly) = self.cell
        cell = ["--cell", f"{1e3 * lx!r},{1e3 * xy!r},0,{1e3 * ly!r}", "--thickness", "0.1", *STIFFNESS]
        kilonewtons = self.place.write("c.csv", "i,j,fn,ftx,fty\n" + "".join(
            f"{p[0]:.0f},{p[1]:.0f},{1e-3 * p[2]!r},{1e-3 * p[3]!r},{1e-3 * p[4]!r}\n" for p in self.pairs))
        discs = "id,x,y,r\n" + "".join(f"{a[0]:.0f},{1e3 * a[2]!r},{1e3 * a[3]!r},{1e3 * a[5]!r}\n" for a in self.atoms)
        discs = self.place.write("discs.csv", discs)
        for length, force in (("mm", "kN"), ("1e-3", "1000")):
            self.assert_stress(self.run_import(discs, "--contacts", kilonewtons, "--length-unit", length, "--force-unit",
                                               force, *cell))
        with_unit = pathlib.Path(kilonewtons)
        with_unit.write_text(with_unit.read_text().replace("fn,ftx,fty", "fn[kN],ftx [kN],fty[kN]"))
        self.assert_stress(self.run_import(discs, "--contacts", with_unit, "--length-unit", "mm", *cell))
        self.refused("found the unit [kN], expected that of --length-unit and --force-unit", discs, "--contacts", with_unit,
                     "--length-unit", "mm", "--force-unit", "N", *cell)
        self.refused("--length-unit: found inch, expected a number > 0 or a length, as m or mm", discs, "--length-unit",
                     "inch", *cell)

    def test_units_of_a_packing_of_our_own_are_brought_to_si(self):
        """A material file takes m and N alone and says who converts."""
        contacts = rows(DATA / "rve400_contacts.csv")
        self.place.write("u_contacts.csv", "i,j,shift_x,shift_y,fn[kN],ftx_on_j[kN],fty_on_j[kN]\n" + "".join(
            ",".join([*list(c.values())[:4], *(repr(1e-3 * float(v)) for v in list(c.values())[4:])]) + "\n"
            for c in contacts))
        cell = rows(DATA / "rve400_cell.csv")[0]
        self.place.write("u_cell.csv", "H00[cm],H01[cm],H10[cm],H11[cm],thickness[mm],rho[g/cm3]\n"
                         f"{100 * float(cell['H00'])!r},0,0,{100 * float(cell['H11'])!r},100,2.65\n")
        discs = "id,x[mm],y[mm],r[mm]\n" + "".join(
            f"{d['id']},{1e3 * float(d['x'])!r},{1e3 * float(d['y'])!r},{1e3 * float(d['r'])!r}\n"
            for d in rows(DATA / "rve400_particles.csv"))
        path = self.place.write("u_particles.csv", discs)
        out = self.run_import(path, *FRICTION)
        self.assert_stress(out, [float(cell["sigma_" + k]) for k in ("xx", "xy", "yx", "yy")], 1e-4)
        self.assertAlmostEqual(float(rows(self.place.path / "result/out_cell.csv")[0]["rho"]), 2650, places=6)
        material = self.place.write("u.toml", 'dimension = 2\n[packing]\nparticles = "u_particles.csv"\n'
                                    'contacts = "u_contacts.csv"\ncell = "u_cell.csv"\n'
                                    '[contact]\nlaw = "frictional"\nyoung = 6e8\nratio = 0.8\nfriction = 0.5\n')
        status, _, err = self.place.run("export", material)
        self.assertEqual(status, 2)
        self.assertIn("column 'H00': found the unit [cm], expected m; grainlaw import brings others to SI", err)


if __name__ == "__main__":
    unittest.main()
