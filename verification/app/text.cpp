#include "app/text.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <iterator>

namespace verification {
namespace {

constexpr std::uint32_t wrong = 0xFFFF;  // stands for bytes outside UTF-8

// Removes and returns the first character of `text`.
std::uint32_t take_character(std::string_view& text) {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(text[k]); };
  const std::uint8_t first = byte(0);
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xC2 ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  std::uint32_t character = size > 1 ? first & (0x7FU >> size) : first;
  bool valid = size > 0 && size <= text.size();
  for (std::size_t k = 1; valid && k < size; ++k) {
    valid = (byte(k) & 0xC0U) == 0x80;
    character = character << 6 | (byte(k) & 0x3FU);
  }
  valid = valid && (size < 3 || character >= (size == 3 ? 0x800U : 0x10000U)) &&
          (character < 0xD800 || character > 0xDFFF) && character <= 0x10FFFF;
  text.remove_prefix(valid ? size : 1);
  return valid ? character : wrong;
}

bool is_control(std::uint32_t character) {
  return character < 0x20 || (character >= 0x7F && character < 0xA0) ||
         (character & 0xFFFEU) == 0xFFFE;
}

// Calls see(character, its bytes) for each character.
template <class See>
void each_character(std::string_view text, See&& see) {
  while (!text.empty()) {
    const std::string_view before = text;
    const std::uint32_t character = take_character(text);
    see(character, before.substr(0, before.size() - text.size()));
  }
}

}  // namespace

std::string gnuplot_text(std::string_view text) {
  // Only the quote is special between single quotes; a line break must not end a command.
  std::string result = "'";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\'')
      result += "''";
    else if (code == 0)
      result += ' ';
    else if (code < 0x20 || code == 0x7F)
      fmt::format_to(std::back_inserter(result), "'.\"\\{:03o}\".'", code);
    else
      result += c;
  }
  return result + "'";
}

std::string xml_text(std::string_view text) {
  std::string result;
  each_character(text, [&](std::uint32_t character, std::string_view bytes) {
    if (character == '&')
      result += "&amp;";
    else if (character == '<')
      result += "&lt;";
    else if (character == '>')
      result += "&gt;";
    else if (character == '"')
      result += "&quot;";
    else if (character == '\t' || character == '\n' || character == '\r')
      fmt::format_to(std::back_inserter(result), "&#{};", character);
    else if (character < 0x20 || (character & 0xFFFEU) == 0xFFFE)
      result += "\xEF\xBF\xBD";
    else
      result += bytes;
  });
  return result;
}

std::string shell_text(std::string_view text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos)
    return std::string(text);
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string terminal_text(std::string_view text) {
  std::string result;
  each_character(text, [&](std::uint32_t character, std::string_view bytes) {
    if (character == '\n' || !is_control(character)) {
      result += bytes;
    } else {
      for (const char c : bytes)
        fmt::format_to(std::back_inserter(result), "\\x{:02x}", static_cast<unsigned char>(c));
    }
  });
  return result;
}

bool is_file_name(std::string_view text) {
  if (text.empty() || text.find('/') != std::string_view::npos ||
      text.find("..") != std::string_view::npos || text == ".")
    return false;
  bool printable = true;
  each_character(text, [&](std::uint32_t character, std::string_view) {
    printable = printable && !is_control(character);
  });
  return printable;
}

}  // namespace verification
