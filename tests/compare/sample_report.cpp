// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/compare/sample_report.hpp"

#include <limits>

namespace vkpt::tests {

using namespace vkpt::client;

namespace {

analysis::LinearImage make_ramp(float step)
{
    analysis::LinearImage image = analysis::make_image(8, 6);
    for (size_t i = 0; i < image.rgb.size(); i++)
        image.rgb[i] = float(i % 24) * step;
    return image;
}

VariantResult make_result(const Variant& variant, double rmse)
{
    VariantResult result;
    result.variant = variant;
    result.error = { rmse, 2 * rmse, 0.01 };
    result.flip = rmse / 4;
    result.bias = { 0.01, rmse > 1 ? 0.002 : 0.02 };
    result.spectrum.power.assign(32, 1);
    result.spectrum.low = 0.5;
    result.spectrum.high = 1;
    result.flicker = 0.125;
    result.ms = 10 * rmse;
    result.light_ms = 7 * rmse;
    if (!variant.is_filtered()) {
        result.curve = { { 1, rmse }, { 2, rmse / 1.4 }, { 4, rmse / 2 } };
        result.equal_time_samples = 2;
        result.equal_time_rmse = rmse / 1.4;
    }
    result.picture = make_ramp(float(rmse) / 10);
    return result;
}

SceneResult make_scene(const char* name, int frame)
{
    SceneResult scene;
    scene.scene = name;
    scene.frame = frame;
    scene.reference.image = make_ramp(0.02f);
    scene.reference.samples = 1024;
    scene.reference.sampler = "subset_mis";
    scene.reference.rmse = 0.03;
    scene.centre_reference = scene.reference;
    scene.device = "a device <of> paper";
    scene.variants = { make_result(make_variant("subset", 8), 1.5), make_result(make_variant("subset", 64), 0.5),
        make_result(make_variant("uniform"), 4), make_result(make_variant("subset", 8, "asvgf"), 0.25) };
    scene.variants[2].bias.interval = std::numeric_limits<double>::infinity();
    scene.variants[3].ms = 0;
    return scene;
}

} // namespace

Report make_sample_report()
{
    Report report;
    report.command = "vkpt compare a b";
    report.size = { 8, 6 };
    report.scenes = { make_scene("maps/a.bsp@1,2,3,0,90", 0), make_scene("b \"</script><b>\".rtrace", 12) };
    std::vector<FigureScene> scenes;
    for (const SceneResult& scene : report.scenes) {
        scenes.push_back({ scene.scene, {} });
        for (const VariantResult& result : scene.variants)
            scenes.back().variants.push_back(result.variant);
    }
    report.figures = plan_plain_figures(scenes);
    return report;
}

} // namespace vkpt::tests
