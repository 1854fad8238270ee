// The report of one conversion, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <spectile/image/image.hpp>
#include <string>

namespace spectile::cli {

nlohmann::json report_json(const std::string& input, const std::string& output, const ImageReport& report);

/// Prints the report. `stats`: what was skipped too.
void print_report(const std::string& input, const std::string& output, const ImageReport& report, bool stats);

}  // namespace spectile::cli
