"""The names and layouts that make_names found in the header are those of a C compiler, and those of
the library that was loaded."""
import ctypes
import os
import subprocess
import unittest

import grainlaw
from grainlaw import names
from grainlaw.abi import library, status_text
from support import material


class Header(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        run = subprocess.run([os.environ["GRAINLAW_HEADER_NAMES"]], text=True, check=True,
                             stdout=subprocess.PIPE)
        cls.said = {}
        for line in run.stdout.splitlines():
            words = line.split()
            cls.said.setdefault(words[0], []).append(words[1:])

    def test_enumerations_are_those_of_the_header(self):
        for kind in ("Status", "Measure", "Tangent", "Action"):
            said = [(name.removeprefix("GRAINLAW_"), int(value)) for name, value in self.said[kind]]
            ours = [(entry.name, entry.value) for entry in getattr(names, kind)]
            self.assertEqual(ours, said)

    def test_structs_have_the_size_and_offsets_of_the_header(self):
        for name, size in self.said["sizeof"]:
            ours = getattr(names, name)
            self.assertEqual(ctypes.sizeof(ours), int(size))
            for field, offset in self.said[name]:
                self.assertEqual(getattr(ours, field).offset, int(offset), field)

    def test_the_library_knows_each_status_and_measure_and_no_more(self):
        unknown = status_text(1000)
        texts = [status_text(status) for status in grainlaw.Status]
        self.assertEqual(len(set(texts) | {unknown}), len(grainlaw.Status) + 1)
        for beyond in (max(grainlaw.Status) + 1, min(grainlaw.Status) - 1):
            self.assertEqual(status_text(beyond), unknown)
        state = grainlaw.State(material())
        for measure in grainlaw.Measure:
            state.measure(measure)
        with self.assertRaises(grainlaw.Error):
            state.measure(max(grainlaw.Measure) + 1)

    def test_version_is_that_of_the_header(self):
        self.assertEqual(grainlaw.version(), names.VERSION)
        self.assertEqual(library.grainlaw_version().decode(), names.VERSION)


if __name__ == "__main__":
    unittest.main()
