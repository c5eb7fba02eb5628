// A rectangle of linear triangles for the example: cells cut from bottom left to top right.
#pragma once

#include <deal.II/grid/tria.h>

#include <array>
#include <vector>

inline void make_triangles(dealii::Triangulation<2>& mesh, const std::array<double, 2>& size,
                           const std::array<unsigned, 2>& divisions) {
  const auto [columns, rows] = divisions;
  std::vector<dealii::Point<2>> vertices;
  for (unsigned j = 0; j <= rows; ++j)
    for (unsigned i = 0; i <= columns; ++i)
      vertices.emplace_back(size[0] * i / columns, size[1] * j / rows);
  std::vector<dealii::CellData<2>> cells;
  const auto add = [&](unsigned a, unsigned b, unsigned c) {
    cells.emplace_back(3);
    cells.back().vertices = {a, b, c};
  };
  for (unsigned j = 0; j < rows; ++j)
    for (unsigned i = 0; i < columns; ++i) {
      const unsigned first = j * (columns + 1) + i;
      const unsigned above = first + columns + 1;
      add(first, first + 1, above + 1);
      add(first, above + 1, above);
    }
  mesh.create_triangulation(vertices, cells, dealii::SubCellData());
}
