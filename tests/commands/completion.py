"""The shell completes commands, options and scenes as the program has them, and the man page knows every command."""
import os
import pathlib
import re
import subprocess
import unittest

from command import GRAINLAW, Place

INSTALLED = pathlib.Path(os.environ["INSTALLED_FILES"])


class Completion(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.addCleanup(self.place.temporary.cleanup)

    def complete(self, *words):
        script = (f"source '{INSTALLED}/grainlaw.bash'; COMP_WORDS=('{GRAINLAW}' {' '.join(repr(w) for w in words)}); "
                  f"COMP_CWORD={len(words)}; compopt() {{ :; }}; _grainlaw; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        done = subprocess.run(["bash", "-c", script], cwd=self.place.path, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.stderr, "")
        return done.stdout.split()

    def commands(self):
        help_text = self.place.run("--help")[1]
        return set(re.findall(r"^  ([a-z]+) ", help_text.split("Subcommands:")[1], re.M))

    def test_commands_are_those_of_the_program(self):
        found = set(self.complete(""))
        self.assertEqual(found - {"--help", "--version"}, self.commands())
        self.assertIn("import", found)
        self.assertEqual(self.complete("poi"), ["point"])

    def test_options_are_those_of_the_command(self):
        self.assertEqual(self.complete("pack", "--see"), ["--seed", "--seeds"])
        self.assertEqual(self.complete("export", "--format", "la"), ["lammps"])

    def test_scenes_are_toml_files(self):
        self.place.write("scene.toml", "")
        self.place.write("scene.csv", "")
        self.assertEqual(self.complete("point", "sce"), ["scene.toml"])

    def test_the_man_page_knows_every_command(self):
        text = (INSTALLED / "grainlaw.1").read_text()
        self.assertEqual(set(re.findall(r'^\.BI "([a-z]+) ', text, re.M)), self.commands())


if __name__ == "__main__":
    unittest.main()
