// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/compare/figures.hpp"

#include <algorithm>
#include <string_view>

namespace vkpt::client {

namespace {

constexpr const char* filter = "asvgf"; // the chapter's
constexpr size_t plain_columns = 3;

// Places on our map for what the figures show.
constexpr const char* many_lights = "maps/vkpt1.bsp";
constexpr const char* glossy_floor = "maps/vkpt1.bsp@0,-300,40,20,90";
constexpr const char* beside_lamps = "maps/vkpt1.bsp@440,-128,60,5,0"; // the lava, too, shines on the walls

class Plan {
public:
    size_t add_scene(const char* scene)
    {
        for (size_t i = 0; i < plan_.scenes.size(); i++)
            if (plan_.scenes[i].scene == scene)
                return i;
        plan_.scenes.push_back({ scene, {} });
        return plan_.scenes.size() - 1;
    }
    FigurePicture use(size_t scene, const std::string& sampler, std::optional<int> subset, const char* denoiser,
        const std::string& caption)
    {
        const Variant variant = make_variant(sampler, subset, denoiser);
        std::vector<Variant>& known = plan_.scenes[scene].variants;
        if (!std::ranges::count(known, variant))
            known.push_back(variant);
        return { variant.label(), caption };
    }
    // One row without and one with the filter, then the reference in both.
    struct Column {
        std::string sampler;
        std::optional<int> subset;
        std::string caption;
    };
    void add(Figure figure, const char* scene, const std::vector<Column>& columns, std::vector<const char*> denoisers)
    {
        figure.scene = add_scene(scene);
        for (const char* denoiser : denoisers) {
            std::vector<FigurePicture> row;
            for (const Column& column : columns)
                row.push_back(use(figure.scene, column.sampler, column.subset, denoiser,
                    column.caption + (denoiser == std::string_view("off") ? "" : ", filtered")));
            const bool is_filtered = denoiser != std::string_view("off");
            row.push_back({ "", is_filtered ? "reference (pixel centres)" : "reference", is_filtered });
            figure.rows.push_back(std::move(row));
        }
        plan_.figures.push_back(std::move(figure));
    }
    FigurePlan take() { return std::move(plan_); }

private:
    FigurePlan plan_;
};

void check_samplers(const FigurePlan& plan, const ModuleInfo& module)
{
    for (const FigureScene& scene : plan.scenes)
        for (const Variant& variant : scene.variants) {
            VariantLists one { { variant.sampler }, { variant.subset.value_or(1) }, { variant.noise },
                { variant.denoiser } };
            make_variants(one, module);
        }
}

} // namespace

std::string first_figure_scene() { return many_lights; }

FigurePlan plan_chapter_figures(const ModuleInfo& module)
{
    Plan plan;
    plan.add({ "Figure 47-1: one sample per pixel, without and with the filter",
                 "Uniform sampling, importance sampling in a stochastic subset of 8, and the converged picture. Above "
                 "unfiltered, below filtered by A-SVGF.",
                 0, {}, 0.5, 0.5, 1 },
        many_lights, { { "uniform", {}, "uniform" }, { "subset", 8, "subset of 8" } }, { "off", filter });
    plan.add(
        { "Figure 47-4: the length of the subset",
            "The longer the subset, the better it represents all lights; the filter recovers less from bad samples.", 0,
            {}, 0.5, 0.5, 1 },
        many_lights,
        { { "uniform", {}, "uniform" }, { "subset", 1, "1" }, { "subset", 8, "8" }, { "subset", 16, "16" },
            { "subset", 32, "32" }, { "subset", 64, "64" } },
        { "off", filter });
    const std::vector<Plan::Column> mis { { "subset", 8, "no MIS" }, { "subset_mis", 8, "MIS" },
        { "subset_mis_blue", 8, "MIS, blue offsets (ours)" } };
    plan.add({ "Figure 47-5: with and without multiple importance sampling, beside lamps",
                 "Close to an emitter its points contribute very differently, which light sampling cannot predict, but "
                 "BSDF sampling can.",
                 0, {}, 0.5, 0.5, 1 },
        beside_lamps, mis, { "off", filter });
    plan.add({ "Figure 47-6: with and without multiple importance sampling, glossy surfaces",
                 "In highlights BSDF sampling finds the emitter; the pseudo-marginal weights keep the mean right.", 0,
                 {}, 0.5, 0.5, 1 },
        glossy_floor, mis, { "off", filter });
    plan.add({ "Figure 47-7: how the error is spread over the pixels",
                 "Stratified subsets keep the blue noise of their random numbers; independent offsets make the error "
                 "white; one shared offset keeps it blue but is biased; offsets with a mask each keep it blue and "
                 "unbiased. The ratio of low to high frequencies is 1 for white noise.",
                 0, {}, 0.4, 0.6, 4 },
        many_lights,
        { { "subset", 8, "no MIS" }, { "subset_mis", 8, "MIS" }, { "subset_mis_biased", 8, "MIS, biased" },
            { "subset_mis_blue", 8, "MIS, blue offsets (ours)" } },
        { "off" });
    FigurePlan result = plan.take();
    check_samplers(result, module);
    return result;
}

std::vector<Figure> plan_plain_figures(const std::vector<FigureScene>& scenes)
{
    std::vector<Figure> figures;
    for (size_t i = 0; i < scenes.size(); i++) {
        Figure figure;
        figure.is_free = true;
        figure.title = scenes[i].scene;
        figure.text = "Select the pictures to compare in the table below.";
        figure.scene = i;
        figure.rows.emplace_back();
        for (size_t v = 0; v < std::min(scenes[i].variants.size(), plain_columns); v++)
            figure.rows[0].push_back({ scenes[i].variants[v].label(), scenes[i].variants[v].label() });
        figure.rows[0].push_back({ "", "reference" });
        figures.push_back(std::move(figure));
    }
    return figures;
}

} // namespace vkpt::client
