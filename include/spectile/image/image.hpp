// Whole images: an RGB EXR to a spectral EXR, a spectral EXR to colour, and what a file holds.
//
// Rules common to all. Memory stays bounded whatever the image's size. An output appears at its path whole or
// not at all. Errors name the file: kBadFile (missing, damaged, deep, without the channels needed),
// kNoPermission, kNoSpace, kNonFinite, kCancelled, kBadArgument, kUnknownName, and those of active_isa().
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <spectile/color/colorimetry.hpp>
#include <spectile/color/rgb_space.hpp>
#include <spectile/pixel_window.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/spectra/named_light.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// Type of an image's samples. Spectra and colours are written as kHalf or kFloat.
enum class SampleType { kHalf, kFloat, kUint32 };
/// "half", "float" or "uint".
std::string_view to_string(SampleType type);

/// OpenEXR's compression methods.
enum class CompressionKind { kNone, kRle, kZips, kZip, kPiz, kPxr24, kB44, kB44a, kDwaa, kDwab };

/// A compression method and its level, for those that have one.
struct Compression {
  CompressionKind kind = CompressionKind::kZip;
  /// zip, zips: zlib's, 1 (fast) to 9 (small); dwaa, dwab: 1 to 500, loss that grows with it. -1 for
  /// OpenEXR's default.
  int level = 1;

  /// Reads "NAME" or "NAME:LEVEL". Errors: kUnknownName, kBadArgument.
  static Result<Compression> parse(std::string_view text);
  std::string description() const;
};

/// Policy for pixels that hold NaN, infinities, or components beyond 2^124, whose spectra could
/// overflow.
enum class NonFinite {
  kStop,  ///< an error that names the first of them and their number
  kZero,  ///< the whole pixel becomes black, and is counted
};

/// Policy for components of the input below 0, in the input's own RGB.
enum class NegativeInput {
  kGamut,  ///< colours outside the method's gamut: see GamutPolicy
  kClip,   ///< set to 0, and their pixels are counted
  kKeep,   ///< kept, as are the samples below 0 that they make
  kError,  ///< an error that names the first of them and their number
};

/// How far a conversion is.
struct Progress {
  std::uint64_t pixels_done = 0;
  std::uint64_t pixels = 0;
};

/// Called now and then, from one thread at a time; false stops the conversion with kCancelled.
using ProgressFunction = std::function<bool(const Progress&)>;

/// A channel whose name says no wavelength, and the band that it holds.
struct MappedChannel {
  std::string name = {};
  Band band = {};
};

/// Which of a file's channels to read. Where nothing is said: the plain ones, or the only ones that there
/// are; of a stereo file the default view; of several parts the first that has any.
struct ChannelChoice {
  std::string layer = {};  ///< of channels named LAYER.NAME; the name of a view or a part is taken too
  std::string view = {};   ///< of a stereo file, such as "right"
  std::string part = {};   ///< of a file of several parts: its name, or its number, from 0
  /// Where it is not empty: the spectral channels, whatever their names. See load_channel_map().
  std::vector<MappedChannel> map = {};
};

/// Options of every conversion.
struct ImageOptions {
  SampleType pixel = SampleType::kHalf;
  Compression compression = {};
  NonFinite nonfinite = NonFinite::kStop;
  /// The part of the input to convert, in the coordinates of its data window, which is then the output's; all
  /// of it where none. No more is decoded than the lines, or tiles, that it touches. Clamped to the data
  /// window, which the report notes; kBadArgument where it lies outside. For
  /// functions that read one image.
  std::optional<PixelWindow> region = {};
  int threads = 0;                 ///< 0: every core that the process may use
  std::size_t tile_lanes = 65536;  ///< most pixels a kernel call works on, 64 or more
  /// upsample_image: whether what is black, masked, constant or repeated is found and not computed again. The
  /// file is the same to the bit without; SkipStats says what it was good for.
  bool skip = true;
  /// Conversions of an image to another write tiles of this width and height, 1 to 4096; none: scanlines.
  std::optional<std::array<int, 2>> tile = {};
  /// Conversions of an image to another write mip levels too, down to one pixel, sizes rounded down, in tiles
  /// of 64 x 64 where `tile` says nothing. A level's pixel is the average of the area that it covers: of
  /// spectra, or of colours in linear light. kBadArgument for coefficients that are not linear in spectra.
  bool mipmap = false;
  bool durable = false;  ///< wait for the device, so that no loss of power takes a file back; films always do
  ChannelChoice channels = {};
  ProgressFunction progress = {};
};

/// Meaning of the colour of a pixel that is not opaque.
enum class AlphaMeaning {
  kPremultiplied,  ///< a straight colour times alpha, as OpenEXR has it
  kStraight,       ///< the straight colour, whatever alpha is
  kIgnored,        ///< any colour: alpha says nothing of it
};
/// "premultiplied", "straight" or "ignore".
std::string_view to_string(AlphaMeaning meaning);

/// How colours become spectra: what upsampling, relighting and verification share.
struct MethodOptions : ImageOptions {
  Method method = kDefaultMethod;
  Quantity quantity = Quantity::kReflectance;
  Bands bands;
  std::optional<NamedLight> light;  ///< under which RGB 1, 1, 1 is the perfect diffuser; D65 where none
  Observer observer = Observer::kCie1931;
  std::shared_ptr<const LearnedNodes> nodes;  ///< of tetrahedral: learned ones; none for sigmoids
  std::optional<RgbSpace> input_space;        ///< of the input's RGB, whatever its attributes say
  NegativeInput negative = NegativeInput::kGamut;
  std::optional<GamutPolicy> out_of_gamut;  ///< kClip where none, but kKeep where negative ones are kept
  /// Of the input, where it has alpha. It matters to methods whose spectrum of half a colour is not half of
  /// its spectrum, reflectances by the sigmoids and tetrahedral: their premultiplied spectra are alpha times
  /// the spectra of the straight colours. Colours of alpha 0, and of 1 and more, are made into spectra as
  /// they are. Nothing: premultiplied, which is noted where it matters.
  std::optional<AlphaMeaning> alpha = {};
  AlphaMeaning alpha_meaning() const noexcept { return alpha.value_or(AlphaMeaning::kPremultiplied); }
};

/// Contents of the output of upsample_image().
enum class Store {
  kSpectra,       ///< a channel for each band
  kCoefficients,  ///< the method's three (or four) coefficients, which expand_image() turns into spectra
};

/// Which pixels are masked: they become black, as spectra and as preview, whatever their RGB (which may be
/// anything, NaN too).
enum class Masking {
  kAlpha,  ///< those whose own alpha is 0; none where there is no alpha
  kNone,   ///< none: what glows where alpha is 0, a flame say, keeps its colours
  kFile,   ///< those where another image is 0; alpha does not matter then
};

struct UpsampleImageOptions : MethodOptions {
  Store store = Store::kSpectra;
  Masking masking = Masking::kNone;
  /// For Masking::kFile: an image of the same size, of which channel A counts, else Y, else R. Errors:
  /// kBadFile for one of another size, or without such a channel.
  std::string mask;
};

/// Colour that project_image() writes.
enum class ColorTarget { kSrgb, kXyz, kLuminance };

/// Computation of relight_image().
enum class RelightMode {
  kDirect,  ///< without spectra: a table of 3 x 7 or 3 x 125 for mixtures, sums in registers for the sigmoids
  kSpectra,  ///< spectrum by spectrum, to check the direct one
};

struct RelightImageOptions : MethodOptions {
  NamedLight under;  ///< the light to see the texture under
  ColorTarget target = ColorTarget::kSrgb;
  Observer seen_by = Observer::kCie1931;
  Adaptation adaptation = Adaptation::kNone;  ///< of the light's white to D65
  RelightMode mode = RelightMode::kDirect;
  explicit RelightImageOptions(NamedLight seen_under) : under(std::move(seen_under)) {}
};

struct ProjectImageOptions : ImageOptions {
  ColorTarget target = ColorTarget::kSrgb;
  Observer observer = Observer::kCie1931;
  std::optional<MeasuredSpectrum> light;      ///< for reflectances; D65 where none is given
  std::optional<Quantity> quantity;           ///< which to take where a file holds both
  Adaptation adaptation = Adaptation::kNone;  ///< of the light's white to D65; reflectances only
  std::optional<double> emission;  ///< that of the same file is added, times this; 1 in every band has Y 1
  bool photometric = false;        ///< light in W / (m2 sr nm) becomes XYZ whose Y is cd / m2; emission only
};

/// Work that upsample_image() saved; all zero where it was told not to skip.
struct SkipStats {
  std::uint64_t masked_pixels = 0;
  std::uint64_t black_pixels = 0;     ///< not masked, black in the method's RGB
  std::uint64_t constant_pixels = 0;  ///< in whole blocks (64 pixels side by side) of one colour, not black
  std::uint64_t chunks = 0;           ///< runs of lines that are compressed together
  std::uint64_t chunks_reused = 0;    ///< ... that were the same as an earlier one
  std::uint64_t colors_looked_up =
      0;  ///< pixels, or constant blocks, whose colour was looked for among those solved
  std::uint64_t colors_solved = 0;  ///< ... and not found
  /// From the measured cost of what was computed: that of a pixel's arithmetic, a colour's solution, and of
  /// the chunks reused the first time; less what looking for them cost. Of one core.
  double core_seconds_saved = 0;
};

/// The note of a report on an RGB image that names no colour space.
inline constexpr const char* kAssumedSpaceNote =
    "linear Rec.709 assumed, as the file names no colour space; --input-space states another";

/// Report of a conversion.
struct ImageReport {
  int width = 0;
  int height = 0;
  std::size_t bands = 0;
  Quantity quantity = Quantity::kReflectance;
  std::uint64_t nonfinite_pixels = 0;     ///< replaced by black
  std::uint64_t negative_pixels = 0;      ///< with a component below 0 (of the input, before clipping)
  std::uint64_t over_one_pixels = 0;      ///< with a component above 1
  std::uint64_t out_of_gamut_pixels = 0;  ///< that the method cannot make, before they were moved
  std::uint64_t clamped_pixels = 0;       ///< with a sample beyond the largest half, written as that
  std::uint64_t bytes_written = 0;
  double seconds = 0;
  SkipStats skipped;
  std::string color_space;         ///< of the input's RGB
  std::vector<std::string> notes;  ///< parts of the input that were left out, and the like
  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  }
};

/// Turns an RGB image into a spectral one. R, G, B stay as preview, black where masked; alpha, other channels
/// and attributes pass through.
///
/// Input: half, float or uint; scanline or tiled, any part, any data window, layers, luminance with or
/// without chroma. RGB is linear, of the space that the options or the attributes colorInteropID or
/// chromaticities name, else sRGB's. Whites: a reflectance's white is adapted (Bradford) from the space's
/// white to D65, so that RGB 1, 1, 1 stays the perfect diffuser; light is not adapted, its XYZ stays what it
/// was. Output: the layout of Fichet, Pacanowski, Wilkie, JCGT 10(3), 2021; or, as coefficients, the float
/// channels spectile.c0, c1, c2 (and spectile.scale) with attributes that say how to expand them.
Result<ImageReport> upsample_image(const std::string& input, const std::string& output,
                                   const UpsampleImageOptions& options = {});

/// Turns a spectral image into linear sRGB (white D65, no adaptation; see Projector::xyz_to_srgb), XYZ or
/// luminance; alpha and other channels pass through.
Result<ImageReport> project_image(const std::string& input, const std::string& output,
                                  const ProjectImageOptions& options = {});

/// Turns a texture into its colour under another light, as if it were upsampled and projected under that; its
/// alpha and other channels pass through. Direct ways give the bits of the long one for the sigmoids, and
/// come within Relighter::bound() of it for mixtures of bases. Colours of alpha 0 are kept (Masking::kNone).
/// Errors: kBadArgument too, for light as quantity.
Result<ImageReport> relight_image(const std::string& input, const std::string& output,
                                  const RelightImageOptions& options);

/// Turns an image of coefficients, written by upsample_image(), into spectra: the bits that upsample_image()
/// would have written. For other bands than those it was made for, the spectra are evaluated there. The
/// image's attributes say method, quantity, light and observer.
struct ExpandImageOptions : ImageOptions {
  std::optional<Bands> bands;  ///< those it was made for where none
};
Result<ImageReport> expand_image(const std::string& input, const std::string& output,
                                 const ExpandImageOptions& options = {});

/// An RGB image in memory, pixel x, y in lane y * width + x.
struct RgbImage {
  int width = 0;
  int height = 0;
  ColorLanes rgb;
};

/// Reads the R, G, B of an image (see upsample_image for what can be read), as they are in the file: not
/// converted to sRGB. Needs memory for the whole image.
Result<RgbImage> read_rgb_image(const std::string& path, const std::string& layer = {}, int threads = 0);

/// Writes an RGB image as linear sRGB. Shapes: rgb holds width * height lanes. Errors: kSizeMismatch too.
Result<void> write_rgb_image(const std::string& path, ColorView rgb, int width, int height,
                             const ImageOptions& options = {});

/// Statistics of one channel of an image.
struct ChannelInfo {
  std::string name;
  std::string type;
  float minimum = 0;  ///< of the finite samples
  float maximum = 0;
  std::uint64_t nonfinite = 0;
  std::uint64_t negative = 0;
};

/// One part of a file.
struct PartInfo {
  std::string name;  ///< empty: none
  std::string view;  ///< empty: none
  bool deep = false;
  PixelWindow data_window;
  PixelWindow display_window;
  bool tiled = false;
  int levels = 1;  ///< mip levels, the image among them
  std::string compression;
  std::size_t channels = 0;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< of every type, as text
};

/// Metadata and statistics of a file.
struct ImageInfo {
  int width = 0;
  int height = 0;
  PixelWindow data_window;
  PixelWindow display_window;
  int parts = 1;
  std::vector<PartInfo> part_list;
  std::vector<std::string>
      contents;  ///< "31 bands of emission, layer \"diffuse\"", "colour R, G, B": all there is
  std::vector<std::string> notes;  ///< guesses, and what is unusual
  std::string dialect;             ///< of the spectral channels' names
  std::string color_space;         ///< of the colour channels; empty: none
  std::string alpha;               ///< channel; empty: none
  bool tiled = false;
  std::string compression;
  std::vector<ChannelInfo> channels;  ///< of the part that was chosen; spectral ones last, by wavelength
  std::optional<Quantity> quantity;   ///< set for a spectral image
  std::optional<Bands> bands;         ///< set for a spectral image
  std::vector<std::pair<std::string, std::string>> attributes;  ///< of that part, of every type, as text
  std::uint64_t nonfinite = 0;                                  ///< samples, over all channels
  std::uint64_t negative = 0;
  std::vector<float> pixel;  ///< the pixel asked for: a spectrum, or one value a channel
};

/// Says what a file holds, and reads the part that the choice asks for, the first flat one without. `pixel`
/// counts from the data window's upper left corner.
Result<ImageInfo> inspect_image(const std::string& path,
                                std::optional<std::array<int, 2>> pixel = std::nullopt, int threads = 0,
                                const ChannelChoice& choice = {});

/// How kernels, reference and oracle compare on a file.
struct VerifyReport {
  std::string isa;
  std::string what;  ///< "smits reflectance, 60 bands" or "projection, 60 bands"
  std::uint64_t pixels = 0;
  std::uint64_t samples = 0;
  std::uint64_t different_samples = 0;  ///< kernel's bits against the reference's
  double max_kernel_difference = 0;     ///< absolute
  double max_oracle_difference = 0;  ///< reference against double, over the pixel's largest possible sample
  double oracle_bound = 0;           ///< maximum of that
  std::vector<std::string> notes;    ///< as in ImageReport
  bool ok() const { return different_samples == 0 && max_oracle_difference <= oracle_bound; }
};

/// Runs the kernels in force, the scalar reference and the double oracle on every pixel of an RGB or spectral
/// file.
Result<VerifyReport> verify_image(const std::string& path, const MethodOptions& options = {});

}  // namespace spectile
