#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "types/ConfigError.hpp"

namespace insonify::sonar {

/** Adds a diagnostic for each entry of a list that is not an index of one of `count` things. */
inline void checkPlaces(const char* path, const std::vector<uint32_t>& list, size_t count, const char* things,
                        types::Diagnostics& diagnostics) {
    for (size_t i = 0; i < list.size(); ++i)
        if (list[i] >= count)
            diagnostics.push_back({fmt::format("{}[{}]", path, i),
                                   fmt::format("is {}; there are {} {}, 0 to {}", list[i], count, things, count - 1)});
}

}  // namespace insonify::sonar
