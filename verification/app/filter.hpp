// Pictures that other programs make: a text goes in, bytes come out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace verification {

// What a program, its arguments after it, makes of a text: without a shell, without files. Else says
// on stderr why there is no such picture, and in which Debian package the program is.
std::optional<std::string> filter(std::vector<std::string> command, const char* package,
                                  const std::string& text, const std::filesystem::path& picture);

}  // namespace verification
