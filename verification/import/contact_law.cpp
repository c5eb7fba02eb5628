#include "import/contact_law.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

namespace verification {

toml::table contact_table(const ImportArguments& arguments, const ForeignPacking& packing,
                          std::vector<std::string>& notes) {
  const FoundStiffness found = found_stiffness(packing);
  toml::table contact{{"law", "frictional"}};
  const auto rounded = [](double value) { return std::stod(fmt::format("{:.8g}", value)); };
  if (arguments.young > 0) {
    contact.insert("young", arguments.young);
  } else if (arguments.kn > 0) {
    contact.insert("kn", arguments.kn);
  } else if (found.young > 0) {
    contact.insert("young", rounded(found.young));
    notes.push_back(fmt::format("young = {:.8g} Pa, from the contacts in the file", found.young));
  } else if (found.kn > 0) {
    contact.insert("kn", rounded(found.kn));
    notes.push_back(fmt::format("kn = {:.8g} N/m, from the contacts in the file", found.kn));
  } else if (arguments.pressure > 0 && !packing.has_contacts) {
    contact.insert("young", 1e8);  // until the pressure is known
  } else {
    throw InputError(
        fmt::format("{}: found {}, expected how stiff contacts are: --young (Pa) or --kn (N/m){}, "
                    "or --material FILE",
                    arguments.files.particles,
                    packing.has_contacts
                        ? "forces that are neither young 2RiRj/(Ri+Rj) nor one kn times the overlap"
                        : "no forces",
                    packing.has_contacts
                        ? ""
                        : ", or the --pressure (Pa) under which particles overlap as they do"));
  }
  double ratio = arguments.ratio;
  if (ratio < 0 && found.ratio > 0) {
    ratio = rounded(found.ratio);
    notes.push_back(fmt::format("ratio = {:.8g}, kt / kn of the contacts in the file", ratio));
  } else if (ratio < 0) {
    ratio = 0.8;
    notes.emplace_back("ratio = 0.8 [-] is assumed for kt / kn; --ratio tells another");
  }
  double friction = arguments.friction;
  if (friction < 0) {
    friction = 0.5;
    notes.emplace_back(
        "friction = 0.5 [-] is assumed, tan(26.6 degrees); --friction tells another");
  }
  contact.insert("ratio", ratio);
  contact.insert("friction", friction);
  return contact;
}

}  // namespace verification
