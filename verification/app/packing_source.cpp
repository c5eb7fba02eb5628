#include "app/packing_source.hpp"

namespace verification {

MaterialSource with_packing(const MaterialSource& source, const std::filesystem::path& prefix) {
  MaterialSource result = unfold(source);
  const std::string stem = std::filesystem::absolute(prefix).string();
  result.changes.insert_or_assign("packing", toml::table{{"particles", stem + "_particles.csv"},
                                                         {"contacts", stem + "_contacts.csv"},
                                                         {"cell", stem + "_cell.csv"}});
  return result;
}

}  // namespace verification
