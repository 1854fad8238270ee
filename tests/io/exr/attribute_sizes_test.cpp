// A small file that claims large attributes is refused before any memory is taken for them.
#include <OpenEXR/ImfPreviewImage.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

class AttributeSizes : public testing::Test {
 protected:
  /// A good file with attributes of the types whose size is their own to say.
  void SetUp() override {
    test::Picture picture = test::blank(9, 6);
    test::add_rgb_noise(picture, Imf::HALF);
    picture.header.insert("aText", Imf::StringAttribute("some text"));
    picture.header.insert("texts", Imf::StringVectorAttribute({"one", "two"}));
    const std::vector<Imf::PreviewRgba> pixels(6);
    picture.header.setPreviewImage(Imf::PreviewImage(3, 2, pixels.data()));
    test::write_scanlines(path_, picture);
    good_ = test::file_bytes(path_);
  }

  /// The error for the file with the four bytes `at` bytes after the text `name` replaced.
  std::string said_of(const std::string& name, std::size_t at, std::uint32_t number) {
    std::string bytes = good_;
    const std::size_t found = bytes.find(name);
    EXPECT_NE(found, std::string::npos);
    std::memcpy(bytes.data() + found + name.size() + at, &number, sizeof(number));
    test::write_text(path_, bytes);
    const auto info = inspect_image(path_, std::nullopt, 1);
    return info ? "" : info.error().message;
  }

  test::TempFolder folder_;
  const std::string path_ = folder_ / "in.exr";
  std::string good_;
};

TEST_F(AttributeSizes, AreBelievedAsFarAsTheFileGoes) {
  EXPECT_TRUE(inspect_image(path_, std::nullopt, 1));
}

TEST_F(AttributeSizes, OfTextsAreRefusedByTheAttributesName) {
  const std::string name("aText\0string\0", 13);
  EXPECT_THAT(said_of(name, 0, 0x70000000), testing::HasSubstr("attribute aText claims 1879048192 bytes"));
  EXPECT_THAT(said_of(name, 0, 0xFFFFFFFF), testing::HasSubstr("attribute aText claims -1 bytes"));
}

TEST_F(AttributeSizes, OfTextsInAListAreRefused) {
  const std::string name("texts\0stringvector\0", 19);
  EXPECT_THAT(said_of(name, 4, 0x70000000), testing::HasSubstr("attribute texts claims 1879048192 bytes"));
}

TEST_F(AttributeSizes, OfPreviewsAreRefused) {
  const std::string name("preview\0preview\0", 16);
  EXPECT_THAT(said_of(name, 4, 20000), testing::HasSubstr("attribute preview claims 160000 bytes"));
  EXPECT_THAT(said_of(name, 4, 0x7FFFFFFF), testing::HasSubstr("attribute preview claims"));
}

TEST_F(AttributeSizes, OfUnknownTypesAreRefused) {
  std::string bytes = good_;
  const std::string name("aText\0string\0", 13);
  bytes[bytes.find(name) + 6] = 'S';
  good_ = bytes;
  EXPECT_THAT(said_of(std::string("aText\0String\0", 13), 0, 0x70000000),
              testing::HasSubstr("attribute aText claims"));
}

}  // namespace
}  // namespace spectile
