// Files of learned nodes: what is written comes back to the bit, and what is none is refused with a sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/spectile.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

LearnedNodes some_nodes() {
  const std::vector<double> nm = {400, 500, 700};
  const std::vector<double> values = {1, 2, 0.5};
  LearnedNodes out = {
      {"a lamp", *MeasuredSpectrum::from_samples(nm, values, Ends::kZero), {}}, {}, 0, {}, {}};
  out.observer = Observer::kCie1964;
  out.reflectances = 17;
  out.wavelengths_nm = {400, 410.25, 720};
  for (std::size_t i = 0; i < 3 * kNodes; ++i) out.offsets.push_back(static_cast<float>(i) / 7 - 20);
  return out;
}

TEST(NodesFile, ComesBackToTheBit) {
  const test::TempFolder folder;
  const LearnedNodes nodes = some_nodes();
  ASSERT_TRUE(save_nodes(nodes, folder / "n.json"));
  const auto read = load_nodes(folder / "n.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->light.name, "a lamp");
  EXPECT_TRUE(same_light(read->light.spectrum, nodes.light.spectrum));
  EXPECT_EQ(read->observer, nodes.observer);
  EXPECT_EQ(read->reflectances, 17U);
  EXPECT_EQ(read->wavelengths_nm, nodes.wavelengths_nm);
  EXPECT_EQ(read->offsets, nodes.offsets);
  EXPECT_EQ(nodes_to_json(*read), nodes_to_json(nodes));
  EXPECT_EQ(nodes_to_json(nodes, true).find('\n'), std::string::npos);
}

TEST(NodesFile, AKnownLightIsKnownByItsName) {
  LearnedNodes nodes = some_nodes();
  nodes.light = {"FL11", *illuminant("FL11"), {}};
  EXPECT_EQ(nodes_to_json(nodes).find("spectrum"), std::string::npos);
  EXPECT_TRUE(same_light(parse_nodes(nodes_to_json(nodes), "n")->light.spectrum, *illuminant("FL11")));
}

TEST(NodesFile, WhatIsNoneIsRefusedInASentence) {
  const std::string good = nodes_to_json(some_nodes(), true);
  const auto refused = [](const std::string& text, const char* because) {
    const auto read = parse_nodes(text, "n.json");
    ASSERT_FALSE(read) << because;
    EXPECT_EQ(read.error().code, ErrorCode::kBadFile);
    EXPECT_THAT(read.error().message, HasSubstr("n.json: "));
    EXPECT_THAT(read.error().message, HasSubstr(because));
    EXPECT_LT(read.error().message.size(), 400U);
  };
  const auto replaced = [&](const std::string& what, const std::string& by) {
    const std::size_t at = good.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return std::string(good).replace(at, what.size(), by);
  };
  refused("", "is no list of nodes");
  refused("{}", "has no \"method\"");
  refused("[]", "is no object");
  refused(good.substr(0, good.size() / 2), "is no list of nodes");
  refused(replaced("\"tetrahedral\"", "\"sigmoid\""), "\"method\" is not");
  refused(replaced("\"1964\"", "\"1965\""), "\"observer\"");
  refused(replaced("17", "-1"), "\"reflectances\"");
  refused(replaced("0.125", "0.25"), "\"levels\" are not 0, 0.125");
  refused(replaced("410.25", "399"), "do not ascend");
  refused(replaced("720.0", "72000.0"), "not from 100");
  refused(replaced("\"a lamp\"", "7"), "the name of a light");
  refused(replaced("\"offsets\":[[", "\"offsets\":[[" + std::string("1,")),
          "has 4 entries for 3 wavelengths");
  refused(replaced("\"offsets\":[", "\"offsets\":[[0,0,0],"), "no list of 125 nodes");
  refused(replaced("\"offsets\":[[-20.0", "\"offsets\":[[1e30"), "an offset of");
  refused(replaced("\"offsets\":[[-20.0", "\"offsets\":[[null"), "holds what is no number");
  refused(replaced("\"method\"", "\"method\":1,\"method\""), "twice");
}

TEST(NodesFile, WhatWouldBeRefusedIsNotWritten) {
  const test::TempFolder folder;
  LearnedNodes nodes = some_nodes();
  nodes.offsets.pop_back();
  EXPECT_EQ(save_nodes(nodes, folder / "n.json").error().code, ErrorCode::kBadArgument);
  EXPECT_FALSE(std::filesystem::exists(folder / "n.json"));
}

}  // namespace
}  // namespace spectile
