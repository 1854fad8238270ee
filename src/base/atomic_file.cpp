// AtomicFile: a file that appears at its path whole, or not at all.
#include "src/base/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

#include "src/base/errors.hpp"

namespace spectile::io {

Error system_error(const std::string& path, const char* doing, int error_number) {
  ErrorCode code = ErrorCode::kBadFile;
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      code = ErrorCode::kNoSpace;
      break;
    case EMFILE:
    case ENFILE:
    case EIO:
      code = ErrorCode::kNoSpace;
      break;
    case ENOMEM:
      code = ErrorCode::kOutOfMemory;
      break;
    case EACCES:
    case EPERM:
    case EROFS:
      code = ErrorCode::kNoPermission;
      break;
    default:
      break;
  }
  return make_error(code, "{}: cannot {}: {}", path, doing, std::generic_category().message(error_number));
}

namespace {

std::string random_suffix() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

/// An unused name beside the target that nobody takes for a finished image.
std::string temporary_name(const std::string& target) {
  // Not made from the target's own name, which may be as long as the system allows already.
  return (std::filesystem::path(target).parent_path() / fmt::format(".spectile-{}.part", random_suffix()))
      .string();
}

/// The name that the system has for an open file.
std::string own_descriptor(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

/// The end of a chain of symbolic links that leads to no file yet, so that the links stay.
std::string end_of_links(const std::string& path) {
  std::filesystem::path at = path;
  std::error_code error;
  constexpr int kMaxLinks = 40;  // as Linux follows
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(at, error); ++i) {
    // A relative target replaces the link's own name; an absolute one replaces all of it.
    at = at.parent_path() / std::filesystem::read_symlink(at, error);
  }
  return at.string();
}

std::string folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? std::string(1, '.') : parent.string();
}

/// Waits until the device holds what was written. Returns an errno, 0 where it does, or where the file system
/// cannot tell.
int synchronize(int descriptor) {
  int done = -1;
  do {
    done = ::fsync(descriptor);
  } while (done != 0 && errno == EINTR);
  return done == 0 || errno == EINVAL || errno == ENOSYS ? 0 : errno;
}

/// The same of the names in a folder; 0 too for one that may not be read.
int synchronize_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno == EACCES ? 0 : errno;
  const int failed = synchronize(descriptor);
  ::close(descriptor);
  return failed;
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  AtomicFile file;
  file.path_ = path;
  file.target_ = path;
  mode_t mode = 0666;
  struct stat status {};
  bool exists = ::stat(path.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) return system_error(path, "write", errno);
  if (!exists) file.target_ = end_of_links(path);
  if (exists) {
    if (S_ISDIR(status.st_mode))
      return make_error(ErrorCode::kBadFile, "{}: cannot write: is a directory", path);
    if (!S_ISREG(status.st_mode))
      return make_error(ErrorCode::kBadFile, "{}: cannot write: not a plain file", path);
    if (::access(path.c_str(), W_OK) != 0) return system_error(path, "write", errno);
    mode = status.st_mode & 0777;
    if (char* resolved = ::realpath(path.c_str(), nullptr)) {
      file.target_ = resolved;
      std::free(resolved);
    }
  }
  const std::string folder = folder_of(file.target_);
#ifdef O_TMPFILE
  file.fd_ = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
  if (file.fd_ < 0 && errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) {
    return system_error(path, "write", errno);
  }
  // Without /proc a nameless file gets no name any more.
  if (file.fd_ >= 0 && ::access(own_descriptor(file.fd_).c_str(), F_OK) != 0) {
    ::close(std::exchange(file.fd_, -1));
  }
#endif
  if (file.fd_ < 0) {
    file.temporary_ = temporary_name(file.target_);
    file.fd_ = ::open(file.temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
    if (file.fd_ < 0) {
      const int error_number = errno;
      file.temporary_.clear();
      return system_error(path, "write", error_number);
    }
  }
  if (exists)
    static_cast<void>(::fchmod(file.fd_, mode));  // the umask does not apply to a file that was there
  return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept {
  *this = std::move(other);
}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this != &other) {
    discard();
    fd_ = std::exchange(other.fd_, -1);
    path_ = std::move(other.path_);
    target_ = std::move(other.target_);
    temporary_ = std::exchange(other.temporary_, {});
  }
  return *this;
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() noexcept {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

Result<void> AtomicFile::write_at(const void* data, std::size_t bytes, std::uint64_t offset) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::pwrite(fd_, from, bytes, static_cast<off_t>(offset));
    if (written < 0) {
      if (errno == EINTR) continue;
      return system_error(path_, "write", errno);
    }
    if (written == 0) return system_error(path_, "write", ENOSPC);
    from += written;
    bytes -= static_cast<std::size_t>(written);
    offset += static_cast<std::uint64_t>(written);
  }
  return {};
}

Result<void> AtomicFile::commit(bool durable) {
  const std::string folder = folder_of(target_);
  if (const int failed = durable ? synchronize(fd_) : 0; failed != 0) {
    return system_error(path_, "write", failed);
  }
  if (temporary_.empty()) {
    // A nameless file gets a temporary name first: linking cannot replace what is there, renaming can.
    std::string name = temporary_name(target_);
    const std::string self = own_descriptor(fd_);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      return system_error(path_, "write", errno);
    }
    // Takes no memory, for want of which the name would stay.
    temporary_ = std::move(name);
  }
  // Some systems report a full device only here.
  const int closed = ::close(std::exchange(fd_, -1));
  if (closed != 0 && errno != EINTR) return system_error(path_, "write", errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) return system_error(path_, "write", errno);
  temporary_.clear();
  if (const int failed = durable ? synchronize_folder(folder) : 0; failed != 0) {
    return system_error(path_, "make sure of its name", failed);
  }
  return {};
}

}  // namespace spectile::io
