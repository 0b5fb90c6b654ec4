// SPDX-License-Identifier: GPL-2.0-or-later
// What is compared, and at equal time.
#include "client/compare/figures.hpp"
#include "client/compare/measure.hpp"
#include "client/host/errors.hpp"

#include "shaders/shared/light_sampler.h"
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

using namespace vkpt::client;

ModuleInfo make_info()
{
    static const char* const samplers[]
        = { "full", "subset", "subset_mis", "subset_mis_biased", "subset_mis_blue", "uniform", nullptr };
    using namespace shared;
    static const uint32_t traits[] = { 0, SAMPLER_USES_SUBSET, SAMPLER_MIS | SAMPLER_USES_SUBSET,
        SAMPLER_MIS | SAMPLER_BIASED | SAMPLER_USES_SUBSET, SAMPLER_MIS | SAMPLER_USES_SUBSET, 0 };
    static const char* const denoisers[] = { "off", "asvgf", nullptr };
    ModuleInfo info {};
    info.light_samplers = samplers;
    info.light_sampler_traits = traits;
    info.denoisers = denoisers;
    return info;
}

TEST(Variants, AreAllCombinationsOnce)
{
    VariantLists lists { { "subset", "uniform" }, { 1, 8 }, { "blue", "white" }, { "off", "asvgf" } };
    const std::vector<Variant> variants = make_variants(lists, make_info());
    EXPECT_EQ(variants.size(), 2u * 2 * 2 + 2 * 2); // uniform has no subsets
    EXPECT_EQ(variants[0].label(), "subset R1 blue");
    EXPECT_EQ(variants[1].label(), "subset R1 blue asvgf");
    EXPECT_EQ(variants.back().label(), "uniform white asvgf");
}

TEST(Variants, SaysWhatThereIs)
{
    const VariantLists wrong[] = { { { "subste" }, { 8 }, { "blue" }, { "off" } },
        { { "subset" }, { 0 }, { "blue" }, { "off" } }, { { "subset" }, { 65 }, { "blue" }, { "off" } },
        { { "subset" }, { 8 }, { "pink" }, { "off" } }, { { "subset" }, { 8 }, { "blue" }, { "nrd" } } };
    const char* const parts[] = { "subset_mis_blue", "1 to 64", "1 to 64", "blue, white", "off, asvgf" };
    for (size_t i = 0; i < std::size(wrong); i++)
        try {
            make_variants(wrong[i], make_info());
            ADD_FAILURE() << i;
        } catch (const WrongUse& error) {
            EXPECT_NE(std::string(error.what()).find(parts[i]), std::string::npos) << error.what();
        }
}

TEST(Curve, IsAPowerLawBetweenItsPoints)
{
    const std::vector<CurvePoint> curve { { 1, 4 }, { 4, 2 }, { 16, 1 } };
    for (const double samples : { 1.0, 2.0, 9.0, 64.0 })
        EXPECT_NEAR(interpolate_curve(curve, samples), 4 / std::sqrt(samples), 1e-9);
    EXPECT_EQ(interpolate_curve({ { 1, 4 } }, 3), 4);
    EXPECT_EQ(interpolate_curve({}, 3), 0);
    EXPECT_EQ(interpolate_curve({ { 1, 0 }, { 2, 0 } }, 3), 0);
}

TEST(ChapterFigures, AreAllThere)
{
    const FigurePlan plan = plan_chapter_figures(make_info());
    EXPECT_EQ(plan.scenes[0].scene, first_figure_scene());
    for (const char* name : { "47-1", "47-4", "47-5", "47-6", "47-7" })
        EXPECT_EQ(std::ranges::count_if(
                      plan.figures, [&](const Figure& f) { return f.title.find(name) != std::string::npos; }),
            1)
            << name;
    for (const Figure& figure : plan.figures)
        for (const std::vector<FigurePicture>& row : figure.rows) {
            EXPECT_EQ(row.back().variant, "") << "the reference comes last";
            for (const FigurePicture& picture : row) {
                const std::vector<Variant>& variants = plan.scenes[figure.scene].variants;
                EXPECT_TRUE(picture.variant.empty() || std::ranges::any_of(variants, [&](const Variant& v) {
                    return v.label() == picture.variant;
                })) << picture.variant;
            }
        }
    ModuleInfo bare = make_info();
    static const char* const few[] = { "subset", nullptr };
    bare.light_samplers = few;
    EXPECT_THROW(plan_chapter_figures(bare), WrongUse);
}

} // namespace
} // namespace vkpt::tests
