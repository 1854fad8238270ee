// The name that a misspelt one was meant for.
#include "src/cli/options/nearest.hpp"

#include <algorithm>
#include <cstddef>

#include "src/cli/options/parse.hpp"

namespace spectile::cli {
namespace {

/// Insertions, deletions, replacements and exchanges of neighbours that turn one text into the other (optimal
/// string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

std::string without_dashes(const std::string& text) {
  return lower_case(text.substr(std::min(text.find_first_not_of('-'), text.size())));
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& names) {
  // Longer than any name; the distance takes the product of both lengths.
  constexpr std::size_t kMaxLength = 64;
  const std::string plain = without_dashes(word);
  if (plain.empty() || plain.size() > kMaxLength) return {};
  std::size_t least = std::max<std::size_t>(1, plain.size() / 3) + 1;
  std::string out;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(plain, without_dashes(name));
    if (distance >= least) continue;
    least = distance;
    out = name;
  }
  constexpr std::size_t kMinPrefix = 3;
  if (!out.empty() || plain.size() < kMinPrefix) return out;
  for (const std::string& name : names) {
    if (without_dashes(name).starts_with(plain)) return name;
  }
  return {};
}

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  const std::string name = nearest(word, names);
  return name.empty() ? name : "; did you mean " + name + "?";
}

}  // namespace spectile::cli
