// Files that a command writes: none replaces another one that it writes or reads, links are followed, and a
// refused run leaves nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

class WrittenFiles : public testing::Test {
 protected:
  WrittenFiles() {
    test::Picture picture = test::blank(12, 9);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(path("in.exr"), picture);
    fs::copy_file(path("in.exr"), path("other.exr"));
    test::write_text(path("lamp.csv"), "380,1\n780,2\n");
    test::write_text(path("plan.json"), "{}");
  }
  std::string path(const std::string& name) const { return folder_ / name; }
  /// Arguments whose words of the form "@name" are files of the folder.
  std::vector<std::string> in_folder(const std::string& command) const {
    std::vector<std::string> out;
    std::istringstream words(command);
    for (std::string word; words >> word;) out.push_back(word[0] == '@' ? path(word.substr(1)) : word);
    return out;
  }
  /// Exit code 2 in one line with both roles, and every file is as it was.
  void expect_refused(const std::string& command, const std::string& role, const std::string& other) {
    const auto before = contents();
    const auto outcome = run_tool(in_folder(command));
    EXPECT_EQ(outcome.exit, 2) << command << "\n" << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(role), HasSubstr(other))) << command;
    EXPECT_TRUE(contents() == before) << command;
  }
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.is_regular_file()) out[entry.path().filename()] = test::file_bytes(entry.path());
      if (!entry.exists()) out[entry.path().filename()] = "a link to nothing";
    }
    return out;
  }
  test::TempFolder folder_;
};

TEST_F(WrittenFiles, OfASimulationDifferFromEachOther) {
  const std::string simulate = "film simulate --size 8 8 --samples 1 ";
  expect_refused(simulate + "-o @x.exr --checkpoint @x.exr", "the output (-o)",
                 "the checkpoint (--checkpoint)");
  expect_refused(simulate + "-o @x.exr --reference @x.exr", "the output (-o)", "the reference (--reference)");
  expect_refused(simulate + "-o @x.exr --reference @y.exr --checkpoint @y.exr",
                 "the checkpoint (--checkpoint)", "the reference (--reference)");
  expect_refused(simulate + "--input bands --bands @plan.json -o @plan.json", "the output",
                 "the bands (--bands)");
  expect_refused(simulate + "--bands @plan.json -o @x.exr --checkpoint @plan.json",
                 "the checkpoint (--checkpoint)", "the bands (--bands)");
}

TEST_F(WrittenFiles, OfAConversionDifferFromAllThatItReads) {
  for (const std::string command : {"upsample @in.exr", "relight @in.exr --illuminant A"}) {
    expect_refused(command + " -o @in.exr", "output", "input");
    expect_refused(command + " -o @x.exr --manifest @in.exr", "the manifest (--manifest)", "an input");
    expect_refused(command + " -o @x.exr --manifest @x.exr", "the manifest (--manifest)", "the output (-o)");
    expect_refused(command + " -o @x.exr --white @lamp.csv --manifest @lamp.csv", "the manifest (--manifest)",
                   "the reference white (--white)");
    expect_refused(command + " -o @lamp.csv --white @lamp.csv", "the output",
                   "the reference white (--white)");
  }
  expect_refused("upsample @in.exr -o @other.exr --mask @other.exr", "the output", "the mask (--mask)");
  expect_refused("upsample @in.exr -o @x.exr --mask @other.exr --manifest @other.exr",
                 "the manifest (--manifest)", "the mask (--mask)");
  expect_refused("relight @in.exr -o @lamp.csv --illuminant @lamp.csv", "the output",
                 "the illuminant (--illuminant)");
  ASSERT_EQ(run_tool(in_folder("upsample @in.exr -o @spectral.exr --store coefficients")).exit, 0);
  for (const std::string command : {"project @spectral.exr", "expand @spectral.exr"}) {
    expect_refused(command + " -o @spectral.exr", "output", "input");
    expect_refused(command + " -o @x.exr --manifest @spectral.exr", "the manifest (--manifest)", "an input");
  }
  expect_refused("project @spectral.exr -o @lamp.csv --illuminant @lamp.csv", "the output",
                 "the illuminant (--illuminant)");
}

TEST_F(WrittenFiles, OfABatchReplaceNoInputOfAnother) {
  fs::create_directory(path("a"));
  fs::copy_file(path("in.exr"), path("a/other.exr"));
  expect_refused("upsample @in.exr @a/other.exr -o @a", "output", "input");
  fs::create_directory(path("b"));
  expect_refused("upsample @other.exr @a/other.exr -o @b", "two inputs", "other.exr");
  EXPECT_TRUE(fs::is_empty(path("b")));
}

TEST_F(WrittenFiles, OfAPlanABenchmarkAndFilmsDifferFromAllThatTheyRead) {
  const std::string plan = "plan --count 4 --folds 0 ";
  expect_refused(plan + "--illuminant @lamp.csv -o @lamp.csv", "the output", "the illuminant (--illuminant)");
  expect_refused(plan + "--illuminant A --reflectances @lamp.csv -o @lamp.csv", "the output",
                 "the reflectances (--reflectances)");
  expect_refused(plan + "--illuminant A --texture @in.exr -o @in.exr", "the output", "a texture (--texture)");
  expect_refused("bench --quick --only half --reflectances @lamp.csv --report @lamp.csv",
                 "the report (--report)", "the reflectances (--reflectances)");
  expect_refused("bench --quick --only half --reflectances @lamp.csv --plot @lamp.csv", "the plot (--plot)",
                 "the reflectances (--reflectances)");
  expect_refused("bench --quick --only half --report @x --plot @x", "the report (--report)",
                 "the plot (--plot)");
  for (const char* film : {"a.exr", "b.exr"}) {
    ASSERT_EQ(run_tool({"film", "simulate", "--size", "8", "8", "--samples", "1", "--seed",
                        film[0] == 'a' ? "1" : "2", "-o", path(film)})
                  .exit,
              0);
  }
  expect_refused("film merge @a.exr @b.exr -o @a.exr", "output", "input");
  expect_refused("film merge @a.exr @b.exr -o @b.exr", "output", "input");
  expect_refused("film develop @a.exr -o @a.exr", "output", "input");
  expect_refused("film average @in.exr @other.exr -o @other.exr", "output", "input");
}

TEST_F(WrittenFiles, OfADemoAreThree) {
  fs::create_directory(path("demo"));
  fs::create_symlink("chart.exr", path("demo/chart-back.exr"));
  expect_refused("demo @demo", "an image of the demo", "chart-back.exr");
}

TEST_F(WrittenFiles, AreKnownByLinksAndByPlace) {
  fs::create_hard_link(path("in.exr"), path("hard.exr"));
  fs::create_symlink("in.exr", path("soft.exr"));
  fs::create_symlink(path("x.exr"), path("to-x"));  // leads to nothing yet
  fs::create_directory(path("d"));
  expect_refused("upsample @in.exr -o @hard.exr", "output", "input");
  expect_refused("upsample @in.exr -o @soft.exr", "output", "input");
  expect_refused("upsample @in.exr -o @d/../in.exr", "output", "input");
  expect_refused("upsample @in.exr -o @x.exr --manifest @to-x", "the manifest (--manifest)",
                 "the output (-o)");
  expect_refused("upsample @in.exr -o @d/../x.exr --manifest @x.exr", "the manifest (--manifest)",
                 "the output (-o)");
  expect_refused("film simulate --size 8 8 -o @x.exr --checkpoint @to-x", "the output (-o)",
                 "the checkpoint (--checkpoint)");
}

TEST_F(WrittenFiles, FollowLinksWhichStay) {
  fs::create_directory(path("d"));
  test::write_text(path("d/old.exr"), "an older file");
  fs::create_symlink("d/old.exr", path("old.exr"));
  fs::create_symlink("d/new.exr", path("new.exr"));  // leads to nothing yet
  fs::create_symlink("new.exr", path("chain.exr"));
  for (const char* name : {"old.exr", "new.exr", "chain.exr"}) {
    const auto outcome = run_tool({"upsample", path("in.exr"), "-o", path(name)});
    EXPECT_EQ(outcome.exit, 0) << outcome;
    EXPECT_TRUE(fs::is_symlink(path(name))) << name;
    EXPECT_TRUE(fs::is_regular_file(
        fs::symlink_status(path(std::string("d/") + (name[0] == 'o' ? "old.exr" : "new.exr")))));
  }
  EXPECT_TRUE(test::file_bytes(path("d/new.exr")) == test::file_bytes(path("d/old.exr")));
}

TEST_F(WrittenFiles, HaveNames) {
  for (const char* command :
       {"upsample @in.exr", "relight @in.exr --illuminant A", "film merge @in.exr", "film simulate",
        "film average @in.exr", "film develop @in.exr", "plan --illuminant A --count 4"}) {
    for (const char* name : {"", "-"}) {
      std::vector<std::string> arguments = in_folder(command);
      arguments.insert(arguments.end(), {"-o", name});
      const auto outcome = run_tool(arguments);
      EXPECT_EQ(outcome.exit, 2) << command << outcome;
      EXPECT_TRUE(outcome.one_line()) << outcome;
      EXPECT_THAT(outcome.err, HasSubstr(name[0] == '-' ? "standard output" : "is empty")) << command;
    }
  }
  EXPECT_EQ(run_tool({"upsample", path("in.exr"), "-o", path("x.exr"), "--manifest", ""}).exit, 2);
  EXPECT_EQ(run_tool({"bench", "--report", "-"}).exit, 2);
  EXPECT_FALSE(fs::exists("-"));
}

TEST_F(WrittenFiles, AreImagesOfNoOtherFormat) {
  for (const char* name : {"x.png", "x.JPG", "x.tiff", "x.hdr"}) {
    for (const char* command :
         {"upsample @in.exr", "project @in.exr", "film simulate", "film average @in.exr"}) {
      std::vector<std::string> arguments = in_folder(command);
      arguments.insert(arguments.end(), {"-o", path(name)});
      const auto outcome = run_tool(arguments);
      EXPECT_EQ(outcome.exit, 2) << outcome;
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(name), HasSubstr("OpenEXR"), HasSubstr("x.exr"))) << outcome;
      EXPECT_FALSE(fs::exists(path(name)));
    }
  }
  fs::create_directory(path("folder.png"));
  EXPECT_EQ(run_tool({"upsample", path("in.exr"), "-o", path("folder.png")}).exit, 0);
}

TEST_F(WrittenFiles, OfTwoInputsAreNotOneImage) {
  for (const char* name : {"one.exr", "one.png"}) {
    const auto outcome = run_tool({"upsample", path("in.exr"), path("other.exr"), "-o", path(name)});
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_TRUE(outcome.one_line());
    EXPECT_FALSE(fs::exists(path(name)));
  }
  EXPECT_EQ(run_tool({"upsample", path("in.exr"), path("other.exr"), "-o", path("two")}).exit, 0);
}

TEST_F(WrittenFiles, ARefusedBatchLeavesNoFolder) {
  fs::create_directory(path("a"));
  fs::copy_file(path("in.exr"), path("a/in.exr"));
  const std::string new_folder = path("new/folder/");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{path("in.exr"), path("a/in.exr")},  // one name for two
        {path("in.exr"), "--manifest", path("in.exr")},              // loses an input
        {path("in.exr"), "--manifest", path("none/manifest")},       // cannot be written
        {path("missing.exr"), path("gone.exr")}}) {                  // nothing to convert
    std::vector<std::string> arguments = {"upsample", "-o", new_folder};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = run_tool(arguments);
    EXPECT_NE(outcome.exit, 0) << outcome;
    EXPECT_FALSE(fs::exists(path("new"))) << testing::PrintToString(more);
  }
  // A folder that was there stays, and so does one with something in it.
  fs::create_directory(path("new"));
  EXPECT_EQ(run_tool({"upsample", path("missing.exr"), "-o", new_folder}).exit, 1);
  EXPECT_TRUE(fs::exists(path("new")));
  EXPECT_FALSE(fs::exists(path("new/folder")));
  EXPECT_EQ(run_tool({"upsample", path("missing.exr"), path("in.exr"), "-o", new_folder}).exit, 1);
  EXPECT_TRUE(fs::exists(new_folder + "in.exr"));
}

}  // namespace
}  // namespace spectile
