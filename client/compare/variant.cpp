// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/compare/variant.hpp"

#include "client/host/errors.hpp"
#include "client/host/name_list.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "shaders/shared/light_sampler.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>

namespace vkpt::client {

namespace {

constexpr int longest_subset = 64;

// "a|b|c" of the cvar's row.
std::vector<std::string> choices_of(std::string_view cvar)
{
    std::vector<std::string> list;
    for (const CvarRow& row : cvar_rows)
        if (row.name == cvar)
            for (std::string_view rest = row.choices; !rest.empty();) {
                const size_t bar = std::min(rest.find('|'), rest.size());
                list.emplace_back(rest.substr(0, bar));
                rest.remove_prefix(std::min(bar + 1, rest.size()));
            }
    return list;
}

void check_names(const char* option, const std::vector<std::string>& wanted, const std::vector<std::string>& known)
{
    for (const std::string& name : wanted)
        if (!std::ranges::count(known, name))
            throw WrongUse(fmt::format("{} {}: there is only {}", option, name, fmt::join(known, ", ")));
}

} // namespace

std::string Variant::label() const
{
    return sampler + (subset ? fmt::format(" R{}", *subset) : "") + " " + noise + (is_filtered() ? " " + denoiser : "");
}

Variant make_variant(const std::string& sampler, std::optional<int> subset, const std::string& denoiser)
{
    return { sampler, subset, "blue", denoiser };
}

std::vector<Variant> make_variants(const VariantLists& lists, const ModuleInfo& module)
{
    check_names("--samplers", lists.samplers, list_names(module.light_samplers));
    check_names("--noise", lists.noises, choices_of("pt_noise"));
    check_names("--denoisers", lists.denoisers, list_names(module.denoisers));
    for (const int subset : lists.subsets)
        if (subset < 1 || subset > longest_subset)
            throw WrongUse(fmt::format("--subsets {}: 1 to {}", subset, longest_subset));
    std::vector<Variant> variants;
    for (const std::string& sampler : lists.samplers)
        for (const int subset : lists.subsets)
            for (const std::string& noise : lists.noises)
                for (const std::string& denoiser : lists.denoisers) {
                    const bool has_subset = find_sampler_traits(module, sampler) & shared::SAMPLER_USES_SUBSET;
                    Variant variant
                        = make_variant(sampler, has_subset ? std::optional(subset) : std::nullopt, denoiser);
                    variant.noise = noise;
                    if (!std::ranges::count(variants, variant))
                        variants.push_back(std::move(variant));
                }
    return variants;
}

} // namespace vkpt::client
