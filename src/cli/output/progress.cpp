// The progress bar, and the signals that stop a run.
#include "src/cli/output/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>

#include "src/cli/output/messages.hpp"
#include "src/cli/output/print.hpp"

namespace spectile::cli {
namespace {

volatile std::sig_atomic_t signal_seen = 0;

extern "C" void note_signal(int signal) {
  signal_seen = signal;
}

/// A bar on stderr, redrawn ten times a second at most; nothing where stderr is no terminal.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool enabled)
      : label_(std::move(label)), shown_(enabled && ::isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() {
    if (drawn_) print_error("\r\033[K");
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  bool update(const Progress& progress) {
    if (interrupted()) return false;
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now - last_ < std::chrono::milliseconds(100)) return true;
    last_ = now;
    drawn_ = true;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double done = static_cast<double>(progress.pixels_done) / static_cast<double>(progress.pixels);
    constexpr int kWidth = 30;
    const int full = static_cast<int>(done * kWidth);
    print_error("\r\033[K{} [{:#<{}}{:.<{}}] {:3.0f} %  {}  {:.0f} s left", label_, "", full, "",
                kWidth - full, 100 * done, speed_text(progress.pixels_done, seconds),
                seconds / done * (1 - done));
    static_cast<void>(std::fflush(stderr));
    return true;
  }

 private:
  std::string label_;
  bool shown_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = start_ - std::chrono::seconds(1);
};

}  // namespace

ProgressFunction progress_bar(const std::string& label, bool enabled) {
  const auto bar = std::make_shared<ProgressBar>(label, enabled);
  return [bar](const Progress& progress) { return bar->update(progress); };
}

bool interrupted() {
  return signal_seen != 0;
}

int interrupted_exit() {
  return signal_seen == 0 ? kInterrupted : kSignalBase + signal_seen;
}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  sigemptyset(&action.sa_mask);
  // A second signal ends the process at once.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace spectile::cli
