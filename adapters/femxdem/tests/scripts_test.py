"""Scripts of users, run as they are, with this adapter's modules instead of FEMxDEM's: one of ours, and those
that Debian's yade brings, on smaller meshes for fewer steps."""
import contextlib
import io
import os
import re
import shutil
import tempfile
import unittest

import numpy as np

from support import DISCS, ROOT, SPHERES

PEER = "/usr/share/doc/yade/examples/FEMxDEM"
SHORTER = {   # what is replaced in the text
    "biaxialSmooth": [(r"nx = 8", "nx = 1"), (r"ny = 16", "ny = 2"), (r"t < 100", "t < 2")],
    "undrain": [(r"nx = 8", "nx = 1"), (r"ny = 16", "ny = 2"), (r"t < 400", "t < 2"), (r"2\.e5", "2.e5")],
    "triaxialRough": [(r"nx = 8", "nx = 1"), (r"ny = 8", "ny = 1"), (r"nz = 16", "nz = 1"), (r"t < 100", "t < 2")],
    "retainingSmooth": [(r"nx = \d+", "nx = 2"), (r"ny = \d+", "ny = 1"), (r"t < \d+", "t < 2")],
}


@contextlib.contextmanager
def folder_with(material):
    """A folder of a run: the material is 0.toml there."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for name in os.listdir(os.path.dirname(material)):
            if name.endswith(".csv"):
                shutil.copy(os.path.join(os.path.dirname(material), name), folder)
        shutil.copy(material, "0.toml")
        yield folder


def run(text, name):
    with contextlib.redirect_stdout(io.StringIO()):
        exec(compile(text, name, "exec"), {"__name__": "__main__"})   # pylint: disable=exec-used


class Scripts(unittest.TestCase):
    def test_the_example_runs(self):
        with open(os.path.join(ROOT, "adapters/femxdem/biaxial.py"), encoding="utf-8") as file:
            text = file.read()
        with folder_with(DISCS):
            run(text, "biaxial.py")
            force = np.loadtxt("result/force.dat")
        self.assertEqual(len(force), 6)
        np.testing.assert_allclose(force[0, 1] / force[0, 2], -1e5, rtol=0.02)
        self.assertTrue(np.all(np.diff(force[:, 1]) < 0), force)

    @unittest.skipUnless(os.path.isdir(PEER), "no examples of FEMxDEM (Debian: yade)")
    def test_the_scripts_of_femxdem_run(self):
        for name, changes in SHORTER.items():
            with self.subTest(name), folder_with(SPHERES if name.startswith("tri") else DISCS):
                path = os.path.join(PEER, f"{name}.py")
                with open(path, encoding="utf-8") as file:
                    text = file.read()
                for old, new in changes:
                    text, found = re.subn(old, new, text)
                    self.assertTrue(found, old)
                run(text, path)
                written = {kind: sorted(os.listdir(f"result/{kind}")) for kind in ("vtk", "gauss", "packing")}
                self.assertEqual(len(written["gauss"]), 2)
                self.assertTrue(written["vtk"][-1].startswith(f"{name}_2"), written["vtk"])
                self.assertIn("packing_0_2_particles.csv", written["packing"])


if __name__ == "__main__":
    unittest.main()
