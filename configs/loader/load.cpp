// The doors of the room: file, text or document in, show or problems out.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "configs/loader/checks.h"
#include "configs/loader/decode.h"
#include "configs/loader/document.h"
#include "configs/loader/loader.h"
#include "configs/loader/report.h"

namespace cupola::loader {

using model::Code;
using model::Problem;

namespace {

class Descriptor {
public:
  explicit Descriptor(int id)
      : id_(id) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (id_ >= 0) ::close(id_);
  }
  [[nodiscard]] int id() const { return id_; }

private:
  int id_;
};

std::string what_it_is(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a FIFO";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

tl::unexpected<model::Problems> unreadable(const std::string& name, std::string found) {
  return model::failure(
      Problem{Code::file_unreadable, "", "a readable file", std::move(found), "", {name, 0, 0}});
}

std::string reason(int error) { return std::generic_category().message(error); }

model::Result<std::string> read_file(const std::string& name) {
  // Not blocking: opening a FIFO would otherwise wait for a writer.
  const Descriptor file(::open(name.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (file.id() < 0) {
    const int error = errno;
    struct stat there {};
    if (::stat(name.c_str(), &there) == 0 && !S_ISREG(there.st_mode))
      return unreadable(name, what_it_is(there.st_mode));
    return unreadable(name, error == ENOENT ? "no such file" : reason(error));
  }
  struct stat status {};
  if (::fstat(file.id(), &status) != 0) return unreadable(name, reason(errno));
  if (!S_ISREG(status.st_mode)) return unreadable(name, what_it_is(status.st_mode));
  const auto too_large = [&](const std::string& found) {
    return model::failure(Problem{Code::file_too_large,
                                  "",
                                  "at most " + std::to_string(max_text_bytes) + " bytes",
                                  found,
                                  "Is it a show file?",
                                  {name, 0, 0}});
  };
  if (static_cast<std::size_t>(status.st_size) > max_text_bytes)
    return too_large(std::to_string(status.st_size) + " bytes");
  std::string text;
  std::array<char, 65536> block{};
  for (;;) {
    const ssize_t count = ::read(file.id(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return unreadable(name, reason(errno));
    if (count == 0) return text;
    text.append(block.data(), static_cast<std::size_t>(count));
    if (text.size() > max_text_bytes) return too_large("more");
  }
}

model::Result<Loaded> load(Document document) {
  Report report(document.keys, document.values);
  for (Problem& problem : document.problems) report.add(std::move(problem));
  model::Show show = decode(document.root, report);
  cross_check(show, report);
  model::Problems problems = report.take();
  if (model::has_errors(problems)) return tl::unexpected(std::move(problems));
  return Loaded{std::move(show), std::move(problems), std::move(document.values)};
}

} // namespace

model::Result<Loaded> parse_show(std::string_view text, const std::string& name) {
  return read_document(text, name).and_then(load);
}

model::Result<Loaded> load_show(const std::filesystem::path& file) {
  auto text = read_file(file.string());
  if (!text) return tl::unexpected(std::move(text.error()));
  return parse_show(*text, file.string());
}

model::Result<Loaded> decode_show(const Json& document) {
  Document unplaced;
  unplaced.root = document;
  return load(std::move(unplaced));
}

} // namespace cupola::loader
