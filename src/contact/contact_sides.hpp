// The contacts of a plain law with friction, each from both its sides.
#pragma once

#include "contact/disc_sides.hpp"
#include "contact/sphere_sides.hpp"
