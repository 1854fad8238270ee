// The progress bar, and the signals that stop a run.
#pragma once

#include <spectile/image/image.hpp>
#include <string>

namespace spectile::cli {

/// Draws a bar on stderr, cleared when the last copy of the function is gone, and stops at signals.
ProgressFunction progress_bar(const std::string& label, bool enabled);

/// True once SIGINT or SIGTERM has come.
bool interrupted();
/// The exit code of a run that a signal stopped: 128 and the signal's number, as shells have it.
int interrupted_exit();
/// Makes SIGINT and SIGTERM end conversions cleanly.
void catch_signals();

}  // namespace spectile::cli
