// Threads that calls with an option `threads` run on.
#pragma once

namespace spectile {

/// Threads that a call with `requested` threads runs on: that many, or one per core that this process may use
/// for 0 or less, but fewer where the system makes no more (limits on processes or memory). They are made now
/// and stay, so that memory taken later cannot be what they lack; calls that need more make them themselves.
int available_threads(int requested);

/// True where the system has refused to make a thread, or memory ended while one was made.
bool threads_refused() noexcept;

}  // namespace spectile
