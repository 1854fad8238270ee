// Preloaded into a program, fails the calls of one function of the system that an environment variable names.
//
//   SPECTILE_FAULT=FUNCTION:N[:ERROR|:short][:persistent]   the N-th call from main on, or all from it on
//   SPECTILE_FAULT_PROGRAM=NAME  only in a program of this name, not in a shell that starts it
//   SPECTILE_FAULT_NO_PROC=1     there is no /proc
//   SPECTILE_FAULT_REPORT=FILE   at exit: a line "FUNCTION CALLS" each, the calls of malloc when the first
//                                thread was made, "injected COUNT", its file
// FUNCTION is a row of kNames, with its variants; malloc_linked: those between a thread's linkat and its next
// rename. `short` does half of a read or a write. Nothing here allocates: it stands below malloc.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include "tests/faults/faults.hpp"

extern "C" {
// glibc's own allocator under the names that nobody replaces: dlsym would itself allocate.
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
}

namespace {

using namespace faults;

/// The function that a replaced one stands before.
template <class Function>
Function next(Function* known, const char* name) {
  Function found = __atomic_load_n(known, __ATOMIC_RELAXED);
  if (found == nullptr) {
    found = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
    __atomic_store_n(known, found, __ATOMIC_RELAXED);
  }
  return found;
}
#define NEXT(name)                            \
  ([] {                                       \
    static decltype(&::name) known = nullptr; \
    return next(&known, #name);               \
  }())

int (*real_main)(int, char**, char**) = nullptr;

int counted_main(int argc, char** argv, char** environment) {
  const char* wanted = getenv("SPECTILE_FAULT_PROGRAM");
  active = wanted == nullptr || strcmp(wanted, program_invocation_short_name) == 0;
  return real_main(argc, argv, environment);
}

mode_t mode_of(int flags, va_list rest) {
  return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(rest, mode_t) : 0;
}

}  // namespace

extern "C" {

int __libc_start_main(int (*start)(int, char**, char**), int argc, char** argv, void (*init)(),
                      void (*fini)(), void (*loader_fini)(), void* stack_end) {
  read_environment();
  real_main = start;
  using Start = int (*)(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*);
  const auto real = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return real(counted_main, argc, argv, init, fini, loader_fini, stack_end);
}

// A process without memory may end so.
void _exit(int status) {
  write_report();
  syscall(SYS_exit_group, status);
  __builtin_unreachable();
}
void _Exit(int status) __attribute__((alias("_exit"), noreturn));

ssize_t read(int file, void* to, size_t bytes) {
  return fails_to_move(kRead, file, &bytes) ? -1 : NEXT(read)(file, to, bytes);
}
ssize_t pread(int file, void* to, size_t bytes, off_t at) {
  return fails_to_move(kPread, file, &bytes) ? -1 : NEXT(pread)(file, to, bytes, at);
}
ssize_t pread64(int file, void* to, size_t bytes, off64_t at) __attribute__((alias("pread")));
ssize_t write(int file, const void* from, size_t bytes) {
  return fails_to_move(kWrite, file, &bytes) ? -1 : NEXT(write)(file, from, bytes);
}
ssize_t writev(int file, const iovec* parts, int count) {
  size_t bytes = 0;
  if (!fails(kWrite, nullptr, file)) return NEXT(writev)(file, parts, count);
  if (!is_short() || count == 0) return -1;
  bytes = parts[0].iov_len > 1 ? parts[0].iov_len / 2 : parts[0].iov_len;
  return NEXT(write)(file, parts[0].iov_base, bytes);
}
ssize_t pwrite(int file, const void* from, size_t bytes, off_t at) {
  return fails_to_move(kPwrite, file, &bytes) ? -1 : NEXT(pwrite)(file, from, bytes, at);
}
ssize_t pwrite64(int file, const void* from, size_t bytes, off64_t at) __attribute__((alias("pwrite")));
size_t fwrite(const void* from, size_t size, size_t count, FILE* file) {
  // Standard error is where the other faults are said.
  if (file == stderr || !fails(kFwrite, nullptr, fileno(file))) return NEXT(fwrite)(from, size, count, file);
  file->_flags |= 0x20;  // as ferror() finds it in glibc
  return 0;
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return fails_to_open(path) ? -1 : NEXT(open)(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open(path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return fails_to_open(path) ? -1 : NEXT(openat)(folder, path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) {
  return fails_to_open(path) ? nullptr : NEXT(fopen)(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  return fopen(path, mode);
}
int close(int file) {
  const bool failed = fails(kClose, nullptr, file);
  const int error = errno;
  const int result =
      NEXT(close)(file);  // the system gives a descriptor up even where it says that closing failed
  if (!failed) return result;
  errno = error;
  return -1;
}
int access(const char* path, int mode) {
  return is_missing(path) ? -1 : NEXT(access)(path, mode);
}
ssize_t readlink(const char* path, char* to, size_t bytes) {
  return is_missing(path) ? -1 : NEXT(readlink)(path, to, bytes);
}
int rename(const char* from, const char* to) {
  linked = false;
  return fails(kRename, to) ? -1 : NEXT(rename)(from, to);
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  if (is_missing(from) || fails(kLink, to)) return -1;
  const int result = NEXT(linkat)(from_folder, from, to_folder, to, flags);
  linked = result == 0;
  return result;
}
int link(const char* from, const char* to) {
  return fails(kLink, to) ? -1 : NEXT(link)(from, to);
}
int fsync(int file) {
  return fails(kFsync, nullptr, file) ? -1 : NEXT(fsync)(file);
}
int fdatasync(int file) {
  return fails(kFsync, nullptr, file) ? -1 : NEXT(fdatasync)(file);
}
int ftruncate(int file, off_t size) {
  return fails(kFtruncate, nullptr, file) ? -1 : NEXT(ftruncate)(file, size);
}
void* mmap(void* at, size_t bytes, int protection, int flags, int file, off_t offset) {
  return fails(kMmap, nullptr, file) ? MAP_FAILED : NEXT(mmap)(at, bytes, protection, flags, file, offset);
}

void* malloc(size_t bytes) {
  return fails_to_allocate() ? nullptr : __libc_malloc(bytes);
}
void* calloc(size_t count, size_t bytes) {
  return fails_to_allocate() ? nullptr : __libc_calloc(count, bytes);
}
void* realloc(void* old, size_t bytes) {
  return fails_to_allocate() ? nullptr : __libc_realloc(old, bytes);
}
void* aligned_alloc(size_t alignment, size_t bytes) {
  return fails_to_allocate() ? nullptr : __libc_memalign(alignment, bytes);
}
void* memalign(size_t alignment, size_t bytes) {
  return fails_to_allocate() ? nullptr : __libc_memalign(alignment, bytes);
}
int posix_memalign(void** to, size_t alignment, size_t bytes) {
  const int error = errno;
  void* memory = fails_to_allocate() ? nullptr : __libc_memalign(alignment, bytes);
  errno = error;
  if (memory == nullptr) return ENOMEM;
  *to = memory;
  return 0;
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) {
  return fails(kThread) ? error_number() : NEXT(pthread_create)(thread, attributes, start, argument);
}

}  // extern "C"
