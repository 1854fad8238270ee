// Closed forms of procedural scenes: the weight of each spectrum in a pixel, and the integrals of the
// spectra.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <spectile/color/sensor.hpp>
#include <spectile/film/film.hpp>
#include <spectile/scene/procedural_scene.hpp>
#include <utility>
#include <vector>

#include "src/scene/layout.hpp"

namespace spectile::scene {

/// The pixels that a film keeps.
PixelWindow filter_window(const FilmOptions& film);

/// The mean factor of each spectrum in a pixel under the film's filter. Where samples are splatted they exist
/// in the window only, and the filter is cut off there.
std::vector<double> amounts(const Layout& layout, const FilmOptions& film, int x, int y);

/// The last few results, each for a key that is expensive to compute from.
template <class Key, class Value>
class Recent {
 public:
  template <class Make>
  std::shared_ptr<const Value> get(const Key& key, const Make& make) {
    const std::scoped_lock lock(mutex_);
    for (const auto& [known, value] : kept_) {
      if (known == key) return value;
    }
    if (kept_.size() == kMost) kept_.erase(kept_.begin());
    kept_.emplace_back(key, std::make_shared<const Value>(make()));
    return kept_.back().second;
  }

 private:
  static constexpr std::size_t kMost = 8;
  std::mutex mutex_;
  std::vector<std::pair<Key, std::shared_ptr<const Value>>> kept_;
};

/// Averages of each spectrum over bands. Shapes: [spectrum][band].
struct Averages {
  std::vector<double> exact;
  std::vector<float> rounded;
};

/// Integrals of the spectra of a scene, computed on first use.
class Responses {
 public:
  using Triple = std::array<double, 3>;
  /// `layout` must outlive it.
  explicit Responses(const Layout& layout) : layout_(layout) {}

  /// Of films fed with bands: the projection of the bands' averages, as those films do it; else integrals.
  /// Shapes: [spectrum].
  std::shared_ptr<const std::vector<Triple>> xyz(const FilmOptions& film);
  std::shared_ptr<const std::vector<Triple>> sensor(const FilmOptions& film, std::size_t which);

  /// `drawn`: over that part of a band that wavelengths are drawn from, 0 where there is none.
  std::shared_ptr<const Averages> averages(const Bands& bands, bool drawn);

 private:
  struct ColorKey {
    Sensor sensor;
    std::optional<Observer> observer;
    std::optional<Bands> bands;
    bool operator==(const ColorKey& other) const;
  };
  struct BandKey {
    Bands bands;
    bool drawn;
    bool operator==(const BandKey&) const = default;
  };
  std::shared_ptr<const std::vector<Triple>> colors(const ColorKey& key);
  std::vector<Triple> computed(const ColorKey& key);
  const Layout& layout_;
  Recent<ColorKey, std::vector<Triple>> colors_;
  Recent<BandKey, Averages> averages_;
};

}  // namespace spectile::scene
