// Running the tool as a user does: arguments, environment, limits; exit code, signal and both outputs.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/sanitized.hpp"

namespace spectile::test {

/// How a process ended.
struct Outcome {
  int exit = -1;      ///< -1 when a signal ended it
  int signal = 0;     ///< 0 when it exited
  bool late = false;  ///< killed for taking too long
  long peak_mib = 0;  ///< the largest that it was in memory
  std::string out;
  std::string err;

  /// True if stderr holds exactly one line of the tool.
  bool one_line() const {
    return err.starts_with("spectile: ") && std::count(err.begin(), err.end(), '\n') == 1 &&
           err.back() == '\n';
  }
  std::string text() const {
    return "exit " + std::to_string(exit) + ", signal " + std::to_string(signal) +
           (late ? ", too late" : "") + "\nstdout: " + out + "\nstderr: " + err;
  }
};

inline std::ostream& operator<<(std::ostream& to, const Outcome& outcome) {
  return to << outcome.text();
}

/// A process of the tool; killed when it goes out of scope unfinished.
class Tool {
 public:
  struct Options {
    std::vector<std::pair<std::string, std::string>> environment = {};
    std::function<bool()> before =
        nullptr;  ///< in the child, just before the tool starts; false: it does not
    std::string program = SPECTILE_TOOL;
    std::string stdout_path = {};  ///< empty: kept
  };

  explicit Tool(const std::vector<std::string>& arguments, const Options& options) {
    out_ = ::memfd_create("stdout", MFD_CLOEXEC);
    err_ = ::memfd_create("stderr", MFD_CLOEXEC);
    std::vector<char*> argv = {const_cast<char*>(options.program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    // The child.
    const int out = options.stdout_path.empty() ? out_ : ::open(options.stdout_path.c_str(), O_WRONLY);
    const int in = ::open("/dev/null", O_RDONLY);
    if (::dup2(in, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err_, 2) < 0) ::_exit(120);
    for (const auto& [name, value] : options.environment) ::setenv(name.c_str(), value.c_str(), 1);
    if (options.before && !options.before()) ::_exit(121);
    ::execv(options.program.c_str(), argv.data());
    ::_exit(122);
  }
  ~Tool() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(out_);
    ::close(err_);
  }
  Tool(const Tool&) = delete;
  Tool& operator=(const Tool&) = delete;

  pid_t pid() const { return pid_; }
  bool running() {
    if (pid_ > 0 && ::wait4(pid_, &status_, WNOHANG, &usage_) == pid_) pid_ = 0;
    return pid_ > 0;
  }
  /// Waits for the end, at most so long; then kills.
  Outcome finish(std::chrono::seconds limit = std::chrono::seconds(kSanitized ? 600 : 60)) {
    const auto end = std::chrono::steady_clock::now() + limit;
    Outcome outcome;
    while (running()) {
      if (!outcome.late && std::chrono::steady_clock::now() > end) {
        outcome.late = true;
        ::kill(pid_, SIGKILL);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (WIFEXITED(status_)) outcome.exit = WEXITSTATUS(status_);
    if (WIFSIGNALED(status_)) outcome.signal = WTERMSIG(status_);
    outcome.peak_mib = usage_.ru_maxrss / 1024;
    outcome.out = contents(out_);
    outcome.err = contents(err_);
    return outcome;
  }
  /// Waits until the tool handles SIGINT itself, which it does once it begins to convert. False when it ended
  /// before.
  bool wait_until_converting() {
    for (int i = 0; i < 20000 && running(); ++i) {
      if (handles_signal(SIGINT)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }

 private:
  bool handles_signal(int number) const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (!line.starts_with("SigCgt:")) continue;
      return ((std::stoull(line.substr(7), nullptr, 16) >> (number - 1)) & 1U) != 0;
    }
    return false;
  }
  static std::string contents(int fd) {
    std::string text(static_cast<std::size_t>(::lseek(fd, 0, SEEK_END)), '\0');
    const ssize_t got = ::pread(fd, text.data(), text.size(), 0);
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return text;
  }
  int out_ = -1;
  int err_ = -1;
  int status_ = 0;
  rusage usage_{};
  pid_t pid_ = -1;
};

inline Outcome run_tool(const std::vector<std::string>& arguments, const Tool::Options& options = {}) {
  return Tool(arguments, options).finish();
}

/// The lines of a text.
inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(line);
  return out;
}

/// One JSON object a line; a line that is none fails the test.
inline std::vector<nlohmann::json> json_lines(const std::string& text) {
  std::vector<nlohmann::json> out;
  for (const std::string& line : lines(text)) {
    out.push_back(nlohmann::json::parse(line, nullptr, false));
    EXPECT_TRUE(out.back().is_object()) << line;
  }
  return out;
}

/// Limits the address space, but under a sanitizer, which reserves most of it.
inline bool limit_memory(rlim_t bytes) {
  const rlimit limit = {bytes, bytes};
  return kSanitized || ::setrlimit(RLIMIT_AS, &limit) == 0;
}

}  // namespace spectile::test
