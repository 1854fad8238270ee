// Films on the command line: shards merged are one run, checkpoints survive kills, and what is wrong is said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <spectile/spectile.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

namespace fs = std::filesystem;

using test::run_tool;
using testing::HasSubstr;

class FilmTool : public testing::Test {
 protected:
  /// simulate with some small settings, and more.
  test::Outcome simulate(const std::string& output, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"film", "simulate", "--size", "48", "40", "-o", folder_ / output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  std::string path(const std::string& name) const { return folder_ / name; }
  test::TempFolder folder_;
};

TEST_F(FilmTool, ShardsMergedInAnyOrderAreTheFileOfOneRun) {
  const std::vector<std::string> settings = {"--samples", "23",         "--spectral",
                                             "--bands",   "400:700:20", "--statistics",
                                             "variance",  "--sensor",   "canon-eos-5d-mkii"};
  ASSERT_EQ(simulate("all.exr", settings).exit, 0);
  for (const char* shard : {"0", "1", "2", "3"}) {
    auto with_shard = settings;
    with_shard.insert(with_shard.end(),
                      {"--shard", std::string(shard) + "/4", "--threads", "2", "--isa", "sse4.2"});
    ASSERT_EQ(simulate(std::string("shard") + shard + ".exr", with_shard).exit, 0);
  }
  const auto merge = [&](const std::vector<std::string>& names, const std::string& output) {
    std::vector<std::string> arguments = {"film", "merge", "-o", path(output)};
    for (const std::string& name : names) arguments.push_back(path("shard" + name + ".exr"));
    const auto outcome = run_tool(arguments);
    ASSERT_EQ(outcome.exit, 0) << outcome;
  };
  merge({"2", "0", "3", "1"}, "a.exr");
  merge({"1", "3"}, "b1.exr");
  EXPECT_EQ(test::file_bytes(path("a.exr")), test::file_bytes(path("all.exr")));
  merge({"0", "1", "2", "3"}, "c.exr");
  EXPECT_EQ(test::file_bytes(path("c.exr")), test::file_bytes(path("all.exr")));
  EXPECT_NE(test::file_bytes(path("b1.exr")), test::file_bytes(path("all.exr")));
}

TEST_F(FilmTool, DevelopsEveryLayer) {
  ASSERT_EQ(simulate("film.exr", {"--statistics", "variance", "--spectral", "--sensor", "cie1964"}).exit, 0);
  const std::pair<const char*, const char*> layers[] = {
      {"srgb", "R"},      {"xyz", "X"},         {"luminance", "Y"},      {"sensor", "G"},
      {"count", "count"}, {"weight", "weight"}, {"variance", "variance"}};
  for (const auto& [layer, channel] : layers) {
    const auto outcome = run_tool(
        {"film", "develop", path("film.exr"), "--to", layer, "-o", path("out.exr"), "--pixel", "float"});
    ASSERT_EQ(outcome.exit, 0) << outcome;
    const auto info = inspect_image(path("out.exr"), std::array{3, 4});
    ASSERT_TRUE(info) << layer;
    EXPECT_EQ(info->width, 48);
    bool found = false;
    for (const ChannelInfo& c : info->channels) found = found || c.name == channel;
    EXPECT_TRUE(found) << layer;
    EXPECT_TRUE(std::string(layer) != "count" || info->pixel[0] == 16);
  }
  ASSERT_EQ(
      run_tool({"film", "develop", path("film.exr"), "--to", "spectral", "-o", path("spectral.exr")}).exit,
      0);
  const auto info = inspect_image(path("spectral.exr"));
  ASSERT_TRUE(info && info->bands);
  EXPECT_EQ(info->bands->count(), 60U);
  // And the tool's own reader takes it.
  EXPECT_EQ(run_tool({"project", path("spectral.exr"), "-o", path("projected.exr")}).exit, 0);
}

TEST_F(FilmTool, ConvergesToTheReference) {
  const auto outcome = simulate("film.exr", {"--scene", "gradients", "--samples", "400", "--reference",
                                             path("reference.exr"), "--json"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_LT(report["rms_luminance_error"].get<double>(), 0.1 * report["mean_luminance"].get<double>());
  ASSERT_EQ(run_tool({"film", "develop", path("film.exr"), "--to", "xyz", "--pixel", "float", "-o",
                      path("xyz.exr")})
                .exit,
            0);
  const auto reference = inspect_image(path("reference.exr"), std::array{20, 20});
  const auto film = inspect_image(path("xyz.exr"), std::array{20, 20});
  ASSERT_TRUE(reference && film);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(film->pixel[c] / reference->pixel[c], 1, 0.4);
  // The former name of the option.
  ASSERT_EQ(simulate("again.exr", {"--scene", "gradients", "--truth", path("again-reference.exr")}).exit, 0);
  EXPECT_EQ(test::file_bytes(path("again-reference.exr")), test::file_bytes(path("reference.exr")));
}

TEST_F(FilmTool, SaysWhatIsWrongInOneLine) {
  ASSERT_EQ(simulate("a.exr").exit, 0);
  ASSERT_EQ(simulate("b.exr", {"--range", "20"}).exit, 0);
  const auto expect = [&](const std::vector<std::string>& arguments, int exit, const std::string& named) {
    const auto outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit, exit) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, HasSubstr(named));
    EXPECT_FALSE(fs::exists(path("out.exr")));
  };
  expect({"film", "merge", path("a.exr"), path("b.exr"), "-o", path("out.exr")}, 1, "range: 2^32 and 2^20");
  expect({"film", "merge", path("a.exr"), path("./a.exr"), "-o", path("out.exr")}, 2, "named twice");
  expect({"film", "merge", path("a.exr"), path("none.exr"), "-o", path("out.exr")}, 1, "none.exr");
  expect({"film", "develop", path("none.exr"), "-o", path("out.exr")}, 1, "none.exr");
  expect({"film", "develop", path("a.exr"), "--to", "variance", "-o", path("out.exr")}, 1,
         "does not keep variance");
  expect({"film", "develop", path("a.exr"), "--to", "spectral", "-o", path("out.exr")}, 1,
         "does not keep spectra");
  expect({"film", "develop", path("a.exr"), "--to", "sensor", "-o", path("out.exr")}, 1, "keeps no sensor");
  expect({"film", "develop", path("a.exr"), "--to", "nonsense", "-o", path("out.exr")}, 2, "nonsense");
  expect({"film", "simulate", "--shard", "3/3", "-o", path("out.exr")}, 2, "3/3");
  expect({"film", "simulate", "--filter", "bell", "-o", path("out.exr")}, 2, "bell");
  expect({"film", "simulate", "--crop", "1,2,3", "-o", path("out.exr")}, 2, "1,2,3");
  expect({"film", "simulate", "--crop", "0,0,5000,2", "-o", path("out.exr")}, 2, "crop window");
  expect({"film", "simulate", "--size", "0", "5", "-o", path("out.exr")}, 2, "0 x 5");
  expect({"film", "simulate", "-o", path("no/such/folder/out.exr")}, 1, "no/such/folder");
  expect({"film"}, 2, "subcommand");
}

class Checkpoints : public FilmTool {
 protected:
  static constexpr int kSide = 64;
  static constexpr int kSamples = 4096;
  std::vector<std::string> arguments() const {
    return {"film",
            "simulate",
            "--scene",
            "spikes",
            "--size",
            std::to_string(kSide),
            std::to_string(kSide),
            "--samples",
            std::to_string(kSamples),
            "--checkpoint",
            path("check.exr"),
            "--every",
            "0",
            "--quiet",
            "-o",
            path("out.exr")};
  }
};

TEST_F(Checkpoints, AreAlwaysOneOfTheStatesThatWereSaved) {
  const ProceduralScene scene = *ProceduralScene::named("spikes");
  FilmOptions options;
  options.width = options.height = kSide;
  const SceneSampling sampling = {.samples_per_pixel = kSamples};
  // The state after each number of steps that a checkpoint was found with, each made once, from the one
  // before.
  std::map<std::uint64_t, std::vector<std::string>> found;
  std::mt19937 random(4);
  int loaded = 0;
  for (int run = 0; run < 20; ++run) {
    fs::remove(path("check.exr"));
    {
      test::Tool tool(arguments(), {});
      std::this_thread::sleep_for(std::chrono::milliseconds(30 + random() % 900));
    }  // killed here
    if (!fs::exists(path("check.exr"))) {
      fs::remove(path("out.exr"));
      continue;
    }
    const auto film = load_film(path("check.exr"));
    ASSERT_TRUE(film) << film.error().message;
    const std::size_t at = film->progress.rfind("steps ");
    ASSERT_NE(at, std::string::npos);
    const std::uint64_t steps = std::stoull(film->progress.substr(at + 6));
    const std::string kept = path("kept" + std::to_string(run) + ".exr");
    fs::rename(path("check.exr"), kept);
    found[steps].push_back(kept);
    ++loaded;
    fs::remove(path("out.exr"));
  }
  EXPECT_GE(loaded, 10);
  EXPECT_GE(found.size(), 3U);
  Film film = *Film::create(options);
  std::uint64_t done = 0;
  for (const auto& [steps, files] : found) {
    ASSERT_TRUE(spectile::simulate(scene, sampling, film, done, steps - done));
    done = steps;
    for (const std::string& file : files) EXPECT_TRUE(load_film(file)->film.same_contents(film)) << steps;
  }
}

TEST_F(Checkpoints, AnInterruptedRunGoesOnToTheSameBits) {
  auto plain = arguments();
  plain.erase(plain.begin() + 9, plain.begin() + 13);  // without a checkpoint
  plain.back() = path("plain.exr");
  const auto whole = run_tool(plain);
  ASSERT_EQ(whole.exit, 0) << whole;
  int runs = 0;
  for (bool finished = false; !finished && runs < 100; ++runs) {
    test::Tool tool(arguments(), {});
    // The first four are ended on the way, the others when they are done.
    for (int ms = 0; ms < (runs < 4 ? 100 : 60000) && tool.running(); ++ms) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (!tool.running()) {
      finished = tool.finish().exit == 0;
      continue;
    }
    ::kill(tool.pid(), runs % 2 == 0 ? SIGTERM : SIGKILL);
    finished = tool.finish().exit == 0;
  }
  EXPECT_GE(runs, 3);
  EXPECT_EQ(test::file_bytes(path("out.exr")), test::file_bytes(path("plain.exr")));
  EXPECT_FALSE(fs::exists(path("check.exr")));
}

TEST_F(Checkpoints, OfAnotherRunAreRefused) {
  ASSERT_EQ(simulate("other.exr", {"--seed", "7"}).exit, 0);
  fs::rename(path("other.exr"), path("check.exr"));
  const auto outcome = run_tool(arguments());
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.err, HasSubstr("another run"));
}

}  // namespace
}  // namespace spectile
