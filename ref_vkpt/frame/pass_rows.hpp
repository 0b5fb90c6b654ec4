// SPDX-License-Identifier: GPL-2.0-or-later
// The rows of shaders/passes.def as data: for recording, compiling ahead, barriers and the table in the docs. Header
// only, no Vulkan.
#pragma once

#include "shaders/shared/frame.h"
#include "shaders/shared/present.h"
#include "shaders/shared/quad.h"

#include <cstdint>
#include <iterator>
#include <string_view>

namespace vkpt {

// See passes.def.
enum class PassKind { plain, traced, lit, choosing };
enum class PassExtent {
    pixels,
    bounce_blocks,
    cache_cells,
    half,
    strata,
    resolved,
    visibility_table,
    output,
    one,
    levels,
    other
};

// What passes hand on: the screen buffers, and some more.
enum PassResource : uint32_t {
#define VKPT_SCREEN_BUFFER(type, name) resource_##name,
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    resource_image,
    resource_exposure,
    resource_light_cache,
    resource_light_visibility,
    resource_trace_stack, // of every pass that traces
    resource_count
};
inline constexpr std::string_view pass_resource_names[] = {
#define VKPT_SCREEN_BUFFER(type, name) #name,
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    "image", "exposure", "light_cache", "light_visibility", "trace_stack"
};
static_assert(std::size(pass_resource_names) == resource_count);

// A bit a resource.
using PassResources = uint64_t;
static_assert(resource_count <= 64, "more resources than PassResources has bits");

struct BorrowedBuffer {
    PassResource name, lender; // `name` lies in its memory
};
inline constexpr BorrowedBuffer borrowed_buffers[] = {
#define VKPT_SCREEN_BUFFER(type, name)
#define VKPT_BORROWED_BUFFER(type, name, lender) { resource_##name, resource_##lender },
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
};

// With those whose memory they lie in: two sets have memory in common where these have bits in common.
consteval PassResources with_lenders(PassResources resources)
{
    for (const BorrowedBuffer& borrowed : borrowed_buffers)
        if (resources >> borrowed.name & 1)
            resources |= PassResources(1) << borrowed.lender;
    return resources;
}

// Of names with spaces between. A name that there is not does not compile.
consteval PassResources find_resources(std::string_view names)
{
    PassResources found = 0;
    while (!names.empty()) {
        const std::string_view name = names.substr(0, names.find(' '));
        uint32_t resource = 0;
        while (pass_resource_names[resource] != name) // past the end: no constant expression
            resource++;
        found |= PassResources(1) << resource;
        names.remove_prefix(name.size() < names.size() ? name.size() + 1 : name.size());
    }
    return found;
}

// A number for each pass, in the order of the rows.
enum class PassId : uint32_t {
#define VKPT_FRAME_PASS(name, kind, push, extent, when, unless, reads, writes, help) name,
#define VKPT_OTHER_PASS(name, kind, push, reads, writes, help) name,
#include "shaders/passes.def"
};

struct Pass {
    PassId id;
    const char* name;
    PassKind kind;
    const char* push; // struct of its push constants, "NONE": it has none
    uint32_t push_bytes;
    PassExtent extent;
    uint32_t when, unless; // FRAME_*
    const char* when_text;
    const char* unless_text;
    PassResources reads, writes;
    PassResources read_memory, written_memory; // with their lenders
    const char* help;

    constexpr bool is_run_with(uint32_t frame_flags) const
    {
        return extent != PassExtent::other && (frame_flags & when) == when && !(frame_flags & unless);
    }
};

namespace pass_row_names {
using namespace shared;
inline constexpr PassKind PLAIN = PassKind::plain, TRACED = PassKind::traced, LIT = PassKind::lit,
                          CHOOSING = PassKind::choosing;
inline constexpr PassExtent PIXELS = PassExtent::pixels, BOUNCE_BLOCKS = PassExtent::bounce_blocks,
                            CACHE_CELLS = PassExtent::cache_cells, HALF = PassExtent::half, STRATA = PassExtent::strata,
                            RESOLVED = PassExtent::resolved, VISIBILITY_TABLE = PassExtent::visibility_table,
                            OUTPUT = PassExtent::output, ONE = PassExtent::one, LEVELS = PassExtent::levels;
consteval PassResources add_trace_stack(PassResources resources, PassKind kind)
{
    return resources | (kind == TRACED || kind == LIT ? PassResources(1) << resource_trace_stack : PassResources(0));
}

struct NONE { };
template <class Push> constexpr uint32_t push_bytes = sizeof(Push);
template <> inline constexpr uint32_t push_bytes<NONE> = 0;

inline constexpr Pass rows[] = {
#define VKPT_FRAME_PASS(name, kind, push, extent, when, unless, reads, writes, help)                                   \
    { PassId::name, #name, kind, #push, push_bytes<push>, extent, when, unless, #when, #unless, find_resources(reads), \
        add_trace_stack(find_resources(writes), kind), with_lenders(find_resources(reads)),                            \
        with_lenders(add_trace_stack(find_resources(writes), kind)), help },
#define VKPT_OTHER_PASS(name, kind, push, reads, writes, help)                                                         \
    { PassId::name, #name, kind, #push, push_bytes<push>, PassExtent::other, 0, 0, "", "", find_resources(reads),      \
        add_trace_stack(find_resources(writes), kind), with_lenders(find_resources(reads)),                            \
        with_lenders(add_trace_stack(find_resources(writes), kind)), help },
#include "shaders/passes.def"
};
} // namespace pass_row_names

inline constexpr auto& pass_rows = pass_row_names::rows;
constexpr const Pass& find_pass(PassId id) { return pass_rows[uint32_t(id)]; }

} // namespace vkpt
