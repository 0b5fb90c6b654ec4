// SPDX-License-Identifier: GPL-2.0-or-later
// What is compared: one light sampler with its settings and what comes after it.
#pragma once

#include "ref_vkpt/extension.hpp"

#include <optional>
#include <string>
#include <vector>

namespace vkpt::client {

struct Variant {
    std::string sampler;
    std::optional<int> subset; // pt_light_subset; nothing: the sampler has none
    std::string noise, denoiser;

    bool is_filtered() const { return denoiser != "off"; }
    std::string label() const; // "subset_mis R8 blue asvgf"; "off" is left out
    bool operator==(const Variant&) const = default;
};

struct VariantLists {
    std::vector<std::string> samplers { "uniform", "subset", "subset_mis", "subset_mis_blue" };
    std::vector<int> subsets { 8 };
    std::vector<std::string> noises { "blue" }, denoisers { "off" };
};

// All combinations, in the lists' order; samplers without subsets once. Throws WrongUse for what the module does not
// have.
std::vector<Variant> make_variants(const VariantLists& lists, const ModuleInfo& module);
// `subset`: nothing for samplers that have none.
Variant make_variant(
    const std::string& sampler, std::optional<int> subset = std::nullopt, const std::string& denoiser = "off");

} // namespace vkpt::client
