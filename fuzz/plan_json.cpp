// Fuzzes plans and learned nodes as JSON: what can be read is written as text that means the very same.
#include <algorithm>
#include <bit>
#include <cmath>
#include <spectile/image/nodes_file.hpp>
#include <spectile/image/plan_file.hpp>

#include "fuzz/support.hpp"

namespace {

using namespace spectile;

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same(std::span<const double> a, std::span<const double> b) {
  return std::ranges::equal(a, b, [](double x, double y) { return same(x, y); });
}

template <class Error>
bool same_error(const Error& a, const Error& b) {
  return a.light == b.light && a.bounces == b.bounces && same(a.error.mean, b.error.mean) &&
         same(a.error.percentile95, b.error.percentile95) && same(a.error.maximum, b.error.maximum);
}

bool same(const BandLight& a, const BandLight& b) {
  return a.name == b.name && same(a.emission, b.emission) &&
         same(a.spectrum.wavelengths_nm(), b.spectrum.wavelengths_nm()) &&
         same(a.spectrum.values(), b.spectrum.values());
}

void require_same(const Plan& a, const Plan& b, const std::string& text) {
  fuzz::require(a.weights.observer == b.weights.observer, "the observer comes back", text);
  fuzz::require(same(a.wavelengths_nm, b.wavelengths_nm), "wavelengths come back to the bit", text);
  fuzz::require(a.bands == b.bands, "bands come back to the bit", text);
  fuzz::require(std::ranges::equal(a.weights.sensor, b.weights.sensor,
                                   [](const auto& x, const auto& y) { return same(x, y); }),
                "sensor weights come back to the bit", text);
  fuzz::require(std::ranges::equal(a.weights.lights, b.weights.lights,
                                   [](const auto& x, const auto& y) { return same(x, y); }),
                "lights come back to the bit", text);
  fuzz::require(std::ranges::equal(a.report.errors, b.report.errors,
                                   [](const auto& x, const auto& y) { return same_error(x, y); }),
                "errors come back to the bit", text);
  fuzz::require(std::ranges::equal(a.report.even_bands, b.report.even_bands,
                                   [](const auto& x, const auto& y) {
                                     return x.sums == y.sums && x.bands == y.bands && same_error(x, y);
                                   }),
                "errors of even bands come back to the bit", text);
}

/// Learned nodes are read by the same rules.
void try_nodes(std::string_view text) {
  const auto nodes = parse_nodes(text, "case");
  if (!fuzz::is_value(nodes)) {
    fuzz::require(nodes.error().message.starts_with("case: "), "an error names its source",
                  nodes.error().message);
    return;
  }
  const std::string written = nodes_to_json(*nodes);
  const auto again = parse_nodes(written, "case");
  fuzz::require(static_cast<bool>(again), "written nodes can be read",
                again ? written : again.error().message);
  fuzz::require(nodes->offsets == again->offsets && nodes->wavelengths_nm == again->wavelengths_nm,
                "nodes come back to the bit", written);
  fuzz::require(nodes_to_json(*again) == written, "nodes written twice are the same text", written);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try_nodes(fuzz::text_of({data, size}));
  const auto plan = parse_plan(fuzz::text_of({data, size}), "case");
  if (!fuzz::is_value(plan)) {
    fuzz::require(plan.error().message.starts_with("case: "), "an error names its source",
                  plan.error().message);
    return 0;
  }
  fuzz::require(
      plan->count() > 0 && !plan->weights.lights.empty() && plan->weights.sensor.size() == plan->count(),
      "a plan has wavelengths, lights, and a weight for each");
  const std::string text = plan_to_json(*plan);
  const auto again = parse_plan(text, "case");
  fuzz::require(static_cast<bool>(again), "a written plan can be read",
                again ? text : again.error().message + "\n" + text);
  require_same(*plan, *again, text);
  fuzz::require(plan_to_json(*again) == text, "a plan written twice is the same text", text);
  return 0;
}
