// validate_image: a file against the rules of the spectral layout.
#include <algorithm>
#include <cmath>
#include <map>
#include <spectile/image/convert.hpp>

#include "src/base/errors.hpp"
#include "src/io/channels/layout_rules.hpp"
#include "src/io/channels/spectral_layout.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/strips.hpp"
#include "src/lanes/tiles.hpp"
#include "src/reference/half.hpp"

namespace spectile {
namespace {

/// Unusual samples of the channels of one kind.
struct SampleCounts {
  std::uint64_t nonfinite = 0;
  std::uint64_t negative = 0;
  std::uint64_t over_one = 0;
};

/// The counts of reflectances, light, and Stokes components, which may be negative.
using CountsByKind = std::map<io::SpectralKind, SampleCounts>;

float sample(const io::Strip& strip, std::size_t plane, int line, std::size_t x) {
  const std::byte* const row = strip.row(plane, line);
  if (strip.sample_bytes(plane) == 2)
    return reference::float_from_half(reinterpret_cast<const std::uint16_t*>(row)[x]);
  return reinterpret_cast<const float*>(row)[x];
}

void count_plane(const io::Strip& strip, std::size_t plane, SampleCounts& counts) {
  for (int line = strip.first_line; line < strip.first_line + strip.lines; ++line) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(strip.width); ++x) {
      const float v = sample(strip, plane, line, x);
      counts.nonfinite += std::isfinite(v) ? 0 : 1;
      counts.negative += v < 0 ? 1 : 0;
      counts.over_one += v > 1 ? 1 : 0;
    }
  }
}

Result<CountsByKind> count_samples(io::ExrInput& input, int part) {
  const io::PartHeader& header = input.header(part);
  CountsByKind out;
  std::vector<io::PlaneSpec> planes;
  std::vector<io::SpectralKind> kinds;
  for (const io::StoredChannel& stored : header.channels()) {
    const auto channel = io::parse_spectral_channel(stored.name, header);
    if (!channel || stored.subsampled()) continue;
    planes.push_back({stored.name, io::readable_type(stored.type)});
    kinds.push_back(channel->kind);
  }
  if (planes.empty()) return out;
  const int step = io::strip_lines(header, planes, 1);
  for (int first = 0; first < header.height(); first += step) {
    const int lines = std::min(step, header.height() - first);
    SPECTILE_ASSIGN(auto strip, io::make_strip(planes, header.width(), first, lines));
    SPECTILE_TRY(io::fill_strip(input, part, planes, *strip));
    for (std::size_t i = 0; i < planes.size(); ++i) count_plane(*strip, i, out[kinds[i]]);
  }
  return out;
}

void remark_samples(const CountsByKind& counts, std::vector<LayoutFinding>& out) {
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0)
      out.push_back(
          {"samples", fmt::format("{} {}{}", count, count == 1 ? "sample " : "samples ", what), true});
  };
  std::uint64_t nonfinite = 0;
  for (const auto& [kind, c] : counts) nonfinite += c.nonfinite;
  add(nonfinite, "not finite");
  for (const auto& [kind, c] : counts) {
    const bool reflects = kind == io::SpectralKind::kReflective || kind == io::SpectralKind::kReradiating;
    if (reflects) {
      add(c.negative, "of reflectance below 0");
      add(c.over_one, "of reflectance above 1");
    } else if (kind == io::SpectralKind::kEmissive) {
      add(c.negative, "of light below 0");
    }
  }
}

Result<std::vector<LayoutFinding>> validate(const std::string& path, int threads) {
  SPECTILE_ASSIGN(auto input, io::ExrInput::open(path, tiles::thread_count(threads)));
  std::vector<LayoutFinding> out;
  bool spectral = false;
  for (int part = 0; part < input->parts(); ++part) {
    const io::PartHeader& header = input->header(part);
    if (!io::has_spectral_names(header)) continue;
    spectral = true;
    std::vector<LayoutFinding> found = io::layout_findings(header);
    if (!header.deep()) {
      SPECTILE_ASSIGN(const auto counts, count_samples(*input, part));
      remark_samples(counts, found);
    }
    for (LayoutFinding& finding : found) {
      if (input->parts() > 1) finding.detail = fmt::format("part {}: {}", part, finding.detail);
      out.push_back(std::move(finding));
    }
  }
  if (!spectral)
    out.push_back({"channels",
                   "no spectral channels, such as T.500,000000nm or S0.500,000000nm (of coefficients, "
                   "expanding makes spectra)"});
  return out;
}

}  // namespace

Result<std::vector<LayoutFinding>> validate_image(const std::string& path, int threads) {
  return io::contained<std::vector<LayoutFinding>>(path, [&] { return validate(path, threads); });
}

}  // namespace spectile
