"""What README.md shows runs, one block after the other."""
import contextlib
import io
import os
import pathlib
import re
import tempfile
import unittest

import numpy as np

from support import DATA, Case

README = pathlib.Path(__file__).resolve().parent.parent / "README.md"


class Page(Case):
    def test_blocks_run_as_they_are_printed(self):
        blocks = re.findall(r"^```python\n(.*?)^```$", README.read_text(encoding="utf-8"), re.M | re.S)
        self.assertEqual(len(blocks), 7)
        try:
            import matplotlib  # pylint: disable=import-outside-toplevel,unused-import
        except ImportError:
            blocks = [re.sub(r"^\w+\.plot.*$", "", block, flags=re.M) for block in blocks]
        names = {}
        with tempfile.TemporaryDirectory() as directory, contextlib.chdir(directory):
            text = (pathlib.Path(DATA) / "rve400.toml").read_text(encoding="utf-8")
            pathlib.Path("sand.toml").write_text(text.replace('= "rve', f'= "{DATA}/rve'),
                                                 encoding="utf-8")
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                for block in blocks:
                    exec(block, names)  # pylint: disable=exec-used
            self.assertTrue(os.path.exists("point0.vtp"))
            with np.load("drained.npz") as saved:
                self.assertEqual(saved["A"].shape[1:], (2, 2, 2, 2))
                self.assertTrue(len(saved["F"]) == len(saved["P"]) == len(saved["A"]) > 5)
        self.assertTrue(names["answer"].ok, names["answer"].message)
        cauchy = names["result"].sigma[-1]
        self.assertLess(np.linalg.norm(names["sigma"] - cauchy), 1e-9 * np.linalg.norm(cauchy))
        self.assertGreater(float(printed.getvalue().split()[0]), 200e3)


if __name__ == "__main__":
    unittest.main()
