#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "components/sonar/multipath/Mirrors.hpp"

namespace insonify::sonar {

/** The mirrors that a ray has hit, in order, and what walls and mirrors have left of it. */
struct MirrorChain {
    static constexpr int max_bounces = MultipathConfig::max_bounces;

    int count = 0;
    std::array<uint64_t, max_bounces> names{};  ///< Equal for all rays that hit the same mirror.
    std::array<MirrorPlane, max_bounces> planes;
    double power = 1;           ///< Share of the power after the mirrors, one way [1].
    double passed = 1;          ///< Share of the power after the walls, one way [1].
    double widest = 0;          ///< Max contribution of a mirror's facet to a mean square slope, over its cosine [1].
    bool begins_lobed = false;  ///< Whether the first mirror has a lobe.
    int walls = 0;              ///< Thin walls that the ray has passed [1].
    uint64_t wall_names = 0;    ///< Equal for all rays that pass the same walls.
    bool was_in_fill = false;   ///< Whether the ray has been in a fluid other than water.

    bool sameAs(const MirrorChain& other) const {
        return count == other.count && wall_names == other.wall_names &&
               std::equal(names.begin(), names.begin() + count, other.names.begin());
    }
    glm::dvec3 image(glm::dvec3 place) const {
        for (int k = count; k-- > 0;) place = planes[static_cast<size_t>(k)].image(place);
        return place;
    }
    glm::dvec3 turned(glm::dvec3 way) const {
        for (int k = count; k-- > 0;) way = planes[static_cast<size_t>(k)].turned(way);
        return way;
    }
    /** Inverts turned(). */
    glm::dvec3 turnedBack(glm::dvec3 way) const {
        for (int k = 0; k < count; ++k) way = planes[static_cast<size_t>(k)].turned(way);
        return way;
    }
};

}  // namespace insonify::sonar
