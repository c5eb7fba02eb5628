#include "app/own_files.hpp"

#include "app/library.hpp"
#include "io/text_file.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace verification {
namespace {

namespace fs = std::filesystem;

constexpr const char* hidden = ".grainlaw";
constexpr auto whole_file = std::numeric_limits<std::uint64_t>::max();
constexpr std::string_view heading =
    "# What the command grainlaw wrote beside this directory, and may write over: whole files (=) "
    "and\n"
    "# beginnings (+), with bytes, checksum and name.\n";

std::uint64_t checksum(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

// Checksum of the first bytes of a file.
std::uint64_t checksum(const fs::path& path, std::uint64_t length) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  std::ifstream file(path, std::ios::binary);
  std::array<char, 1 << 16> block;
  while (length > 0 && file) {
    file.read(block.data(),
              static_cast<std::streamsize>(std::min<std::uint64_t>(length, block.size())));
    const auto count = static_cast<std::size_t>(file.gcount());
    XXH3_64bits_update(&state, block.data(), count);
    length -= count;
  }
  return XXH3_64bits_digest(&state);
}

// What a file was at one time.
struct Mark {
  Content content = Content::whole;
  std::uint64_t size = 0;
  std::uint64_t sum = 0;

  bool operator==(const Mark&) const = default;
  [[nodiscard]] bool fits(const fs::path& path) const {
    std::error_code error;
    const std::uint64_t found = fs::file_size(path, error);
    if (error) return false;
    if (content == Content::whole ? found != size : found < size) return false;
    return checksum(path, size) == sum;
  }
  [[nodiscard]] std::string line(const std::string& name) const {
    return fmt::format("{} {} {:016x} {}\n", content == Content::whole ? '=' : '+', size, sum,
                       name);
  }
};

// Other processes that write into the directory wait, where the file system knows how.
class DirectoryLock {
 public:
  explicit DirectoryLock(const fs::path& directory)
      : number_(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (number_ >= 0) static_cast<void>(::flock(number_, LOCK_EX));
  }
  ~DirectoryLock() {
    if (number_ >= 0) ::close(number_);
  }
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int number_;
};

// Names of a directory's files that the process writes, from the first time until its end.
class NamesInUse {
 public:
  explicit NamesInUse(fs::path file) : file_(std::move(file)) {}
  ~NamesInUse() {
    if (number_ >= 0) ::close(number_);
  }
  NamesInUse(const NamesInUse&) = delete;
  NamesInUse& operator=(const NamesInUse&) = delete;

  // False where another process has the name. File systems without locks know of none.
  [[nodiscard]] bool take(const std::string& name) {
    if (!taken_.insert(name).second) return true;
    if (number_ < 0) number_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (number_ < 0) return true;
    struct flock byte {};
    byte.l_type = F_WRLCK;
    byte.l_whence = SEEK_SET;
    byte.l_start = static_cast<off_t>(checksum(name) >> 2);  // not below 0
    byte.l_len = 1;
    if (::fcntl(number_, F_OFD_SETLK, &byte) == 0) return true;
    return errno != EAGAIN && errno != EACCES;
  }

 private:
  fs::path file_;
  int number_ = -1;
  std::set<std::string> taken_;
};

// The list of one directory. Of a file it has what it was and what it is about to be, so that the
// process may be killed at any time.
class List {
 public:
  explicit List(const fs::path& directory)
      : directory_(directory / hidden),
        path_(directory_ / "written"),
        in_use_(directory_ / "in_use") {
    const DirectoryLock lock(directory_);
    std::ifstream file(path_, std::ios::binary);
    std::size_t lines = 0;
    for (std::string line; std::getline(file, line); ++lines) read(line);
    constexpr std::size_t few = 1000;
    if (lines > few && lines > 4 * marks_.size()) shorten();
  }

  [[nodiscard]] bool has(const fs::path& path) const {
    const auto found = marks_.find(path.filename().string());
    return found != marks_.end() && std::any_of(found->second.begin(), found->second.end(),
                                                [&](const Mark& mark) { return mark.fits(path); });
  }

  void add(const std::string& name, const Mark& mark) {
    std::error_code error;
    fs::create_directory(directory_, error);
    if (error)
      throw ComputationError(
          fmt::format("{}: cannot be made: {}", directory_.string(), error.message()));
    if (!in_use_.take(name))
      throw ComputationError(
          fmt::format("{}: another run is writing it, expected one at a time: wait for its end, or "
                      "give another --output",
                      (directory_.parent_path() / name).string()));
    if (const auto& marks = marks_[name]; !marks.empty() && marks.back() == mark) return;
    learn(name, mark);
    const DirectoryLock lock(directory_);
    const auto size = fs::file_size(path_, error);
    const bool old = !error && size > 0;
    as<ComputationError>([&] {
      const std::string path = path_.string();
      auto file = old ? grainlaw::core::GrowingFile(path, size) : grainlaw::core::GrowingFile(path);
      file.append((old ? "" : std::string(heading)) + mark.line(name));
    });
  }

 private:
  void read(const std::string& line) {
    std::istringstream words(line);
    char kind = 0;
    Mark mark;
    std::string name;
    if (!(words >> kind >> mark.size >> std::hex >> mark.sum) || words.get() != ' ') return;
    if ((kind != '=' && kind != '+') || !std::getline(words, name)) return;
    mark.content = kind == '=' ? Content::whole : Content::beginning;
    learn(name, mark);
  }

  // A whole file comes after its beginning; else the last two count.
  void learn(const std::string& name, const Mark& mark) {
    std::vector<Mark>& marks = marks_[name];
    if (!marks.empty() && marks.back().content == Content::beginning &&
        mark.content == Content::whole)
      marks.clear();
    if (marks.size() > 1) marks.erase(marks.begin());
    marks.push_back(mark);
  }

  void shorten() const {
    std::string text(heading);
    for (const auto& [name, marks] : marks_)
      for (const Mark& mark : marks) text += mark.line(name);
    as<ComputationError>([&] { grainlaw::core::write_text(path_.string(), text); });
  }

  fs::path directory_, path_;
  NamesInUse in_use_;
  std::map<std::string, std::vector<Mark>> marks_;
};

// The list of the process.
struct Lists {
  std::mutex mutex;
  std::optional<OwnFiles::Others> others;  // none: no OwnFiles
  std::map<fs::path, List> by_directory;

  List& of(const fs::path& path) {
    fs::path directory = path.parent_path();
    if (directory.empty()) directory = ".";
    return by_directory.try_emplace(directory, directory).first->second;
  }
};

Lists& lists() {
  static Lists all;
  return all;
}

bool foreign(const fs::path& path) {
  std::error_code error;
  const auto kind = fs::status(path, error).type();
  if (kind == fs::file_type::not_found) return fs::is_symlink(fs::symlink_status(path, error));
  // What streams is not lost by writing, and a directory cannot be written.
  return kind == fs::file_type::regular && !lists().of(path).has(path);
}

void list(const fs::path& path, const Mark& mark) {
  lists().of(path).add(path.filename().string(), mark);
}

void list_found(const fs::path& path, Content content, std::uint64_t most) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return;
  const std::uint64_t length = std::min<std::uint64_t>(fs::file_size(path, error), most);
  if (!error) list(path, {content, length, checksum(path, length)});
}

}  // namespace

OwnFiles::OwnFiles(Others others) { lists().others = others; }

OwnFiles::~OwnFiles() {
  lists().others.reset();
  lists().by_directory.clear();
}

bool is_of_others(const fs::path& path) {
  const std::lock_guard lock(lists().mutex);
  return foreign(path);
}

void list_before(const fs::path& path, std::string_view bytes, Content content) {
  const std::lock_guard lock(lists().mutex);
  if (!lists().others) return;
  const bool others = foreign(path);
  if (others && *lists().others == OwnFiles::Others::keep)
    throw ComputationError(fmt::format(
        "{}: is there, and was not written by grainlaw or was changed since; expected --force to "
        "write over it",
        path.string()));
  std::error_code error;
  const auto kind = fs::status(path, error).type();
  if (kind == fs::file_type::regular && !others)
    list_found(path, Content::whole, whole_file);  // stays its own where writing fails
  if (kind == fs::file_type::regular || kind == fs::file_type::not_found)
    list(path, {content, bytes.size(), checksum(bytes)});
}

void list_as_it_is(const fs::path& path) {
  const std::lock_guard lock(lists().mutex);
  if (lists().others) list_found(path, Content::whole, whole_file);
}

void list_beginning(const fs::path& path, std::uint64_t length) {
  const std::lock_guard lock(lists().mutex);
  if (lists().others) list_found(path, Content::beginning, length);
}

fs::path written_first(const fs::path& path) {
  const std::lock_guard lock(lists().mutex);
  if (!lists().others) return {};
  return path.parent_path() / hidden / (path.filename().string() + ".new");
}

}  // namespace verification
