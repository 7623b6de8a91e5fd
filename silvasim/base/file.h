// Whole files in and out. Output appears under its final name only when it is complete.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace silvasim::base {

// A file that is written beside its final name and renamed at commit(); destroyed without commit() it is removed, also
// when a second Ctrl-C ends the program.
//
// Permissions: those of the file that is replaced; for a new one, what the umask leaves.
// Links: a symbolic link as target is followed, also one to a file yet to be.
// Errors: base::Error naming the path where the folder is missing, the target is no regular file (a folder, a device),
//   the disk is full (checked at commit, after fsync).
class NewFile {
 public:
  // `inputs`: files that must not be overwritten (an output that is also an input is an error).
  explicit NewFile(const std::filesystem::path& target, std::span<const std::filesystem::path> inputs = {});
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  // Where to write until commit(). Keeps the target's extension last, because libraries choose formats by it.
  const std::filesystem::path& path() const { return temporary_; }

  void write(std::span<const std::byte> bytes);  // appends
  void write(const std::string& text);

  // Flushes to the disk, then renames over the target. For a file that a library wrote under path(): the same.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  int slot_ = -1;
  unsigned permissions_ = 0;  // 0: a new file
  bool committed_ = false;
};

// Reads a regular file whole. Errors: base::Error if it is missing, no regular file, or larger than `most_bytes`.
std::string read_file(const std::filesystem::path& path, std::size_t most_bytes);

// Called by the interrupt handler only.
void remove_unfinished_files_from_signal_handler() noexcept;

}  // namespace silvasim::base
