// The name that a misspelt one was meant for.
#pragma once

#include <string>
#include <vector>

namespace spectile::cli {

/// The name at the smallest edit distance from `word`, if that is at most a third of the word's length, else
/// the first one that begins with it; empty where there is none. Dashes at the start do not count.
std::string nearest(const std::string& word, const std::vector<std::string>& names);

/// "; did you mean NAME?", or an empty text.
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

}  // namespace spectile::cli
