// The packings as they are made, before the isotropic compression, by the paper's own counts.

#include "evidence/papers/liu2019_biaxial/biaxial.hpp"
#include "pack/written.hpp"

#include <fmt/format.h>

namespace verification {

// Copies are particles of their own, with the contacts within the frame; each contact counts alike in
// the fabric (section 4.1, eq. 38 and 39).
void count_made_packings(PaperStudy& study) {
  for (const char* name : {"packing", "packing_across_005", "packing_across_008"}) {
    const std::filesystem::path prefix = study.results / name;
    if (!std::filesystem::exists(prefix.string() + "_contacts.csv")) continue;
    const WrittenPacking packing = read_written(prefix.string());
    Eigen::Matrix2d fabric = Eigen::Matrix2d::Zero();
    for (const WrittenContact& contact : packing.contacts) {
      const Eigen::Vector2d normal = packing.branch(contact).normalized();
      fabric += normal * normal.transpose();
    }
    const Eigen::Vector2d eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(fabric).eigenvalues();
    const auto particles = static_cast<double>(packing.radius.size());
    const auto contacts = static_cast<double>(packing.contacts.size());
    study.facts.add(fmt::format("made.{}.particles", name), particles);
    study.facts.add(fmt::format("made.{}.coordination", name), 2 * contacts / particles);
    study.facts.add(fmt::format("made.{}.anisotropy", name), eigenvalues[1] / eigenvalues[0] - 1);
  }
}

}  // namespace verification
