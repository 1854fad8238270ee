// Faults: which calls of the system are to fail, and how many there were. Nothing here allocates: it stands
// below malloc.
#include "tests/faults/faults.hpp"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace faults {
namespace {

struct KindName {
  const char* name;
  int error;
};
constexpr KindName kNames[kKinds] = {{"read", EIO},
                                     {"pread", EIO},
                                     {"write", ENOSPC},
                                     {"pwrite", ENOSPC},
                                     {"fwrite", ENOSPC},
                                     {"open", EMFILE},
                                     {"close", EIO},
                                     {"rename", EACCES},
                                     {"linkat", ENOSPC},
                                     {"fsync", EIO},
                                     {"ftruncate", ENOSPC},
                                     {"mmap", ENOMEM},
                                     {"malloc", ENOMEM},
                                     {"malloc_linked", ENOMEM},
                                     {"pthread_create", EAGAIN}};

struct ErrorName {
  const char* name;
  int number;
};
constexpr ErrorName kErrors[] = {
    {"ENOSPC", ENOSPC}, {"EIO", EIO},     {"EMFILE", EMFILE}, {"EACCES", EACCES}, {"ENOMEM", ENOMEM},
    {"EAGAIN", EAGAIN}, {"EINTR", EINTR}, {"EDQUOT", EDQUOT}, {"ENOENT", ENOENT}, {"EROFS", EROFS}};

constexpr int kNone = -1;
int fault_kind = kNone;
int fault_error = 0;
bool fault_short = false;
bool fault_persistent = false;
unsigned long fault_call = 0;
unsigned long calls[kKinds];
unsigned long mallocs_at_thread = 0;
unsigned long injected = 0;
char first_file[4096];
bool no_proc = false;

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

}  // namespace

bool active = false;
__thread bool linked = false;

void read_environment() {
  no_proc = getenv("SPECTILE_FAULT_NO_PROC") != nullptr;
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

namespace {

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

}  // namespace

bool fails(Kind kind, const char* path, int descriptor) {
  if (!active) return false;
  const unsigned long call = __atomic_add_fetch(&calls[kind], 1, __ATOMIC_RELAXED);
  if (kind == kThread && call == 1) mallocs_at_thread = __atomic_load_n(&calls[kMalloc], __ATOMIC_RELAXED);
  if (kind != fault_kind || (fault_persistent ? call < fault_call : call != fault_call)) return false;
  if (__atomic_fetch_add(&injected, 1, __ATOMIC_RELAXED) == 0) note_file(path, descriptor);
  errno = fault_error;
  return true;
}

bool fails_to_allocate() {
  const bool fails_linked = linked && fails(kMallocLinked);
  return fails(kMalloc) || fails_linked;
}

bool is_missing(const char* path) {
  if (!active || !no_proc || strncmp(path, "/proc", 5) != 0 || (path[5] != '/' && path[5] != '\0'))
    return false;
  errno = ENOENT;
  return true;
}

bool fails_to_open(const char* path) {
  return is_missing(path) || fails(kOpen, path);
}

bool fails_to_move(Kind kind, int descriptor, size_t* bytes) {
  if (!fails(kind, nullptr, descriptor)) return false;
  if (!fault_short) return true;
  if (*bytes > 1) *bytes /= 2;
  return false;
}

bool is_short() {
  return fault_short;
}

int error_number() {
  return fault_error;
}

namespace {

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

}  // namespace

__attribute__((destructor)) void write_report() {
  const char* path = active ? getenv("SPECTILE_FAULT_REPORT") : nullptr;
  active = false;
  if (path == nullptr) return;
  const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0666));
  if (file < 0) return;
  for (int kind = 0; kind < kKinds; ++kind) put_count(file, kNames[kind].name, calls[kind]);
  put_count(file, "malloc_at_thread", mallocs_at_thread);
  put_count(file, "injected", injected);
  put(file, "file ");
  put(file, first_file);
  put(file, "\n");
  syscall(SYS_close, file);
}

}  // namespace faults
