// Conversion of particles between coordinates and records, overloaded by dimension.
#pragma once

#include "increment/disc_records.hpp"
#include "increment/sphere_records.hpp"
