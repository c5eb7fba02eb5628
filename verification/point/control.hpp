// What a path prescribes at a point, and its derivative with respect to F.
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

// Of stresses their values, else the component of F. A stress that is to equal another one is their
// difference.
template <int D>
Controlled<D> controlled(const Conditions<D>& conditions, const TensorOf<D>& deformation,
                         const EvaluationOf<D>& evaluation);

// F with the components of the diagonal that follow multiplied by one factor, so that its determinant
// is this one. F at which none is stays as it comes out: it is refused when it is evaluated.
template <int D>
TensorOf<D> with_volume(TensorOf<D> deformation, const std::array<bool, 3>& follows,
                        double determinant);

// Rows of `derivative` of the components that follow: of the first of them det F, of the others the
// difference from the first, over their values at the start; rows beside them stay.
template <int D>
void follow_volume(TangentOf<D>& derivative, const TensorOf<D>& deformation,
                   const std::array<bool, 3>& follows);

}  // namespace verification
