// Half contacts of a plain law with friction: each contact listed at both its nodes.
#pragma once

#include "contact/disc_sides.hpp"
#include "contact/sphere_sides.hpp"
