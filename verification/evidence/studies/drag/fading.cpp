#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace verification::drag {
namespace {

constexpr double farthest = 0.02;  // largest strain
constexpr int increments = 40;     // on the way there, and as many back

template <int D>
struct Path {
  const char* name;
  TensorOf<D> rate;  // F - 1 over the strain
};

template <int D>
std::vector<Path<D>> paths() {
  const TensorOf<D> isotropic = TensorOf<D>::Identity();
  TensorOf<D> axial = TensorOf<D>::Zero();
  axial(D - 1, D - 1) = D;
  TensorOf<D> sheared = isotropic;
  sheared(0, D - 1) = 1;
  return {{"isotropic", isotropic}, {"axial", axial}, {"with shear", sheared}};
}

template <int D>
void expand(Study& study, Findings& findings, const Packing& packing) {
  for (const Path<D>& path : paths<D>()) {
    Host<D> host(study.materials(packing, {.stress_free = true}));
    int failed = 0, fewest = host.report.contacts, without = 0;
    double least = pressure;
    for (int k = 1; k <= 2 * increments; ++k) {
      const int level = k <= increments ? k : 2 * increments - k;
      const double strain = farthest * level / increments;
      if (!host.lead(TensorOf<D>::Identity() + strain * path.rate, 1, 0)) {
        ++failed;
        continue;
      }
      without += host.report.contacts == 0 ? 1 : 0;
      fewest = k == 1 ? host.report.contacts : std::min(fewest, host.report.contacts);
      least = std::min(least, host.p());
    }
    findings.row({packing.name(), path.name, 2.0 * increments, static_cast<double>(fewest),
                  static_cast<double>(without), least / pressure, host.p() / pressure,
                  host.relaxation_steps / host.evaluations, host.milliseconds / host.evaluations},
                 {{static_cast<double>(failed), 0}});
  }
}

}  // namespace

void fade(Study& study) {
  Findings findings(study.options(), "fading",
                    "expansion by 2 % in 40 increments until contacts are lost, and back; "
                    "contacts_lost = \"stress_free\"",
                    {"packing", "path", "increments[-]", "fewest_contacts[-]", "without_any[-]",
                     "least_p[-]", "last_p[-]", "relaxation_steps[-]", "ms[-]"},
                    {{"failed[-]"}});
  std::vector<Packing> packings = discs(study.packings(2), 200);
  for (const Packing& packing : spheres(study.packings(2), 150)) packings.push_back(packing);
  for (const Packing& packing : packings)
    in_dimension(packing.dimension, [&](auto d) { expand<d>(study, findings, packing); });
  findings.print();
}

}  // namespace verification::drag
