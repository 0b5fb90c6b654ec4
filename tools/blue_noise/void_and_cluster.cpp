// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/blue_noise/void_and_cluster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace vkpt::blue_noise {

namespace {

constexpr int kernel_radius = 9; // pixels; beyond, the Gaussian is below 2e-5
constexpr double energy_unit = double(1u << 25); // the sum of all weights, about 30, stays below 2^31
constexpr int initial_share = 10; // one voxel of this many is set at the start

// Which voxels are set, the energy that they put on every voxel, and per row the extremes that the search needs.
class Pattern {
public:
    explicit Pattern(const MaskSettings& settings)
        : size_(settings.shape.size)
        , slices_(settings.shape.slices)
        , energy_(voxel_count(), 0)
        , is_set_(voxel_count(), 0)
        , rows_(size_t(size_) * size_t(slices_))
    {
        const auto gauss = [](int distance2, double sigma) {
            return uint32_t(std::lround(energy_unit * std::exp(-distance2 / (2 * sigma * sigma))));
        };
        for (int y = -kernel_radius; y <= kernel_radius; y++)
            for (int x = -kernel_radius; x <= kernel_radius; x++)
                spatial_.push_back(gauss(x * x + y * y, settings.spatial_sigma));
        for (int t = 0; t < slices_; t++) {
            const int distance = std::min(t, slices_ - t);
            temporal_.push_back(t == 0 ? 0 : gauss(distance * distance, settings.temporal_sigma));
        }
        for (size_t row = 0; row < rows_.size(); row++)
            scan_row(row);
    }

    size_t voxel_count() const { return size_t(size_) * size_t(size_) * size_t(slices_); }
    size_t set_count() const { return set_count_; }

    // The set voxel of highest energy, and the unset one of lowest.
    size_t tightest_cluster() const
    {
        const auto row = std::max_element(
            rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.highest_set < b.highest_set; });
        return find_in_row(size_t(row - rows_.begin()), row->highest_set, 1);
    }
    size_t largest_void() const
    {
        const auto row = std::min_element(
            rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.lowest_unset < b.lowest_unset; });
        return find_in_row(size_t(row - rows_.begin()), row->lowest_unset, 0);
    }

    void toggle(size_t voxel)
    {
        const bool add = !is_set_[voxel];
        is_set_[voxel] = add;
        set_count_ += add ? 1 : size_t(-1);
        const int x = int(voxel % size_t(size_));
        const int y = int(voxel / size_t(size_)) % size_;
        const int t = int(voxel / (size_t(size_) * size_t(size_)));
        const uint32_t* weight = spatial_.data();
        for (int dy = -kernel_radius; dy <= kernel_radius; dy++) {
            const size_t row = size_t(t * size_ + wrap(y + dy));
            for (int dx = -kernel_radius; dx <= kernel_radius; dx++)
                change(row * size_t(size_) + size_t(wrap(x + dx)), *weight++, add);
            scan_row(row);
        }
        for (int other = 0; other < slices_; other++) {
            if (other == t)
                continue;
            const size_t row = size_t(other * size_ + y);
            change(row * size_t(size_) + size_t(x), temporal_[size_t(std::abs(other - t))], add);
            scan_row(row);
        }
    }

private:
    struct Row {
        int64_t highest_set = -1;
        int64_t lowest_unset = std::numeric_limits<int64_t>::max();
    };

    int wrap(int coordinate) const { return coordinate & (size_ - 1); }
    void change(size_t voxel, uint32_t weight, bool add) { energy_[voxel] += add ? weight : 0u - weight; }

    void scan_row(size_t row)
    {
        // Unset voxels count as energy 0 among the set and the reverse: no branch. Energies are shifted by one for
        // that.
        uint32_t highest = 0, lowest = std::numeric_limits<uint32_t>::max();
        const uint32_t* energy = &energy_[row * size_t(size_)];
        const uint32_t* set = &is_set_[row * size_t(size_)];
        for (int x = 0; x < size_; x++) {
            const uint32_t mask = 0u - set[x];
            highest = std::max(highest, (energy[x] + 1) & mask);
            lowest = std::min(lowest, energy[x] | mask);
        }
        rows_[row].highest_set = int64_t(highest) - 1;
        rows_[row].lowest_unset
            = lowest == std::numeric_limits<uint32_t>::max() ? std::numeric_limits<int64_t>::max() : lowest;
    }

    size_t find_in_row(size_t row, int64_t energy, uint32_t set) const
    {
        size_t voxel = row * size_t(size_);
        while (is_set_[voxel] != set || int64_t(energy_[voxel]) != energy)
            voxel++;
        return voxel;
    }

    int size_, slices_;
    size_t set_count_ = 0;
    std::vector<uint32_t> spatial_, temporal_;
    std::vector<uint32_t> energy_, is_set_; // per voxel
    std::vector<Row> rows_;
};

// Random voxels, then the tightest cluster moved into the largest void until that changes nothing.
void make_initial_pattern(Pattern& pattern, uint32_t seed)
{
    std::mt19937 rng(seed);
    std::vector<uint32_t> voxels(pattern.voxel_count());
    std::iota(voxels.begin(), voxels.end(), 0u);
    const size_t wanted = voxels.size() / initial_share;
    for (size_t i = 0; i < wanted; i++) {
        // Not std::shuffle: its order is the library's own affair.
        std::swap(voxels[i], voxels[i + rng() % (voxels.size() - i)]);
        pattern.toggle(voxels[i]);
    }
    // Two patterns may alternate for ever; each move lowers the energy long before that.
    for (size_t moves = 0; moves < voxels.size(); moves++) {
        const size_t cluster = pattern.tightest_cluster();
        pattern.toggle(cluster);
        const size_t gap = pattern.largest_void();
        pattern.toggle(gap);
        if (gap == cluster)
            return;
    }
}

// Rank of every voxel in the whole volume. Above half, the tightest cluster of unset voxels is again the largest void.
std::vector<uint32_t> rank_voxels(const Pattern& initial)
{
    std::vector<uint32_t> ranks(initial.voxel_count());
    Pattern pattern = initial;
    while (pattern.set_count() > 0) {
        const size_t voxel = pattern.tightest_cluster();
        pattern.toggle(voxel);
        ranks[voxel] = uint32_t(pattern.set_count());
    }
    pattern = initial;
    while (pattern.set_count() < pattern.voxel_count()) {
        const size_t voxel = pattern.largest_void();
        ranks[voxel] = uint32_t(pattern.set_count());
        pattern.toggle(voxel);
    }
    return ranks;
}

// Ranks of the volume to ranks of each slice, then to values that are unique in the volume.
std::vector<uint32_t> make_slices_uniform(const std::vector<uint32_t>& ranks, MaskShape shape)
{
    const size_t slice_voxels = size_t(shape.size) * size_t(shape.size), slices = size_t(shape.slices);
    std::vector<uint32_t> by_rank(ranks.size());
    for (size_t voxel = 0; voxel < ranks.size(); voxel++)
        by_rank[ranks[voxel]] = uint32_t(voxel);
    std::vector<uint32_t> used_of_slice(slices, 0), used_of_rank(slice_voxels, 0), values(ranks.size());
    for (const uint32_t voxel : by_rank) {
        const uint32_t slice_rank = used_of_slice[voxel / slice_voxels]++;
        values[voxel] = slice_rank * uint32_t(slices) + used_of_rank[slice_rank]++;
    }
    return values;
}

} // namespace

std::vector<uint32_t> make_mask(const MaskSettings& settings)
{
    Pattern pattern(settings);
    make_initial_pattern(pattern, settings.seed);
    return make_slices_uniform(rank_voxels(pattern), settings.shape);
}

} // namespace vkpt::blue_noise
