// The table of colours gives the bits of solving, to any number of threads, and solves each colour once.
#include "src/upsampling/color_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include "src/dispatch/dispatch.hpp"

namespace spectile {
namespace {

constexpr std::size_t kLine = 192;

/// Lines of colours, some of them outside every gamut.
std::vector<float> made_up(std::size_t lines, unsigned colors, unsigned seed) {
  std::mt19937 random(seed);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  std::vector<float> out(lines * 3 * kLine);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = static_cast<float>(random() % colors) / static_cast<float>(colors) * 1.5F - 0.2F;
  }
  return out;
}

/// A line's coefficients and flags, through the table or without.
struct Line {
  FloatBuffer memory = *FloatBuffer::create(7 * kLine);
  std::vector<std::uint8_t> outside = std::vector<std::uint8_t>(kLine);
  float* row(std::size_t i) { return memory.data() + i * kLine; }
  rows::Coefficients out() { return {{row(3), row(4), row(5)}, row(6)}; }
  void load(const float* from) { std::copy_n(from, 3 * kLine, row(0)); }
  std::vector<float> result() { return {row(3), row(3) + 4 * kLine}; }
};

class ColorTables : public testing::Test {
 protected:
  std::vector<float> directly(const float* from, std::vector<std::uint8_t>& outside) {
    Line line;
    line.load(from);
    float* const rgb[3] = {line.row(0), line.row(1), line.row(2)};
    std::uint64_t unsolved[kLine / kLanesPerBlock] = {};
    rows::gamut_clip(kernels_, upsampler_, rgb, GamutPolicy::kClip, kLine, line.outside.data());
    rows::solve(kernels_, upsampler_, rgb, line.out(), unsolved, kLine);
    outside = line.outside;
    return line.result();
  }

  static void look_up(rows::ColorTable& table, rows::ColorTable::Batch& batch, Line& line) {
    const float* const rgb[3] = {line.row(0), line.row(1), line.row(2)};
    rows::ColorTable::clear(batch);
    table.add(batch, rgb, kLine);
    table.solve(batch);
    table.take(batch, 0, kLine, line.out(), line.outside.data());
  }

  const kernels::KernelTable& kernels_ = **dispatch::active();
  const Upsampler upsampler_ = *Upsampler::create(Method::kSigmoid, Quantity::kUnbounded, Bands());
};

TEST_F(ColorTables, GiveTheBitsOfSolvingToEveryThread) {
  constexpr std::size_t kLines = 60;
  const std::vector<float> colors = made_up(kLines, 9, 1);
  std::vector<std::vector<float>> expected;
  std::vector<std::vector<std::uint8_t>> outside(kLines);
  for (std::size_t i = 0; i < kLines; ++i) {
    expected.push_back(directly(colors.data() + i * 3 * kLine, outside[i]));
  }
  rows::ColorTable table(kernels_, upsampler_, GamutPolicy::kClip, kLines * kLine);
  std::vector<std::uint64_t> solved(4);
  std::vector<int> wrong(4);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      auto batch = *rows::ColorTable::Batch::create(kLine);
      Line line;
      for (std::size_t i = 0; i < kLines; ++i) {
        line.load(colors.data() + i * 3 * kLine);
        look_up(table, batch, line);
        wrong[t] += line.result() != expected[i] || line.outside != outside[i] ? 1 : 0;
      }
      solved[t] = batch.solved;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4));
  std::set<std::array<float, 3>> distinct;
  for (std::size_t i = 0; i < kLines * kLine; ++i) {
    const float* const line = colors.data() + i / kLine * 3 * kLine;
    distinct.insert({line[i % kLine], line[i % kLine + kLine], line[i % kLine + 2 * kLine]});
  }
  EXPECT_EQ(solved[0] + solved[1] + solved[2] + solved[3], distinct.size());
}

TEST_F(ColorTables, ThatAreFullStillSolve) {
  constexpr std::size_t kLines = 40;
  const std::vector<float> colors = made_up(kLines, 100000, 2);
  // 1024 places for 7680 colours.
  rows::ColorTable table(kernels_, upsampler_, GamutPolicy::kClip, 1);
  auto batch = *rows::ColorTable::Batch::create(kLine);
  Line line;
  for (std::size_t i = 0; i < kLines; ++i) {
    line.load(colors.data() + i * 3 * kLine);
    look_up(table, batch, line);
    std::vector<std::uint8_t> outside;
    EXPECT_EQ(line.result(), directly(colors.data() + i * 3 * kLine, outside)) << "line " << i;
    EXPECT_EQ(line.outside, outside) << "line " << i;
  }
}

TEST_F(ColorTables, TellZeroFromMinusZero) {
  std::vector<float> colors(3 * kLine, 0.0F);
  for (std::size_t i = 0; i < kLine; i += 2) colors[i] = -0.0F;
  rows::ColorTable table(kernels_, upsampler_, GamutPolicy::kClip, kLine);
  auto batch = *rows::ColorTable::Batch::create(kLine);
  Line line;
  line.load(colors.data());
  look_up(table, batch, line);
  EXPECT_EQ(batch.solved, 2U);
}

TEST_F(ColorTables, GiveUpWhereNothingComesAgain) {
  rows::ColorTable table(kernels_, upsampler_, GamutPolicy::kClip, 100000);
  auto batch = *rows::ColorTable::Batch::create(kLine);
  Line line;
  int tried = 0;
  const std::vector<float> colors = made_up(1000, 100000, 3);
  for (std::size_t i = 0; i < 1000; ++i) {
    if (!table.worth_while(batch)) continue;
    ++tried;
    line.load(colors.data() + i * 3 * kLine);
    look_up(table, batch, line);
  }
  EXPECT_LT(tried, 150);
}

}  // namespace
}  // namespace spectile
