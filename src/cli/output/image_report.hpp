// The report of one conversion, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <spectile/image/image.hpp>
#include <string>

#include "src/cli/output/messages.hpp"

namespace spectile::cli {

nlohmann::json report_json(const std::string& input, const std::string& output, const ImageReport& report);

/// The handling of an RGB image's unusual colours, which the report explains.
struct ColorHandling {
  NegativeInput negative = NegativeInput::kGamut;
  GamutPolicy out_of_gamut = GamutPolicy::kClip;
  bool clips_above_one = false;  ///< colours above 1 are out of the method's gamut, and clipped
};

/// Prints the report. `colors`: of an RGB image. `notes`: of the run. `stats`: what was skipped too.
void print_report(const std::string& input, const std::string& output, const ImageReport& report,
                  const std::optional<ColorHandling>& colors, Notes& notes, bool stats);

}  // namespace spectile::cli
