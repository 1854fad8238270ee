// Settings as one line of text, and whether an image that holds one needs to be made anew.
#include <sys/stat.h>

#include <spectile/image/nodes_file.hpp>
#include <spectile/image/polarisation.hpp>
#include <spectile/image/settings.hpp>
#include <spectile/spectra/band_weights.hpp>

#include "src/base/digest.hpp"
#include "src/base/enum_names.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/exr/attributes.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile {
namespace {

/// Text in quotation marks on one line, such that no two texts look alike.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 32 || byte == 127) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string to_text(const MeasuredSpectrum& spectrum) {
  Digest digest;
  for (const double nm : spectrum.wavelengths_nm()) digest.add(nm);
  for (const double value : spectrum.values()) digest.add(value);
  return fmt::format("{}#{}", spectrum.values().size(), digest.text());
}

std::string to_text(const Bands& bands) {
  Digest digest;
  for (const Band& band : bands.list()) digest.add(band.lower_nm).add(band.centre_nm).add(band.upper_nm);
  if (const BandWeights* const own = bands.weights()) {
    digest.add(bands.are_points() ? 1 : 0).add(own->observer == Observer::kCie1964 ? 1964 : 1931);
    for (const auto& weights : own->sensor) {
      for (const double v : weights) digest.add(v);
    }
    for (const BandLight& light : own->lights) {
      for (const double v : light.emission) digest.add(v);
    }
  }
  const auto [first, last] = bands.range_nm();
  return fmt::format("{} from {} to {} nm #{}", bands.count(), first, last, digest.text());
}

std::string to_text(const std::vector<MappedChannel>& map) {
  std::string names;
  Digest digest;
  for (const MappedChannel& channel : map) {
    names += channel.name + '\n';
    digest.add(channel.band.lower_nm).add(channel.band.centre_nm).add(channel.band.upper_nm);
  }
  return fmt::format("{}#{}", quoted(std::as_const(names)), digest.text());
}

std::string to_text(const RgbSpace& space) {
  const Chromaticities& c = space.chromaticities;
  Digest digest;
  for (const auto& point : {c.red, c.green, c.blue, c.white}) {
    for (const double value : point) digest.add(value);
  }
  return fmt::format("{}#{}{}", quoted(space.name), digest.text(), space.relative_to_d65 ? " under D65" : "");
}

std::string to_text(const LearnedNodes& nodes) {
  Digest digest;
  for (const double nm : nodes.wavelengths_nm) digest.add(nm);
  for (const float offset : nodes.offsets) digest.add(static_cast<double>(offset));
  return fmt::format("{}#{}", nodes.reflectances, digest.text());
}

/// The first and the last pixel, both included.
std::string to_text(const PixelWindow& w) {
  return fmt::format("{},{},{},{}", w.x0, w.y0, std::int64_t{w.x1} - 1, std::int64_t{w.y1} - 1);
}

constexpr EnumName<ColorTarget> kTargets[] = {
    {ColorTarget::kSrgb, "srgb"}, {ColorTarget::kXyz, "xyz"}, {ColorTarget::kLuminance, "luminance"}};
constexpr EnumName<Adaptation> kAdaptations[] = {
    {Adaptation::kNone, "none"}, {Adaptation::kBradford, "bradford"}, {Adaptation::kCat16, "cat16"}};
constexpr EnumName<NegativeInput> kNegatives[] = {{NegativeInput::kGamut, "gamut"},
                                                  {NegativeInput::kClip, "clip"},
                                                  {NegativeInput::kKeep, "keep"},
                                                  {NegativeInput::kError, "stop"}};
constexpr EnumName<GamutPolicy> kGamutPolicies[] = {
    {GamutPolicy::kClip, "clip"}, {GamutPolicy::kKeep, "keep"}, {GamutPolicy::kError, "stop"}};

constexpr EnumName<AlphaMeaning> kAlphaMeanings[] = {{AlphaMeaning::kPremultiplied, "premultiplied"},
                                                     {AlphaMeaning::kStraight, "straight"},
                                                     {AlphaMeaning::kIgnored, "ignore"}};

/// "; name=value" after what is there.
class Line {
 public:
  explicit Line(const char* command) : text_(fmt::format("spectile {}; {}", SPECTILE_VERSION, command)) {}

  Line& add(const char* name, std::string_view value) {
    text_ += fmt::format("; {}={}", name, value);
    return *this;
  }

  Line& add(const ImageOptions& options) {
    // An option that is added there has to be looked at here: this no longer compiles then. Threads,
    // lanes, skipping, durability and progress change no bit.
    const auto& [pixel, compression, nonfinite, region, threads, tile_lanes, skip, tile, mipmap, durable,
                 channels, progress] = options;
    add("pixel", to_string(pixel));
    add("compression", compression.description());
    add("nonfinite", nonfinite == NonFinite::kZero ? "zero" : "stop");
    add("layer", quoted(channels.layer));
    add("view", quoted(channels.view));
    add("part", quoted(channels.part));
    if (!channels.map.empty()) add("channels", to_text(channels.map));
    add("region", region ? to_text(*region) : "all");
    // As they are written: mip levels alone imply tiles.
    const auto written = io::tiles_of(options);
    add("tile",
        written ? fmt::format("{}x{}{}", (*written)[0], (*written)[1], mipmap ? " mipmap" : "") : "none");
    return *this;
  }

  Line& add(const MethodOptions& options) {
    add(static_cast<const ImageOptions&>(options));
    add("method", to_string(options.method));
    add("quantity", to_string(options.quantity));
    add("bands", to_text(options.bands));
    add("white", options.light ? quoted(options.light->name) + to_text(options.light->spectrum) : "D65");
    add("white-observer", to_string(options.observer));
    if (options.nodes) add("nodes", to_text(*options.nodes));
    add("input-space", options.input_space ? to_text(*options.input_space) : "of the file");
    add("negative", enum_name(kNegatives, options.negative));
    add("out-of-gamut",
        options.out_of_gamut ? enum_name(kGamutPolicies, *options.out_of_gamut) : "by negative");
    add("alpha", to_string(options.alpha_meaning()));
    return *this;
  }

  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

std::string settings_in(const io::ExrInput& input) {
  for (int part = 0; part < input.parts(); ++part) {
    if (auto found = input.header(part).text(io::kSettingsAttribute)) return *std::move(found);
  }
  return {};
}

bool is_before(const timespec& a, const timespec& b) {
  return a.tv_sec != b.tv_sec ? a.tv_sec < b.tv_sec : a.tv_nsec < b.tv_nsec;
}

}  // namespace

std::string_view to_string(AlphaMeaning meaning) {
  return enum_name(kAlphaMeanings, meaning);
}

std::string settings_text(const UpsampleImageOptions& options) {
  Line line("upsample");
  line.add(options).add("store", options.store == Store::kCoefficients ? "coefficients" : "spectra");
  line.add("mask", options.masking == Masking::kFile    ? quoted(options.mask)
                   : options.masking == Masking::kAlpha ? "alpha"
                                                        : "none");
  return std::move(line).text();
}

std::string settings_text(const RelightImageOptions& options) {
  Line line("relight");
  line.add(options);
  line.add("under", quoted(options.under.name) + to_text(options.under.spectrum));
  line.add("to", enum_name(kTargets, options.target));
  line.add("observer", to_string(options.seen_by));
  line.add("adapt", enum_name(kAdaptations, options.adaptation));
  line.add("way", options.mode == RelightMode::kSpectra ? "spectra" : "direct");
  return std::move(line).text();
}

std::string settings_text(const ProjectImageOptions& options) {
  Line line("project");
  line.add(options);
  line.add("to", enum_name(kTargets, options.target));
  line.add("observer", to_string(options.observer));
  line.add("illuminant", options.light ? to_text(*options.light) : "D65");
  line.add("quantity", options.quantity ? to_string(*options.quantity) : "of the file");
  line.add("adapt", enum_name(kAdaptations, options.adaptation));
  // As texts of earlier files have it, where neither is asked for.
  if (options.emission) line.add("emission", fmt::format("{}", *options.emission));
  if (options.photometric) line.add("unit", "cd/m2");
  return std::move(line).text();
}

std::string settings_text(const PolarisationImageOptions& options) {
  Line line("project");
  line.add(options);
  line.add("to", options.polarisation == Polarisation::kDegree ? "dop" : "aolp");
  line.add("observer", to_string(options.observer));
  return std::move(line).text();
}

std::string settings_text(const ExpandImageOptions& options) {
  Line line("expand");
  line.add(options).add("bands", options.bands ? to_text(*options.bands) : "of the file");
  return std::move(line).text();
}

std::string settings_text(const ConvertImageOptions& options) {
  Line line("convert");
  line.add(options);
  line.add("keep-depth", options.keep_depth ? "yes" : "no");
  line.add("quantity", options.quantity ? to_string(*options.quantity) : "of the file");
  line.add("dialect", quoted(options.dialect));
  line.add("bands", options.bands ? to_text(*options.bands) : "of the file");
  line.add("scale", fmt::format("{}", options.scale));
  line.add("units", quoted(options.units));
  return std::move(line).text();
}

Result<std::string> settings_of(const std::string& path) {
  return io::contained<std::string>(path, [&]() -> Result<std::string> {
    SPECTILE_ASSIGN(const auto input, io::ExrInput::open(path, 1));
    return settings_in(*input);
  });
}

bool up_to_date(const std::string& output, std::span<const std::string> dependencies,
                std::string_view settings) {
  struct stat made {};
  if (::stat(output.c_str(), &made) != 0 || !S_ISREG(made.st_mode)) return false;
  for (const std::string& file : dependencies) {
    struct stat source {};
    if (::stat(file.c_str(), &source) != 0 || !is_before(source.st_mtim, made.st_mtim)) return false;
  }
  const auto same = io::contained<bool>(output, [&]() -> Result<bool> {
    SPECTILE_ASSIGN(const auto input, io::ExrInput::open(output, 1));
    if (settings.empty() || settings_in(*input) != settings) return false;
    for (int part = 0; part < input->parts(); ++part) {
      if (!input->header(part).deep()) SPECTILE_TRY(input->read_last(part));
    }
    return true;
  });
  return same && *same;
}

}  // namespace spectile
