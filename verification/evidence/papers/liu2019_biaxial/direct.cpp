// Multi-scale against direct simulations A and B: is it within their difference before the peak?

#include "evidence/papers/liu2019_biaxial/biaxial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

constexpr double strain_step = 0.0025;

// Differences of the stress ratio over the strains before the first peak of the three.
struct Comparison {
  int strains = 0, within = 0;         // within: |MS - A| or |MS - B| at most |A - B|
  double ms_a = 0, ms_b = 0, a_b = 0;  // root mean squares
  // From 2 B - A: what A and B lead to when the error of a specimen goes with its surface over its
  // volume, which B halves.
  double ms_limit = 0;
  double until = 0;
};

Comparison compare(const Biaxial& ms, const Biaxial& a, const Biaxial& b,
                   const std::string& packing, Table& table) {
  Comparison c;
  c.until = std::min({ms.strain[ms.peak()], a.strain[a.peak()], b.strain[b.peak()]});
  for (double strain = strain_step; strain <= c.until + 1e-9; strain += strain_step) {
    const double m = ms.ratio_at(strain), ra = a.ratio_at(strain), rb = b.ratio_at(strain);
    const double ma = std::abs(m - ra), mb = std::abs(m - rb), ab = std::abs(ra - rb);
    const bool within = std::min(ma, mb) <= ab;
    table.row({packing, strain, m, ra, rb, ma, mb, ab, within ? "yes" : "no"});
    ++c.strains;
    c.within += within ? 1 : 0;
    c.ms_a += ma * ma;
    c.ms_b += mb * mb;
    c.a_b += ab * ab;
    c.ms_limit += (m - 2 * rb + ra) * (m - 2 * rb + ra);
  }
  for (double* sum : {&c.ms_a, &c.ms_b, &c.a_b, &c.ms_limit})
    *sum = std::sqrt(*sum / std::max(c.strains, 1));
  return c;
}

// Mean and spread over the packings at one strain.
struct Spread {
  double mean = 0, deviation = 0;
};

Spread deviation_of(const std::vector<double>& values) {
  Spread s;
  for (const double value : values) s.mean += value / static_cast<double>(values.size());
  double square = 0;
  for (const double value : values) square += (value - s.mean) * (value - s.mean);
  s.deviation = values.size() > 1 ? std::sqrt(square / static_cast<double>(values.size() - 1)) : 0;
  return s;
}

}  // namespace

void compare_with_direct(PaperStudy& study) {
  Table strains("Stress ratio before the peak, strain by strain",
                {"packing", "strain[-]", "MS[-]", "A[-]", "B[-]", "abs(MS-A)[-]", "abs(MS-B)[-]",
                 "abs(A-B)[-]", "within"});
  Table summary("Stress ratio before the peak: root mean squares of differences",
                {"packing", "until_strain[-]", "MS-A[-]", "MS-B[-]", "A-B[-]", "MS-(2B-A)[-]",
                 "strains_within[-]", "strains[-]", "peak_MS[-]", "peak_A[-]", "peak_B[-]"});
  struct Triple {
    Biaxial ms, a, b;
  };
  std::vector<Triple> packings;
  const auto add = [&](const std::string& packing, const std::string& ms, const std::string& a,
                       const std::string& b, bool own) {
    const auto m = load_biaxial(study, ms), ra = load_biaxial(study, a),
               rb = load_biaxial(study, b);
    if (!m || !ra || !rb) return;
    const Comparison c = compare(*m, *ra, *rb, packing, strains);
    summary.row({packing, c.until, c.ms_a, c.ms_b, c.a_b, c.ms_limit, static_cast<double>(c.within),
                 static_cast<double>(c.strains), m->ratio[m->peak()], ra->ratio[ra->peak()],
                 rb->ratio[rb->peak()]});
    const auto fact = [&](const char* name, double value) {
      std::string which = packing;
      std::replace(which.begin(), which.end(), ' ', '_');
      study.facts.add(fmt::format(fmt::runtime(name), which), value);
    };
    fact("direct.{}.rms_to_b", c.ms_b);
    fact("direct.{}.rms_a_to_b", c.a_b);
    fact("direct.{}.until", c.until);
    if (own) packings.push_back({*m, *ra, *rb});
  };
  for (const char* mesh : {"1x1", "1x2", "2x4", "4x8"})
    add(std::string("mesh ") + mesh, std::string("biaxial_") + mesh, "dns_a", "dns_b", false);
  for (int k = 1; k <= 5; ++k) {
    const std::string stem = fmt::format("dns_packings_{}_", k);
    add(fmt::format("packing {}", k), stem + "rve", stem + "a", stem + "b", true);
  }
  if (!packings.empty()) {
    double over = 0;
    for (const Triple& t : packings)
      over +=
          t.ms.ratio[t.ms.peak()] / t.b.ratio[t.b.peak()] / static_cast<double>(packings.size());
    study.facts.add("direct.packings.peak_over_b_mean", over);
    Table means(
        "Mean over the packings (standard deviation)",
        {"strain[-]", "packings[-]", "MS[-]", "sd_MS[-]", "A[-]", "sd_A[-]", "B[-]", "sd_B[-]"});
    for (double strain = 0.005; strain <= 0.0451; strain += 0.005) {
      std::vector<double> ms, a, b;
      for (const Triple& t : packings) {
        ms.push_back(t.ms.ratio_at(strain));
        a.push_back(t.a.ratio_at(strain));
        b.push_back(t.b.ratio_at(strain));
      }
      const Spread m = deviation_of(ms), sa = deviation_of(a), sb = deviation_of(b);
      means.row({strain, static_cast<double>(packings.size()), m.mean, m.deviation, sa.mean,
                 sa.deviation, sb.mean, sb.deviation});
    }
    means.print();
    means.write(study.results / "direct_means.csv");
    Panel panel{"stress ratio [-]"};
    const auto draw_all = [&](const char* title, const char* colour, auto&& member) {
      for (std::size_t k = 0; k < packings.size(); ++k) {
        const Biaxial& run = member(packings[k]);
        panel.curves.push_back({k == 0 ? title : "", run.strain, run.ratio, colour,
                                k == 0 ? Stroke::solid : Stroke::thin});
      }
    };
    draw_all("DNS A", colour::orange, [](const Triple& t) -> const Biaxial& { return t.a; });
    draw_all("DNS B", colour::green, [](const Triple& t) -> const Biaxial& { return t.b; });
    draw_all("multi-scale", colour::blue, [](const Triple& t) -> const Biaxial& { return t.ms; });
    draw({"Five packings", "axial strain [-]", {panel}}, study.results / "figure_04_packings");
  }
  strains.write(study.results / "direct_strains.csv");
  summary.print();
  summary.write(study.results / "direct_summary.csv");
}

}  // namespace verification
