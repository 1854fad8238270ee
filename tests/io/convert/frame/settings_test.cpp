// Settings: different options give different texts, images carry theirs, and what is up to date is told.
#include <OpenEXR/ImfStringAttribute.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <set>
#include <spectile/image/average.hpp>
#include <spectile/image/settings.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::Picture;
using testing::HasSubstr;

const NamedLight kLamp = {"lamp", *illuminant("FL11")};

/// Texts of option sets that each differ from the others; any two alike fail the test.
class Texts {
 public:
  template <class Options>
  void add(const std::string& what, const Options& options) {
    const std::string text = settings_text(options);
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_TRUE(seen_.insert({text, what}).second) << what << " is like " << seen_[text] << ": " << text;
    EXPECT_EQ(settings_text(options), text);
  }

 private:
  std::map<std::string, std::string> seen_;
};

/// Adds a set of options for each change.
template <class Options>
void add_each(Texts& texts, const Options& usual,
              const std::vector<std::pair<std::string, std::function<void(Options&)>>>& changes) {
  for (const auto& [what, change] : changes) {
    Options options = usual;
    change(options);
    texts.add(what, options);
  }
}

template <class Options>
void add_image_options(Texts& texts, const Options& usual) {
  texts.add("usual", usual);
  for (const char* name : {"none", "rle", "zips:1", "zip:2", "zip:9", "piz", "pxr24", "b44", "b44a", "dwaa",
                           "dwaa:46", "dwab", "dwab:100"}) {
    Options options = usual;
    options.compression = *Compression::parse(name);
    texts.add(name, options);
  }
  add_each<Options>(
      texts, usual,
      {{"pixel",
        [&](Options& o) { o.pixel = o.pixel == SampleType::kHalf ? SampleType::kFloat : SampleType::kHalf; }},
       {"region", [](Options& o) { o.region = PixelWindow::inclusive(1, 2, 3, 4); }},
       {"other region", [](Options& o) { o.region = PixelWindow::inclusive(12, 3, 4, 5); }},
       {"nonfinite", [](Options& o) { o.nonfinite = NonFinite::kZero; }},
       {"tile",
        [](Options& o) {
          o.tile = {64, 64};
        }},
       {"other tile",
        [](Options& o) {
          o.tile = {64, 32};
        }},
       {"mipmap", [](Options& o) { o.mipmap = true; }},
       {"mipmap in other tiles", [](Options& o) {
          o.mipmap = true;
          o.tile = {64, 32};
        }}});
}

TEST(Settings, MipmapAloneIsThatInItsUsualTiles) {
  UpsampleImageOptions options;
  options.mipmap = true;
  const std::string alone = settings_text(options);
  options.tile = {64, 64};
  EXPECT_EQ(settings_text(options), alone);
}

template <class Options>
void add_method_options(Texts& texts, const Options& usual) {
  add_image_options(texts, usual);
  for (const std::string& name : method_names()) {
    Options options = usual;
    options.method = *parse_method(name);
    if (options.method != usual.method) texts.add(name, options);
  }
  for (const std::string& name : rgb_space_names()) {
    Options options = usual;
    options.input_space = *rgb_space(name);
    texts.add(name, options);
  }
  for (const char* bands : {"400:700:10", "400:700:2.5", "380:780:5", "400,500,600", "400,500,601"}) {
    Options options = usual;
    options.bands = *Bands::parse(bands);
    texts.add(bands, options);
  }
  const NamedLight changed = {"lamp", kLamp.spectrum.scaled(1 + 1e-15)};
  add_each<Options>(
      texts, usual,
      {{"unbounded", [](Options& o) { o.quantity = Quantity::kUnbounded; }},
       {"illuminant", [](Options& o) { o.quantity = Quantity::kIlluminant; }},
       {"light", [](Options& o) { o.light = kLamp; }},
       {"light's samples", [&](Options& o) { o.light = changed; }},
       {"light's name",
        [](Options& o) {
          o.light = NamedLight{"lamp\"", kLamp.spectrum};
        }},
       {"white observer", [](Options& o) { o.observer = Observer::kCie1964; }},
       {"clip negative", [](Options& o) { o.negative = NegativeInput::kClip; }},
       {"keep negative", [](Options& o) { o.negative = NegativeInput::kKeep; }},
       {"stop at negative", [](Options& o) { o.negative = NegativeInput::kError; }},
       {"clip gamut", [](Options& o) { o.out_of_gamut = GamutPolicy::kClip; }},
       {"keep gamut", [](Options& o) { o.out_of_gamut = GamutPolicy::kKeep; }},
       {"stop at gamut", [](Options& o) { o.out_of_gamut = GamutPolicy::kError; }},
       {"under D65",
        [](Options& o) {
          o.input_space = *rgb_space("srgb");
          o.input_space->relative_to_d65 = !o.input_space->relative_to_d65;
        }},
       {"straight", [](Options& o) { o.alpha = AlphaMeaning::kStraight; }},
       {"no alpha", [](Options& o) { o.alpha = AlphaMeaning::kIgnored; }},
       {"layer", [](Options& o) { o.channels.layer = "left"; }},
       {"layer that looks like more", [](Options& o) { o.channels.layer = "left\"; store=\"x\n"; }},
       {"layer with a backslash", [](Options& o) { o.channels.layer = "left\\\"; store=\\\"x\\x0a"; }}});
}

TEST(Settings, DifferentOptionsGiveDifferentTexts) {
  Texts texts;
  add_method_options(texts, UpsampleImageOptions());
  add_each<UpsampleImageOptions>(
      texts, {}, {{"store", [](UpsampleImageOptions& o) { o.store = Store::kCoefficients; }}});

  const RelightImageOptions relight(kLamp);
  add_method_options(texts, relight);
  add_each<RelightImageOptions>(texts, relight,
                                {{"under", [](auto& o) { o.under.spectrum = *illuminant("A"); }},
                                 {"name under", [](auto& o) { o.under.name = "other"; }},
                                 {"xyz", [](auto& o) { o.target = ColorTarget::kXyz; }},
                                 {"luminance", [](auto& o) { o.target = ColorTarget::kLuminance; }},
                                 {"seen by", [](auto& o) { o.seen_by = Observer::kCie1964; }},
                                 {"bradford", [](auto& o) { o.adaptation = Adaptation::kBradford; }},
                                 {"cat16", [](auto& o) { o.adaptation = Adaptation::kCat16; }},
                                 {"way", [](auto& o) { o.mode = RelightMode::kSpectra; }}});

  add_image_options(texts, ProjectImageOptions());
  add_each<ProjectImageOptions>(texts, {},
                                {{"xyz", [](auto& o) { o.target = ColorTarget::kXyz; }},
                                 {"luminance", [](auto& o) { o.target = ColorTarget::kLuminance; }},
                                 {"observer", [](auto& o) { o.observer = Observer::kCie1964; }},
                                 {"light", [](auto& o) { o.light = kLamp.spectrum; }},
                                 {"other light", [](auto& o) { o.light = *illuminant("A"); }},
                                 {"reflectance", [](auto& o) { o.quantity = Quantity::kReflectance; }},
                                 {"illuminant", [](auto& o) { o.quantity = Quantity::kIlluminant; }},
                                 {"bradford", [](auto& o) { o.adaptation = Adaptation::kBradford; }},
                                 {"cat16", [](auto& o) { o.adaptation = Adaptation::kCat16; }}});

  add_image_options(texts, ExpandImageOptions());
  add_each<ExpandImageOptions>(texts, {},
                               {{"bands", [](auto& o) { o.bands = Bands(); }},
                                {"other bands", [](auto& o) { o.bands = *Bands::parse("400:700:10"); }}});

  add_image_options(texts, ConvertImageOptions());
  add_each<ConvertImageOptions>(texts, {},
                                {{"depth", [](auto& o) { o.keep_depth = false; }},
                                 {"reflectance", [](auto& o) { o.quantity = Quantity::kReflectance; }},
                                 {"illuminant", [](auto& o) { o.quantity = Quantity::kIlluminant; }},
                                 {"dialect", [](auto& o) { o.dialect = "ocean"; }},
                                 {"bands", [](auto& o) { o.bands = Bands(); }},
                                 {"scale", [](auto& o) { o.scale = 1 + 1e-15; }},
                                 {"units", [](auto& o) { o.units = "lx\"; scale=\"2"; }}});
}

TEST(Settings, WhatChangesNoBitIsNotInThem) {
  UpsampleImageOptions options;
  const std::string text = settings_text(options);
  options.threads = 3;
  options.tile_lanes = 64;
  options.progress = [](const Progress&) { return true; };
  EXPECT_EQ(settings_text(options), text);
  EXPECT_THAT(text, testing::StartsWith("spectile "));
  EXPECT_THAT(text, HasSubstr("; upsample; pixel=half; compression=zip:1; "));
}

class SettingsUpToDate : public testing::Test {
 protected:
  SettingsUpToDate() {
    Picture picture = test::blank(40, 300);
    test::add_rgb_noise(picture, Imf::HALF);
    picture.header.insert("spectileSettings", Imf::StringAttribute("of another image"));
    test::write_scanlines(input_, picture);
    set_time(input_, -10);
  }
  /// Sets when a file was last written, in seconds from now.
  static void set_time(const std::string& path, double seconds, long nanoseconds = 0) {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    now.tv_sec += static_cast<time_t>(seconds);
    now.tv_nsec = nanoseconds;
    const timespec times[2] = {now, now};
    ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
  }
  bool fresh(const std::string& output, std::vector<std::string> dependencies,
             const std::string& settings) const {
    return up_to_date(output, dependencies, settings);
  }
  test::TempFolder folder_;
  const std::string input_ = folder_ / "in.exr";
  const std::string spectral_ = folder_ / "out.exr";
  const std::string settings_ = settings_text(test::kUpsample);
};

TEST_F(SettingsUpToDate, EveryConversionWritesItsOwn) {
  ASSERT_TRUE(upsample_image(input_, spectral_, test::kUpsample));
  EXPECT_EQ(*settings_of(spectral_), settings_);
  EXPECT_EQ(*settings_of(input_), "of another image");

  ProjectImageOptions project;
  project.target = ColorTarget::kXyz;
  ASSERT_TRUE(project_image(spectral_, folder_ / "xyz.exr", project));
  EXPECT_EQ(*settings_of(folder_ / "xyz.exr"), settings_text(project));

  const RelightImageOptions relight(kLamp);
  ASSERT_TRUE(relight_image(input_, folder_ / "lit.exr", relight));
  EXPECT_EQ(*settings_of(folder_ / "lit.exr"), settings_text(relight));

  UpsampleImageOptions compact;
  compact.store = Store::kCoefficients;
  ASSERT_TRUE(upsample_image(input_, folder_ / "compact.exr", compact));
  const ExpandImageOptions expand;
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "expanded.exr", expand));
  EXPECT_EQ(*settings_of(folder_ / "expanded.exr"), settings_text(expand));
}

TEST_F(SettingsUpToDate, DoNotPassToWhatIsNoConversion) {
  const auto rgb = read_rgb_image(input_);
  ASSERT_TRUE(write_rgb_image(folder_ / "plain.exr", rgb->rgb.view(), rgb->width, rgb->height));
  EXPECT_EQ(*settings_of(folder_ / "plain.exr"), "");
  ASSERT_TRUE(average_images(std::vector<std::string>{input_, input_}, folder_ / "average.exr"));
  EXPECT_EQ(*settings_of(folder_ / "average.exr"), "");
  EXPECT_EQ(settings_of(folder_ / "none.exr").error().code, ErrorCode::kBadFile);
}

TEST_F(SettingsUpToDate, AnOutputIsUpToDateUntilWhatMadeItChanges) {
  EXPECT_FALSE(fresh(spectral_, {input_}, settings_));
  ASSERT_TRUE(upsample_image(input_, spectral_, test::kUpsample));
  EXPECT_TRUE(fresh(spectral_, {input_}, settings_));
  EXPECT_TRUE(fresh(spectral_, {}, settings_));
  EXPECT_FALSE(fresh(spectral_, {input_}, settings_ + " "));
  EXPECT_FALSE(fresh(spectral_, {input_}, ""));
  EXPECT_FALSE(fresh(spectral_, {input_, folder_ / "no lamp"}, settings_));
  test::write_text(folder_ / "lamp", "400 1\n700 2\n");
  set_time(folder_ / "lamp", -5);
  EXPECT_TRUE(fresh(spectral_, {input_, folder_ / "lamp"}, settings_));
  set_time(folder_ / "lamp", 5);
  EXPECT_FALSE(fresh(spectral_, {input_, folder_ / "lamp"}, settings_));
  EXPECT_FALSE(fresh(folder_.path().string(), {input_}, settings_));
}

TEST_F(SettingsUpToDate, TimesAreComparedToTheNanosecond) {
  ASSERT_TRUE(upsample_image(input_, spectral_, test::kUpsample));
  set_time(input_, 100, 500);
  set_time(spectral_, 100, 500);
  struct stat a {};
  struct stat b {};
  ::stat(input_.c_str(), &a);
  ::stat(spectral_.c_str(), &b);
  if (a.st_mtim.tv_sec != b.st_mtim.tv_sec) set_time(spectral_, 99, 500);
  EXPECT_FALSE(fresh(spectral_, {input_}, settings_)) << "equal times are no proof";
  const timespec later[2] = {{a.st_mtim.tv_sec, 501}, {a.st_mtim.tv_sec, 501}};
  ASSERT_EQ(::utimensat(AT_FDCWD, spectral_.c_str(), later, 0), 0);
  EXPECT_TRUE(fresh(spectral_, {input_}, settings_));
}

TEST_F(SettingsUpToDate, AnInputThatChangesWhileItIsReadIsAnError) {
  Picture picture = test::blank(20, 3000);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder_ / "long.exr", picture);
  UpsampleImageOptions options;
  options.threads = 1;
  const auto changed = [&](const std::function<void()>& change) {
    int calls = 0;
    options.progress = [&](const Progress&) {
      if (calls++ == 0) change();
      return true;
    };
    const auto report = upsample_image(folder_ / "long.exr", spectral_, options);
    EXPECT_FALSE(std::filesystem::exists(spectral_));
    return report ? "" : report.error().message;
  };
  const std::string message = (folder_ / "long.exr") + ": was changed while it was read";
  EXPECT_EQ(changed([&] { set_time(folder_ / "long.exr", -20); }), message);
  EXPECT_EQ(changed([&] {
              std::filesystem::copy_file(folder_ / "long.exr", folder_ / "copy.exr");
              std::filesystem::rename(folder_ / "copy.exr", folder_ / "long.exr");
            }),
            message);
  options.progress = nullptr;
  EXPECT_TRUE(upsample_image(folder_ / "long.exr", spectral_, options));
}

TEST_F(SettingsUpToDate, AMaskThatChangesWhileItIsReadIsAnError) {
  Picture picture = test::blank(20, 3000);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder_ / "long.exr", picture);
  test::write_scanlines(folder_ / "mask.exr", picture);
  UpsampleImageOptions options;
  options.threads = 1;
  options.masking = Masking::kFile;
  options.mask = folder_ / "mask.exr";
  int calls = 0;
  options.progress = [&](const Progress&) {
    if (calls++ == 0) set_time(options.mask, -20);
    return true;
  };
  const auto report = upsample_image(folder_ / "long.exr", spectral_, options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, options.mask + ": was changed while it was read");
  EXPECT_FALSE(std::filesystem::exists(spectral_));
}

TEST_F(SettingsUpToDate, AFileCutShortIsNotUpToDate) {
  ASSERT_TRUE(upsample_image(input_, spectral_, test::kUpsample));
  const auto size = std::filesystem::file_size(spectral_);
  ASSERT_TRUE(fresh(spectral_, {input_}, settings_));
  for (const std::uintmax_t left : {size - 100, size / 2, std::uintmax_t{2000}, std::uintmax_t{0}}) {
    std::filesystem::resize_file(spectral_, left);
    EXPECT_FALSE(fresh(spectral_, {input_}, settings_)) << left;
  }
}

}  // namespace
}  // namespace spectile
