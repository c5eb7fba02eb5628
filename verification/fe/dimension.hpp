// Dispatch between discs and spheres.
#pragma once

namespace verification {

// Calls the function template for 2 or 3: in_dimension(d, [&]<int D>() { ... }).
template <class Function>
decltype(auto) in_dimension(int dimension, Function&& function) {
  return dimension == 2 ? function.template operator()<2>() : function.template operator()<3>();
}

}  // namespace verification
