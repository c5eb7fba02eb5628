// grainlaw in deal.II 9.4: the quadrature points of a mesh as one set, and Newton's method over them, on
// any number of ranks of MPI. Functions are calls of all ranks together, and throw StatusError on all.
#pragma once

#include <grainlaw/dealii/newton.hpp>
#include <grainlaw/dealii/points.hpp>
#include <grainlaw/dealii/ranks.hpp>
#include <grainlaw/dealii/refinement.hpp>
