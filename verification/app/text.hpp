// Text of users inside other languages, where all of it stays text; and as the name of a file.
#pragma once

#include <string>
#include <string_view>

namespace verification {

// A string expression of gnuplot. Shown literally where the command says `noenhanced`.
std::string gnuplot_text(std::string_view text);

// Content or attribute of XML. What XML cannot hold at all, most control characters, becomes U+FFFD.
std::string xml_text(std::string_view text);

// A field of a comma-separated table (RFC 4180): in quotes where it has to be.
std::string csv_field(std::string_view text);

// One word of a shell's command.
std::string shell_text(std::string_view text);

// For a terminal: control characters but line breaks as \x1b, so that they do nothing there.
std::string terminal_text(std::string_view text);

// Whether results can be called by it: UTF-8 without "/", ".." and control characters, not empty.
bool is_file_name(std::string_view text);
inline constexpr const char* file_name_rule =
    "a name for files: not empty, without \"/\", \"..\" and control characters";

}  // namespace verification
