// Batches: --update passes over what is done, --shard shares inputs out, --manifest says what became of each.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <map>
#include <set>
#include <spectile/image/settings.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::Outcome;
using test::run_tool;
using testing::HasSubstr;
using testing::Not;

using Environment = std::vector<std::pair<std::string, std::string>>;

class Batches : public testing::Test {
 protected:
  Batches() {
    std::filesystem::create_directory(folder_ / "in");
    for (int i = 0; i < 7; ++i) {
      test::Picture picture = test::blank(8 + i, 5);
      test::add_rgb_noise(picture, Imf::HALF);
      inputs_.push_back(folder_ / ("in/" + std::to_string(i) + ".exr"));
      test::write_scanlines(inputs_.back(), picture);
      set_age(inputs_.back(), 100);
    }
  }
  static void set_age(const std::string& path, time_t seconds) {
    timespec then{};
    ::clock_gettime(CLOCK_REALTIME, &then);
    then.tv_sec -= seconds;
    const timespec times[2] = {then, then};
    ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
  }
  /// upsample into the folder "out".
  std::vector<std::string> upsample(std::vector<std::string> more) const {
    std::vector<std::string> out = {"upsample"};
    out.insert(out.end(), inputs_.begin(), inputs_.end());
    out.insert(out.end(), {"-o", output_});
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  Outcome run(std::vector<std::string> more, const Environment& environment = {}) const {
    test::Tool::Options options;
    options.environment = environment;
    return run_tool(upsample(std::move(more)), options);
  }
  std::set<std::string> outputs() const {
    std::set<std::string> out;
    if (!std::filesystem::exists(output_)) return out;
    for (const auto& entry : std::filesystem::directory_iterator(output_))
      out.insert(entry.path().filename());
    return out;
  }
  static std::size_t count(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
  }
  test::TempFolder folder_;
  const std::string output_ = folder_ / "out/";
  std::vector<std::string> inputs_;
};

TEST_F(Batches, UpdateConvertsWhatIsNewOnly) {
  Outcome first = run({"-u"});
  ASSERT_EQ(first.exit, 0) << first;
  EXPECT_THAT(first.out, HasSubstr("7 converted, 0 up to date\n"));
  Outcome second = run({"--update"});
  EXPECT_THAT(second.out, HasSubstr("0 converted, 7 up to date\n"));
  EXPECT_EQ(count(second.out, ": up to date\n"), 7U);
  const std::string bytes = test::file_bytes(output_ + "3.exr");
  set_age(inputs_[3], -100);
  Outcome third = run({"-u"});
  EXPECT_THAT(third.out, HasSubstr("1 converted, 6 up to date\n"));
  EXPECT_EQ(test::file_bytes(output_ + "3.exr"), bytes);
  std::filesystem::remove(output_ + "5.exr");
  set_age(inputs_[3], 100);
  EXPECT_THAT(run({"-u"}).out, HasSubstr("1 converted, 6 up to date\n"));
  // Without the option all are converted, and no count is given.
  Outcome all = run({});
  EXPECT_THAT(all.out, Not(HasSubstr("up to date")));
  EXPECT_EQ(count(all.out, "Mpixel/s"), 7U);
}

TEST_F(Batches, UpdateConvertsAnewForOtherSettings) {
  ASSERT_EQ(run({"-u"}).exit, 0);
  EXPECT_THAT(run({"-u", "--threads", "1", "--isa", "scalar"}).out, HasSubstr("0 converted, 7 up to date\n"));
  test::write_text(folder_ / "lamp.csv", "400,1\n700,2\n");
  set_age(folder_ / "lamp.csv", 100);
  const std::vector<std::vector<std::string>> others = {{"--pixel", "float"},
                                                        {"--compression", "zip:4"},
                                                        {"--method", "mallett"},
                                                        {"--bands", "400:700:10"},
                                                        {"--quantity", "illuminant"},
                                                        {"--white", "A"},
                                                        {"--white-observer", "1964"},
                                                        {"--input-space", "rec2020"},
                                                        {"--negative", "clip"},
                                                        {"--out-of-gamut", "keep"},
                                                        {"--store", "coefficients"},
                                                        {"--nonfinite", "zero"},
                                                        {"--white", folder_ / "lamp.csv"}};
  for (std::vector<std::string> other : others) {
    other.emplace_back("-u");
    EXPECT_THAT(run(other).out, HasSubstr("7 converted, 0 up to date\n")) << other[0] << other[1];
    EXPECT_THAT(run(other).out, HasSubstr("0 converted, 7 up to date\n")) << other[0] << other[1];
  }
  // The light's file is one of those that the outputs are made from.
  set_age(folder_ / "lamp.csv", -100);
  EXPECT_THAT(run({"-u", "--white", folder_ / "lamp.csv"}).out, HasSubstr("7 converted, 0 up to date\n"));
}

TEST_F(Batches, UpdateSeesAPlanChange) {
  const std::string plan = folder_ / "plan.json";
  const auto write_plan = [&](const char* first_nm) {
    test::write_text(plan, std::string("{\"wavelengths_nm\": [") + first_nm +
                               ", 550, 610], \"sensor\": {\"x\": [0.2, 0.3, 0.45], \"y\": [0, 0.7, 0.3], "
                               "\"z\": [1, 0.08, 0]}, \"illuminants\": [{\"name\": \"D65\", "
                               "\"emission\": [1, 1, 1]}], \"observer\": \"1931\"}");
    set_age(plan, 100);
  };
  write_plan("450");
  const std::vector<std::string> options = {"-u", "--method", "smits", "--bands", plan};
  const Outcome first = run(options);
  EXPECT_THAT(first.out, HasSubstr("7 converted, 0 up to date\n")) << first;
  EXPECT_THAT(run(options).out, HasSubstr("0 converted, 7 up to date\n"));
  // Another plan under the name, however old; the same one, written anew.
  write_plan("455");
  EXPECT_THAT(run(options).out, HasSubstr("7 converted, 0 up to date\n"));
  EXPECT_THAT(run(options).out, HasSubstr("0 converted, 7 up to date\n"));
  set_age(plan, -100);
  EXPECT_THAT(run(options).out, HasSubstr("7 converted, 0 up to date\n"));
}

TEST_F(Batches, NoOutputReplacesADependency) {
  const std::string lamp = folder_ / "lamp.csv";
  const std::string text = "400,1\n700,2\n";
  test::write_text(lamp, text);
  const Outcome outcome = run_tool({"upsample", inputs_[0], "--white", lamp, "-o", lamp});
  EXPECT_EQ(outcome.exit, 2) << outcome;
  EXPECT_THAT(outcome.err, HasSubstr(lamp + ": the output is " + lamp + ", which it is made from"));
  EXPECT_TRUE(test::file_bytes(lamp) == text);
}

TEST_F(Batches, UpdateReachesEveryCommand) {
  const std::string compact = folder_ / "compact.exr";
  const std::string spectral = folder_ / "spectral.exr";
  const std::vector<std::vector<std::string>> commands = {
      {"upsample", inputs_[0], "--store", "coefficients", "-o", compact},
      {"expand", compact, "-o", spectral},
      {"project", spectral, "--illuminant", "A", "-o", folder_ / "rgb.exr"},
      {"relight", inputs_[0], "--illuminant", "A", "-o", folder_ / "lit.exr"}};
  for (std::vector<std::string> command : commands) {
    command.emplace_back("-u");
    Outcome first = run_tool(command);
    EXPECT_THAT(first.out, HasSubstr("1 converted, 0 up to date\n")) << first;
    set_age(command[0] == "expand" ? spectral : command[0] == "upsample" ? compact : inputs_[0], 50);
    EXPECT_THAT(run_tool(command).out, HasSubstr("0 converted, 1 up to date\n")) << command[0];
  }
}

TEST_F(Batches, UpdateTriesFailuresAgainAndSaysSo) {
  test::write_text(inputs_[2], "no image");
  Outcome outcome = run({"-u"});
  EXPECT_EQ(outcome.exit, 1) << outcome;
  EXPECT_THAT(outcome.out, HasSubstr("6 converted, 0 up to date, 1 failed\n"));
  outcome = run({"-u", "--json"});
  EXPECT_EQ(outcome.exit, 1) << outcome;
  int skipped = 0;
  for (const auto& line : test::json_lines(outcome.out)) {
    skipped += line.value("skipped", false) ? 1 : 0;
    EXPECT_EQ(line.contains("error"), line["input"] == inputs_[2]);
  }
  EXPECT_EQ(skipped, 6);
}

TEST_F(Batches, ShardsShareTheInputsOut) {
  std::map<std::string, int> times;
  for (int i = 0; i < 3; ++i) {
    std::filesystem::remove_all(output_);
    // The order, and inputs named twice, do not matter.
    if (i > 0) std::reverse(inputs_.begin(), inputs_.end());
    if (i > 0) inputs_.push_back(inputs_[0]);
    const Outcome outcome = run({"--shard", std::to_string(i) + "/3"});
    EXPECT_EQ(outcome.exit, 0) << outcome;
    const auto made = outputs();
    EXPECT_THAT(outcome.out, HasSubstr("shard " + std::to_string(i) + "/3: " + std::to_string(made.size()) +
                                       " of 7 inputs\n"));
    EXPECT_THAT(made.size(), testing::AnyOf(2, 3));
    for (const std::string& name : made) ++times[name];
  }
  EXPECT_EQ(times.size(), 7U);
  for (const auto& [name, n] : times) EXPECT_EQ(n, 1) << name;
}

TEST_F(Batches, AnEmptyShardIsSuccess) {
  const Outcome outcome = run({"--shard", "8/9"});
  EXPECT_EQ(outcome.exit, 0) << outcome;
  EXPECT_TRUE(outputs().empty());
  const Outcome one =
      run_tool({"upsample", inputs_[0], "-o", folder_ / "one.exr", "--shard", "1/2", "--json"});
  EXPECT_EQ(one.exit, 0) << one;
  EXPECT_EQ(one.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "one.exr"));
}

TEST_F(Batches, BadShardsAreWrongUsage) {
  for (const char* bad : {"3", "3/3", "4/3", "-1/3", "0/0", "a/b", "1/2/3", "/", "0/", "1.0/2", " 0/2",
                          "+0/2", "0/99999999999999999999", "NONE"}) {
    const Outcome outcome = run({"--shard", bad});
    EXPECT_EQ(outcome.exit, 2) << bad << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_TRUE(outputs().empty());
  }
}

Environment slurm(const std::string& id, const std::string& n, const std::string& first = "",
                  const std::string& step = "") {
  Environment out = {{"SLURM_ARRAY_TASK_ID", id}, {"SLURM_ARRAY_TASK_COUNT", n}};
  if (!first.empty()) out.emplace_back("SLURM_ARRAY_TASK_MIN", first);
  if (!step.empty()) out.emplace_back("SLURM_ARRAY_TASK_STEP", step);
  return out;
}

TEST_F(Batches, ATaskOfASlurmArrayTakesItsShare) {
  EXPECT_THAT(run({}, slurm("2", "3")).out, HasSubstr("shard 2/3: "));
  EXPECT_THAT(run({}, slurm("3", "3", "1")).out, HasSubstr("shard 2/3: "));
  EXPECT_THAT(run({}, slurm("10", "4", "4", "2")).out, HasSubstr("shard 3/4: "));
  EXPECT_THAT(run({}, slurm("10", "4", "10", "2")).out, HasSubstr("shard 0/4: "));
  EXPECT_THAT(run({"--shard", "1/2"}, slurm("2", "3")).out, HasSubstr("shard 1/2: "));
  EXPECT_THAT(run({"--shard", "none"}, slurm("2", "3")).out, Not(HasSubstr("shard")));
  EXPECT_THAT(run({}, {{"SLURM_ARRAY_TASK_ID", "2"}}).out, Not(HasSubstr("shard")));
}

TEST_F(Batches, ASlurmArrayWithoutEvenSharesIsRefused) {
  const std::vector<Environment> bad = {
      slurm("3", "3"),           slurm("x", "3"),      slurm("0", ""),           slurm("7", "3", "1", "1"),
      slurm("2", "3", "1", "2"), slurm("0", "3", "1"), slurm("1", "3", "0", "0")};
  for (const Environment& environment : bad) {
    const Outcome outcome = run({}, environment);
    EXPECT_EQ(outcome.exit, 2) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, HasSubstr("--shard none"));
    EXPECT_EQ(run({"--shard", "none"}, environment).exit, 0);
    std::filesystem::remove_all(output_);
  }
}

TEST_F(Batches, TheManifestSaysWhatBecameOfEachInput) {
  const std::string manifest = folder_ / "manifest.jsonl";
  test::write_text(inputs_[2], "no image");
  EXPECT_EQ(run({"--manifest", manifest, "--shard", "0/2", "-u", "--quiet"}).exit, 1);
  EXPECT_EQ(run({"--manifest", manifest, "-u"}).exit, 1);
  const auto lines = test::json_lines(test::file_bytes(manifest));
  ASSERT_EQ(lines.size(), 11U);
  const std::string settings = settings_text(UpsampleImageOptions());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& line = lines[i];
    EXPECT_EQ(line["settings"], settings);
    EXPECT_EQ(line["shard"], i < 4 ? nlohmann::json("0/2") : nlohmann::json(nullptr));
    const std::string input = line["input"];
    const std::string output = line["output"];
    if (input == inputs_[2]) {
      EXPECT_EQ(line["status"], "failed");
      EXPECT_THAT(line["error"].get<std::string>(), HasSubstr("not an OpenEXR file"));
      continue;
    }
    EXPECT_EQ(line["bytes"], std::filesystem::file_size(output));
    const bool again = i >= 4 && (input == inputs_[0] || input == inputs_[4] || input == inputs_[6]);
    EXPECT_EQ(line["status"], again ? "up-to-date" : "converted") << line;
    if (again) continue;
    EXPECT_EQ(line["pixels"].get<int>() % 5, 0);
    EXPECT_EQ(line["bands"], 60);
    EXPECT_GT(line["seconds"].get<double>(), 0);
  }
}

TEST_F(Batches, ManyProcessesMayShareAManifest) {
  const std::string manifest = folder_ / "manifest.jsonl";
  std::vector<std::unique_ptr<test::Tool>> tools;
  for (int i = 0; i < 7; ++i) {
    tools.push_back(std::make_unique<test::Tool>(
        upsample({"--manifest", manifest, "--shard", std::to_string(i) + "/7"}), test::Tool::Options()));
  }
  for (auto& tool : tools) EXPECT_EQ(tool->finish().exit, 0);
  std::set<std::string> seen;
  for (const auto& line : test::json_lines(test::file_bytes(manifest))) {
    EXPECT_TRUE(seen.insert(line["input"]).second);
  }
  EXPECT_EQ(seen.size(), 7U);
}

TEST_F(Batches, AManifestThatCannotBeWrittenStopsTheRun) {
  const Outcome missing = run({"--manifest", folder_ / "none/manifest"});
  EXPECT_EQ(missing.exit, 2) << missing;
  EXPECT_TRUE(missing.one_line());
  EXPECT_TRUE(outputs().empty());
  const Outcome full = run({"--manifest", "/dev/full"});
  EXPECT_EQ(full.exit, 3) << full;
  EXPECT_TRUE(full.one_line());
  EXPECT_EQ(outputs().size(), 1U);
}

}  // namespace
}  // namespace spectile
