// What a material file says about the boundary of the representative volume.
#pragma once

namespace grainlaw {

enum class BoundaryType { periodic_cell, frame_p };
enum class BoundaryMethod { direct, servo };
enum class ContactWeight { copies, one };

// The published servo, Liu, Bosco & Suiker (2017) Tables 2-4. The gains are per particle and scale
// with 1/M, as there; here they are dimensionless, stated for the lightest boundary particle:
// g_a = gain_force / kn, g_m = gain_moment / (kn R^2). Table 4 means about 0.25 and 0.5.
struct ServoOptions {
  double gain_force = 0.2;      // stable below 0.3 [-]
  double gain_moment = 0.4;     // [-]
  double inheritance = 1;       // n_f; 0 is the algorithm without prediction (Table 3) [-]
  double tolerance = 1e-6;      // eps_a on the residual r_a (Table 2, 1.5.A) [-]
  int max_corrections = 20000;  // per increment [-]
};

struct BoundaryOptions {
  BoundaryType type = BoundaryType::periodic_cell;
  BoundaryMethod method = BoundaryMethod::direct;
  ContactWeight weight = ContactWeight::copies;  // 1 / copies of a contact on a side, or 1
  ServoOptions servo;
};

}  // namespace grainlaw
