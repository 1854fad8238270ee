// Texts that are built to take long: time grows with their length, not with its square.
#include <gtest/gtest.h>
#include <malloc.h>

#include <chrono>
#include <functional>
#include <spectile/image/channel_map.hpp>
#include <spectile/image/nodes_file.hpp>
#include <spectile/image/plan_file.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/support/exr_files.hpp"
#include "tests/support/sanitized.hpp"

namespace spectile {
namespace {

std::string repeated(std::string_view text, std::size_t times) {
  std::string out;
  out.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) out += text;
  return out;
}

/// Lines of numbers that count up, each made from its number.
std::string lines(std::size_t count, const std::function<std::string(std::size_t)>& line) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += line(i) + "\n";
  return out;
}

struct Case {
  const char* name;
  std::function<std::string(std::size_t n)> text;
  std::function<void(const std::string& path, const std::string& text)> parse;
  std::size_t n = 20000;
};

void parse_plan_text(const std::string& /*path*/, const std::string& text) {
  static_cast<void>(parse_plan(text, "plan"));
}
void parse_nodes_text(const std::string& /*path*/, const std::string& text) {
  static_cast<void>(parse_nodes(text, "nodes"));
}
void parse_table(const std::string& path, const std::string& text) {
  test::write_text(path, text);
  static_cast<void>(load_spectrum_table(path));
}
void parse_map(const std::string& path, const std::string& text) {
  test::write_text(path, text);
  static_cast<void>(load_channel_map(path));
}

const Case kCases[] = {
    {"levels of nodes",
     [](std::size_t n) { return "{\"method\":\"tetrahedral\",\"levels\":[" + repeated("0,", n) + "0]}"; },
     parse_nodes_text},
    {"objects in a list", [](std::size_t n) { return "{\"illuminants\":[" + repeated("{},", n) + "{}]}"; },
     parse_plan_text},
    {"objects of a key",
     [](std::size_t n) { return "{\"illuminants\":[" + repeated("{\"a\":1},", n) + "1]}"; }, parse_plan_text},
    {"lists in a list", [](std::size_t n) { return "{\"illuminants\":[" + repeated("[],", n) + "[]]}"; },
     parse_plan_text},
    {"keys",
     [](std::size_t n) {
       return "{" + lines(n, [](std::size_t i) { return "\"k" + std::to_string(i) + "\":1,"; }) + "\"z\":1}";
     },
     parse_plan_text},
    {"a long text", [](std::size_t n) { return "{\"observer\":\"" + repeated("\\u00e9", n) + "\"}"; },
     parse_plan_text},
    {"columns",
     [](std::size_t n) {
       return lines(
           n, [](std::size_t i) { return std::to_string(300 + 0.01 * static_cast<double>(i)) + ",0.5"; });
     },
     parse_table},
    {"columns, descending",
     [](std::size_t n) {
       return lines(n, [n](std::size_t i) {
         return std::to_string(300 + 0.01 * static_cast<double>(n - i)) + " 0.5";
       });
     },
     parse_table},
    {"pairs on a line",
     [](std::size_t n) {
       return lines(1, [n](std::size_t) {
         std::string out;
         for (std::size_t i = 0; i < n; ++i)
           out += std::to_string(300 + 0.01 * static_cast<double>(i)) + ":0.5, ";
         return out;
       });
     },
     parse_table},
    {"rows by name",
     [](std::size_t n) {
       return "name,wavelength,value\n" + lines(n, [](std::size_t i) {
                return "p" + std::to_string(i / 2) + "," + std::to_string(400 + 100 * (i % 2)) + ",0.5";
              });
     },
     parse_table},
    {"comments", [](std::size_t n) { return repeated("# comment\n", n) + "400 1\n500 1\n"; }, parse_table},
    {"words", [](std::size_t n) { return repeated("word ", n) + "\n400 1\n500 1\n"; }, parse_table},
    {"separators", [](std::size_t n) { return repeated(",", n) + "\n400,1\n500,1\n"; }, parse_table},
    {"quotes", [](std::size_t n) { return repeated("\"", n) + "\n400,1\n500,1\n"; }, parse_table},
    {"channels",
     [](std::size_t n) {
       return lines(n, [](std::size_t i) { return "c" + std::to_string(i) + "," + std::to_string(400 + i); });
     },
     parse_map},
};

double seconds_of(const Case& c, const std::string& path, std::size_t n) {
  const std::string text = c.text(n);
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    c.parse(path, text);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  return best;
}

TEST(ParseTime, GrowsWithTheLength) {
  // Else memory goes back to the system after each text, and getting its pages again takes several times as
  // long as the parsing.
  // A sanitizer's allocator has no such thresholds.
  ASSERT_TRUE(test::kSanitized || mallopt(M_MMAP_THRESHOLD, 1 << 30) == 1);
  ASSERT_TRUE(test::kSanitized || mallopt(M_TRIM_THRESHOLD, 1 << 30) == 1);
  const test::TempFolder folder;
  for (const Case& c : kCases) {
    const double once = seconds_of(c, folder / "text", c.n);
    const double eight = seconds_of(c, folder / "text", 8 * c.n);
    // Eight times the text: 8 where time is linear, 64 where it is quadratic. Below 20 ms nothing matters.
    EXPECT_LT(eight, std::max(24 * once, 0.02)) << c.name << ": " << once << " s, then " << eight << " s";
    EXPECT_LT(eight, 5) << c.name;
  }
}

}  // namespace
}  // namespace spectile
