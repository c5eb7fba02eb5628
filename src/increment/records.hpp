// Particles between their coordinates and the records that the loops over contacts read, by overloads
// for the records' dimension.
#pragma once

#include "increment/disc_records.hpp"
#include "increment/sphere_records.hpp"
