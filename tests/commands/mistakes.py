#!/usr/bin/env python3
"""Mistakes that users make with words, paths and scenes: what is wrong, where, and what was expected."""
import os
import unittest

from command import MATERIAL, POINT, SOLVE, WAVE, Place

SEGMENT = POINT.format(steps=2, stretch=0.9999)
MESH_WITHOUT_NAMES = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
1
1 3 2 1 1 1 2 3 4
$EndElements
"""
SCENE = "figure = false\n" + SEGMENT + MATERIAL


class Mistakes(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.addCleanup(self.place.temporary.cleanup)
        self.place.write("scene.toml", SCENE)

    def told(self, *arguments, status=2):
        found, _, err = self.place.run(*arguments)
        self.assertEqual(found, status, err)
        return err

    def test_a_misspelt_word_is_named(self):
        for words in (["pointt"], ["pointt", "scene.toml"], ["point", "--jbos"], ["pack", "--sed", "3"]):
            with self.subTest(words=words):
                wrong = next(word for word in words if word not in ("point", "pack"))
                self.assertIn(wrong, self.told(*words))
        self.assertIn("SCENE is required", self.told("point"))

    def test_the_names_that_keys_takes_are_those_that_are_told(self):
        names = self.told("keys", "words").split("one of ")[1].strip().split(", ")
        self.assertIn("columns", names)
        for name in names:
            self.assertEqual(self.place.run("keys", name)[0], 0, name)

    def test_a_path_that_is_no_file_is_told_with_the_cause(self):
        (self.place.path / "folder").mkdir()
        os.mkfifo(self.place.path / "pipe")
        for path, cause in (("nix.toml", "No such file"), ("folder", "Is a directory"), ("pipe", "found a pipe"),
                            ("a" * 300, "File name too long"), ("scene.toml/x", "Not a directory")):
            for command in ("point", "import", "export"):
                with self.subTest(command=command, path=path):
                    self.assertIn(f"{path}: cannot be read: {cause}",
                                  self.told(command, path, *(["--format", "yade"] if command == "export" else [])))

    def test_a_material_that_is_no_file_is_told_at_its_key(self):
        (self.place.path / "folder").mkdir()
        for text in ('""', '"folder"', '"nix.toml"', '{ file = "" }', f'"{"a" * 300}"'):
            self.place.write("m.toml", f"material = {text}\n" + SEGMENT)
            self.assertIn("m.toml:1: material: found ", self.told("point", "m.toml"), text)

    def test_a_list_of_own_files_that_cannot_be_made_is_told_with_the_cause(self):
        (self.place.path / "out").mkdir()
        (self.place.path / "out" / ".grainlaw").write_text("")
        self.assertIn("out/.grainlaw: cannot be made: ", self.told("point", "scene.toml", "--output", "out", status=1))

    def test_cycles_without_an_amplitude_are_told_what_one_is(self):
        self.place.write("cycles.toml", MATERIAL
                         + '[[segment]]\ntest = "undrained"\ncycles = 2\n')
        self.assertIn("{ strain = 5e-3 }", self.told("point", "cycles.toml"))

    def test_a_case_that_is_not_there_is_told_with_those_that_are(self):
        self.place.write("cases.toml", SCENE + '[[case]]\nname = "dense"\n[[case]]\nname = "loose"\n')
        self.assertIn("expected one of dense, loose", self.told("point", "cases.toml", "--case", "lose"))

    def test_a_number_of_cells_is_told_its_bounds(self):
        self.place.write("mesh.toml", "steps = 1\n" + MATERIAL
                         + SOLVE.format(value=-1e-4).replace("divisions = [1, 1]", "divisions = [1, 10001]"))
        self.assertIn("each an integer from 1 to 10000", self.told("solve", "mesh.toml"))

    def test_pictures_that_the_path_does_not_reach_are_told(self):
        self.place.write("far.toml", "pictures = [5e-5, 0.5]\n" + SCENE)
        self.assertIn("reaches 1 of 2", self.told("point", "far.toml", status=0))

    def test_a_set_of_a_mesh_without_names_is_told_that_it_has_none(self):
        self.place.write("plain.msh", MESH_WITHOUT_NAMES)
        self.place.write("mesh.toml", 'steps = 1\n[mesh]\nfile = "plain.msh"\n[[displacement]]\non = "base"\n'
                         + 'component = "x"\nvalue = 0.0\n' + MATERIAL)
        err = self.told("solve", "mesh.toml")
        if "built without Gmsh" in err:
            self.skipTest(err)
        self.assertIn('found "base", expected a mesh with sets: the physical groups of its file are none', err)

    def test_a_material_of_a_wave_is_told_once(self):
        self.place.write("w.toml", WAVE.format(repeat=3, duration=1e-4).replace("density = 2000", "density = 0"))
        err = self.told("wave", "w.toml")
        self.assertIn("packing.density: found 0, expected a number > 0", err)
        self.assertEqual(err.count("w.toml"), 1, err)

    def test_a_wave_without_sections_tells_no_differences_from_particles(self):
        self.place.write("w.toml", WAVE.format(repeat=3, duration=1e-4).replace("[0.02]", "[]"))
        found, out, err = self.place.run("wave", "w.toml")
        self.assertEqual(found, 0, err)
        self.assertIn("core-seconds\n", out)
        self.assertNotIn("against particles", out)


if __name__ == "__main__":
    unittest.main()
