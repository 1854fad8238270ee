// The meaning of two images' samples, which must be the same for an average.
#pragma once

#include <optional>
#include <string>

#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// The first difference of the attributes that say what samples mean: colour space, exposure value, units,
/// filters; as "its NAME is A, but that of FIRST is B". Nothing where nothing does. An attribute that is
/// missing has its default, where there is one.
std::optional<std::string> difference_of_meaning(const PartHeader& other, const PartHeader& first,
                                                 const std::string& first_path);

}  // namespace spectile::io
