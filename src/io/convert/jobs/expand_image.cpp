// expand_image: an image of a method's coefficients becomes a spectral one, line by line.
#include <cmath>
#include <cstring>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/conversion.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/coefficient_source.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/stages/band_channels.hpp"
#include "src/io/convert/stages/band_filter.hpp"
#include "src/io/convert/stages/color_rows.hpp"

namespace spectile {
namespace {

using io::LineStats;
using io::Strip;

/// ExpandWork space of one slot.
struct ExpandWork {
  FloatBuffer coefficients;  // four rows of whole blocks
  io::BandPacker::Work bands;
  io::BandFilter::Work filtered;
};

class ExpandJob : public io::FilteredJob {
 public:
  ExpandJob(io::CoefficientSource& source, const rows::SampledRows& rows, const ExpandImageOptions& options,
            const kernels::KernelTable& kernels)
      : source_(source),
        rows_(rows),
        options_(options),
        packer_(kernels, rows, options),
        filter_(kernels, source.upsampler(), rows, packer_, options, false) {}

  /// Output channels: what passes through, then the bands.
  std::vector<io::ChannelSpec> channels(const Bands& bands) const {
    std::vector<io::ChannelSpec> out;
    for (std::size_t i = source_.coefficients(); i < source_.planes().size(); ++i) {
      out.push_back({source_.planes()[i].name, source_.planes()[i].type});
    }
    io::add_band_channels(out, bands, source_.upsampler().quantity(), options_.pixel);
    return out;
  }

  Result<void> prepare(const io::ExrWriter& writer, std::size_t slots) override {
    writer_ = &writer;
    padded_ = blocks_for(static_cast<std::size_t>(writer.width())) * kLanesPerBlock;
    for (std::size_t i = 0; i < slots; ++i) {
      SPECTILE_ASSIGN(auto coefficients, FloatBuffer::create(4 * padded_));
      SPECTILE_ASSIGN(auto bands, packer_.work());
      SPECTILE_ASSIGN(auto filtered, filter_.work(writer.width()));
      works_.push_back({std::move(coefficients), std::move(bands), std::move(filtered)});
    }
    return {};
  }

  int strip_lines(int chunk_lines) const override { return source_.strip_lines(chunk_lines); }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    return source_.read(first_line, lines);
  }

  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override {
    ExpandWork& work = works_[slot];
    const auto width = static_cast<std::size_t>(strip.width);
    const io::LineCoefficients of = load(work, strip, line, stats);
    if (packed == nullptr) return;
    pass_through(strip, line, source_.coefficients(), packed);
    stats.clamped += packer_.line(work.bands, of, width, *writer_, passing_count(), packed);
    if (options_.mipmap) filter_.scan(of, width);
  }

  std::vector<io::PlaneSpec> strip_planes() const override { return source_.planes(); }
  float padding(std::size_t plane) const override {
    return plane < source_.coefficients() ? rows_.black()[plane] : 0;
  }

  std::vector<std::pair<std::size_t, io::PlaneSpec>> passing() const override {
    std::vector<std::pair<std::size_t, io::PlaneSpec>> out;
    for (std::size_t i = source_.coefficients(); i < source_.planes().size(); ++i) {
      out.emplace_back(i, source_.planes()[i]);
    }
    return out;
  }

  std::size_t filtered_rows() const override { return filter_.rows(); }

  void filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) override {
    LineStats counted_before;
    const io::LineCoefficients of = load(works_[slot], strip, line, counted_before);
    filter_.filter(of, static_cast<std::size_t>(strip.width), rows);
  }

  void level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) override {
    ExpandWork& work = works_[slot];
    pass_through(strip, line, 0, packed);
    filter_.pack(work.filtered, work.bands, {strip, line, passing_count()}, *writer_, passing_count(),
                 packed);
  }

 private:
  std::size_t passing_count() const { return source_.planes().size() - source_.coefficients(); }

  /// A line's coefficients, those that cannot be used black.
  io::LineCoefficients load(ExpandWork& work, const Strip& strip, int line, LineStats& stats) const {
    const auto width = static_cast<std::size_t>(strip.width);
    float* rows[4] = {};
    for (std::size_t k = 0; k < source_.coefficients(); ++k) {
      rows[k] = work.coefficients.data() + k * padded_;
      std::memcpy(rows[k], strip.row(k, line), width * sizeof(float));
      std::fill(rows[k] + width, rows[k] + blocks_for(width) * kLanesPerBlock, 0.0F);
    }
    sanitize(rows, width, line, stats);
    return {{rows[0], rows[1], rows[2]}, rows[3]};
  }

  void pass_through(const Strip& strip, int line, std::size_t first_plane, std::byte* packed) const {
    const auto width = static_cast<std::size_t>(strip.width);
    for (std::size_t i = 0; i < passing_count(); ++i) {
      const std::size_t plane = first_plane + i;
      std::memcpy(packed + writer_->channel_offset(i, width), strip.row(plane, line), strip.row_bytes[plane]);
    }
  }

  /// Counts pixels whose coefficients are not finite, or whose samples could overflow, and makes them black.
  void sanitize(float* const rows[4], std::size_t width, int line, LineStats& stats) const {
    const std::size_t count = source_.coefficients();
    bool all_good = true;
    for (std::size_t k = 0; k < count; ++k) {
      all_good = all_good && io::largest_magnitude(rows[k], width) <= rows_.limits()[k];
    }
    for (std::size_t x = 0; x < width && !all_good; ++x) {
      bool good = true;
      for (std::size_t k = 0; k < count; ++k) good = good && std::fabs(rows[k][x]) <= rows_.limits()[k];
      if (good) continue;
      stats.nonfinite.add(1, static_cast<int>(x), line);
      for (std::size_t k = 0; k < count; ++k) rows[k][x] = rows_.black()[k];
    }
  }

  io::CoefficientSource& source_;
  const rows::SampledRows& rows_;
  const ExpandImageOptions& options_;
  io::BandPacker packer_;
  io::BandFilter filter_;
  const io::ExrWriter* writer_ = nullptr;
  std::vector<ExpandWork> works_;
  std::size_t padded_ = 0;
};

/// Says where the sigmoid's spectra had to be continued beyond the bands that they were made for.
void note_continued(const Upsampler& upsampler, const Bands& bands, std::vector<std::string>& notes) {
  if (!is_sigmoid(upsampler.method())) return;
  const double first = upsampler.bands()[0].centre_nm;
  const double last = upsampler.bands()[upsampler.bands().count() - 1].centre_nm;
  if (bands[0].centre_nm >= first && bands[bands.count() - 1].centre_nm <= last) return;
  notes.push_back(fmt::format(
      "beyond {} to {} nm, for which the coefficients were made, spectra keep the value there", first, last));
}

Result<ImageReport> expand_file(const std::string& input, const std::string& output,
                                const ExpandImageOptions& options) {
  SPECTILE_ASSIGN(const auto setup, io::set_up_job(std::array{input}, output, options));
  SPECTILE_ASSIGN(auto file, io::ExrInput::open(input, setup.threads));
  SPECTILE_ASSIGN(auto source, io::CoefficientSource::open(std::move(file), options.region));
  const Upsampler& upsampler = source->upsampler();
  const Bands bands = options.bands.value_or(upsampler.bands());
  const auto over = rows::SampledRows::over(upsampler, bands);
  if (!over) return make_error(over.error().code, "{}: {}", input, over.error().message);
  const rows::SampledRows& rows = *over;

  ExpandJob job(*source, rows, options, setup.kernels);
  MethodOptions made;
  if (upsampler.options().light) {
    made.light = NamedLight{io::light_name_of(source->header()), *upsampler.options().light};
  }
  auto texts = io::method_attributes(upsampler, made, false);
  io::pass_alpha_attribute(texts, source->header());
  io::add_layout_attributes(texts, upsampler.quantity(), bands);
  io::ImageSpec spec = io::conversion_spec(source->header(), job.channels(bands), std::move(texts), options,
                                           settings_text(options));
  spec.replaced = io::spectral_attribute_names();
  ImageReport known;
  known.bands = bands.count();
  known.quantity = upsampler.quantity();
  known.notes = source->notes();
  note_continued(upsampler, bands, known.notes);
  return io::run_image_job({job, output, std::move(spec), options,
                            io::at_nonfinite(input, options, source->offset()), std::move(known)});
}

}  // namespace

Result<ImageReport> expand_image(const std::string& input, const std::string& output,
                                 const ExpandImageOptions& options) {
  return io::timed(input, [&] { return expand_file(input, output, options); });
}

}  // namespace spectile
