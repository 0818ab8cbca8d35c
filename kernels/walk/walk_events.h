// The events of a random walk through a stack, as recorded by `shade` and replayed by `gather` from
// the last one back: L, the radiance of all lanes, is what comes in along the path there.
#ifndef RERADIANT_WALK_EVENTS_H
#define RERADIANT_WALK_EVENTS_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"

/// Straight through slab `index` over a length (in thicknesses): L *= exp(-(depth - s) length),
/// where s is the extinction that distances were sampled with (0: they were not, or the walk's
/// weight says so).
#define WALK_PASS 1u
/// Scattered in slab `index` after a length: L *= scattering / s * exp(-(depth - s) length).
#define WALK_SCATTER 2u
/// The diffuse substrate: L = M L.
#define WALK_SUBSTRATE 3u
/// A facet of conductor `index` met at a cosine: L *= R(cosine).
#define WALK_REFLECT 4u
/// Conductor `index` gave back what its V-cavities lost: L *= what facets kept of it.
#define WALK_BOUNCE 5u
/// Met dyes in slab `index` after a length: L = (scattering L + emission L) exp(-depth length).
/// Where the slab scatters, both parts have an L of their own, which WALK_MIX (written after, read
/// before) makes of the one that comes in: value L is for scattering, and what makes the mean of
/// the two weights 1 for emission.
#define WALK_EMIT 6u
#define WALK_MIX 7u
/// A light seen from here: L += value * E. E is its spectrum after what the events that follow
/// (and are read before) say of its way here: E *= exp(-depth length), and so on. Where the L for
/// emission is another, WALK_CONNECT_EMISSION says what it receives.
#define WALK_CONNECT 8u
#define WALK_CONNECT_EMISSION 9u
#define WALK_LIGHT_PASS 10u
#define WALK_LIGHT_REFLECT 11u
#define WALK_LIGHT_BOUNCE 12u

#define WALK_KIND(code) ((code) >> 24)
#define WALK_INDEX(code) ((code)&0xffffffu)
#define WALK_CODE(kind, index) ((kind) << 24 | (index))

/// Appends to one vertex's list. Chunks come from a pool that all walks share; when it is used up
/// nothing more is written, but the counter goes on, so that the host knows how many to make and
/// shades the batch again (the walks themselves do not depend on it).
typedef struct {
    __global WalkChunk* chunks;
    __global uint* used;
    uint capacity;
    uint chunk, count, last_code;
} WalkWriter;

WalkWriter walk_writer(__global WalkChunk* chunks, __global uint* used, uint capacity) {
    const WalkWriter writer = {chunks, used, capacity, NO_INDEX, WALK_CHUNK_EVENTS, 0u};
    return writer;
}

void walk_write(WalkWriter* writer, uint code, float value) {
    if (writer->count == WALK_CHUNK_EVENTS) {
        const uint fresh = atomic_inc(writer->used);
        if (fresh < writer->capacity)
            writer->chunks[fresh].previous = writer->chunk;
        writer->chunk = fresh;
        writer->count = 0u;
    }
    if (writer->chunk < writer->capacity) {
        const WalkEvent event = {code, value};
        writer->chunks[writer->chunk].events[writer->count] = event;
    }
    ++writer->count;
    writer->last_code = code;
}

/// Passages of the same slab one after the other become one.
void walk_write_pass(WalkWriter* writer, uint part, float length) {
    const uint code = WALK_CODE(WALK_PASS, part);
    if (writer->last_code != code)
        walk_write(writer, code, length);
    else if (writer->chunk < writer->capacity)
        writer->chunks[writer->chunk].events[writer->count - 1u].value += length;
}

/// Reads a list from its end.
typedef struct {
    __global const WalkChunk* chunks;
    uint chunk, count;
} WalkReader;

/// The event before; returns 0 when there is none.
int walk_read(WalkReader* reader, WalkEvent* event) {
    if (reader->count == 0u && reader->chunk != NO_INDEX) {
        reader->chunk = reader->chunks[reader->chunk].previous;
        reader->count = WALK_CHUNK_EVENTS;
    }
    if (reader->chunk == NO_INDEX)
        return 0;
    *event = reader->chunks[reader->chunk].events[--reader->count];
    return 1;
}

#endif
