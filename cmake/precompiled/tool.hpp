// Precompiled for the tool: see library.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <spectile/spectile.hpp>
#include <string>
#include <vector>
