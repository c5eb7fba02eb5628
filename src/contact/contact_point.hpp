// One contact: forces and stiffness in its own frame, and energy of its springs. Functions are
// overloaded by the dimension of the list: contact_point(), contact_stiffness(), contact_moment()
// and stored_energy().
#pragma once

#include "contact/disc_point.hpp"
#include "contact/sphere_moment.hpp"
#include "contact/sphere_point.hpp"
