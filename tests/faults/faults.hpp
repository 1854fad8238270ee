// Faults: which calls of the system are to fail, and how many there were.
#pragma once

#include <stddef.h>

namespace faults {

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
  kMallocLinked,
  kThread,
  kKinds
};

/// Set before main, when there is one thread.
extern bool active;

/// Set in a thread that made a name by linkat and has not renamed it yet.
extern __thread bool linked;

/// Reads the variables of the environment.
void read_environment();

/// Counts a call; true if it is one that fails, with errno set. Notes the path, or the descriptor, that it is
/// for.
bool fails(Kind kind, const char* path = nullptr, int descriptor = -1);

/// As fails(), of a call that takes memory.
bool fails_to_allocate();

/// True for a path that is to be missing, with errno set.
bool is_missing(const char* path);

/// As fails(), of a call that opens.
bool fails_to_open(const char* path);

/// As fails(), of a call that moves bytes: where it is to be short it does not fail, but moves half of them.
bool fails_to_move(Kind kind, int descriptor, size_t* bytes);

/// True where a call that fails is to be short instead.
bool is_short();

/// The number of the error that is injected.
int error_number();

/// Writes the report, once.
void write_report();

}  // namespace faults
