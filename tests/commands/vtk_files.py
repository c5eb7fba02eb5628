"""VTK's own reader opens what `grainlaw solve` writes for ParaView, of every element."""
import unittest

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

from command import PERIODIC, Place
from starts import SPHERES

# Displacements at the end of a uniform compression along the last axis, the others held.
SIZES = {2: [0.5, 1.0], 3: [0.5, 0.4, 1.0]}
ENDS = {2: [("left", "right"), ("bottom", "top")], 3: [("left", "right"), ("front", "back"), ("bottom", "top")]}
SHORTENING = 1e-4


def scene(element, dimension):
    size = SIZES[dimension]
    text = "steps = 1\nthreads = 1\nvtk_every = 1\n" + (PERIODIC if dimension == 2 else "[material]" + SPHERES)
    text += f"[mesh]\nsize = {size}\ndivisions = {[2, 1, 2][:dimension]}\nelement = '{element}'\n"
    for axis, (low, high) in enumerate(ENDS[dimension]):
        last = axis == dimension - 1
        text += f"[[displacement]]\non = '{low}'\ncomponent = '{'xyz'[axis]}'\nvalue = 0.0\n"
        text += f"[[displacement]]\non = '{high}'\ncomponent = '{'xyz'[axis]}'\nvalue = {-SHORTENING * last}\n"
    return text


class VtkFiles(unittest.TestCase):
    def read(self, reader, path):
        errors = []
        reader.AddObserver("ErrorEvent", lambda *_: errors.append(path))
        reader.SetFileName(str(path))
        reader.Update()
        self.assertEqual(errors, [])
        return reader.GetOutput()

    def check(self, element, dimension, nodes):
        place = Place()
        self.addCleanup(place.temporary.cleanup)
        status, _, err = place.run("solve", place.write("s.toml", scene(element, dimension)), "--output", "out")
        self.assertEqual(status, 0, err)
        grid = self.read(vtkXMLUnstructuredGridReader(), place.path / "out/s_mesh_0001.vtu")
        self.assertEqual(grid.GetCell(0).GetNumberOfPoints(), nodes)
        sizes = vtkCellSizeFilter()
        sizes.SetInputData(grid)
        sizes.Update()
        found = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Area" if dimension == 2 else "Volume"))
        size = SIZES[dimension]
        expected = size[0] * size[1] * (size[2] if dimension == 3 else 1)
        expected *= 1 - SHORTENING / size[-1]
        self.assertGreater(found.min(), 0)
        self.assertAlmostEqual(found.sum(), expected, delta=1e-9)
        # A uniform strain: the nodes move in proportion to where they are.
        moved = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
        place_now = vtk_to_numpy(grid.GetPoints().GetData())
        before = place_now - moved
        last = dimension - 1
        self.assertLess(abs(moved[:, last] + SHORTENING / size[-1] * before[:, last]).max(), 1e-9)
        stress = vtk_to_numpy(grid.GetCellData().GetArray("stress"))
        self.assertEqual(stress.shape[1], dimension ** 2)
        self.assertLess(stress[:, -1].max(), 0)
        points = self.read(vtkXMLPolyDataReader(), place.path / "out/s_points_0001.vtp")
        self.assertEqual(points.GetNumberOfPoints() % grid.GetNumberOfCells(), 0)
        self.assertEqual(points.GetPointData().GetArray("deformation").GetNumberOfComponents(), dimension ** 2)

    def test_plane_elements(self):
        for element, nodes in (("q4", 4), ("q4fbar", 4), ("q4r", 4), ("q8", 8), ("t3", 3), ("t6", 6)):
            with self.subTest(element):
                self.check(element, 2, nodes)

    def test_solid_elements(self):
        for element, nodes in (("hex8", 8), ("hex8fbar", 8), ("hex20", 20), ("tet10", 10)):
            with self.subTest(element):
                self.check(element, 3, nodes)


if __name__ == "__main__":
    unittest.main()
