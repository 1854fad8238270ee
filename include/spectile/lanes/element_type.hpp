// ElementType: the kind of number that an array of the caller's holds.
#pragma once

namespace spectile {

/// Kinds of numbers in memory that the caller owns.
enum class ElementType {
  kFloat,   ///< 32 bit
  kHalf,    ///< 16 bit, the pattern of an IEEE 754 half
  kUint8,   ///< 0 to 255 for 0 to 1
  kUint16,  ///< 0 to 65535 for 0 to 1
};

}  // namespace spectile
