// The spectile command.
#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"
#include "src/cli/options/command.hpp"
#include "src/cli/output/messages.hpp"
#include "src/cli/output/print.hpp"

namespace {

int run(int argc, char** argv) {
  using namespace spectile::cli;
  const CommandLine command_line(
      "spectile",
      "Turns RGB textures into spectral OpenEXR images and back, relights them, and accumulates spectral "
      "samples.",
      SPECTILE_VERSION);
  const Command app = command_line.root();
  app.footer(
      "Example:\n  spectile upsample wood.exr -o wood-spectral.exr\n"
      "Exit codes: 0 done, 1 an input that cannot be used, 2 wrong usage, 3 no space, memory or\n"
      "permission, 130 or 143 interrupted (128 and the signal's number).");
  app.require_subcommand();
  int exit = kOk;
  add_demo(app, exit);
  add_upsample(app, exit);
  add_expand(app, exit);
  add_relight(app, exit);
  add_project(app, exit);
  add_convert(app, exit);
  add_info(app, exit);
  add_validate(app, exit);
  add_verify(app, exit);
  add_spectra(app, exit);
  add_plan(app, exit);
  add_fit(app, exit);
  add_film(app, exit);
  add_bench(app, exit);
  try {
    exit = command_line.run(argc, argv).value_or(exit);
  } catch (const Stop& stop) {
    exit = stop.exit;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    print_error("spectile: cannot write to standard output\n");
    return kNoRoom;
  }
  return exit;
}

/// Opens descriptors 0 to 2 on /dev/null where they are closed: the next file that is opened would have their
/// number, and what is printed would go into it.
void open_standard_descriptors() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) static_cast<void>(::open("/dev/null", O_RDWR));
  }
}

/// Where memory ends in a place that cannot report it, such as a thread of a library.
[[noreturn]] void terminate() noexcept {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    spectile::cli::remove_empty_output_folder();
    spectile::cli::print_out_of_memory();
    std::_Exit(spectile::cli::kNoRoom);
  } catch (const std::exception& error) {
    spectile::cli::print_error("spectile: a fault of the tool itself: {}\n", error.what());
  } catch (...) {
  }
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  std::set_terminate(terminate);
  open_standard_descriptors();
  // A file beyond the shell's size limit is then an error like a full disk, and does not end the process.
  static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    spectile::cli::print_out_of_memory();
    return spectile::cli::kNoRoom;
  } catch (const std::filesystem::filesystem_error& error) {
    spectile::cli::print_error("spectile: {}\n", error.what());
    return spectile::cli::kBadInput;
  } catch (const std::system_error& error) {
    // {fmt} throws this where standard output is full or closed.
    spectile::cli::print_error("spectile: cannot write to standard output: {}\n", error.code().message());
    return spectile::cli::kNoRoom;
  } catch (const std::exception& error) {
    spectile::cli::print_error("spectile: {}\n", error.what());
    return spectile::cli::kBadInput;
  }
}
