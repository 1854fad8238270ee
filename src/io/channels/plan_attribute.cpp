// The plan of a file's bands, as an attribute.
#include "src/io/channels/plan_attribute.hpp"

#include <cmath>
#include <spectile/image/plan_file.hpp>
#include <spectile/plan/plan.hpp>

#include "src/base/errors.hpp"

namespace spectile::io {

void add_plan_attribute(TextAttributes& texts, const Bands& bands) {
  if (bands.weights() == nullptr) return;
  texts.emplace_back(kPlanAttribute, plan_to_json(plan_of_bands(bands), true));
}

Result<Bands> with_plan(const PartHeader& header, const Bands& bands, const std::string& path) {
  const auto text = header.text(kPlanAttribute);
  if (!text && bands.overlap()) {
    return make_error(ErrorCode::kBadFile, "{}: its bands overlap, without a plan that weighs them", path);
  }
  if (!text) return bands;
  SPECTILE_ASSIGN(const auto plan, parse_plan(*text, path + ": attribute " + kPlanAttribute));
  auto planned = planned_bands(plan);
  if (!planned) return make_error(ErrorCode::kBadFile, "{}: {}", path, planned.error().message);
  bool same = planned->count() == bands.count();
  // Names of channels have six decimals.
  constexpr double kRounded = 1e-6;
  for (std::size_t b = 0; same && b < bands.count(); ++b) {
    same = std::abs((*planned)[b].centre_nm - bands[b].centre_nm) <= kRounded;
  }
  if (same) return planned;
  return make_error(ErrorCode::kBadFile,
                    "{}: its {} bands are not the {} wavelengths of its attribute {}, which would weigh them "
                    "wrongly",
                    path, bands.count(), planned->count(), kPlanAttribute);
}

}  // namespace spectile::io
