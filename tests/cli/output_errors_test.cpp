// Outputs that cannot be written: no permission, no space, no plain file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
namespace fs = std::filesystem;

class OutputErrors : public testing::Test {
 protected:
  OutputErrors() {
    // 64 lines of 300 pixels and 60 half bands: 2.4 MB without compression.
    test::Picture picture = test::blank(300, 64);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(good_, picture);
  }

  test::Outcome upsample(const std::string& target, const test::Tool::Options& options = {}) {
    return run_tool({"upsample", good_, "-o", target, "--compression", "none"}, options);
  }

  void expect_failure(const std::string& target, int exit, const test::Tool::Options& options = {}) {
    const auto outcome = upsample(target, options);
    EXPECT_EQ(outcome.exit, exit) << target << "\n" << outcome;
    EXPECT_TRUE(outcome.one_line()) << target << "\n" << outcome;
    EXPECT_THAT(outcome.err, testing::HasSubstr(target));
    EXPECT_EQ(outcome.out, "");
  }

  test::TempFolder folder_;
  const std::string good_ = folder_ / "good.exr";
};

/// A small file system of its own in this process's own view of the mounts; gone with it.
class Mount {
 public:
  Mount(std::string path, const std::string& options) : path_(std::move(path)) {
    fs::create_directory(path_);
    if (::unshare(CLONE_NEWNS) != 0) return;
    if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return;
    made_ = ::mount("tmpfs", path_.c_str(), "tmpfs", 0, options.c_str()) == 0;
  }
  ~Mount() {
    if (made_) ::umount2(path_.c_str(), MNT_DETACH);
  }
  Mount(const Mount&) = delete;
  Mount& operator=(const Mount&) = delete;
  bool made() const { return made_; }
  bool make_read_only() {
    return ::mount("none", path_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) == 0;
  }

 private:
  std::string path_;
  bool made_ = false;
};

/// Becomes a user without rights, where it is the one with all.
bool become_nobody() {
  constexpr uid_t kNobody = 65534;
  return ::geteuid() != 0 || (::setgid(kNobody) == 0 && ::setuid(kNobody) == 0);
}

TEST_F(OutputErrors, FullDiskIsNoSpaceAndLeavesNothing) {
  // The disk fills in the header, after a few lines, and near the end.
  for (const char* size : {"size=4k", "size=64k", "size=1m", "size=2m"}) {
    const Mount disk(folder_ / "disk", size);
    if (!disk.made()) GTEST_SKIP() << "may not mount a small disk here";
    expect_failure(folder_ / "disk/out.exr", 3);
    EXPECT_TRUE(fs::is_empty(folder_ / "disk")) << size;
  }
}

TEST_F(OutputErrors, FullDiskLeavesTheOldTarget) {
  const Mount disk(folder_ / "disk", "size=1m");
  if (!disk.made()) GTEST_SKIP() << "may not mount a small disk here";
  test::write_text(folder_ / "disk/out.exr", "precious");
  expect_failure(folder_ / "disk/out.exr", 3);
  EXPECT_EQ(test::file_bytes(folder_ / "disk/out.exr"), "precious");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "disk"), fs::directory_iterator()), 1);
}

TEST_F(OutputErrors, FullDiskStopsEveryFileOfSeveralWithItsOwnLine) {
  const Mount disk(folder_ / "disk", "size=64k");
  if (!disk.made()) GTEST_SKIP() << "may not mount a small disk here";
  fs::copy_file(good_, folder_ / "other.exr");
  const auto outcome = run_tool({"upsample", good_, folder_ / "other.exr", "-o", folder_ / "disk"});
  EXPECT_EQ(outcome.exit, 3) << outcome;
  EXPECT_EQ(test::lines(outcome.err).size(), 2U) << outcome;
  EXPECT_TRUE(fs::is_empty(folder_ / "disk"));
}

TEST_F(OutputErrors, ReadOnlyDiskIsNoPermission) {
  Mount disk(folder_ / "disk", "size=8m");
  if (!disk.made() || !disk.make_read_only()) GTEST_SKIP() << "may not mount a small disk here";
  expect_failure(folder_ / "disk/out.exr", 3);
  expect_failure(folder_ / "disk/new/", 3);
}

TEST_F(OutputErrors, SizeLimitOfTheShellIsNoSpace) {
  expect_failure(folder_ / "out.exr", 3, {.before = [] {
                   const rlimit limit = {1 << 20, 1 << 20};
                   return ::setrlimit(RLIMIT_FSIZE, &limit) == 0;
                 }});
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"good.exr"});
}

TEST_F(OutputErrors, ForbiddenFolderOrFileIsNoPermission) {
  fs::create_directory(folder_ / "closed");
  fs::create_directory(folder_ / "open");
  test::write_text(folder_ / "open/old.exr", "precious");
  fs::copy_file(SPECTILE_TOOL, folder_ / "tool");
  ASSERT_EQ(::chmod((folder_ / "closed").c_str(), 0555), 0);
  ASSERT_EQ(::chmod((folder_ / "open").c_str(), 0777), 0);
  ASSERT_EQ(::chmod((folder_ / "open/old.exr").c_str(), 0444), 0);
  ASSERT_EQ(::chmod((folder_ / "good.exr").c_str(), 0444), 0);
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
  const test::Tool::Options nobody = {.before = become_nobody, .program = folder_ / "tool"};
  if (run_tool({"--version"}, nobody).exit != 0)
    GTEST_SKIP() << "no user without rights can run the tool here";
  expect_failure(folder_ / "closed/out.exr", 3, nobody);
  expect_failure(folder_ / "open/old.exr", 3, nobody);
  expect_failure(folder_ / "closed/new/", 3, nobody);
  EXPECT_EQ(test::file_bytes(folder_ / "open/old.exr"), "precious");
  const auto written = upsample(folder_ / "open/new.exr", nobody);
  EXPECT_EQ(written.exit, 0) << written;
  // An input that may not be read.
  ASSERT_EQ(::chmod((folder_ / "good.exr").c_str(), 0), 0);
  const auto hidden = run_tool({"info", good_}, nobody);
  EXPECT_EQ(hidden.exit, 3) << hidden;
  EXPECT_TRUE(hidden.one_line()) << hidden;
}

TEST_F(OutputErrors, MissingFolderIsBadInput) {
  expect_failure(folder_ / "missing/out.exr", 1);
}

TEST_F(OutputErrors, PathBelowAFileIsBadInput) {
  expect_failure(folder_ / "good.exr/out.exr", 1);
}

TEST_F(OutputErrors, FolderThatCannotBeMadeIsWrongUsage) {
  expect_failure(folder_ / "good.exr/", 2);
  fs::copy_file(good_, folder_ / "other.exr");
  const auto outcome = run_tool({"upsample", good_, folder_ / "other.exr", "-o", good_});
  EXPECT_EQ(outcome.exit, 2) << outcome;
  EXPECT_TRUE(outcome.one_line()) << outcome;
}

TEST_F(OutputErrors, ProcIsAClearError) {
  const auto outcome = upsample("/proc/out.exr");
  EXPECT_TRUE(outcome.exit == 1 || outcome.exit == 3) << outcome;
  EXPECT_TRUE(outcome.one_line()) << outcome;
}

TEST_F(OutputErrors, DeviceIsAClearErrorAndStaysADevice) {
  for (const char* device : {"/dev/full", "/dev/null"}) {
    expect_failure(device, 1);
    EXPECT_TRUE(fs::is_character_file(device));
  }
}

TEST_F(OutputErrors, PipeIsAClearErrorAndStaysAPipe) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0666), 0);
  const auto outcome =
      test::Tool({"upsample", good_, "-o", folder_ / "pipe"}, {}).finish(std::chrono::seconds(10));
  EXPECT_FALSE(outcome.late);
  EXPECT_EQ(outcome.exit, 1) << outcome;
  EXPECT_TRUE(outcome.one_line()) << outcome;
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
}

TEST_F(OutputErrors, FullStandardOutputIsNoSpace) {
  for (const auto& arguments : {std::vector<std::string>{"info", good_}, {"verify", good_, "--json"}}) {
    const auto outcome = run_tool(arguments, {.stdout_path = "/dev/full"});
    EXPECT_EQ(outcome.exit, 3) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
  }
}

}  // namespace
}  // namespace spectile
