// Errors in a command line or a file are one line, with the exit code of its kind.
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <spectile/isa.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
namespace fs = std::filesystem;

class Usage : public testing::Test {
 protected:
  Usage() {
    test::Picture picture = test::blank(40, 20);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(good_, picture);
  }

  /// Runs and expects one line on stderr, nothing on stdout, the exit code, and no output file.
  void expect_failure(const std::vector<std::string>& arguments, int exit, const std::string& named,
                      const test::Tool::Options& options = {}) {
    const auto outcome = run_tool(arguments, options);
    const std::string what = testing::PrintToString(arguments);
    EXPECT_EQ(outcome.exit, exit) << what << "\n" << outcome;
    EXPECT_TRUE(outcome.one_line()) << what << "\n" << outcome;
    EXPECT_EQ(outcome.out, "") << what;
    EXPECT_THAT(outcome.err, testing::HasSubstr(named)) << what;
    EXPECT_FALSE(fs::exists(out_)) << what;
  }

  /// A file that every command must refuse as bad input.
  void expect_bad_input(const std::string& path) {
    expect_failure({"upsample", path, "-o", out_}, 1, path);
    expect_failure({"project", path, "-o", out_}, 1, path);
    expect_failure({"info", path}, 1, path);
    expect_failure({"verify", path}, 1, path);
  }

  test::TempFolder folder_;
  const std::string good_ = folder_ / "good.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(Usage, MissingFileIsBadInput) {
  expect_bad_input(folder_ / "missing.exr");
}

TEST_F(Usage, DirectoryIsBadInput) {
  expect_bad_input(folder_.path().string());
}

TEST_F(Usage, TextIsBadInput) {
  test::write_text(folder_ / "text.exr", "These are words, not pixels.\n");
  expect_bad_input(folder_ / "text.exr");
}

TEST_F(Usage, EmptyFileIsBadInput) {
  test::write_text(folder_ / "empty.exr", "");
  expect_bad_input(folder_ / "empty.exr");
}

TEST_F(Usage, MagicNumberAloneIsBadInput) {
  test::write_text(folder_ / "short.exr", test::file_bytes(good_).substr(0, 8));
  expect_bad_input(folder_ / "short.exr");
}

TEST_F(Usage, TruncatedFileIsBadInput) {
  const std::string bytes = test::file_bytes(good_);
  for (const double share : {0.1, 0.5, 0.9}) {
    const auto length = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    test::write_text(folder_ / "cut.exr", bytes.substr(0, length));
    expect_bad_input(folder_ / "cut.exr");
  }
}

TEST_F(Usage, DeviceIsBadInput) {
  expect_bad_input("/dev/zero");
}

TEST_F(Usage, PipeIsBadInputAndDoesNotHang) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.exr").c_str(), 0666), 0);
  for (const char* command : {"info", "verify"}) {
    const auto outcome = test::Tool({command, folder_ / "pipe.exr"}, {}).finish(std::chrono::seconds(5));
    EXPECT_FALSE(outcome.late) << command << " waits for a writer";
    EXPECT_EQ(outcome.exit, 1) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
  }
}

TEST_F(Usage, DeepImageIsBadInput) {
  Imf::Header header(4, 3);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  std::vector<unsigned> counts(12, 1);
  std::vector<float> samples(12, 0.5F);
  std::vector<float*> pointers;
  for (float& sample : samples) pointers.push_back(&sample);
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), 4, 16));
  frame.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*),
                                   4 * sizeof(float*), sizeof(float)));
  {
    Imf::DeepScanLineOutputFile file((folder_ / "deep.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(3);
  }
  expect_bad_input(folder_ / "deep.exr");
  EXPECT_THAT(run_tool({"info", folder_ / "deep.exr"}).err, testing::HasSubstr("deep"));
}

TEST_F(Usage, ImageWithoutRgbIsBadInput) {
  test::Picture picture = test::blank(10, 10);
  picture.add("G", Imf::FLOAT, [](int, int) { return 1.0; });
  test::write_scanlines(folder_ / "green.exr", picture);
  expect_failure({"upsample", folder_ / "green.exr", "-o", out_}, 1, "R, G, B");
  expect_failure({"project", folder_ / "green.exr", "-o", out_}, 1, "spectral");
  expect_failure({"verify", folder_ / "green.exr"}, 1, "green.exr");
  EXPECT_EQ(run_tool({"info", folder_ / "green.exr"}).exit, 0);
}

TEST_F(Usage, RealImageWithoutRgbIsBadInput) {
  SPECTILE_NEEDS_IMAGES("rgb");
  expect_failure({"upsample", (test::shared_images("rgb") / "WideFloatRange.exr").string(), "-o", out_}, 1,
                 "WideFloatRange.exr");
}

TEST_F(Usage, RgbIsNoInputForProject) {
  expect_failure({"project", good_, "-o", out_}, 1, "has no spectral channels");
}

TEST_F(Usage, WrongOptionsAreWrongUsage) {
  const std::vector<std::vector<std::string>> wrong = {
      {"--no-such-option"},      {"--method", "magic"},       {"--quantity", "colour"},
      {"--compression", "lzma"}, {"--compression", "zip:77"}, {"--pixel", "double"},
      {"--nonfinite", "ignore"}, {"--negative", "flip"},      {"--out-of-gamut", "move"},
      {"--bands", "700:400:5"},  {"--bands", "400:700:7"},    {"--bands", "few"},
      {"--bands", ""},           {"--threads", "-1"},         {"--threads", "many"},
      {"--lanes", "0"},          {"--tile", "64", "5000"},    {"--lanes", "63"},
      {"--isa", "avx1024"}};
  for (const auto& options : wrong) {
    std::vector<std::string> arguments = {"upsample", good_, "-o", out_};
    arguments.insert(arguments.end(), options.begin(), options.end());
    // A range of bands is named by its numbers, other values as they are.
    const std::string value = options.back();
    expect_failure(arguments, 2, value.find(':') == 3 ? value.substr(0, 3) : value.empty() ? "bands" : value);
  }
  expect_failure({"project", good_, "-o", out_, "--illuminant", "D66"}, 2, "D66");
  expect_failure({"project", good_, "-o", out_, "--observer", "2006"}, 2, "2006");
  expect_failure({"project", good_, "-o", out_, "--to", "lab"}, 2, "lab");
  expect_failure({"info", good_, "--pixel", "1;2"}, 2, "1;2");
  expect_failure({"info", good_, "--pixel", "40,0"}, 2, "40,0");
  expect_failure({"upsample", good_}, 2, "output");
  expect_failure({"upsample", "-o", out_}, 2, "IN");
  expect_failure({"paint", good_}, 2, "spectile");
  expect_failure({}, 2, "subcommand");
}

TEST_F(Usage, InstructionSetThatCannotRunHereIsWrongUsage) {
  const auto isas = available_isas();
  for (const std::string isa : {"sse4.2", "avx2", "avx512", "neon"}) {
    if (std::find(isas.begin(), isas.end(), isa) != isas.end()) continue;
    expect_failure({"upsample", good_, "-o", out_, "--isa", isa}, 2, isa);
    expect_failure({"verify", good_}, 2, isa, {.environment = {{"SPECTILE_ISA", isa}}});
  }
}

TEST_F(Usage, EnvironmentNamesTheInstructionSet) {
  expect_failure({"upsample", good_, "-o", out_}, 2, "bogus", {.environment = {{"SPECTILE_ISA", "bogus"}}});
  const auto outcome = run_tool({"verify", good_, "--json"}, {.environment = {{"SPECTILE_ISA", "scalar"}}});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_EQ(test::json_lines(outcome.out).at(0)["isa"], "scalar");
  // The option wins.
  const auto forced =
      run_tool({"verify", good_, "--json", "--isa", "scalar"}, {.environment = {{"SPECTILE_ISA", "bogus"}}});
  EXPECT_EQ(forced.exit, 0) << forced;
}

TEST_F(Usage, InputAsOutputIsWrongUsage) {
  const std::string before = test::file_bytes(good_);
  const auto outcome = run_tool({"upsample", good_, "-o", good_});
  EXPECT_EQ(outcome.exit, 2) << outcome;
  EXPECT_TRUE(outcome.one_line()) << outcome;
  EXPECT_EQ(test::file_bytes(good_), before);
}

TEST_F(Usage, NonFinitePixelsStopWithTheirPlaceAndNumber) {
  test::Picture picture = test::read_picture(good_);
  picture.planes.at("R").set(picture.index(7, 5), HUGE_VAL);
  test::write_scanlines(folder_ / "inf.exr", picture);
  expect_failure({"upsample", folder_ / "inf.exr", "-o", out_}, 1, "1 non-finite pixel, the first at 7,5");
  EXPECT_EQ(run_tool({"upsample", folder_ / "inf.exr", "-o", out_, "--nonfinite", "zero"}).exit, 0);
}

}  // namespace
}  // namespace spectile
