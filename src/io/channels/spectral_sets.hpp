// SpectralSet: spectral channels that belong together, and the choice among those that a file holds.
#pragma once

#include <optional>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

#include "src/io/channels/spectral_layout.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// Light that is absorbed in one band and emitted in another, and the channel that holds how much.
struct ReradiationChannel {
  std::string name;
  std::size_t from_band = 0;
  std::size_t to_band = 0;
};

/// The spectrum of one part, layer, view and quantity.
struct SpectralSet {
  int part = 0;
  std::string part_name;  ///< empty in files of one part
  std::string layer;      ///< empty for plain channels
  std::string view;       ///< empty where the file is not stereo
  bool default_view = true;
  Quantity quantity = Quantity::kReflectance;
  bool quantity_assumed = false;      ///< the names do not say it
  const Dialect* dialect = nullptr;   ///< null for a channel map
  std::vector<std::string> names;     ///< channels, in ascending order of wavelength
  std::vector<SpectralChannel> read;  ///< of the names
  std::vector<MappedChannel> mapped;  ///< instead, for a channel map
  std::vector<std::pair<std::string, SpectralChannel>> reradiating;
  std::vector<std::pair<std::string, SpectralChannel>> polarised;  ///< of emission; ascending likewise

  /// Centres, or edges where the names have them. Errors: kBadFile.
  Result<Bands> bands(const PartHeader& header, const std::string& path) const;
  /// Errors: kBadFile for wavelengths that no band has.
  Result<std::vector<ReradiationChannel>> reradiation(const Bands& bands, const std::string& path) const;
  /// The channels of a Stokes component, 1 to 3, in the order of `names`. Errors: kBadFile where there are
  /// none, or of other wavelengths than S0.
  Result<std::vector<std::string>> stokes(int component, const std::string& path) const;
  /// "31 bands of emission, layer \"diffuse\", view \"right\"".
  std::string description() const;
};

/// "reflectance" or "emission".
const char* quantity_noun(Quantity quantity);

/// All sets of a file's flat parts, in the order of parts, layers and views.
std::vector<SpectralSet> spectral_sets(const ExrInput& input);

/// The set that the choice and the quantity ask for. What was assumed and what is left out is added to
/// `notes`. Nothing where the file holds no spectra. Errors: kBadFile for a choice that fits none, and where
/// several layers fit, with what there is.
Result<std::optional<SpectralSet>> choose_spectra(const ExrInput& input, const ChannelChoice& choice,
                                                  std::optional<Quantity> quantity,
                                                  std::vector<std::string>& notes);

/// The same, with the set of the other quantity that the chosen one's part, layer and view hold too, where no
/// quantity was asked for. Reflectance comes first. Empty where the file holds no spectra.
Result<std::vector<SpectralSet>> choose_all_spectra(const ExrInput& input, const ChannelChoice& choice,
                                                    std::optional<Quantity> quantity,
                                                    std::vector<std::string>& notes);

/// The bands that names are read as, without a plan. Errors: kBadArgument for those that no bands have.
Result<Bands> bands_read(const std::vector<SpectralChannel>& read);

/// The planes of a set's channels, in their order, those of re-radiation after the others.
/// Errors: kBadFile for one that is subsampled.
Result<std::vector<PlaneSpec>> band_planes(const PartHeader& header, const SpectralSet& set,
                                           const std::string& path);

/// The flat part that a choice names, by its name or its number. Nothing for no choice. Errors: kBadFile,
/// with the parts that there are.
Result<std::optional<int>> chosen_part(const ExrInput& input, const std::string& part);

/// "layer \"diffuse\", view \"right\"", for messages.
std::string asked_for(const ChannelChoice& choice);

/// "beauty", or the number of a part without a name.
std::string part_label(const ExrInput& input, int part);

/// Appends a note that names the parts of which nothing is read, where there are some.
void note_other_parts(const ExrInput& input, const std::vector<int>& read, std::vector<std::string>& notes);

}  // namespace spectile::io
