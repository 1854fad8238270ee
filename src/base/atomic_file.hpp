// AtomicFile: a file that appears at its path whole, or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <spectile/result.hpp>
#include <string>

namespace spectile::io {

/// Written without a name where the system can (so that a killed run leaves nothing), else under a temporary
/// name beside the target; commit() puts it in the target's place. Symbolic links are followed and stay, also
/// one that leads to no file yet.
class AtomicFile {
 public:
  /// Errors: kNoPermission, kNoSpace, kBadFile (a target that is a directory or a device, a folder that is
  /// missing).
  static Result<AtomicFile> create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Writes all `bytes` at `offset`. Errors: as create(), by what the system says.
  Result<void> write_at(const void* data, std::size_t bytes, std::uint64_t offset);

  /// Gives the file its name, replacing what had it. `durable`: waits until the device holds the file and its
  /// name, so that it is whole after a loss of power too. Errors: as create().
  Result<void> commit(bool durable);

 private:
  AtomicFile() = default;
  void discard() noexcept;
  int fd_ = -1;
  std::string path_;       // as the caller gave it, for messages
  std::string target_;     // with symbolic links resolved
  std::string temporary_;  // empty while the file has no name
};

/// The error for a failed system call on `path`.
Error system_error(const std::string& path, const char* doing, int error_number);

}  // namespace spectile::io
