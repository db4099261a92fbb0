#pragma once
// Ray queries of Embree 3 and 4, which have different interfaces.
#include <cmath>
#include <cstddef>
#include <span>

#if !__has_include(<embree3/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace insonify::sonar {

/** Sets components of directions that are nearer to 0 than 1e-18 to 0. Embree takes them for +1e-18. In a packet with
 *  negative components along the same axis it then loses hits of other rays, also far from the edge of a surface. Such
 *  components are the rounding of a level or upright sonar that is turned. */
inline void flushDirections(auto& ray) {
    for (float* const components : {ray.dir_x, ray.dir_y, ray.dir_z})
        for (int i = 0; i < 16; ++i) components[i] = std::abs(components[i]) < 1e-18f ? 0.0f : components[i];
}

#if RTC_VERSION_MAJOR >= 4

/** Finds the first hits of 16 rays. `valid`: -1 for active rays, aligned to 64 bytes. */
inline void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
    flushDirections(rays.ray);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &rays, &arguments);
}

/** Finds the first hits of packets whose rays are all active; a ray whose tfar is below its tnear hits nothing. */
inline void intersect(RTCScene scene, std::span<RTCRayHit16> packets) {
    alignas(64) static constexpr int all[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    for (RTCRayHit16& rays : packets) intersect(scene, all, rays);
}

/** Sets tfar of each ray that hits anything to -infinity. */
inline void occlude(RTCScene scene, const int* valid, bool are_coherent, RTCRay16& rays) {
    flushDirections(rays);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = are_coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcOccluded16(valid, scene, &rays, &arguments);
}

#else

inline RTCIntersectContext getContext(bool are_coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = are_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

/** Finds the first hits of 16 rays. `valid`: -1 for active rays, aligned to 64 bytes. */
inline void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
    flushDirections(rays.ray);
    RTCIntersectContext context = getContext(true);
    rtcIntersect16(valid, scene, &context, &rays);
}

/** Finds the first hits of packets whose rays are all active; a ray whose tfar is below its tnear hits nothing. */
inline void intersect(RTCScene scene, std::span<RTCRayHit16> packets) {
    for (RTCRayHit16& rays : packets) flushDirections(rays.ray);
    RTCIntersectContext context = getContext(true);
    rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets.data()), 16,
                   static_cast<unsigned>(packets.size()), sizeof(RTCRayHit16));
}

/** Sets tfar of each ray that hits anything to -infinity. */
inline void occlude(RTCScene scene, const int* valid, bool are_coherent, RTCRay16& rays) {
    flushDirections(rays);
    RTCIntersectContext context = getContext(are_coherent);
    rtcOccluded16(valid, scene, &context, &rays);
}

#endif

}  // namespace insonify::sonar
