// spectile fit: from measured reflectances to nodes, and images made with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <spectile/image/image.hpp>
#include <spectile/image/nodes_file.hpp>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

class FitCommand : public testing::Test {
 protected:
  /// A table of `count` reflectances with a dip at 560 nm.
  void write_table(const std::string& path, int count, double dip = 0.5, double phase = 0) const {
    std::string table;
    for (int nm = 380; nm <= 780; nm += 10) {
      table += std::to_string(nm);
      for (int i = 0; i < count; ++i) {
        const double d = (nm - 560) / 20.0;
        const double smooth = 0.5 + 0.35 * std::sin(nm * 0.009 + 0.7 * i + phase);
        table += "," + std::to_string(smooth * (1 - dip * std::exp(-d * d)));
      }
      table += "\n";
    }
    test::write_text(path, table);
  }
  void write_image() const {
    test::Picture picture = test::blank(32, 4);
    int channel = 0;
    for (const char* name : {"R", "G", "B"}) {
      const int k = channel++;
      picture.add(name, Imf::FLOAT, [=](int x, int y) { return 0.9 * test::noise(x, y, k); });
    }
    test::write_scanlines(folder_ / "in.exr", picture);
  }
  test::TempFolder folder_;
  const std::string nodes_ = folder_ / "nodes.json";
};

TEST_F(FitCommand, WritesNodesAndTheirErrorsOnWhatTookNoPart) {
  write_table(folder_ / "paints.csv", 40);
  write_table(folder_ / "cloth.csv", 15, 0.5, 0.3);
  const auto outcome = run_tool({"fit", "--reflectances", folder_ / "paints.csv", "--reflectances",
                                 folder_ / "cloth.csv", "-o", nodes_});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_THAT(outcome.out, HasSubstr("learned from 55 reflectances"));
  EXPECT_THAT(outcome.out, HasSubstr("held out: a fifth, five times"));
  EXPECT_THAT(outcome.out, HasSubstr("held out: " + (folder_ / "cloth.csv")));
  EXPECT_THAT(outcome.out, HasSubstr("for materials like these learning pays: "));
  EXPECT_THAT(outcome.out, HasSubstr("for materials of another origin, as " + (folder_ / "paints.csv") +
                                     " learning pays: "));
  EXPECT_EQ(load_nodes(nodes_)->reflectances, 55U);
  const auto json = run_tool({"fit", "--reflectances", folder_ / "paints.csv", "-o", nodes_, "--json"});
  ASSERT_EQ(json.exit, 0) << json;
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report["trials"].size(), 1U);
  EXPECT_EQ(report["trials"][0]["pays"], true);
  EXPECT_LT(report["trials"][0]["tetrahedral, learned"]["mean"], report["trials"][0]["sigmoid"]["mean"]);
}

TEST_F(FitCommand, SaysWhenLearningDoesNotPay) {
  write_table(folder_ / "dips.csv", 30, 0.6);
  write_table(folder_ / "humps.csv", 30, -0.6);
  const auto outcome = run_tool(
      {"fit", "--reflectances", folder_ / "dips.csv", "--reflectances", folder_ / "humps.csv", "-o", nodes_});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_THAT(outcome.out, HasSubstr("for materials of another origin, as " + (folder_ / "dips.csv") +
                                     " learning does not pay: "));
  EXPECT_THAT(outcome.out, HasSubstr("for materials of another origin, as " + (folder_ / "humps.csv") +
                                     " learning does not pay: "));
}

TEST_F(FitCommand, NodesShapeSpectraAndTravelWithCoefficients) {
  write_table(folder_ / "paints.csv", 40);
  write_image();
  ASSERT_EQ(run_tool({"fit", "--reflectances", folder_ / "paints.csv", "-o", nodes_}).exit, 0);
  const auto upsample = [&](const std::string& to, std::vector<std::string> more) {
    std::vector<std::string> all = {"upsample", folder_ / "in.exr", "-o",      to,
                                    "--method", "tetrahedral",      "--pixel", "float"};
    all.insert(all.end(), more.begin(), more.end());
    const auto outcome = run_tool(all);
    EXPECT_EQ(outcome.exit, 0) << outcome;
    return test::read_picture(to);
  };
  const auto plain = upsample(folder_ / "plain.exr", {});
  const auto learned = upsample(folder_ / "learned.exr", {"--nodes", nodes_});
  EXPECT_FALSE(plain.planes == learned.planes);
  upsample(folder_ / "c.exr", {"--nodes", nodes_, "--store", "coefficients"});
  std::filesystem::remove(nodes_);
  const auto expanded = run_tool({"expand", folder_ / "c.exr", "-o", folder_ / "e.exr", "--pixel", "float"});
  ASSERT_EQ(expanded.exit, 0) << expanded;
  EXPECT_TRUE(test::read_picture(folder_ / "e.exr").planes == learned.planes);
  const auto back =
      run_tool({"project", folder_ / "learned.exr", "-o", folder_ / "back.exr", "--pixel", "float"});
  ASSERT_EQ(back.exit, 0) << back;
  const auto in = test::read_picture(folder_ / "in.exr");
  const auto out = test::read_picture(folder_ / "back.exr");
  for (const char* name : {"R", "G", "B"}) {
    for (std::size_t i = 0; i < in.pixels(); ++i)
      ASSERT_NEAR(out.planes.at(name).at(i), in.planes.at(name).at(i), 4e-6);
  }
}

TEST_F(FitCommand, RelightAndVerifyTakeThem) {
  write_table(folder_ / "paints.csv", 40);
  write_image();
  ASSERT_EQ(run_tool({"fit", "--reflectances", folder_ / "paints.csv", "-o", nodes_}).exit, 0);
  const auto verified =
      run_tool({"verify", folder_ / "in.exr", "--method", "tetrahedral", "--nodes", nodes_, "--json"});
  EXPECT_EQ(verified.exit, 0) << verified;
  EXPECT_GT(nlohmann::json::parse(verified.out)["max_oracle_difference"], 0);
  const auto relit = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"relight", folder_ / "in.exr",  "--illuminant", "A",
                                    "-o",      folder_ / "lit.exr", "--method",     "tetrahedral"};
    all.insert(all.end(), more.begin(), more.end());
    const auto outcome = run_tool(all);
    EXPECT_EQ(outcome.exit, 0) << outcome;
    return test::read_picture(folder_ / "lit.exr");
  };
  EXPECT_FALSE(relit({}).planes == relit({"--nodes", nodes_}).planes);
}

TEST_F(FitCommand, WhatIsHeldOutIsNotLearnedFromInAnotherFile) {
  write_table(folder_ / "all.csv", 40);
  write_table(folder_ / "some.csv", 15);  // the first 15 of the others
  const auto trials = [&](std::vector<std::string> files) {
    std::vector<std::string> all = {"fit", "-o", nodes_, "--json"};
    for (const std::string& file : files) all.insert(all.end(), {"--reflectances", folder_ / file});
    const auto outcome = run_tool(all);
    EXPECT_EQ(outcome.exit, 0) << outcome;
    return nlohmann::json::parse(outcome.out)["trials"];
  };
  const auto both = trials({"all.csv", "some.csv"});
  ASSERT_EQ(both.size(), 3U);
  EXPECT_FALSE(both[1].contains("pays"));
  EXPECT_THAT(both[1]["why"].get<std::string>(), HasSubstr("the others are only 0 reflectances"));
  EXPECT_TRUE(both[2].contains("pays"));
}

TEST_F(FitCommand, WrongUsesAreSaid) {
  write_table(folder_ / "paints.csv", 12);
  write_table(folder_ / "few.csv", 4);
  write_image();
  ASSERT_EQ(run_tool({"fit", "--reflectances", folder_ / "paints.csv", "-o", nodes_}).exit, 0);
  struct Wrong {
    std::vector<std::string> arguments;
    int exit;
    const char* named;
  };
  const std::string in = folder_ / "in.exr";
  const std::string out = folder_ / "out.exr";
  for (const Wrong& wrong :
       {Wrong{{"fit", "--reflectances", folder_ / "few.csv", "-o", folder_ / "n.json"}, 2, "not from 4"},
        Wrong{{"fit", "--reflectances", folder_ / "none.csv", "-o", folder_ / "n.json"}, 1, "none.csv"},
        Wrong{{"fit", "--reflectances", folder_ / "paints.csv", "-o", folder_ / "paints.csv"},
              2,
              "which it is made from"},
        Wrong{{"upsample", in, "-o", out, "--method", "sigmoid", "--nodes", nodes_},
              2,
              "--nodes is for --method tetrahedral"},
        Wrong{{"upsample", in, "-o", out, "--method", "tetrahedral", "--nodes", in}, 1, "in.exr"},
        Wrong{{"upsample", in, "-o", nodes_, "--method", "tetrahedral", "--nodes", nodes_},
              2,
              "which it is made from"},
        Wrong{{"upsample", in, "-o", out, "--method", "tetrahedral", "--nodes", nodes_, "--white", "D50"},
              2,
              "learned for the white D65"}}) {
    const auto outcome = run_tool(wrong.arguments);
    EXPECT_EQ(outcome.exit, wrong.exit) << outcome;
    EXPECT_TRUE(outcome.one_line()) << outcome;
    EXPECT_THAT(outcome.err, HasSubstr(wrong.named));
    EXPECT_FALSE(std::filesystem::exists(out));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "n.json"));
  }
}

}  // namespace
}  // namespace spectile
