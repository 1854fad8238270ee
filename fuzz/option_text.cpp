// Fuzzes texts of options: what can be read is written as a text that means the same.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <spectile/color/sensor.hpp>
#include <spectile/film/pixel_filter.hpp>
#include <spectile/image/image.hpp>
#include <spectile/scene/procedural_scene.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "fuzz/support.hpp"
#include "src/cli/options/parse.hpp"

namespace {

using namespace spectile;

void bands(std::string_view text) {
  const auto read = Bands::parse(text);
  if (!fuzz::is_value(read)) return;
  const auto list = read->list();
  fuzz::require(read->count() >= 1 && read->count() <= Bands::kMaxBands, "there are 1 to 4096 bands");
  const auto again = Bands::from_list({list.begin(), list.end()});
  fuzz::require(again && *again == *read, "a list of bands makes the same bands");
  fuzz::require(!read->description().empty(), "bands have a description");
}

void compression(std::string_view text) {
  const auto read = Compression::parse(text);
  if (!fuzz::is_value(read)) return;
  const auto again = Compression::parse(read->description());
  fuzz::require(again && again->kind == read->kind && again->level == read->level,
                "a compression's text means the same", read->description());
}

void filter(std::string_view text) {
  const auto read = PixelFilter::parse(text);
  if (!fuzz::is_value(read)) return;
  const auto again = PixelFilter::parse(read->to_text());
  fuzz::require(again && *again == *read, "a filter's text means the same", read->to_text());
  fuzz::require(std::isfinite(read->integral()) && read->integral() > 0, "a filter's integral is above 0",
                read->to_text());
  for (const double u : {0.0, 0.3, 0.999}) {
    const FilterSample sample = read->sample(u, 1 - u);
    fuzz::require(std::abs(sample.dx) <= read->radius_x() && std::abs(sample.dy) <= read->radius_y(),
                  "samples are within the radius", read->to_text());
    fuzz::require(std::isfinite(sample.weight), "weights are finite", read->to_text());
  }
}

void spectrum(std::string_view text) {
  const auto read = named_spectrum(text);
  if (!fuzz::is_value(read)) return;
  for (const double nm : {1.0, 360.0, 555.5, 830.0, 1e5}) {
    fuzz::require(std::isfinite((*read)(nm)), "a named spectrum is finite everywhere",
                  fmt::format("{} at {} nm: {}", text, nm, (*read)(nm)));
  }
  const auto found = find_spectrum(std::string(text));
  fuzz::require(found && (*found)(555.5) == (*read)(555.5), "a name is found before a file",
                std::string(text));
}

void names(std::string_view text) {
  if (const auto method = parse_method(text); fuzz::is_value(method)) {
    fuzz::require(to_string(*method) == text, "a method's name means the same", std::string(text));
  }
  if (const auto quantity = parse_quantity(text); fuzz::is_value(quantity)) {
    fuzz::require(to_string(*quantity) == text, "a quantity's name means the same", std::string(text));
  }
  if (fuzz::is_value(ProceduralScene::named(text))) {
    fuzz::require(std::ranges::count(ProceduralScene::names(), text) == 1, "a scene is one of the list",
                  std::string(text));
  }
  fuzz::is_value(Sensor::named(text));
  if (fuzz::is_value(illuminant(text))) {
    fuzz::require(static_cast<bool>(named_spectrum(text)), "an illuminant is a named spectrum",
                  std::string(text));
  }
  if (const auto space = rgb_space(text); fuzz::is_value(space)) {
    fuzz::require(!space->name.empty(), "a space has a name", std::string(text));
  }
}

void places(std::string_view text) {
  if (const auto shard = cli::parse_shard(text)) {
    fuzz::require(shard->index < shard->count, "a share is one of them", shard->text());
    const auto again = cli::parse_shard(shard->text());
    fuzz::require(again && again->index == shard->index && again->count == shard->count,
                  "a share's text means the same", shard->text());
  }
  if (const auto r = cli::parse_region(text)) {
    fuzz::require(!r->empty(), "a region is not empty");
    fuzz::require(cli::parse_region(fmt::format("{},{},{},{}", r->x0, r->y0, r->x1 - 1, r->y1 - 1)) == r,
                  "a region's text means the same");
  }
  if (const auto pixel = cli::parse_pixel(text)) {
    fuzz::require(cli::parse_pixel(fmt::format("{}", fmt::join(*pixel, ","))) == pixel,
                  "a pixel's text means the same");
  }
  if (const auto weights = cli::parse_weights(text); fuzz::is_value(weights)) {
    const auto again = cli::parse_weights(fmt::format("{}", fmt::join(*weights, ",")));
    fuzz::require(again && again->size() == weights->size() && !weights->empty(),
                  "weights' text means the same");
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of({data, size});
  bands(text);
  compression(text);
  filter(text);
  spectrum(text);
  names(text);
  places(text);
  return 0;
}
