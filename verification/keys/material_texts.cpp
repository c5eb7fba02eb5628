#include "keys/keys.hpp"

namespace verification {
namespace {

constexpr KeyText texts[] = {
    {"dimension", "-", "of the packing"},
    {"thickness", "m",
     "of discs; may be left to the cell file, with which it has to agree; not with spheres"},

    {"packing.generator", "",
     "makes a packing, see [packings](#packings); else `particles` and `cell` name files"},
    {"packing.particles", "", "table of particles, see [files of a packing](#files-of-a-packing)"},
    {"packing.contacts", "",
     "table of contacts to start from these forces, of the same contact stiffness; without it "
     "contacts are found and the packing relaxed"},
    {"packing.cell", "", "table of the cell"},
    {"packing.density", "kg/m3",
     "of the particles; `solver.inertia`, the reference methods and dynamics use it, nothing else"},
    {"packing.count", "-", "particles, of compaction and growth"},
    {"packing.radii", "m", "uniform by number between the two, of compaction and growth"},
    {"packing.seed", "-", "of chance: the same seed makes the same packing"},
    {"packing.pressure", "Pa", "to which the packing is brought, compression positive"},
    {"packing.void_ratio", "-",
     "to which the packing is brought instead of a pressure; with one, by a friction up to "
     "contact.friction that is found"},
    {"packing.friction", "-", "tan(phi) while the packing is made; 0 makes the densest"},
    {"packing.anisotropy", "-",
     "wanted anisotropy of the contact normals; needs `friction` > 0; -1: as it comes"},
    {"packing.anisotropy_direction", "deg; of spheres -",
     "of most contacts: an angle from axis 1; of spheres a vector [x, y, z]"},
    {"packing.growth_rate", "-", "of radii over the mean speed of particles, of growth"},
    {"packing.volume_fraction", "-",
     "at which growth ends and compression begins, of discs 0.4 to 0.95; 0: when they jam"},
    {"packing.columns", "-",
     "of \"square\" and \"hexagonal\": discs in a row of the cell; a frame has one more"},
    {"packing.rows", "-",
     "of \"square\" and \"hexagonal\": rows of the cell; a frame has one more; even of "
     "\"hexagonal\""},
    {"packing.cells", "-", "of lattices of spheres: unit cells along x, y, z"},
    {"packing.radius", "m", "of lattices"},
    {"packing.overlap", "m",
     "of lattices, instead of a pressure, at most half a radius; 0: particles that just touch"},
    {"packing.radius_spread", "-",
     "of lattices: radii differ by up to this share; a perfect lattice stays affine under any F"},

    {"contact.law", "", "see [contact laws](theory.md#contact-laws)"},
    {"contact.young", "Pa", "kn = young 2 Ri Rj / (Ri + Rj); not of \"hertz\""},
    {"contact.kn", "N/m", "normal stiffness of every contact; not of \"hertz\""},
    {"contact.ratio", "-", "kt / kn, of \"frictional\" and \"bonded\""},
    {"contact.friction", "-", "tan(phi); of bonds after they broke; not of \"compressive\""},
    {"contact.rotation", "", "false: particles do not turn; not of \"compressive\""},
    {"contact.shear_modulus", "Pa", "of \"hertz\": of the particle material"},
    {"contact.poisson", "-", "of \"hertz\": of the particle material"},
    {"contact.rolling.ratio", "-", "kr = ratio kt r^2 with r = 2 Ri Rj / (Ri + Rj)"},
    {"contact.rolling.friction", "-", "the moment is at most friction r fn"},
    {"contact.rolling.twisting_ratio", "-", "of spheres: the same about the branch"},
    {"contact.rolling.twisting_friction", "-", "of spheres: bound of the moment about the branch"},
    {"contact.bond.normal_strength", "N", "tension at which a bond breaks alone"},
    {"contact.bond.tangential_strength", "N", "tangential force at which a bond breaks alone"},
    {"contact.bond.normal_stiffness", "N/m",
     "kn of a bond while it holds; both stiffnesses, or neither: those of the contact"},
    {"contact.bond.tangential_stiffness", "N/m", "kt of a bond while it holds"},
    {"contact.bond.bending_stiffness", "N m/rad", "of a bond against rolling"},
    {"contact.bond.bending_strength", "N m", "moment at which a bond breaks alone"},
    {"contact.bond.torsion_stiffness", "N m/rad", "of spheres: of a bond against twisting"},
    {"contact.bond.torsion_strength", "N m",
     "of spheres: moment of twisting at which a bond breaks alone"},
    {"contact.bond.gap", "m", "particles this far apart are bonded too, at most a diameter"},

    {"boundary.type", "",
     "see [boundary conditions](theory.md#boundary-conditions); spheres have the periodic cell "
     "alone"},
    {"boundary.method", "",
     "\"direct\": solves for the boundary too; \"servo\": the published feedback, of frames"},
    {"boundary.contact_weight", "",
     "of a contact on a side of a frame: \"copies\": 1 over its copies; \"one\": 1"},
    {"boundary.inner_rotation", "",
     "of frames: \"fixed\": inner discs do not turn, those of the boundary as their sides say"},
    {"boundary.servo.gain_force", "-",
     "of \"servo\": share of an unbalanced force that is corrected"},
    {"boundary.servo.gain_moment", "-", "of \"servo\": the same of moments"},
    {"boundary.servo.gain_deformation", "-", "of \"servo\": the same of the mean deformation"},
    {"boundary.servo.inheritance", "-",
     "of \"servo\": share of the last increment that predicts the next"},
    {"boundary.servo.tolerance", "-",
     "of \"servo\": unbalanced boundary force / mean contact force"},
    {"boundary.servo.tolerance_deformation", "-", "of \"servo\": error of the mean deformation"},
    {"boundary.servo.max_corrections", "-", "of \"servo\": then the increment has failed"},
#define SIDE(side)                                                                       \
  {"boundary." side ".x", "", "of \"mixed\": rule of the side along x"},                 \
      {"boundary." side ".y", "", "of \"mixed\": rule along y; without it that of `x`"}, \
      {"boundary." side ".rotation", "",                                                 \
       "of \"mixed\": of the discs of the side; without it it goes with the rules"},     \
  {                                                                                      \
    "boundary." side ".row", "",                                                         \
        "of \"mixed\": \"rigid\": the discs of the side are one straight body"           \
  }
    SIDE("left"),
    SIDE("right"),
    SIDE("bottom"),
    SIDE("top"),
#undef SIDE
    {"boundary.stress.P11", "Pa",
     "of \"mixed\": prescribed, tension positive; F11 is found; at most three components"},
    {"boundary.stress.P12", "Pa", "the same; F12 is found"},
    {"boundary.stress.P21", "Pa", "the same; F21 is found"},
    {"boundary.stress.P22", "Pa", "the same; F22 is found"},

    {"solver.tolerance", "-", "largest residual of a particle / mean contact normal force"},
    {"solver.loose_tolerance", "-",
     "accept an increment at this residual where friction keeps switching, with the tangent of the "
     "contacts as they are; `residual` of the report tells; 0: never"},
    {"solver.start", "",
     "\"committed\": P is a function of the committed state and F; \"trial\": the equilibrium of "
     "the last trial is where the search starts, see [limits](limits.md)"},
    {"solver.method", "",
     "\"direct\": see [how an increment is solved](theory.md#how-an-increment-is-solved); "
     "\"advancing\": relaxation that moves the history on; \"published\": local damping, the "
     "history moves on in every step; \"chain\" is the old word for \"direct\""},
    {"solver.force_floor", "N",
     "residuals are relative to no smaller force, and far smaller ones count as none; 0: 1e-3 of "
     "the mean force at F = I. For packings that start almost without stress; not with \"T\" or a "
     "prescribed stress"},
    {"solver.increment_limit", "-",
     "of the strain increment times kn / (p t), above which an increment is made in parts; with "
     "`viscous_number` only where `viscous_steps` fail"},
    {"solver.contacts_lost", "",
     "\"stress_free\": where no contact carries or all forces fade, P = 0 is an answer, and so is "
     "its tangent"},
    {"solver.viscous_number", "-",
     "a law in time, without jumps: strain rate times memory, the strain over which drag remembers "
     "how particles moved; 1e-3 is recommended; 0: equilibrium"},
    {"solver.viscous_rate", "1 / time of the host",
     "strain rate that `viscous_number` is meant at: the memory lasts viscous_number / "
     "viscous_rate, and the host has to tell its time step (`grainlaw_state_set_time_step`), or "
     "the first increment is refused; 0: the strain is the time"},
    {"solver.viscous_steps", "-", "parts of an increment with `viscous_number`"},
    {"solver.inertia", "",
     "fluctuations have the mass of the particles, by `packing.density`, for waves: the host has "
     "to tell its time step in s, and an increment is one step; not with \"T\", a prescribed "
     "stress or `viscous_number`"},
    {"solver.published.damping", "-", "of \"published\": local damping"},
    {"solver.published.time_step_ratio", "-", "of \"published\": time step / critical one"},
    {"solver.published.energy_tolerance", "-",
     "of \"published\": kinetic over elastic energy at the end; 0: not asked for"},
    {"solver.published.max_steps", "-", "of \"published\": then the increment has failed"},
};

}  // namespace

std::span<const KeyText> material_key_texts() { return texts; }

}  // namespace verification
