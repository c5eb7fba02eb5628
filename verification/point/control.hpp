// Quantities that a path prescribes at a point, and their derivatives by F.
#pragma once

#include "app/library.hpp"
#include "point/path.hpp"

#include <array>

namespace verification {

// The prescribed measure by component, and its derivative.
template <int D>
struct Controlled {
  ComponentsOf<D> value;
  TangentOf<D> derivative;
};

template <int D>
using Conditions = std::array<Target, D * D>;

template <int D>
Conditions<D> conditions_of(const Segment& segment);

// The controlled quantity per component: a stress where one is prescribed, else the component of F.
// A stress that equals another one is controlled by their difference.
template <int D>
Controlled<D> controlled(const Conditions<D>& conditions, const TensorOf<D>& deformation,
                         const EvaluationOf<D>& evaluation);

// Scales the diagonal components that follow by one factor, so that det F becomes this volume. An F
// without such a factor is returned unchanged; its evaluation will refuse it.
template <int D>
TensorOf<D> with_volume(TensorOf<D> deformation, const std::array<bool, 3>& follows,
                        double determinant);

// Replaces the rows of components that follow: the first by det F, the others by their difference
// from the first, over the values at the start.
template <int D>
void follow_volume(TangentOf<D>& derivative, const TensorOf<D>& deformation,
                   const std::array<bool, 3>& follows);

}  // namespace verification
