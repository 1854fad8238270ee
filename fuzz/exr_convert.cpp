// Fuzzes conversions of EXR files: each leaves a whole image that says how it was made, or nothing.
#include <algorithm>
#include <array>
#include <spectile/image/average.hpp>
#include <spectile/image/settings.hpp>

#include "fuzz/exr_size.hpp"
#include "fuzz/support.hpp"

namespace {

using namespace spectile;

constexpr std::array kKinds = {CompressionKind::kNone, CompressionKind::kRle,  CompressionKind::kZips,
                               CompressionKind::kZip,  CompressionKind::kPiz,  CompressionKind::kPxr24,
                               CompressionKind::kB44,  CompressionKind::kB44a, CompressionKind::kDwaa,
                               CompressionKind::kDwab};

void choose(fuzz::Choices& choices, ImageOptions& options) {
  options.threads = 1;
  options.pixel = choices.one_in(2) ? SampleType::kFloat : SampleType::kHalf;
  options.compression.kind = kKinds[choices.below(kKinds.size())];
  options.compression.level = -1;
  options.nonfinite = choices.one_in(4) ? NonFinite::kStop : NonFinite::kZero;
  options.tile_lanes = choices.one_in(2) ? 64 : 65536;
  options.skip = !choices.one_in(2);
  if (choices.one_in(4))
    options.tile = {1 + static_cast<int>(choices.below(40)), 1 + static_cast<int>(choices.below(40))};
  if (choices.one_in(4)) {
    const int x = static_cast<int>(choices.below(8)) - 2;
    const int y = static_cast<int>(choices.below(8)) - 2;
    options.region = PixelWindow::inclusive(x, y, x + static_cast<int>(choices.below(8)),
                                            y + static_cast<int>(choices.below(8)));
  }
}

void choose(fuzz::Choices& choices, MethodOptions& options) {
  choose(choices, static_cast<ImageOptions&>(options));
  constexpr std::array kMethods = {Method::kSmits,      Method::kSmits1999, Method::kSmitsExact,
                                   Method::kMallett,    Method::kSigmoid,   Method::kSigmoidObserver,
                                   Method::kTetrahedral};
  // The last ones search for what they need, which takes a hundred times as long as the rest of a case.
  options.method = kMethods[choices.below(choices.one_in(16) ? static_cast<unsigned>(kMethods.size()) : 3)];
  options.quantity = static_cast<Quantity>(choices.below(3));
  options.negative = static_cast<NegativeInput>(choices.below(3));
}

/// Invariants of every conversion.
void check(const Result<ImageReport>& report, const fuzz::CaseFolder& folder, const std::string& settings) {
  const bool done = fuzz::is_value(report);
  if (done) {
    const auto info = inspect_image(folder.output(), std::nullopt, 1);
    fuzz::require(static_cast<bool>(info), "what was written can be read", info ? "" : info.error().message);
    fuzz::require(info->width == report->width && info->height == report->height,
                  "an output is of the size reported");
    // Averages have channels, whatever they mean, and no settings.
    fuzz::require(!info->bands || settings.empty() || info->bands->count() == report->bands,
                  "an output has the bands reported");
    const auto said = settings_of(folder.output());
    fuzz::require(settings.empty() || (said && *said == settings), "an output says how it was made",
                  settings);
  }
  folder.require_tidy(done);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::Bytes bytes(data, size);
  if (!fuzz::is_small_image(bytes, 1 << 12)) return 0;
  const fuzz::CaseFolder folder(bytes);
  fuzz::Choices choices(bytes);
  // One way a case, so that cases stay short.
  switch (choices.below(6)) {
    case 0: {
      ProjectImageOptions options;
      choose(choices, options);
      options.target = static_cast<ColorTarget>(choices.below(3));
      check(project_image(folder.input(), folder.output(), options), folder, settings_text(options));
      break;
    }
    case 1: {
      ExpandImageOptions options;
      choose(choices, options);
      check(expand_image(folder.input(), folder.output(), options), folder, settings_text(options));
      break;
    }
    case 2: {
      RelightImageOptions options({"A", *illuminant("A")});
      choose(choices, options);
      check(relight_image(folder.input(), folder.output(), options), folder, settings_text(options));
      break;
    }
    case 3: {
      AverageOptions options;
      choose(choices, options);
      options.region.reset();
      const std::vector<std::string> twice = {folder.input(), folder.input()};
      check(average_images(twice, folder.output(), options), folder, {});
      break;
    }
    case 4: {
      ConvertImageOptions options;
      choose(choices, options);
      options.keep_depth = choices.one_in(2);
      const std::vector<std::string> dialects = spectral_dialects();
      options.dialect = dialects[choices.one_in(2) ? 0 : choices.below(dialects.size())];
      if (choices.one_in(4)) options.quantity = Quantity::kReflectance;
      if (choices.one_in(4)) options.bands = Bands();
      if (choices.one_in(4)) options.scale = 0.01;
      check(convert_image(folder.input(), folder.output(), options), folder, settings_text(options));
      break;
    }
    default: {
      UpsampleImageOptions options;
      choose(choices, options);
      options.store = choices.one_in(2) ? Store::kCoefficients : Store::kSpectra;
      options.masking = choices.one_in(2) ? Masking::kNone : Masking::kAlpha;
      check(upsample_image(folder.input(), folder.output(), options), folder, settings_text(options));
    }
  }
  return 0;
}
