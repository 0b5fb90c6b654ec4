// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/display.hpp"
#include "client/base64.hpp"
#include "client/compare/page_parts.hpp"
#include "client/compare/plot.hpp"
#include "client/compare/report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;

// The references' labels: this, and nothing.
constexpr const char* centre_reference = "centre";

std::string picture_name(size_t scene, const std::string& label) { return fmt::format("{}:{}", scene, label); }

std::string make_data_url(const analysis::LinearImage& image, float exposure)
{
    return "data:image/png;base64,"
        + encode_base64(formats::write_png(encode_display(map_to_display(image, exposure))));
}

std::string short_figures(const VariantResult& result)
{
    std::string text = fmt::format("RMSE {:.3f}, FLIP {:.3f}", result.error.rmse, result.flip);
    if (!result.spectrum.power.empty())
        text += fmt::format(", low/high {:.2f}", result.spectrum.low_to_high());
    return text;
}

std::string short_figures(const Reference& reference)
{
    return fmt::format("{} samples, its own RMSE {:.3f}", reference.samples, reference.rmse);
}

const VariantResult* find_variant(const SceneResult& scene, const std::string& label)
{
    for (const VariantResult& result : scene.variants)
        if (result.variant.label() == label)
            return &result;
    return nullptr;
}

Json make_figure_data(const Report& report, const Figure& figure)
{
    Json rows = Json::array();
    for (const std::vector<FigurePicture>& row : figure.rows) {
        Json items = Json::array();
        for (const FigurePicture& picture : row) {
            const SceneResult& scene = report.scenes[figure.scene];
            const VariantResult* result = find_variant(scene, picture.variant);
            const bool is_centre
                = scene.centre_reference && (result ? result->variant.is_filtered() : picture.is_centre);
            const Reference& reference = is_centre ? *scene.centre_reference : scene.reference;
            const std::string reference_name = picture_name(figure.scene, is_centre ? centre_reference : "");
            items.push_back({ { "picture", result ? picture_name(figure.scene, picture.variant) : reference_name },
                { "reference", reference_name }, { "caption", picture.caption },
                { "figures", result ? short_figures(*result) : short_figures(reference) } });
        }
        rows.push_back(std::move(items));
    }
    return { { "scene", figure.scene }, { "x", figure.x }, { "y", figure.y }, { "zoom", figure.zoom },
        { "free", figure.is_free }, { "rows", std::move(rows) } };
}

std::string make_data(const Report& report)
{
    Json data { { "figures", Json::array() }, { "pictures", Json::object() } };
    for (const Figure& figure : report.figures)
        data["figures"].push_back(make_figure_data(report, figure));
    for (size_t i = 0; i < report.scenes.size(); i++) {
        const SceneResult& scene = report.scenes[i];
        data["pictures"][picture_name(i, "")] = make_data_url(scene.reference.image, scene.exposure);
        if (scene.centre_reference)
            data["pictures"][picture_name(i, centre_reference)]
                = make_data_url(scene.centre_reference->image, scene.exposure);
        for (const VariantResult& result : scene.variants)
            data["pictures"][picture_name(i, result.variant.label())] = make_data_url(result.picture, scene.exposure);
    }
    std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
    // "</script>" inside would end the element.
    for (size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
        text.replace(at, 2, "<\\/");
    return text;
}

// ---- the table

struct Cell {
    std::string text, value; // value: what sorting goes by, where it is not the text
    const char* kind = "";
};
using MakeCell = Cell (*)(const SceneResult&, const VariantResult&);
struct Column {
    const char *name, *help;
    bool is_word;
    MakeCell make;
    bool lowest_is_best = false;
};

Cell number_cell(double value, int digits)
{
    if (!std::isfinite(value))
        return {};
    return { fmt::format("{:.{}f}", value, digits), fmt::format("{:.9g}", value) };
}

Cell bias_cell(const VariantResult& result)
{
    Cell cell = number_cell(100 * result.bias.mean, 2);
    cell.kind = std::abs(result.bias.mean) > result.bias.interval ? "biased" : "";
    return cell;
}

// Twice what chance explains would be a rare accident of so many blocks.
Cell local_bias_cell(const VariantResult& result)
{
    Cell cell = number_cell(100 * result.local_bias.rms, 2);
    cell.kind = result.local_bias.excess > 2 ? "biased" : "";
    return cell;
}

const Column columns[] = {
    { "scene", "", true, [](const SceneResult& s, const VariantResult&) { return Cell { s.scene }; } },
    { "frame", "", false, [](const SceneResult& s, const VariantResult&) { return Cell { std::to_string(s.frame) }; } },
    { "sampler", "pt_light_sampler", true,
        [](const SceneResult&, const VariantResult& r) { return Cell { r.variant.sampler }; } },
    { "subset", "pt_light_subset; empty: the sampler does not use it", false,
        [](const SceneResult&, const VariantResult& r) {
            return Cell { r.variant.subset ? std::to_string(*r.variant.subset) : "" };
        } },
    { "noise", "pt_noise", true, [](const SceneResult&, const VariantResult& r) { return Cell { r.variant.noise }; } },
    { "denoiser", "flt_denoiser", true,
        [](const SceneResult&, const VariantResult& r) { return Cell { r.variant.denoiser }; } },
    { "spp", "Samples per pixel of each picture; for filtered ones, of each frame after the warm-up frames", false,
        [](const SceneResult&, const VariantResult& r) { return Cell { std::to_string(r.samples) }; } },
    { "RMSE", "Root mean square error of luminance, divided by the mean of the reference", false,
        [](const SceneResult&, const VariantResult& r) { return number_cell(r.error.rmse, 4); }, true },
    { "rel. MSE", "Mean of error^2 / (reference^2 + 1e-4 mean^2), pixel by pixel", false,
        [](const SceneResult&, const VariantResult& r) { return number_cell(r.error.relative_mse, 3); }, true },
    { "FLIP", "Difference seen when flipping between picture and reference (Andersson et al. 2020): 0 none, 1 the most",
        false, [](const SceneResult&, const VariantResult& r) { return number_cell(r.flip, 4); }, true },
    { "bias %",
        "Difference of the means. Marked: outside its 95 % confidence interval, as one in twenty unbiased variants is",
        false, [](const SceneResult&, const VariantResult& r) { return bias_cell(r); } },
    { "± %", "Half of that interval, from the runs and the reference", false,
        [](const SceneResult&, const VariantResult& r) { return number_cell(100 * r.bias.interval, 2); } },
    { "local bias %",
        "Root mean square of the systematic error in blocks of 16 x 16 pixels, divided by the mean of the reference. "
        "Marked: "
        "more than twice the mean square that chance explains",
        false, [](const SceneResult&, const VariantResult& r) { return local_bias_cell(r); } },
    { "low/high",
        "Power of the relative error below 1/8 cycle per pixel divided by that above: white noise 1, blue noise less",
        false,
        [](const SceneResult&, const VariantResult& r) {
            return r.spectrum.power.empty() ? Cell() : number_cell(r.spectrum.low_to_high(), 3);
        } },
    { "flicker", "Root mean square change between frames that the reference does not have, divided by its mean", false,
        [](const SceneResult&, const VariantResult& r) { return number_cell(r.flicker, 4); }, true },
    { "ms", "Time of a frame's passes on the device: median", false,
        [](const SceneResult&, const VariantResult& r) { return r.ms > 0 ? number_cell(r.ms, 1) : Cell(); }, true },
    { "light ms", "direct_light and indirect_light alone: median", false,
        [](const SceneResult&, const VariantResult& r) { return r.light_ms > 0 ? number_cell(r.light_ms, 1) : Cell(); },
        true },
    { "ratio", "The same relative to the scene's first row: median over runs, which take turns", false,
        [](const SceneResult&, const VariantResult& r) {
            return r.light_ms > 0 ? number_cell(r.light_ratio, 3) : Cell();
        } },
    { "equal-time spp", "Samples that take as long as those of the scene's slowest unfiltered variant", false,
        [](const SceneResult&, const VariantResult& r) {
            return r.equal_time_samples ? number_cell(*r.equal_time_samples, 2) : Cell();
        } },
    { "equal-time RMSE", "RMSE with that many samples, from the measured curve", false,
        [](const SceneResult&, const VariantResult& r) {
            return r.equal_time_rmse ? number_cell(*r.equal_time_rmse, 4) : Cell();
        },
        true },
};

// The lowest number of a column among the unfiltered, or filtered, variants of a scene.
double lowest(const SceneResult& scene, const Column& column, bool is_filtered)
{
    double least = INFINITY;
    for (const VariantResult& result : scene.variants)
        if (const Cell cell = column.make(scene, result);
            result.variant.is_filtered() == is_filtered && !cell.text.empty())
            least = std::min(least, std::stod(cell.value));
    return least;
}

std::string make_table_row(const SceneResult& scene, size_t number, const VariantResult& result)
{
    const std::string label = escape_markup(result.variant.label());
    std::string row = fmt::format(
        R"(<tr><td><input type="checkbox" aria-label="show {0}" data-scene="{1}" data-picture="{1}:{0}" data-reference="{1}:{3}" data-caption="{0}" data-figures="{2}"></td>)",
        label, number, escape_markup(short_figures(result)),
        scene.centre_reference && result.variant.is_filtered() ? centre_reference : "");
    for (const Column& column : columns) {
        Cell cell = column.make(scene, result);
        if (column.lowest_is_best && !cell.text.empty()
            && std::stod(cell.value) == lowest(scene, column, result.variant.is_filtered()))
            cell.kind = "best";
        row += fmt::format(R"(<td class="{}{}")", column.is_word ? "word " : "", cell.kind);
        if (!cell.value.empty())
            row += fmt::format(R"( data-value="{}")", cell.value);
        row += ">" + escape_markup(cell.text) + "</td>";
    }
    return row + "</tr>\n";
}

std::string make_table(const Report& report)
{
    std::string table = "<div class=\"scroll\"><table id=\"rows\"><thead><tr><th></th>";
    for (const Column& column : columns)
        table += fmt::format(R"(<th data-column="{0}"{1} title="{2}">{0}</th>)", column.name,
            column.is_word ? " class=\"word\"" : "", escape_markup(column.help));
    table += "</tr></thead><tbody>\n";
    for (size_t i = 0; i < report.scenes.size(); i++)
        for (const VariantResult& result : report.scenes[i].variants)
            table += make_table_row(report.scenes[i], i, result);
    return table + "</tbody></table></div>\n";
}

std::string make_legend()
{
    std::string list = "<details><summary>What the columns mean</summary><dl>";
    for (const Column& column : columns)
        if (*column.help)
            list += fmt::format("<dt>{}</dt><dd>{}</dd>", column.name, escape_markup(column.help));
    return list
        + "</dl><p>Coloured: the lowest of its scene, among unfiltered and among filtered variants.</p></details>\n";
}

// ---- plots

std::string make_plots(const SceneResult& scene)
{
    Plot samples { "Error at equal samples", "samples per pixel", "RMSE / mean", {}, true, true };
    Plot time { "Error at equal time", "milliseconds", "RMSE / mean", {}, true, true };
    Plot spectrum { "Spectrum of the error", "cycles per pixel", "power, white = 1", {}, false, false, true };
    Plot cost { "What an error costs", "milliseconds a frame", "FLIP", {}, false, false };
    for (const VariantResult& result : scene.variants) {
        const std::string name = result.variant.label();
        PlotLine by_samples { name, {} }, by_time { name, {} }, power { name, {} };
        for (const CurvePoint& point : result.curve) {
            by_samples.points.push_back({ double(point.samples), point.rmse });
            by_time.points.push_back({ point.samples * result.ms, point.rmse });
        }
        const size_t bands = result.spectrum.power.size();
        for (size_t band = 0; band < bands; band++)
            if (result.spectrum.power[band] > 0
                && !result.variant.is_filtered()) // the lowest bands hold no frequency of a tile
                power.points.push_back({ (double(band) + 0.5) / double(2 * bands), result.spectrum.power[band] });
        samples.lines.push_back(std::move(by_samples));
        time.lines.push_back(std::move(by_time));
        spectrum.lines.push_back(std::move(power));
        cost.lines.push_back({ name, {} });
        if (result.ms > 0)
            cost.lines.back().points.push_back({ result.ms, result.flip });
    }
    return fmt::format("<h3>{}</h3>\n<div class=\"plots\">{}{}{}{}</div>\n", escape_markup(scene.scene),
        draw_plot(samples), draw_plot(time), draw_plot(spectrum), draw_plot(cost));
}

std::string make_references(const Report& report)
{
    std::string text = "<section id=\"references\"><h2>References</h2>\n";
    for (const SceneResult& scene : report.scenes) {
        const Reference& reference = scene.reference;
        text += fmt::format(
            "<p><strong>{}</strong>, frame {}: {} samples per pixel by <code>{}</code>. Its own RMSE is {:.4f} of its "
            "mean, from its two halves; its mean is known within ±{:.2f} % (95 %). Drawn by {} ({}), rays by {}.</p>\n",
            escape_markup(scene.scene), scene.frame, reference.samples, escape_markup(reference.sampler),
            reference.rmse, 100 * reference.mean_interval, escape_markup(scene.device), escape_markup(scene.driver),
            escape_markup(scene.trace_backend));
        if (scene.centre_reference)
            text += fmt::format(
                "<p>Filtered pictures are compared with a reference of the pixels' centres, as filters see them: "
                "{} samples, its own RMSE {:.4f}.</p>\n",
                scene.centre_reference->samples, scene.centre_reference->rmse);
        for (const std::string& note : scene.notes)
            text += "<p class=\"hint\">" + escape_markup(note) + "</p>\n";
    }
    return text + "</section>\n";
}

std::string make_figures(const Report& report)
{
    std::string text;
    for (size_t i = 0; i < report.figures.size(); i++)
        text += fmt::format(R"(<div class="viewer" data-figure="{}"><h3>{}</h3><p class="text">{}</p>
<p class="controls"><label><input type="checkbox" class="difference"> difference to the reference, 4 times amplified</label></p>
<div class="grid-of-pictures" tabindex="0" role="group" aria-label="{}"></div></div>
)",
            i, escape_markup(report.figures[i].title), escape_markup(report.figures[i].text),
            escape_markup(report.figures[i].title));
    return text;
}

std::string make_summary(const Report& report)
{
    return fmt::format(
        "{} x {} pixels; {} independent runs of every variant, in turns; flicker over {} frames, after {} "
        "warm-up frames for the filters.{} Pictures are shown with one exposure per scene; figures are of linear "
        "radiance.",
        report.size.width, report.size.height, report.options.runs, report.options.frames, report.options.warmup,
        report.settings.empty() ? "" : escape_markup(fmt::format(" Settings: {}.", fmt::join(report.settings, ", "))));
}

// Replaces {{name}} once; what is put in is not looked at again.
std::string fill_template(std::string_view page, const std::vector<std::pair<std::string, std::string>>& parts)
{
    std::string result;
    while (!page.empty()) {
        const size_t start = std::min(page.find("{{"), page.size());
        result += page.substr(0, start);
        page.remove_prefix(start);
        if (page.empty())
            break;
        const size_t end = page.find("}}");
        for (const auto& [name, text] : parts)
            if (page.substr(2, end - 2) == name)
                result += text;
        page.remove_prefix(end + 2);
    }
    return result;
}

} // namespace

std::string make_page(const Report& report)
{
    std::string plots;
    for (const SceneResult& scene : report.scenes)
        plots += make_plots(scene);
    return fill_template(page_html,
        { { "style", page_css }, { "command", escape_markup(report.command) }, { "summary", make_summary(report) },
            { "references", make_references(report) }, { "figures", make_figures(report) },
            { "table", make_table(report) }, { "legend", make_legend() }, { "plots", plots },
            { "data", make_data(report) }, { "program", page_js } });
}

} // namespace vkpt::client
