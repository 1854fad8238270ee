// Result: values, errors, and the ways on from either.
#include <gtest/gtest.h>

#include <memory>
#include <spectile/result.hpp>
#include <string>

namespace spectile::test {
namespace {

Result<int> half_of(int v) {
  if (v % 2 == 0) return v / 2;
  return Error{ErrorCode::kBadArgument, std::to_string(v) + " is odd"};
}

Result<void> even(int v) {
  SPECTILE_TRY(half_of(v));
  return {};
}

Result<int> quarter_of(int v) {
  SPECTILE_ASSIGN(const int half, half_of(v));
  int quarter = 0;
  SPECTILE_ASSIGN(quarter, half_of(half));
  return quarter;
}

TEST(Results, HoldAValueOrAnError) {
  EXPECT_TRUE(half_of(4).has_value());
  EXPECT_EQ(*half_of(4), 2);
  EXPECT_EQ(half_of(4).value_or(7), 2);
  EXPECT_FALSE(half_of(3).has_value());
  EXPECT_EQ(half_of(3).value_or(7), 7);
  const Result<int> kept = half_of(4);
  EXPECT_EQ(kept.value_or(7), 2);
  EXPECT_EQ(half_of(3).error().message, "3 is odd");
  EXPECT_TRUE(even(2).has_value());
  EXPECT_FALSE(even(3).has_value());
}

TEST(Results, MoveWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> one = std::make_unique<int>(1);
  const std::unique_ptr<int> taken = std::move(one).value_or(nullptr);
  EXPECT_EQ(*taken, 1);
  Result<std::unique_ptr<int>> none = Error{ErrorCode::kNoSpace, "full"};
  EXPECT_EQ(std::move(none).value_or(nullptr), nullptr);
}

TEST(Results, AreHandedOnByTheMacros) {
  EXPECT_EQ(*quarter_of(12), 3);
  EXPECT_EQ(quarter_of(6).error().message, "3 is odd");
  EXPECT_EQ(quarter_of(6).error().code, ErrorCode::kBadArgument);
  EXPECT_EQ(even(5).error().message, "5 is odd");
}

TEST(ResultsDeathTest, TakingTheValueOfAnErrorEndsWithItsSentence) {
  EXPECT_DEATH(static_cast<void>(*half_of(3)), "the value of an error was taken: 3 is odd");
  EXPECT_DEATH(static_cast<void>(half_of(5).operator->()), "5 is odd");
}

}  // namespace
}  // namespace spectile::test
