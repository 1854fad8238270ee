// Files damaged on purpose end in a clear error or a proper result, never in a crash or without memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

namespace fs = std::filesystem;

class InputErrors : public testing::Test {
 protected:
  /// Runs a command on a file with 4 GiB of address space.
  void check(const std::vector<std::string>& arguments, bool writes) {
    const auto outcome =
        test::run_tool(arguments, {.before = [] { return test::limit_memory(rlim_t{4} << 30); }});
    const std::string what = testing::PrintToString(arguments);
    EXPECT_FALSE(outcome.late) << what;
    EXPECT_EQ(outcome.signal, 0) << what << "\n" << outcome;
    EXPECT_THAT(outcome.exit, testing::AnyOf(0, 1, 2, 3)) << what << "\n" << outcome;
    if (outcome.exit == 0) {
      EXPECT_EQ(outcome.err, "") << what;
      EXPECT_EQ(fs::exists(out_), writes) << what;
      ++good_;
    } else {
      EXPECT_TRUE(outcome.one_line()) << what << "\n" << outcome;
      EXPECT_EQ(outcome.out, "") << what;
      EXPECT_FALSE(fs::exists(out_)) << what;
      ++bad_;
    }
    fs::remove(out_);
    EXPECT_TRUE(fs::is_empty(folder_.path()))
        << what << " leaves " << testing::PrintToString(folder_.names());
  }

  void check_file(const std::string& path) {
    check({"info", path}, false);
    check({"upsample", path, "-o", out_, "--nonfinite", "zero"}, true);
    check({"project", path, "-o", out_, "--nonfinite", "zero"}, true);
    check({"verify", path}, false);
  }

  test::TempFolder folder_;
  const std::string out_ = folder_ / "out.exr";
  int good_ = 0;
  int bad_ = 0;
};

TEST_F(InputErrors, OfOpenExrsOwnCollectionNeverCrash) {
  SPECTILE_NEEDS_IMAGES("damaged");
  const auto files = test::shared_files("damaged");
  ASSERT_FALSE(files.empty());
  for (const std::string& path : files) check_file(path);
  RecordProperty("runs_refused", bad_);
  RecordProperty("runs_done", good_);
  EXPECT_GT(bad_, good_);
}

TEST_F(InputErrors, WithASingleWrongByteNeverCrash) {
  const test::TempFolder inputs;
  test::Picture picture = test::blank(70, 40);
  picture.header.compression() = Imf::PIZ_COMPRESSION;
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(inputs / "good.exr", picture);
  const std::string good = test::file_bytes(inputs / "good.exr");
  // Bytes all over the header and the chunk table, which decide on sizes and places.
  std::uint32_t state = 1;
  for (int i = 0; i < 60; ++i) {
    state = state * 1664525U + 1013904223U;
    std::string bytes = good;
    const std::size_t at = 4 + (state >> 8) % 500;
    bytes[at] = static_cast<char>(i % 3 == 0 ? 0xFF : bytes[at] ^ (1 << (state >> 5) % 8));
    test::write_text(inputs / "bad.exr", bytes);
    check({"upsample", inputs / "bad.exr", "-o", out_, "--nonfinite", "zero"}, true);
  }
}

TEST_F(InputErrors, ClaimingHugeSizesTakeNoMemory) {
  const test::TempFolder inputs;
  test::Picture picture = test::blank(8, 8);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(inputs / "good.exr", picture);
  const std::string good = test::file_bytes(inputs / "good.exr");
  const std::string name("dataWindow\0box2i\0", 17);
  const std::size_t at = good.find(name);
  ASSERT_NE(at, std::string::npos);
  // The lower right corner follows name, type, size and upper left corner.
  const std::size_t corner = at + name.size() + 4 + 8;
  for (const auto& [width, height] : {std::pair{2000000000, 8},
                                      {8, 2000000000},
                                      {2147483647, 2147483647},
                                      {250000, 250000},
                                      {260000, 8},
                                      {-5, -5}}) {
    std::string bytes = good;
    const std::int32_t values[] = {width, height};
    std::memcpy(bytes.data() + corner, values, sizeof(values));
    test::write_text(inputs / "huge.exr", bytes);
    check_file(inputs / "huge.exr");
  }
  EXPECT_EQ(good_, 0);
}

}  // namespace
}  // namespace spectile
