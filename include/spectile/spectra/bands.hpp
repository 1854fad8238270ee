// Bands: the wavelength intervals over which a sampled spectrum holds averages.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <spectile/result.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spectile {

struct BandWeights;
struct PlanReport;

/// Meaning of a sample in a band.
enum class BandSampling {
  kPoints,    ///< the value at the centre, as renderers that trace wavelengths take it
  kAverages,  ///< the average over the band, as sampled spectra hold it
};

/// One wavelength interval. Units: nm; lower < centre < upper.
struct Band {
  double lower_nm = 0;
  double centre_nm = 0;
  double upper_nm = 0;
  double width_nm() const noexcept { return upper_nm - lower_nm; }
  friend bool operator==(const Band&, const Band&) = default;
};

/// An immutable list of bands in ascending order; cheap to copy. Those of plans may overlap, no others do.
/// A sampled spectrum's value in a band is the average of the spectrum over the band.
class Bands {
 public:
  /// 400 to 700 nm in 60 bands of 5 nm, the field's usual choice.
  Bands();

  /// Uniform bands of `step_nm` from `first_nm` to `last_nm`.
  /// Units: nm. The range must hold an integer number of steps (to 1e-6 of a step).
  /// Errors: kBadArgument for edges not finite or not positive, an empty range, a step that does not divide
  /// it, or more than kMaxBands bands.
  static Result<Bands> uniform(double first_nm, double last_nm, double step_nm);

  /// Any list of bands, in ascending order, gaps allowed.
  /// Errors: kBadArgument for an empty list, more than kMaxBands, unordered or overlapping bands.
  static Result<Bands> from_list(std::vector<Band> bands);

  /// The same, but bands may overlap: only their centres ascend. For averages with weights of their own,
  /// those of a plan; projections without such weights, averages over wavelength, and films fed with
  /// wavelengths, which count each wavelength once, refuse them. Errors: kBadArgument for an empty list, more
  /// than kMaxBands, or unordered bands.
  static Result<Bands> from_overlapping(std::vector<Band> bands);

  /// Bands around given centres: edges halfway between neighbours, the outer ones symmetric.
  /// A single centre gets a band of 1 nm.
  /// Errors: kBadArgument as for from_list.
  static Result<Bands> from_centres(std::span<const double> centres_nm);

  /// Reads "FIRST:LAST:STEP" (nm), or a comma-separated list of centres.
  /// Errors: kBadArgument with the text quoted.
  static Result<Bands> parse(std::string_view text);

  /// These bands with weights of their own, by which projections weigh them, and the report of the plan that
  /// the weights are of, which files carry along and no operation reads. The edges of points, halfway between
  /// neighbours, only say which part of the spectrum each stands for.
  /// Errors: kBadArgument for no lights, and for lists of other lengths than the bands.
  Result<Bands> with_weights(BandWeights weights, BandSampling sampling,
                             std::shared_ptr<const PlanReport> report = nullptr) const;

  static constexpr std::size_t kMaxBands = 4096;

  std::size_t count() const noexcept { return bands_->size(); }
  const Band& operator[](std::size_t i) const noexcept { return (*bands_)[i]; }
  std::span<const Band> list() const noexcept { return *bands_; }

  /// Weights of planned bands; null for others.
  const BandWeights* weights() const noexcept;
  /// Report of the plan that the weights are of; null where there is none.
  const PlanReport* report() const noexcept;
  /// True if samples are values at the centres, as some plans' are, and not averages.
  bool are_points() const noexcept;
  /// The lowest edge and the highest.
  std::pair<double, double> range_nm() const noexcept;
  /// True if a wavelength is in two of them.
  bool overlap() const noexcept;

  /// "400:700:5", or for other lists the count and the range: "36 bands from 375 to 735 nm".
  std::string description() const;

  /// Equal when every edge and centre is, and so are the weights where there are any. Lights are equal when
  /// their names and spectra are, on any scale.
  friend bool operator==(const Bands& a, const Bands& b) noexcept {
    return (a.bands_ == b.bands_ || *a.bands_ == *b.bands_) &&
           (a.weighting_ == b.weighting_ || same_weighting(a, b));
  }

 private:
  struct Weighting;
  explicit Bands(std::vector<Band> bands);
  static bool same_weighting(const Bands& a, const Bands& b) noexcept;
  std::shared_ptr<const std::vector<Band>> bands_;
  std::shared_ptr<const Weighting> weighting_;
};

}  // namespace spectile
