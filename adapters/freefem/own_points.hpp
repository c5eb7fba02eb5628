// Points of the elements that a rank owns, and what FreeFEM's functions are there. Read by the plugin
// alone.
#pragma once

#include <ff++.hpp>

#include <stdexcept>
#include <vector>

namespace grainlaw_freefem {

// The points in the reference element, in the order of the numbers of a space of Element_QF.
inline std::vector<R2> points_of_element(const FESpace& Q) {
  const TypeOfFE& element = *Q.TFE[0];
  const KN<R2>& places = element.Pi_h_R2();
  if (Q.N != 1 || element.NbDoF != places.N())
    throw std::invalid_argument("expected a space of points, of Element_QF");
  std::vector<R2> points(static_cast<std::size_t>(element.NbDoF));
  const auto& of = element.Ph_ijalpha();
  for (long k = 0; k < of.N(); ++k) points[static_cast<std::size_t>(of[k].i)] = places[of[k].p];
  return points;
}

inline std::vector<R3> points_of_element(const FESpace3& Q) {
  const auto& element = *Q.TFE[0];
  if (Q.N != 1 || element.NbDoF != element.NbPtforInterpolation)
    throw std::invalid_argument("expected a space of points, of Element_QF");
  std::vector<R3> points(static_cast<std::size_t>(element.NbDoF));
  for (int k = 0; k < element.NbcoefforInterpolation; ++k)
    points[static_cast<std::size_t>(element.dofInterpolation[k])] =
        element.PtInterpolation[element.pInterpolation[k]];
  return points;
}

inline void shapes(const FElement& K, const R2& at, int derivative, RNMK& values) {
  bool what[last_operatortype];
  initwhatd(what, derivative);
  K.BF(what, at, values);
}

inline void shapes(const FElement3& K, const R3& at, int derivative, RNMK& values) {
  K.BF(Fwhatd(static_cast<operatortype>(derivative)), at, values);
}

// A rank owns the elements rank, rank + ranks, ...: neighbours, which cost the same, go to different
// ranks.
template <class Space>
long elements_of(const Space& V, long rank, long ranks) {
  if (ranks < 1 || rank < 0 || rank >= ranks)
    throw std::invalid_argument("rank " + std::to_string(rank) + " of " + std::to_string(ranks));
  return (V.NbOfElements - rank + ranks - 1) / ranks;
}

// Numbers of a rank's points in the space.
template <class Space>
void own_points(const Space& Q, long rank, long ranks, KN<long>& numbers) {
  const auto per = static_cast<long>(points_of_element(Q).size());
  numbers.resize(elements_of(Q, rank, ranks) * per);
  long k = 0;
  for (long e = rank; e < Q.NbOfElements; e += ranks) {
    const auto element = Q[static_cast<int>(e)];
    for (int q = 0; q < per; ++q) numbers[k++] = element(q);
  }
}

// Values of the shape functions of V at a rank's points (row: the point's place among them; column:
// the number in V), or their derivatives along the axis 1, 2 or 3.
template <class Space>
void own_rows(const Space& V, const Space& Q, long rank, long ranks, long axis, KN<long>& row,
              KN<long>& column, KN<double>& value) {
  if (&V.Th != &Q.Th || V.N != 1)
    throw std::invalid_argument("expected a space of one component, on the mesh of the points");
  if (axis < 0 || axis > 3)
    throw std::invalid_argument("axis " + std::to_string(axis) + ", expected 0 to 3");
  const int kinds[] = {op_id, op_dx, op_dy, op_dz};
  const int derivative = kinds[axis];
  const auto places = points_of_element(Q);
  const int shared = V.TFE[0]->NbDoF;
  const long entries = elements_of(V, rank, ranks) * static_cast<long>(places.size()) * shared;
  row.resize(entries);
  column.resize(entries);
  value.resize(entries);
  RNMK values(shared, 1, last_operatortype);
  long k = 0, point = 0;
  for (long e = rank; e < V.NbOfElements; e += ranks) {
    const auto element = V[static_cast<int>(e)];
    for (const auto& place : places) {
      values = 0.;
      shapes(element, place, derivative, values);
      for (int i = 0; i < shared; ++i, ++k) {
        row[k] = point;
        column[k] = element(i);
        value[k] = values(i, 0, derivative);
      }
      ++point;
    }
  }
}

}  // namespace grainlaw_freefem
