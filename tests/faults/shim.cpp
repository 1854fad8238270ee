// Preloaded into a program, fails the calls of one function of the system that an environment variable names.
//
//   SPECTILE_FAULT=FUNCTION:N[:ERROR|:short][:persistent]   the N-th call from main on, or all from it on
//   SPECTILE_FAULT_PROGRAM=NAME  only in a program of this name, not in a shell that starts it
//   SPECTILE_FAULT_REPORT=FILE   at exit: a line "FUNCTION CALLS" each, "injected COUNT", its file
// FUNCTION is a row of kKinds, with its variants. `short` does half of a read or a write. Nothing here allocates: it
// stands below malloc.
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

extern "C" {
// glibc's own allocator under the names that nobody replaces: dlsym would itself allocate.
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
}

namespace {

enum Kind {
  kRead,
  kPread,
  kWrite,
  kPwrite,
  kFwrite,
  kOpen,
  kClose,
  kRename,
  kLink,
  kFsync,
  kFtruncate,
  kMmap,
  kMalloc,
  kThread,
  kKinds
};

struct KindName {
  const char* name;
  int error;
};
constexpr KindName kNames[kKinds] = {{"read", EIO},         {"pread", EIO},
                                     {"write", ENOSPC},     {"pwrite", ENOSPC},
                                     {"fwrite", ENOSPC},    {"open", EMFILE},
                                     {"close", EIO},        {"rename", EACCES},
                                     {"linkat", ENOSPC},    {"fsync", EIO},
                                     {"ftruncate", ENOSPC}, {"mmap", ENOMEM},
                                     {"malloc", ENOMEM},    {"pthread_create", EAGAIN}};

struct ErrorName {
  const char* name;
  int number;
};
constexpr ErrorName kErrors[] = {
    {"ENOSPC", ENOSPC}, {"EIO", EIO},     {"EMFILE", EMFILE}, {"EACCES", EACCES}, {"ENOMEM", ENOMEM},
    {"EAGAIN", EAGAIN}, {"EINTR", EINTR}, {"EDQUOT", EDQUOT}, {"ENOENT", ENOENT}, {"EROFS", EROFS}};

constexpr int kNone = -1;
bool active = false;  // set before main, when there is one thread
int fault_kind = kNone;
int fault_error = 0;
bool fault_short = false;
bool fault_persistent = false;
unsigned long fault_call = 0;
unsigned long calls[kKinds];
unsigned long injected = 0;
char first_file[4096];

/// True for `word` at the start of *text, which then stands behind it and its colon.
bool take_word(const char** text, const char* word) {
  const size_t length = strlen(word);
  if (strncmp(*text, word, length) != 0 || ((*text)[length] != ':' && (*text)[length] != '\0')) return false;
  *text += length + ((*text)[length] == ':' ? 1 : 0);
  return true;
}

[[noreturn]] void refuse(const char* text) {
  constexpr char kMessage[] = "faults: cannot understand SPECTILE_FAULT ";
  syscall(SYS_write, 2, kMessage, sizeof kMessage - 1);
  syscall(SYS_write, 2, text, strlen(text));
  syscall(SYS_write, 2, "\n", 1L);
  syscall(SYS_exit_group, 99);
  __builtin_unreachable();
}

void read_environment() {
  const char* whole = getenv("SPECTILE_FAULT");
  if (whole == nullptr || *whole == '\0') return;
  const char* text = whole;
  for (int kind = 0; kind < kKinds && fault_kind == kNone; ++kind) {
    if (take_word(&text, kNames[kind].name)) fault_kind = kind;
  }
  if (fault_kind == kNone) refuse(whole);
  fault_error = kNames[fault_kind].error;
  while (*text >= '0' && *text <= '9')
    fault_call = 10 * fault_call + static_cast<unsigned long>(*text++ - '0');
  if (fault_call == 0) refuse(whole);
  if (*text == ':') ++text;
  while (*text != '\0') {
    const char* before = text;
    if (take_word(&text, "short")) fault_short = true;
    if (take_word(&text, "persistent")) fault_persistent = true;
    for (const ErrorName& error : kErrors) {
      if (take_word(&text, error.name)) fault_error = error.number;
    }
    if (text == before) refuse(whole);
  }
}

/// Keeps the file that the first failing call is for: its path, or what the system calls a descriptor.
void note_file(const char* path, int descriptor) {
  if (path != nullptr) {
    for (size_t i = 0; i + 1 < sizeof first_file && path[i] != '\0'; ++i) first_file[i] = path[i];
  } else if (descriptor >= 0) {
    char link[32] = "/proc/self/fd/";
    char digits[12];
    int count = 0;
    for (int rest = descriptor; rest > 0 || count == 0; rest /= 10)
      digits[count++] = static_cast<char>('0' + rest % 10);
    char* end = link + strlen(link);
    while (count > 0) *end++ = digits[--count];
    *end = '\0';
    syscall(SYS_readlinkat, AT_FDCWD, link, first_file, sizeof first_file - 1);
  }
}

/// Counts a call; true if it is one that fails, with errno set.
bool fails(Kind kind, const char* path = nullptr, int descriptor = -1) {
  if (!active) return false;
  const unsigned long call = __atomic_add_fetch(&calls[kind], 1, __ATOMIC_RELAXED);
  if (kind != fault_kind || (fault_persistent ? call < fault_call : call != fault_call)) return false;
  if (__atomic_fetch_add(&injected, 1, __ATOMIC_RELAXED) == 0) note_file(path, descriptor);
  errno = fault_error;
  return true;
}

/// As fails(), of a call that moves bytes: where it is to be short it does not fail, but moves half of them.
bool fails_to_move(Kind kind, int descriptor, size_t* bytes) {
  if (!fails(kind, nullptr, descriptor)) return false;
  if (!fault_short) return true;
  if (*bytes > 1) *bytes /= 2;
  return false;
}

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

void put(int file, const char* text) {
  syscall(SYS_write, file, text, strlen(text));
}

void put_count(int file, const char* name, unsigned long count) {
  char digits[24];
  char* at = digits + sizeof digits;
  *--at = '\0';
  *--at = '\n';
  do *--at = static_cast<char>('0' + count % 10);
  while ((count /= 10) > 0);
  put(file, name);
  put(file, " ");
  put(file, at);
}

__attribute__((destructor)) void write_report() {
  const char* path = active ? getenv("SPECTILE_FAULT_REPORT") : nullptr;
  active = false;
  if (path == nullptr) return;
  const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0666));
  if (file < 0) return;
  for (int kind = 0; kind < kKinds; ++kind) put_count(file, kNames[kind].name, calls[kind]);
  put_count(file, "injected", injected);
  put(file, "file ");
  put(file, first_file);
  put(file, "\n");
  syscall(SYS_close, file);
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
  if (!fault_short || count == 0) return -1;
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
  return fails(kOpen, path) ? -1 : NEXT(open)(path, flags, mode);
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
  return fails(kOpen, path) ? -1 : NEXT(openat)(folder, path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) {
  return fails(kOpen, path) ? nullptr : NEXT(fopen)(path, mode);
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
int rename(const char* from, const char* to) {
  return fails(kRename, to) ? -1 : NEXT(rename)(from, to);
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  return fails(kLink, to) ? -1 : NEXT(linkat)(from_folder, from, to_folder, to, flags);
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
  return fails(kMalloc) ? nullptr : __libc_malloc(bytes);
}
void* calloc(size_t count, size_t bytes) {
  return fails(kMalloc) ? nullptr : __libc_calloc(count, bytes);
}
void* realloc(void* old, size_t bytes) {
  return fails(kMalloc) ? nullptr : __libc_realloc(old, bytes);
}
void* aligned_alloc(size_t alignment, size_t bytes) {
  return fails(kMalloc) ? nullptr : __libc_memalign(alignment, bytes);
}
void* memalign(size_t alignment, size_t bytes) {
  return fails(kMalloc) ? nullptr : __libc_memalign(alignment, bytes);
}
int posix_memalign(void** to, size_t alignment, size_t bytes) {
  const int error = errno;
  void* memory = fails(kMalloc) ? nullptr : __libc_memalign(alignment, bytes);
  errno = error;
  if (memory == nullptr) return ENOMEM;
  *to = memory;
  return 0;
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) {
  return fails(kThread) ? fault_error : NEXT(pthread_create)(thread, attributes, start, argument);
}

}  // extern "C"
