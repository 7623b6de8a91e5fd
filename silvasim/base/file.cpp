#include "silvasim/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "silvasim/base/error.h"

namespace silvasim::base {

namespace fs = std::filesystem;

namespace {

// Names of files that are being written, readable from a signal handler: fixed memory, one flag a slot.
constexpr std::size_t slot_count = 32;
struct Slot {
  std::atomic<bool> taken{false};
  std::atomic<bool> named{false};
  std::array<char, 4096> name{};
};
std::array<Slot, slot_count> unfinished;

int take_slot(const std::string& name) {
  for (std::size_t i = 0; i < slot_count; ++i) {
    bool free = false;
    if (name.size() < unfinished[i].name.size() && unfinished[i].taken.compare_exchange_strong(free, true)) {
      std::memcpy(unfinished[i].name.data(), name.c_str(), name.size() + 1);
      unfinished[i].named = true;
      return static_cast<int>(i);
    }
  }
  return -1;
}

void free_slot(int slot) {
  if (slot < 0) return;
  unfinished[static_cast<std::size_t>(slot)].named = false;
  unfinished[static_cast<std::size_t>(slot)].taken = false;
}

[[noreturn]] void fail(const std::string& what, const fs::path& path, int reason) {
  throw Error(what + " \"" + path.string() + "\": " + std::generic_category().message(reason));
}

// The file that a link stands for, also one that does not exist yet. Links may name links.
fs::path behind_links(const fs::path& name) {
  constexpr int most_links = 40;
  fs::path path = name;
  std::error_code none;
  for (int i = 0; fs::is_symlink(path, none); ++i) {
    if (i == most_links) fail("cannot write", name, ELOOP);
    const fs::path to = fs::read_symlink(path, none);
    if (none) fail("cannot write", name, none.value());
    path = to.is_absolute() ? to : path.parent_path() / to;
  }
  return path;
}

// Makes the new name itself survive a power cut. Where a file system cannot do that, the file is whole all the same.
void flush_folder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

void remove_unfinished_files_from_signal_handler() noexcept {
  for (Slot& slot : unfinished) {
    if (slot.named) unlink(slot.name.data());
  }
}

NewFile::NewFile(const fs::path& target, std::span<const fs::path> inputs) : target_(target) {
  if (target.empty() || !target.has_filename())
    throw Error("cannot write \"" + target.string() + "\": it names no file");
  // Follow a link to what it names, so that renaming replaces the file and not the link.
  target_ = behind_links(target);
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  if (fs::is_directory(status)) throw Error("cannot write \"" + target.string() + "\": it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error("cannot write \"" + target.string() + "\": it is no regular file");
  }
  for (const fs::path& input : inputs) {
    if (fs::equivalent(input, target_, ignored)) {
      throw Error("cannot write \"" + target.string() + "\": it is also an input");
    }
  }
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw Error("cannot write \"" + target.string() + "\": there is no folder \"" + folder.string() + "\"");
  }
  // Who may read a file does not change because it is written anew.
  if (fs::exists(status)) permissions_ = static_cast<unsigned>(status.permissions()) & 0777u;

  // The process id keeps two runs apart. O_EXCL refuses a file that is already there, for instance the rest of a killed
  // run that had the same process id, as runs in containers do: then the next number serves.
  static std::atomic<unsigned> serial{0};
  constexpr int most_attempts = 1000;
  constexpr std::size_t longest_stem = 160;  // file systems allow names of 255 bytes
  int reason = EEXIST;
  for (int attempt = 0; attempt < most_attempts && reason == EEXIST; ++attempt) {
    temporary_ = folder / ("." + target_.stem().string().substr(0, longest_stem) + ".part" + std::to_string(getpid()) +
                           "-" + std::to_string(serial++) + target_.extension().string());
    slot_ = take_slot(temporary_.string());
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    reason = errno;
    free_slot(slot_);
    slot_ = -1;
  }
  fail("cannot write", target_, reason);
}

NewFile::~NewFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!committed_) unlink(temporary_.c_str());
  free_slot(slot_);
}

void NewFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot write", target_, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void NewFile::write(const std::string& text) { write(std::as_bytes(std::span(text))); }

void NewFile::commit() {
  // A library may have replaced the file under this name, so flush what the name stands for now.
  const int now = open(temporary_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (now < 0) fail("cannot write", target_, errno);
  const bool flushed = (permissions_ == 0 || fchmod(now, permissions_) == 0) && fsync(now) == 0;
  const int reason = errno;
  close(now);
  if (!flushed) fail("cannot write", target_, reason);
  const bool closed = close(descriptor_) == 0;
  descriptor_ = -1;
  if (!closed) fail("cannot write", target_, errno);
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot write", target_, errno);
  committed_ = true;
  flush_folder(target_.has_parent_path() ? target_.parent_path() : fs::path("."));
}

std::string read_file(const fs::path& path, std::size_t most_bytes) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) fail("cannot read", path, errno);
  struct Closer {
    int descriptor;
    ~Closer() { close(descriptor); }
  } closer{descriptor};
  struct stat status {};
  if (fstat(descriptor, &status) != 0) fail("cannot read", path, errno);
  if (!S_ISREG(status.st_mode)) throw Error("cannot read \"" + path.string() + "\": it is no regular file");
  const auto too_large = [&](std::size_t size) {
    return Error("cannot read \"" + path.string() + "\": it has " + std::to_string(size) + " bytes or more, at most " +
                 std::to_string(most_bytes) + " are allowed");
  };
  const std::size_t claimed = static_cast<std::size_t>(status.st_size);
  if (claimed > most_bytes) throw too_large(claimed);

  // Read to the end, wherever it is: the file may grow or shrink meanwhile, and the kernel's own files claim no size.
  std::string text(claimed + 1, '\0');
  std::size_t filled = 0;
  while (true) {
    const ssize_t got = read(descriptor, text.data() + filled, text.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("cannot read", path, errno);
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
    if (filled > most_bytes) throw too_large(filled);
    if (filled == text.size()) text.resize(2 * filled + 4096);
  }
  text.resize(filled);
  return text;
}

}  // namespace silvasim::base
