// What the fuzz targets share: files in memory, bounds on the work that an input asks for, small
// materials.
#pragma once

#include <toml++/toml.h>

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

// Ends the process with the place, which libFuzzer reports with the input. Not assert, which optimised
// builds leave out.
#define EXPECT(condition)                                                           \
  do {                                                                              \
    if (!(condition)) {                                                             \
      std::fprintf(stderr, "%s:%d: expected %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                 \
    }                                                                               \
  } while (false)

namespace fuzz {

// A file with a path that is nowhere on the disk.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("fuzz", 0)) { EXPECT(descriptor_ >= 0); }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void write(std::string_view content) const {
    EXPECT(ftruncate(descriptor_, 0) == 0);
    EXPECT(pwrite(descriptor_, content.data(), content.size(), 0) ==
           static_cast<ssize_t>(content.size()));
  }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

// The text up to the next line of three dashes, which is taken away with it.
inline std::string_view next_part(std::string_view& text) {
  constexpr std::string_view separator = "---\n";
  const std::size_t end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + separator.size());
  return part;
}

inline bool has_large_integer(const toml::node& node) {
  constexpr std::int64_t largest = 40;
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      if (has_large_integer(value)) return true;
  } else if (const auto* array = node.as_array()) {
    for (const auto& value : *array)
      if (has_large_integer(value)) return true;
  }
  const auto integer = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
  return integer && (*integer > largest || *integer < -largest);
}

// Integers are numbers of discs, elements, steps: larger ones ask for work, not for other code.
inline bool asks_for_much(std::string_view text) {
  const toml::parse_result parsed = toml::parse(text);
  return parsed && has_large_integer(parsed.table());
}

// Six discs in two rows of three that touch six others each, under 100 kPa.
inline std::string lattice(const std::string& contact, const std::string& more = {}) {
  return "dimension = 2\nthickness = 0.1\n"
         "packing = { generator = 'hexagonal', columns = 3, rows = 2, radius = 5e-3, pressure = "
         "1e5, "
         "radius_spread = 0.02, seed = 1 }\n"
         "contact = { " +
         contact + " }\n" + more;
}
inline const std::string frictional =
    "law = 'frictional', young = 6e8, ratio = 0.8, friction = 0.5";
inline const std::string bonded =
    "law = 'bonded', young = 6e8, ratio = 0.8, friction = 0.5, rolling = { ratio = 1.0, friction = "
    "0.1 }, bond = { normal_strength = 300.0, "
    "tangential_strength = 200.0, bending_stiffness = 10.0, bending_strength = 0.5, "
    "gap = 1e-4 }";
inline const std::string layer =
    "[boundary]\ntype = 'mixed'\nleft = { x = 'P', y = 'P', rotation = 'periodic' }\n"
    "right = { x = 'P', y = 'P', rotation = 'periodic' }\nstress = { P22 = -1e5 }\n"
    "bottom = { x = 'D', y = 'D', rotation = 'fixed', row = 'rigid' }\n"
    "top = { x = 'D', y = 'D', rotation = 'fixed', row = 'rigid' }\n";
inline const std::string hertz =
    "law = 'hertz', shear_modulus = 3e8, poisson = 0.2, friction = 0.5";

}  // namespace fuzz
