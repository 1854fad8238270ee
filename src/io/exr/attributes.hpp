// Attributes of an image: what each describes, and what becomes of it in an image made of that one.
#pragma once

#include <OpenEXR/ImfForward.h>
#include <OpenEXR/openexr.h>

#include <set>
#include <string>
#include <vector>

namespace spectile::io {

/// Name of the attribute in which an image says how it was made; it never passes from an input to an output.
inline constexpr const char* kSettingsAttribute = "spectileSettings";
/// Name of the attribute that holds the plan of a file's bands.
inline constexpr const char* kPlanAttribute = "spectilePlan";

/// How an output's pixels differ from its source's.
enum class PixelChange {
  kSpectra,  ///< R, G, B are the source's, spectra beside them are new
  kColor,    ///< the colours are new, spectra are gone
  kAverage,  ///< all samples are averages, of the kind that they were
  kRenamed,  ///< spectra mean what they did, under other names, in other bands or units; R, G, B are the
             ///< source's
};

/// All that decides which of a source's attributes an output takes over.
struct AttributeRules {
  PixelChange change = PixelChange::kSpectra;
  std::set<std::string> channels;     // of the output
  std::vector<std::string> replaced;  // names of attributes that are made anew, or not at all
  std::string view;                   // from which the output's plain R, G, B come; empty for the default one
};

/// Copies the attributes of `from` that still hold for a part being written. Types that this build does not
/// know travel as they are.
exr_result_t copy_attributes(const Imf::Header& from, exr_context_t to, int part,
                             const AttributeRules& rules);

/// Names of the attributes that do not hold any more and are not made anew, in their order.
std::vector<std::string> attributes_left_out(const Imf::Header& from, const AttributeRules& rules);

}  // namespace spectile::io
