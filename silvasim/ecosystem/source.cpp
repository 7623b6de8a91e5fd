#include "silvasim/ecosystem/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "silvasim/base/error.h"

namespace silvasim::ecosystem {

namespace {

class Memory : public Source {
 public:
  Memory(std::span<const std::byte> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  const std::string& name() const override { return name_; }
  std::uint64_t size() const override { return bytes_.size(); }
  std::span<const std::byte> fetch(std::uint64_t offset, std::uint64_t size, std::vector<std::byte>&) const override {
    return bytes_.subspan(offset, size);
  }

 private:
  std::span<const std::byte> bytes_;
  std::string name_;
};

// Reads piece by piece, from any thread. Not mapped into memory: a file that another program cuts off meanwhile must be
// an error, not a signal.
class File : public Source {
 public:
  explicit File(const std::filesystem::path& path) : name_(path.string()) {
    descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0) throw base::Error("cannot read \"" + name_ + "\": " + std::generic_category().message(errno));
    struct stat status {};
    const bool known = fstat(descriptor_, &status) == 0;
    if (!known || !S_ISREG(status.st_mode)) {
      close(descriptor_);
      throw base::Error("cannot read \"" + name_ + "\": it is no regular file");
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() override { close(descriptor_); }

  const std::string& name() const override { return name_; }
  std::uint64_t size() const override { return size_; }
  std::span<const std::byte> fetch(std::uint64_t offset, std::uint64_t size,
                                   std::vector<std::byte>& buffer) const override {
    buffer.resize(size);
    std::size_t filled = 0;
    while (filled < size) {
      const ssize_t got =
          pread(descriptor_, buffer.data() + filled, size - filled, static_cast<off_t>(offset + filled));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw base::Error("cannot read \"" + name_ + "\": " + std::generic_category().message(errno));
      if (got == 0) throw base::Error("cannot read \"" + name_ + "\": it was cut off while it was read");
      filled += static_cast<std::size_t>(got);
    }
    return buffer;
  }

 private:
  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace

std::unique_ptr<Source> source_from_memory(std::span<const std::byte> bytes, std::string name) {
  return std::make_unique<Memory>(bytes, std::move(name));
}

std::unique_ptr<Source> source_from_file(const std::filesystem::path& path) { return std::make_unique<File>(path); }

}  // namespace silvasim::ecosystem
