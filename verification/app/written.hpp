// Files that a run has written, for the user.
#pragma once

#include "app/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Files that begin with the same stem.
class Written {
 public:
  explicit Written(const std::filesystem::path& stem) : stem_(stem.string()) {}

  void add(const std::string& end) {
    if (std::find(ends_.begin(), ends_.end(), end) == ends_.end()) ends_.push_back(end);
  }
  // Adds stem.svg and stem.png.
  void add_pictures(bool drawn) {
    if (!drawn) return;
    add(".svg");
    add(".png");
  }
  [[nodiscard]] std::string text() const {
    return ends_.empty() ? "wrote nothing"
                         : fmt::format("wrote {}{}", terminal_text(stem_), fmt::join(ends_, ", "));
  }

 private:
  std::string stem_;
  std::vector<std::string> ends_;
};

}  // namespace verification
