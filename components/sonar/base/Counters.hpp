#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace insonify::sonar {

/** What the stages of a ping count. */
enum class Counter : size_t {
    ObjectsCulled,
    Rays,
    Pixels,
    OnwardRays,
    OcclusionRays,
    SamplesMerged,
    Cells,
    WallsPassed,
    MirrorPaths,
    Bins,
    Targets,
    Edges
};
inline constexpr size_t counter_count = 12;

/** The name of a counter, the stage whose time its rate is of, and what it counts. */
struct CounterMeaning {
    const char *name, *stage, *meaning;
};
inline constexpr std::array<CounterMeaning, counter_count> counter_meanings{{
    {"objects_culled", "cull", "objects that an image does not see; with rays, moving objects that a tile skips"},
    {"rays", "draw", "rays from the sonar, without the padding of tiles"},
    {"pixels", "draw", "pixels of the images that have a triangle in view"},
    {"onward_rays", "deposit", "rays that go on from a surface, through a wall or by a mirror"},
    {"occlusion_rays", "deposit", "rays that find whether a path back is open"},
    {"samples_merged", "deposit", "samples that share the cell of a neighbour"},
    {"cells", "deposit", "cells whose echoes are added to bins"},
    {"walls_passed", "deposit", "walls that rays have passed"},
    {"mirror_paths", "deposit", "paths by mirrors with an echo, each way counted"},
    {"bins", "beams", "bins that are filled, of azimuth cells where beams are formed of them"},
    {"targets", "beams", "targets without extent that have an echo"},
    {"edges", "beams", "straight edges with an echo"},
}};

/** Counts by Counter [1]. */
using Counts = std::array<uint64_t, counter_count>;

/** What this thread has counted since it started. A ThreadPool adds what its workers count in a job to the thread that
 *  runs the job; so the difference across a ping is that of the ping, whatever the number of threads. */
extern constinit thread_local Counts thread_counts;

inline void count(Counter what, uint64_t more = 1) { thread_counts[static_cast<size_t>(what)] += more; }

/** What the pings of a task have counted, and the time in each of their stages. */
struct CountedPings {
    uint64_t pings = 0;
    Counts counts{};
    std::array<double, 5> seconds{};  ///< Stages in the order of StageOf (plan/EchoRenderer.hpp) [s].
    double all_seconds = 0;           ///< Of the pings but the first, from start to end [s].
    double divided_seconds = 0;       ///< The part in which their work was divided among threads [s].

    /** Adds a ping before which the thread had counted `before`. */
    void add(const Counts& before, const auto& stages) {
        ++pings;
        for (size_t i = 0; i < counter_count; ++i) counts[i] += thread_counts[i] - before[i];
        for (size_t i = 0; i < seconds.size(); ++i) seconds[i] += stages[i].seconds;
    }
};

}  // namespace insonify::sonar
