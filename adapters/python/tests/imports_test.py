"""The modules of the package do not import each other in a circle, for types neither."""
import ast
import graphlib
import pathlib
import unittest

import grainlaw

PACKAGE = pathlib.Path(grainlaw.__file__).parent


def imported(path):
    """Modules of the package that a module names in an import, wherever that stands in it."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            yield from [node.module] if node.module else [name.name for name in node.names]


class Imports(unittest.TestCase):
    def test_there_is_no_circle(self):
        graph = {path.stem: set(imported(path)) for path in PACKAGE.glob("*.py")}
        self.assertIn("points", graph["laboratory"])
        self.assertFalse([name for name, others in graph.items() if "__init__" in others])
        graphlib.TopologicalSorter(graph).prepare()   # raises CycleError, with the circle


if __name__ == "__main__":
    unittest.main()
