// Escaping of users' texts for other languages and for file names.
#pragma once

#include <string>
#include <string_view>

namespace verification {

// A gnuplot string expression, literal where the command says `noenhanced`.
std::string gnuplot_text(std::string_view text);

// Content or attribute of XML. Characters that XML excludes, most control characters, become
// U+FFFD.
std::string xml_text(std::string_view text);

// One word of a shell command.
std::string shell_text(std::string_view text);

// Text for a terminal: control characters except line breaks as \x1b.
std::string terminal_text(std::string_view text);

// Whether a text may name files: not empty, UTF-8, without "/", ".." and control characters.
bool is_file_name(std::string_view text);
inline constexpr const char* file_name_rule =
    "a name for files: not empty, without \"/\", \"..\" and control characters";

}  // namespace verification
