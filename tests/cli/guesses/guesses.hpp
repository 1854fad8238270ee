// Guesses that readers make: each is said in the text of every command that makes it, and in its JSON.
#pragma once

#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile::test {

using Arguments = std::vector<std::string>;

/// A guess: what the input holds, and the words that must be said.
struct Guess {
  std::string name;
  std::function<Picture()> picture;
  std::vector<std::string> said;
  Arguments more = {};  ///< options that the guess needs
};

class Guesses : public testing::Test {
 protected:
  /// Runs a command as text and as quiet JSON, and finds the words in both.
  static void expect_said(const std::string& guess, const Arguments& command,
                          const std::vector<std::string>& words) {
    const std::string what = guess + ": " + fmt::format("{}", fmt::join(command, " "));
    const Outcome text = run_tool(command);
    ASSERT_EQ(text.exit, 0) << what << "\n" << text;
    for (const std::string& word : words) EXPECT_THAT(text.out, testing::HasSubstr(word)) << what;
    Arguments with_json = command;
    with_json.insert(with_json.end(), {"--json", "--quiet"});
    const Outcome json = run_tool(with_json);
    ASSERT_EQ(json.exit, 0) << what << "\n" << json;
    const auto parsed = nlohmann::json::parse(json.out, nullptr, false);
    ASSERT_TRUE(parsed.is_object()) << what << "\n" << json;
    ASSERT_TRUE(parsed.contains("notes")) << what;
    std::string notes;
    for (const auto& note : parsed["notes"]) notes += note.get<std::string>() + "\n";
    for (const std::string& word : words) EXPECT_THAT(notes, testing::HasSubstr(word)) << what;
  }
  /// The same of a guess in an image, for the commands that read it.
  void expect_said(const Guess& guess, const std::vector<Arguments>& commands) {
    Picture picture = guess.picture();
    write_scanlines(in_, picture);
    for (Arguments command : commands) {
      command.insert(command.end(), guess.more.begin(), guess.more.end());
      expect_said(guess.name, command, guess.said);
    }
  }
  /// A plan for these lights and more: a number of reflectances are needed beside.
  Arguments plan(const std::string& light, const Arguments& more) const {
    std::string text = "nm,a,b,c,d,e,f,g,h,i,j\n";
    for (int nm = 400; nm <= 700; nm += 20) {
      text += std::to_string(nm);
      for (int i = 0; i < 10; ++i) text += fmt::format(",{}", noise(nm, i, 0));
      text += "\n";
    }
    write_text(folder_ / "patches.csv", text);
    Arguments out = {"plan",
                     "--illuminant",
                     light,
                     "--count",
                     "3",
                     "--folds",
                     "0",
                     "-o",
                     folder_ / "plan.json",
                     "--reflectances",
                     folder_ / "patches.csv"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  /// Quiet and without JSON nothing is said.
  static void expect_silence(Arguments command) {
    command.emplace_back("--quiet");
    const Outcome outcome = run_tool(command);
    EXPECT_EQ(outcome.exit, 0) << outcome;
    EXPECT_EQ(outcome.out, "");
  }

  TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

/// One part a picture, under these names.
inline void write_parts(const std::string& path, const std::vector<std::pair<std::string, Picture*>>& parts) {
  std::vector<Imf::Header> headers;
  for (const auto& [name, picture] : parts) {
    picture->header.setName(name);
    picture->header.setType("scanlineimage");
    headers.push_back(picture->header);
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()), true);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Imf::OutputPart part(file, static_cast<int>(i));
    part.setFrameBuffer(parts[i].second->frame_buffer());
    part.writePixels(parts[i].second->height());
  }
}

/// Channels of one value, 4 x 4 pixels.
inline Picture constant(const std::vector<std::string>& names, double value = 0.5,
                        Imf::PixelType type = Imf::FLOAT) {
  Picture picture = blank(4, 4);
  for (const std::string& name : names) picture.add(name, type, [=](int, int) { return value; });
  return picture;
}

/// Bands of 10 nm from 400 to 700 of one value, under a prefix.
inline void add_bands(Picture& picture, const std::string& prefix, double value = 0.5) {
  for (int nm = 400; nm <= 700; nm += 10) {
    picture.add(fmt::format("{}.{},000000nm", prefix, nm), Imf::FLOAT, [=](int, int) { return value; });
  }
}

inline Picture spectral(const std::vector<std::string>& prefixes) {
  Picture picture = blank(4, 4);
  for (const std::string& prefix : prefixes) add_bands(picture, prefix);
  return picture;
}

}  // namespace spectile::test
