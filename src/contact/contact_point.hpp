// One contact: its forces and stiffness in its own frame, and what its springs hold; by overloads of
// contact_point(), contact_stiffness(), contact_moment() and stored_energy() for the list's dimension.
#pragma once

#include "contact/disc_point.hpp"
#include "contact/sphere_moment.hpp"
#include "contact/sphere_point.hpp"
