// An output appears whole or not at all, and nothing else changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

namespace fs = std::filesystem;

class AtomicOutput : public testing::Test {
 protected:
  AtomicOutput() {
    test::Picture picture = test::blank(70, 50);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(folder_ / "good.exr", picture);
    picture.planes.at("G").set(picture.index(69, 49), std::numeric_limits<double>::infinity());
    test::write_scanlines(folder_ / "bad.exr", picture);
  }

  test::TempFolder folder_;
};

TEST_F(AtomicOutput, FailedConversionLeavesTheOldTarget) {
  test::write_text(folder_ / "out.exr", "precious");
  for (const auto kind : {CompressionKind::kNone, CompressionKind::kZip, CompressionKind::kDwab}) {
    UpsampleImageOptions options;
    options.compression = {kind, -1};
    ASSERT_FALSE(upsample_image(folder_ / "bad.exr", folder_ / "out.exr", options));
    EXPECT_EQ(test::file_bytes(folder_ / "out.exr"), "precious");
    EXPECT_EQ(folder_.names(), (std::vector<std::string>{"bad.exr", "good.exr", "out.exr"}));
  }
}

TEST_F(AtomicOutput, TargetIsOldUntilTheLastLineIsWritten) {
  test::write_text(folder_ / "out.exr", "precious");
  UpsampleImageOptions options;
  int calls = 0;
  options.progress = [&](const Progress&) {
    ++calls;
    EXPECT_EQ(test::file_bytes(folder_ / "out.exr"), "precious");
    EXPECT_EQ(folder_.names(), (std::vector<std::string>{"bad.exr", "good.exr", "out.exr"}))
        << "a file under a temporary name while the system can do without";
    return true;
  };
  const auto report = upsample_image(folder_ / "good.exr", folder_ / "out.exr", options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_GT(calls, 1);
  EXPECT_EQ(test::read_picture(folder_ / "out.exr").planes.size(), 63U);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"bad.exr", "good.exr", "out.exr"}));
}

TEST_F(AtomicOutput, InputAndOutputMustDiffer) {
  const std::string before = test::file_bytes(folder_ / "good.exr");
  fs::create_symlink(folder_ / "good.exr", folder_ / "link.exr");
  fs::create_hard_link(folder_ / "good.exr", folder_ / "twin.exr");
  const std::string detour = folder_ / "../" + folder_.path().filename().string() + "/good.exr";
  for (const std::string& output :
       {folder_ / "good.exr", folder_ / "link.exr", folder_ / "twin.exr", detour}) {
    const auto report = upsample_image(folder_ / "good.exr", output, test::kUpsample);
    ASSERT_FALSE(report) << output;
    EXPECT_EQ(report.error().code, ErrorCode::kBadArgument) << output;
    const auto projected = project_image(folder_ / "good.exr", output, test::kProject);
    ASSERT_FALSE(projected) << output;
    EXPECT_EQ(projected.error().code, ErrorCode::kBadArgument) << output;
  }
  EXPECT_EQ(test::file_bytes(folder_ / "good.exr"), before);
}

TEST_F(AtomicOutput, LinkStaysAndItsTargetIsReplaced) {
  fs::create_directory(folder_ / "elsewhere");
  test::write_text(folder_ / "elsewhere/real.exr", "old");
  fs::create_symlink("elsewhere/real.exr", folder_ / "link.exr");
  ASSERT_FALSE(upsample_image(folder_ / "bad.exr", folder_ / "link.exr", test::kUpsample));
  EXPECT_EQ(test::file_bytes(folder_ / "elsewhere/real.exr"), "old");
  ASSERT_TRUE(upsample_image(folder_ / "good.exr", folder_ / "link.exr", test::kUpsample));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.exr"));
  EXPECT_EQ(test::read_picture(folder_ / "elsewhere/real.exr").planes.size(), 63U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "elsewhere"), fs::directory_iterator()), 1);
}

TEST_F(AtomicOutput, ReplacedFileKeepsItsMode) {
  test::write_text(folder_ / "out.exr", "old");
  ASSERT_EQ(::chmod((folder_ / "out.exr").c_str(), 0640), 0);
  ASSERT_TRUE(upsample_image(folder_ / "good.exr", folder_ / "out.exr", test::kUpsample));
  struct stat status {};
  ASSERT_EQ(::stat((folder_ / "out.exr").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST_F(AtomicOutput, NewFileObeysTheUmask) {
  const mode_t before = ::umask(027);
  const auto report = upsample_image(folder_ / "good.exr", folder_ / "out.exr", test::kUpsample);
  ::umask(before);
  ASSERT_TRUE(report);
  struct stat status {};
  ASSERT_EQ(::stat((folder_ / "out.exr").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST_F(AtomicOutput, NameMayBeAsLongAsTheSystemAllows) {
  // 255 bytes, NAME_MAX of the usual file systems: a temporary name beside it must not be longer.
  const std::string name = std::string(251, 'x') + ".exr";
  const auto report = upsample_image(folder_ / "good.exr", folder_ / name, test::kUpsample);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"bad.exr", "good.exr", name}));
}

TEST_F(AtomicOutput, ImpossibleTargetsAreErrorsThatNameThem) {
  fs::create_directory(folder_ / "folder");
  const std::vector<std::string> before = folder_.names();
  for (const std::string& output :
       {folder_ / "folder", folder_ / "missing/out.exr", folder_ / "good.exr/out.exr",
        std::string("/dev/null"), std::string("/dev/full"), std::string()}) {
    const auto report = upsample_image(folder_ / "good.exr", output, test::kUpsample);
    ASSERT_FALSE(report) << output;
    EXPECT_EQ(report.error().code, ErrorCode::kBadFile) << output;
    EXPECT_THAT(report.error().message, testing::HasSubstr(output));
    EXPECT_EQ(folder_.names(), before) << output;
  }
}

TEST_F(AtomicOutput, WrittenRgbImageIsReadBack) {
  auto rgb = ColorLanes::create(5 * 3);
  ASSERT_TRUE(rgb);
  for (std::size_t i = 0; i < 15; ++i) {
    for (std::size_t k = 0; k < 3; ++k) rgb->at(i, k) = static_cast<float>(i) + 0.25F * static_cast<float>(k);
  }
  ASSERT_TRUE(write_rgb_image(folder_ / "rgb.exr", rgb->view(), 5, 3));
  const auto read = read_rgb_image(folder_ / "rgb.exr");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->width, 5);
  ASSERT_EQ(read->height, 3);
  for (std::size_t i = 0; i < 15; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(read->rgb.at(i, k), rgb->at(i, k));
  }
  const auto wrong = write_rgb_image(folder_ / "wrong.exr", rgb->view(), 5, 4);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::kSizeMismatch);
  EXPECT_FALSE(fs::exists(folder_ / "wrong.exr"));
}

}  // namespace
}  // namespace spectile
