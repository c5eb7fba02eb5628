#include "app/gnuplot.hpp"

#include "app/atomic_file.hpp"
#include "app/filter.hpp"
#include "app/text.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

namespace verification {
namespace {

// Mends XML: gnuplot escapes only & and <, but "]]>" and most control characters are not allowed.
std::string well_formed(const std::string& svg) {
  std::string result;
  for (const char c : svg) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '>' && result.ends_with("]]"))
      result += "&gt;";
    else if (code < 0x20 && c != '\t' && c != '\n' && c != '\r')
      result += "\xEF\xBF\xBD";
    else
      result += c;
  }
  return result;
}

}  // namespace

bool run_gnuplot(const std::string& body, const std::filesystem::path& stem, int width,
                 int height) {
  const std::string text = terminal_text(body);  // bytes that are no UTF-8 as \xff
  for (const std::string kind : {"svg", "png"}) {
    // Without gnuplotrc and ~/.gnuplot.
    const std::optional<std::string> picture =
        filter({"gnuplot", "-d"}, "gnuplot-nox",
               fmt::format("set encoding utf8\nset terminal {} size {},{} font 'DejaVu Sans,14' "
                           "background '#ffffff'\n{}",
                           kind == "svg" ? "svg" : "pngcairo", width, height, text),
               stem);
    if (!picture) return false;
    write_file(stem.string() + "." + kind, kind == "svg" ? well_formed(*picture) : *picture);
  }
  return true;
}

}  // namespace verification
