// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/compare/report.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;

// Infinite and undefined numbers have no place in JSON.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(); }

Json make_row(const SceneResult& scene, const VariantResult& result)
{
    return { { "scene", scene.scene }, { "frame", scene.frame }, { "sampler", result.variant.sampler },
        { "subset", result.variant.subset ? Json(*result.variant.subset) : Json() }, { "noise", result.variant.noise },
        { "denoiser", result.variant.denoiser }, { "spp", result.samples }, { "rmse", number(result.error.rmse) },
        { "rel_mse", number(result.error.relative_mse) }, { "flip", number(result.flip) },
        { "bias", number(result.bias.mean) }, { "bias_ci95", number(result.bias.interval) },
        { "spectrum_low_high", result.spectrum.power.empty() ? Json() : number(result.spectrum.low_to_high()) },
        { "flicker", number(result.flicker) }, { "ms", result.ms > 0 ? Json(result.ms) : Json() } };
}

Json make_details(const VariantResult& result)
{
    Json curve = Json::array();
    for (const CurvePoint& point : result.curve)
        curve.push_back({ { "spp", point.samples }, { "rmse", number(point.rmse) } });
    return { { "variant", result.variant.label() }, { "equal_time_spp", number(result.equal_time_samples) },
        { "equal_time_rmse", number(result.equal_time_rmse) }, { "local_bias", number(result.local_bias.rms) },
        { "local_bias_excess", number(result.local_bias.excess) }, { "light_ms", number(result.light_ms) },
        { "light_ratio", number(result.light_ratio) }, { "curve", curve }, { "spectrum", result.spectrum.power } };
}

Json make_reference_data(const Reference& reference)
{
    return { { "spp", reference.samples }, { "sampler", reference.sampler }, { "rmse", number(reference.rmse) },
        { "mean_ci95", number(reference.mean_interval) }, { "cached", reference.was_cached } };
}

Json make_scene(const SceneResult& scene)
{
    Json json { { "scene", scene.scene }, { "frame", scene.frame },
        { "reference", make_reference_data(scene.reference) } };
    if (scene.centre_reference)
        json["centre_reference"] = make_reference_data(*scene.centre_reference);
    json["exposure"] = number(double(scene.exposure));
    json["device"] = scene.device;
    json["driver"] = scene.driver;
    json["trace_backend"] = scene.trace_backend;
    json["notes"] = scene.notes;
    return json;
}

// RFC 4180.
std::string csv_field(const Json& value)
{
    if (value.is_null())
        return "";
    if (value.is_number_float())
        return fmt::format("{:.6g}", value.get<double>());
    if (!value.is_string())
        return value.dump();
    std::string text = value.get<std::string>();
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    for (size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
        text.insert(at, 1, '"');
    return '"' + text + '"';
}

} // namespace

std::string make_json(const Report& report)
{
    Json json { { "schema", report_schema }, { "command", report.command },
        { "size", fmt::format("{}x{}", report.size.width, report.size.height) }, { "settings", report.settings },
        { "runs", report.options.runs }, { "frames", report.options.frames }, { "warmup", report.options.warmup } };
    json["scenes"] = json["rows"] = json["details"] = Json::array();
    for (const SceneResult& scene : report.scenes) {
        json["scenes"].push_back(make_scene(scene));
        for (const VariantResult& result : scene.variants) {
            json["rows"].push_back(make_row(scene, result));
            json["details"].push_back(make_details(result));
        }
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string make_csv(const Report& report)
{
    std::string text;
    const auto add_line = [&](const std::vector<std::string>& fields) {
        for (size_t i = 0; i < fields.size(); i++)
            text += (i ? "," : "") + fields[i];
        text += "\r\n";
    };
    for (const SceneResult& scene : report.scenes)
        for (const VariantResult& result : scene.variants) {
            std::vector<std::string> names, values;
            const Json row = make_row(scene, result);
            for (const auto& [name, value] : row.items()) {
                names.push_back(name);
                values.push_back(csv_field(value));
            }
            if (text.empty())
                add_line(names);
            add_line(values);
        }
    return text;
}

} // namespace vkpt::client
