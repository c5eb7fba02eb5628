// What a program says last on its error stream, here FreeFEM: with which code it ends. A plugin is
// not told it in any other way.
#pragma once

#include <charconv>
#include <streambuf>
#include <string>
#include <string_view>

namespace grainlaw_freefem {

// Passes on what is written, and keeps the end of it.
class LastWords : public std::streambuf {
 public:
  explicit LastWords(std::streambuf* to) : to_(to) {}
  [[nodiscard]] std::streambuf* to() const { return to_; }

  // Code of the error, or of exit(n), by which the script ends; 0: there is none.
  [[nodiscard]] int code() const {
    constexpr std::string_view before = " err code ", after = " ,  mpirank ";
    if (end_.find(after) == std::string::npos) return 0;
    if (end_.find("Strange catch exception") != std::string::npos) return 1;  // no memory
    int code = 0;
    const std::size_t line = end_.rfind(before);
    if (line == std::string::npos) return 0;
    const char* const number = end_.data() + line + before.size();
    std::from_chars(number, end_.data() + end_.size(), code);
    return code;
  }

 protected:
  int_type overflow(int_type character) override {
    if (traits_type::eq_int_type(character, traits_type::eof())) return sync();
    const char one = traits_type::to_char_type(character);
    return xsputn(&one, 1) == 1 ? character : traits_type::eof();
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    end_.append(text, static_cast<std::size_t>(size));
    if (end_.size() > longest) end_.erase(0, end_.size() - longest);
    return to_->sputn(text, size);
  }
  int sync() override { return to_->pubsync(); }

 private:
  static constexpr std::size_t longest = 100;

  std::streambuf* to_;
  std::string end_;
};

}  // namespace grainlaw_freefem
