// The header of a converted spectral image: which attributes still hold, and what is said about the others.
#include "src/io/convert/jobs/convert_header.hpp"

#include <algorithm>
#include <spectile/image/settings.hpp>

#include "src/base/errors.hpp"
#include "src/io/channels/plan_attribute.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/sources/method_attributes.hpp"
#include "src/io/convert/stages/band_channels.hpp"

namespace spectile::io {
namespace {

constexpr const char* kUnits = "emissiveUnits";
constexpr const char* kHandedness = "polarisationHandedness";
constexpr const char* kDefaultUnits = "W.m^-2.sr^-1";

/// Collects the attributes and notes of an output.
class HeaderMaker {
 public:
  HeaderMaker(const SetsSource& source, const Dialect& dialect, const std::vector<ConvertedSpectra>& spectra,
              const ConvertImageOptions& options, std::vector<std::string>& notes)
      : source_(source.header()), dialect_(dialect), spectra_(spectra), options_(options), notes_(notes) {}

  ImageSpec make(std::vector<ChannelSpec> channels) {
    add_version();
    add_units();
    check_handedness();
    for (const ConvertedSpectra& spectra : spectra_) add_channels(spectra);
    if (options_.bands || options_.scale != 1) {
      for (const std::string& name : method_attribute_names()) leave_out(name);
    }
    note_lost();
    note_preview();
    ImageSpec spec =
        conversion_spec(source_, std::move(channels), std::move(texts_), options_, settings_text(options_));
    spec.number_attributes = std::move(numbers_);
    spec.replaced = std::move(replaced_);
    spec.change = PixelChange::kRenamed;
    if (!source_.views().empty()) spec.view = spectra_.front().from->set.view;
    return spec;
  }

 private:
  bool is_layout() const { return dialect_.says_quantity; }

  const ConvertedSpectra* light() const {
    const auto at = std::ranges::find_if(
        spectra_, [](const auto& s) { return s.from->set.quantity == Quantity::kIlluminant; });
    return at == spectra_.end() ? nullptr : &*at;
  }

  /// The attribute describes what the output does not hold.
  void leave_out(const std::string& name) {
    replaced_.push_back(name);
    if (source_.has_attribute(name)) lost_.push_back(name);
  }

  void add_version() {
    replaced_.emplace_back(kPlanAttribute);
    replaced_.emplace_back("spectralLayoutVersion");
    const Bands& bands = spectra_.front().bands;
    if (is_layout()) {
      add_layout_attributes(texts_, Quantity::kReflectance, bands);
    } else {
      add_plan_attribute(texts_, bands);
    }
  }

  void add_units() {
    if (light() == nullptr) return leave_out(kUnits);
    const auto stated = source_.text(kUnits);
    std::string units = options_.units.empty() ? stated.value_or("") : options_.units;
    if (units.empty() && is_layout()) {
      units = kDefaultUnits;
      notes_.push_back(fmt::format(
          "the units of emission, which the file does not state, are taken for {}; --units states "
          "others",
          units));
    }
    if (units.empty()) return;
    if (options_.scale != 1 && options_.units.empty()) {
      notes_.push_back(
          fmt::format("emission is multiplied by {}, and emissiveUnits still says {}; --units states others",
                      options_.scale, units));
    }
    texts_.emplace_back(kUnits, units);
  }

  void check_handedness() {
    if (light() == nullptr || light()->from->stokes.empty()) return leave_out(kHandedness);
    const auto stated = source_.text(kHandedness);
    if (stated == "left" || stated == "right") return;
    notes_.push_back(
        fmt::format("the handedness of polarised light is {}, where the layout asks for "
                    "polarisationHandedness \"left\" or "
                    "\"right\"",
                    stated ? "\"" + *stated + "\"" : "not stated"));
  }

  /// Attributes of channels, which have other names now: filter curves, and Ocean's wavelengths.
  void add_channels(const ConvertedSpectra& spectra) {
    const SpectralSet& set = spectra.from->set;
    std::size_t curves = 0;
    for (std::size_t i = 0; i < set.names.size(); ++i) {
      replaced_.push_back(set.names[i] + ".wavelength");
      if (!source_.has_attribute(set.names[i])) continue;
      replaced_.push_back(set.names[i]);
      const auto curve = source_.text(set.names[i]);
      if (curve && is_layout() && !options_.bands) {
        texts_.emplace_back(spectra.names[i].name, *curve);
      } else {
        ++curves;
      }
    }
    for (const WrittenChannel& channel : spectra.names) {
      if (channel.metres) numbers_.emplace_back(channel.name + ".wavelength", *channel.metres);
    }
    if (curves > 0) {
      notes_.push_back(fmt::format("left out: the filter curve{} of {} channel{}", curves == 1 ? "" : "s",
                                   curves, curves == 1 ? "" : "s"));
    }
    note_place(set);
  }

  /// A layer, or a view that is not the default one, whose spectra become plain beside a plain preview.
  void note_place(const SpectralSet& set) {
    const bool of_view = !source_.views().empty() && !set.default_view;
    if (&set != &spectra_.front().from->set || (set.layer.empty() && !of_view)) return;
    const std::string place =
        set.layer.empty() ? fmt::format("view \"{}\"", set.view) : fmt::format("layer \"{}\"", set.layer);
    notes_.push_back(fmt::format("the channels of {} become plain ones{}", place,
                                 source_.find("R") == nullptr ? "" : "; R, G, B stay what they are"));
  }

  void note_lost() {
    if (lost_.empty()) return;
    notes_.push_back(fmt::format("attributes left out, since they describe what the output does not hold: {}",
                                 fmt::join(lost_, ", ")));
  }

  void note_preview() {
    if (options_.scale == 1 || source_.find("R") == nullptr) return;
    notes_.emplace_back("R, G, B stay as they are: spectral samples alone are multiplied");
  }

  const PartHeader& source_;
  const Dialect& dialect_;
  const std::vector<ConvertedSpectra>& spectra_;
  const ConvertImageOptions& options_;
  std::vector<std::string>& notes_;
  TextAttributes texts_;
  std::vector<std::pair<std::string, double>> numbers_;
  std::vector<std::string> replaced_;
  std::vector<std::string> lost_;
};

}  // namespace

ImageSpec converted_spec(const SetsSource& source, const Dialect& dialect,
                         const std::vector<ConvertedSpectra>& spectra, std::vector<ChannelSpec> channels,
                         const ConvertImageOptions& options, std::vector<std::string>& notes) {
  return HeaderMaker(source, dialect, spectra, options, notes).make(std::move(channels));
}

}  // namespace spectile::io
