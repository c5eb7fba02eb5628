"""A test case of mistakes of a script."""
import unittest

import grainlaw


class Told(unittest.TestCase):
    def told(self, words, action):
        """The action raises ValueError or grainlaw.Error, with these words."""
        with self.assertRaises((ValueError, grainlaw.Error)) as caught:
            action()
        self.assertIn(words, str(caught.exception))
