"""A build that is not of this checkout, or that Python cannot load, is refused with the reason."""
import importlib.util
import pathlib
import tempfile
import unittest

BACKEND = pathlib.Path(__file__).resolve().parent.parent / "wheel_backend.py"


def backend():
    spec = importlib.util.spec_from_file_location("wheel_backend", BACKEND)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Backend(unittest.TestCase):
    def test_a_build_that_cannot_be_taken_is_refused_with_the_reason(self):
        module = backend()
        ours = f"CMAKE_HOME_DIRECTORY:INTERNAL={module.root}\n"
        for cache, words in (
                ("CMAKE_HOME_DIRECTORY:INTERNAL=/elsewhere/grainlaw\n",
                 "is of another checkout, /elsewhere/grainlaw; expected one of "),
                (ours + "BUILD_SHARED_LIBS:BOOL=OFF\n", "makes a static library"),
                (ours + "GRAINLAW_SANITIZE:STRING=address\n", "of GRAINLAW_SANITIZE=address")):
            for build in (module.build_wheel, module.build_editable):
                with self.subTest(words), tempfile.TemporaryDirectory() as directory:
                    file = pathlib.Path(directory) / "CMakeCache.txt"
                    file.write_text(cache, encoding="utf-8")
                    with self.assertRaises(SystemExit) as told:
                        build(directory, {"build-dir": directory})
                    self.assertIn(f"build-dir {file.parent}", str(told.exception))
                    self.assertIn(words, str(told.exception))
                    self.assertEqual(list(file.parent.iterdir()), [file])


if __name__ == "__main__":
    unittest.main()
