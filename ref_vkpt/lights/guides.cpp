// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/guides.hpp"

#include "common/colour.hpp"
#include "shaders/shared/octahedral.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <map>
#include <utility>

namespace vkpt {

namespace {

// A cell stands out where it sends so many times of what the faces that the cluster sees send on average.
constexpr float standing_out = 3;
constexpr size_t max_blocks = 8192; // that may be guides, in a map
constexpr size_t max_tests = 1u << 24; // of clusters against blocks, or clusters
// Guides' weights are 16-bit floats; what they are relative to does not matter.
constexpr float power_scale = 1.0f / 65536;

struct LitCell {
    int cluster;
    glm::uvec2 place; // in its face
    float radiance; // luminance that it reflects
    glm::vec3 centre;
};

struct Block {
    uint32_t face;
    glm::uvec2 first; // cell of the face
    int cluster; // of its brightest cell
    float brightest = 0, power = 0, moment = 0; // greatest, sum and sum of squares of its cells' radiances
    glm::vec3 centre { 0 };
    std::vector<size_t> cells; // of the layout
    uint32_t number = 0; // among the guides, 0: none yet
};

class GuideChoice {
public:
    GuideChoice(const GuideSources& sources, std::span<shared::CacheValue> values)
        : sources_(sources)
        , values_(values)
    {
    }

    LightCacheGuides choose()
    {
        collect_blocks();
        find_means();
        for (size_t cluster = 0; cluster < means_.size(); cluster++)
            list_cluster(cluster);
        return std::move(result_);
    }

private:
    float cell_area() const { return sources_.layout.cell_size * sources_.layout.cell_size; }

    LitCell describe(const shared::CacheCell& cell) const
    {
        const shared::CacheFace& face = sources_.layout.faces[cell.face];
        const shared::CacheFacePlane& plane = sources_.layout.planes[cell.face];
        constexpr uint32_t mask = (1u << shared::CACHE_SIZE_BITS) - 1;
        const uint32_t layers = face.size >> (2 * shared::CACHE_SIZE_BITS), across = face.size & mask,
                       number = (cell.first_value - face.first_value) / layers;
        LitCell lit {};
        lit.place = { number % across, number / across };
        lit.centre
            = plane.origin + plane.across * (float(lit.place.x) + 0.5f) + plane.down * (float(lit.place.y) + 0.5f);
        glm::vec3 light(0);
        for (uint32_t layer = 0; layer < layers; layer++) {
            const uint32_t style = face.styles[layer / 2] >> (layer % 2 * 16) & 0xffff;
            if (style < sources_.lightstyles.size())
                light += cached_light(values_[cell.first_value + layer]) * sources_.lightstyles[style];
        }
        const float radiance = luminance(light * sources_.colours[sources_.bsp.faces[cell.face].texinfo]);
        lit.radiance = std::isfinite(radiance) ? radiance : 0;
        lit.cluster = plane.cluster >= 0 ? plane.cluster : sources_.bsp.find_cluster(lit.centre + plane.normal);
        return lit;
    }

    // Neighbours of one face, which follow one another row by row; and per cluster what its cells send.
    void collect_blocks()
    {
        sums_.assign(sources_.lists.cluster_count(), {});
        uint32_t face = UINT32_MAX;
        std::map<std::pair<uint32_t, uint32_t>, size_t> of_face;
        for (size_t i = 0; i < sources_.layout.cells.size(); i++) {
            const shared::CacheCell& cell = sources_.layout.cells[i];
            const LitCell lit = describe(cell);
            if (lit.cluster < 0 || size_t(lit.cluster) >= sums_.size())
                continue;
            sums_[size_t(lit.cluster)] += glm::vec2(lit.radiance, 1);
            if (cell.face != face)
                of_face.clear();
            face = cell.face;
            const glm::uvec2 place = lit.place / shared::CACHE_GUIDE_SIDE;
            const auto [entry, is_new] = of_face.try_emplace({ place.x, place.y }, blocks_.size());
            if (is_new)
                blocks_.push_back(
                    { face, place * shared::CACHE_GUIDE_SIDE, lit.cluster, 0, 0, 0, glm::vec3(0), {}, 0 });
            add_cell(blocks_[entry->second], i, lit);
        }
        const size_t kept = std::min({ blocks_.size(), max_blocks, max_tests / std::max<size_t>(sums_.size(), 1) });
        std::ranges::nth_element(blocks_, blocks_.begin() + std::ptrdiff_t(kept), std::greater(), &Block::moment);
        blocks_.resize(kept);
    }

    static void add_cell(Block& block, size_t cell, const LitCell& lit)
    {
        block.cells.push_back(cell);
        block.power += lit.radiance;
        block.moment += lit.radiance * lit.radiance;
        block.centre += lit.centre * lit.radiance;
        if (lit.radiance > block.brightest)
            block.cluster = lit.cluster;
        block.brightest = std::max(block.brightest, lit.radiance);
    }

    // Of what each cluster sees.
    void find_means()
    {
        const size_t clusters = sums_.size();
        const bool few = clusters * clusters <= max_tests;
        glm::vec2 all(0);
        for (const glm::vec2& sum : sums_)
            all += sum;
        means_.assign(clusters, all.x / std::max(all.y, 1.0f));
        for (size_t i = 0; i < clusters && few; i++) {
            glm::vec2 seen(0);
            for (size_t k = 0; k < clusters; k++)
                if (k == i || sources_.lists.visible_from(i).contains(int(k)))
                    seen += sums_[k];
            means_[i] = seen.x / std::max(seen.y, 1.0f);
        }
    }

    // Those that bring the greatest part of the bounce light's second moment.
    void list_cluster(size_t cluster)
    {
        struct Entry {
            float score;
            size_t block;
        };
        std::vector<Entry> entries;
        const formats::ClusterSet& visible = sources_.lists.visible_from(cluster);
        const Bounds bounds = sources_.lists.cluster_bounds(cluster);
        for (size_t i = 0; i < blocks_.size(); i++) {
            const Block& block = blocks_[i];
            if (!(block.brightest > standing_out * means_[cluster])
                || (size_t(block.cluster) != cluster && !visible.contains(block.cluster)))
                continue;
            const glm::vec3 centre = block.centre / block.power,
                            way = glm::clamp(centre, bounds.mins, bounds.maxs) - centre;
            entries.push_back({ block.moment / std::max(glm::dot(way, way), cell_area()), i });
        }
        const size_t kept = std::min<size_t>(entries.size(), shared::CACHE_MAX_GUIDES);
        std::ranges::partial_sort(entries, entries.begin() + std::ptrdiff_t(kept), std::greater(), &Entry::score);
        entries.resize(kept);
        for (Entry& entry : entries)
            number_guide(blocks_[entry.block]);
        std::ranges::sort(entries, {}, [&](const Entry& entry) { return blocks_[entry.block].number; });
        const uint32_t first = uint32_t(result_.entries.size());
        for (const Entry& entry : entries)
            if (const Block& block = blocks_[entry.block]; block.number != 0) {
                result_.entries.push_back(block.number);
                result_.guides.push_back(describe_guide(block));
            }
        result_.lists.push_back({ first, uint32_t(result_.entries.size()) - first });
    }

    shared::CacheGuide describe_guide(const Block& block) const
    {
        const glm::vec3 normal = sources_.layout.planes[block.face].normal;
        // The length of the octahedron's normal.
        const float length = 1 / (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
        const uint32_t power = glm::packHalf1x16(std::min(block.power * cell_area() * power_scale / length, 6e4f));
        return { block.centre / block.power, glm::packSnorm2x8(shared::direction_to_octahedron(normal)) | power << 16 };
    }

    // The number stays 0 where there are too many.
    void number_guide(Block& block)
    {
        if (block.number != 0 || result_.blocks.size() == shared::CACHE_MAX_GUIDE_BLOCKS)
            return;
        const shared::CacheFacePlane& plane = sources_.layout.planes[block.face];
        shared::CacheGuideBlock out {};
        out.corner = plane.origin + plane.across * float(block.first.x) + plane.down * float(block.first.y);
        out.across = plane.across;
        out.down = plane.down;
        block.number = uint32_t(result_.blocks.size()) + 1;
        for (const size_t i : block.cells) {
            const shared::CacheCell& cell = sources_.layout.cells[i];
            const LitCell lit = describe(cell);
            const uint32_t share = uint32_t(std::max(std::lround(255 * lit.radiance / block.brightest), 1l));
            const glm::uvec2 at = lit.place - block.first;
            out.shares[at.y] |= share << (8 * at.x);
            out.total += share;
            values_[cell.first_value].last |= block.number << shared::CACHE_GUIDE_SHIFT;
        }
        result_.blocks.push_back(out);
    }

    const GuideSources& sources_;
    std::span<shared::CacheValue> values_;
    std::vector<Block> blocks_;
    std::vector<glm::vec2> sums_; // per cluster: radiance and number of its cells
    std::vector<float> means_;
    LightCacheGuides result_;
};

} // namespace

glm::vec3 cached_light(const shared::CacheValue& value)
{
    const uint64_t bits = value.light[0] | uint64_t(value.light[1]) << 32;
    const auto unpack
        = [&](int component) { return std::bit_cast<float>(uint32_t(bits >> (21 * component) & 0x1fffff) << 10); };
    return { unpack(0), unpack(1), unpack(2) };
}

LightCacheGuides choose_guides(const GuideSources& sources, std::span<shared::CacheValue> values)
{
    return GuideChoice(sources, values).choose();
}

} // namespace vkpt
