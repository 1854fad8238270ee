// A run that is killed or interrupted leaves nothing that looks finished.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <cstddef>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

namespace fs = std::filesystem;

/// Makes the system refuse files without a name, as some file systems do.
bool refuse_nameless_files() {
  // __O_TMPFILE of the kernel; O_TMPFILE holds O_DIRECTORY too.
  constexpr std::uint32_t kNameless = O_TMPFILE & ~O_DIRECTORY;
  sock_filter steps[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[2])),
      BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, kNameless, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EOPNOTSUPP),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog program = {static_cast<unsigned short>(std::size(steps)), steps};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

class Interruption : public testing::Test {
 protected:
  Interruption() {
    fs::create_directory(folder_ / "target");
    // Takes some seconds with the slowest compression.
    test::Picture picture = test::blank(2048, 768);
    picture.header.compression() = Imf::NO_COMPRESSION;
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(folder_ / "in.exr", picture);
  }

  std::vector<std::string> arguments() const {
    return {"upsample", folder_ / "in.exr", "-o", folder_ / "target/out.exr", "--compression", "zip:9"};
  }

  std::vector<std::string> left() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_ / "target"))
      out.push_back(entry.path().filename());
    return out;
  }

  /// Nothing at the target, and nothing that anyone takes for an image.
  void expect_nothing_finished() const {
    for (const std::string& name : left()) {
      EXPECT_TRUE(name.starts_with('.') && name.ends_with(".part")) << name;
    }
  }

  /// Lets the tool convert for so long, then sends the signal.
  static test::Outcome stop_after(test::Tool& tool, int milliseconds, int signal) {
    EXPECT_TRUE(tool.wait_until_converting());
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    EXPECT_TRUE(tool.running()) << "the run is over after " << milliseconds << " ms";
    ::kill(tool.pid(), signal);
    return tool.finish(std::chrono::seconds(20));
  }

  test::TempFolder folder_;
};

constexpr int kMoments[] = {0, 20, 150, 500};

TEST_F(Interruption, LeavesNothing) {
  for (const int moment : kMoments) {
    test::Tool tool(arguments(), {});
    const auto outcome = stop_after(tool, moment, SIGKILL);
    EXPECT_EQ(outcome.signal, SIGKILL);
    EXPECT_THAT(left(), testing::IsEmpty()) << moment << " ms";
  }
}

TEST_F(Interruption, LeavesNothingFinishedWhereFilesMustHaveNames) {
  for (const int moment : kMoments) {
    test::Tool tool(arguments(), {.before = refuse_nameless_files});
    const auto outcome = stop_after(tool, moment, SIGKILL);
    if (outcome.exit == 121) GTEST_SKIP() << "system calls cannot be filtered here";
    EXPECT_EQ(outcome.signal, SIGKILL);
    expect_nothing_finished();
  }
}

TEST_F(Interruption, LeavesTheOldTarget) {
  test::write_text(folder_ / "target/out.exr", "precious");
  for (const int signal : {SIGKILL, SIGINT, SIGTERM}) {
    test::Tool tool(arguments(), {});
    stop_after(tool, 100, signal);
    EXPECT_EQ(test::file_bytes(folder_ / "target/out.exr"), "precious");
    EXPECT_THAT(left(), testing::ElementsAre("out.exr"));
  }
}

TEST_F(Interruption, InterruptEndsWithOneLineAndItsOwnCode) {
  for (const int signal : {SIGINT, SIGTERM}) {
    for (const int moment : kMoments) {
      test::Tool tool(arguments(), {});
      const auto outcome = stop_after(tool, moment, signal);
      EXPECT_EQ(outcome.exit, 128 + signal) << outcome;
      EXPECT_TRUE(outcome.one_line()) << outcome;
      EXPECT_EQ(outcome.out, "");
      EXPECT_THAT(left(), testing::IsEmpty()) << moment << " ms";
    }
  }
}

TEST_F(Interruption, InterruptTidiesUpWhereFilesMustHaveNames) {
  for (const int moment : kMoments) {
    test::Tool tool(arguments(), {.before = refuse_nameless_files});
    const auto outcome = stop_after(tool, moment, SIGINT);
    if (outcome.exit == 121) GTEST_SKIP() << "system calls cannot be filtered here";
    EXPECT_EQ(outcome.exit, 130) << outcome;
    EXPECT_THAT(left(), testing::IsEmpty()) << moment << " ms";
  }
}

TEST_F(Interruption, FinishedRunIsTheSameWhereFilesMustHaveNames) {
  test::Picture picture = test::blank(70, 20);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder_ / "small.exr", picture);
  const auto named = test::run_tool({"upsample", folder_ / "small.exr", "-o", folder_ / "target/named.exr"},
                                    {.before = refuse_nameless_files});
  if (named.exit == 121) GTEST_SKIP() << "system calls cannot be filtered here";
  EXPECT_EQ(named.exit, 0) << named;
  const auto nameless =
      test::run_tool({"upsample", folder_ / "small.exr", "-o", folder_ / "target/nameless.exr"});
  EXPECT_EQ(nameless.exit, 0) << nameless;
  EXPECT_EQ(left().size(), 2U);
  EXPECT_EQ(test::file_bytes(folder_ / "target/named.exr"),
            test::file_bytes(folder_ / "target/nameless.exr"));
}

TEST_F(Interruption, InterruptEndsAWholeBatch) {
  fs::copy_file(folder_ / "in.exr", folder_ / "second.exr");
  test::Tool tool({"upsample", folder_ / "in.exr", folder_ / "second.exr", "-o", folder_ / "target",
                   "--compression", "zip:9"},
                  {});
  const auto outcome = stop_after(tool, 50, SIGINT);
  EXPECT_EQ(outcome.exit, 130) << outcome;
  EXPECT_THAT(left(), testing::IsEmpty());
}

TEST_F(Interruption, PlansAnswerWithinASecond) {
  // Some 20 seconds of work, of which the signal comes at the beginning or in the middle.
  for (const int moment : {50, 1500}) {
    test::Tool tool({"plan", "--illuminant", "D65", "--illuminant", "A", "--illuminant", "FL11", "--count",
                     "16", "-o", folder_ / "target/plan.json"},
                    {});
    ASSERT_TRUE(tool.wait_until_converting());
    std::this_thread::sleep_for(std::chrono::milliseconds(moment));
    ASSERT_TRUE(tool.running());
    const auto start = std::chrono::steady_clock::now();
    ::kill(tool.pid(), SIGTERM);
    const auto outcome = tool.finish(std::chrono::seconds(20));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(outcome.exit, 128 + SIGTERM) << outcome;
    EXPECT_LT(took.count(), test::kSanitized ? 20 : 2) << moment;
    EXPECT_THAT(left(), testing::IsEmpty());
  }
}

TEST_F(Interruption, InterruptEndsTheDemo) {
  test::Tool tool({"demo", folder_ / "demo"}, {});
  ASSERT_TRUE(tool.wait_until_converting());
  ::kill(tool.pid(), SIGINT);
  const auto outcome = tool.finish(std::chrono::seconds(60));
  // By its own code, or as the signal does by default.
  EXPECT_TRUE(outcome.exit == 130 || outcome.signal == SIGINT) << outcome;
}

}  // namespace
}  // namespace spectile
