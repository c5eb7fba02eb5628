"""What the tests share: the material of 400 discs and checks on errors."""
import os
import unittest

import grainlaw

DATA = os.environ["GRAINLAW_TEST_DATA"]
MATERIAL = os.path.join(DATA, "rve400.toml")

_loaded = {}


def material(path=MATERIAL):
    """The material, read once per test program."""
    if path not in _loaded:
        _loaded[path] = grainlaw.Material(path)
    return _loaded[path]


class Case(unittest.TestCase):
    def assert_refused(self, status, words, call, *arguments, **options):
        """The call raises Error with this status, and its message has all the words."""
        with self.assertRaises(grainlaw.Error) as caught:
            call(*arguments, **options)
        self.assertEqual(caught.exception.status, status)
        for word in words:
            self.assertIn(word, str(caught.exception))
        return caught.exception
