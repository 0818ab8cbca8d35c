#pragma once

// The differences between Embree 3.13 and Embree 4 that this project meets, all of them.

#if RERADIANT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace reradiant {

/// Rays are traced so many at a time; a device without vectors so wide takes them one by one.
inline constexpr int packet_rays = 16;

/// What callbacks of a query see: where they leave the distance of each ray's nearest hit, by its
/// id, in double precision.
struct PacketContext {
#if RERADIANT_EMBREE_MAJOR >= 4
    RTCRayQueryContext embree;
#else
    RTCIntersectContext embree;
#endif
    double* distances;
};

#if RERADIANT_EMBREE_MAJOR >= 4

inline void embree_intersect(RTCScene scene, const int* valid, RTCRayHit16& packet, bool coherent,
                             double* distances) {
    PacketContext context{{}, distances};
    rtcInitRayQueryContext(&context.embree);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context.embree;
    arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, &packet, &arguments);
}

inline void embree_occluded(RTCScene scene, const int* valid, RTCRay16& packet) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    rtcOccluded16(valid, scene, &packet, &arguments);
}

#else

inline void embree_intersect(RTCScene scene, const int* valid, RTCRayHit16& packet, bool coherent,
                             double* distances) {
    PacketContext context{{}, distances};
    rtcInitIntersectContext(&context.embree);
    context.embree.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, &context.embree, &packet);
}

inline void embree_occluded(RTCScene scene, const int* valid, RTCRay16& packet) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded16(valid, scene, &context, &packet);
}

#endif

} // namespace reradiant
