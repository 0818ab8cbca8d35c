#include "host/study/converge/converge_store.h"

#include "host/base/atomic_file.h"
#include "host/base/json_numbers.h"
#include "host/base/regular_file.h"
#include "host/report/json_file.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

namespace reradiant {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr const char* identity_attribute = "reradiant:studyIdentity";
constexpr const char* estimate_attribute = "reradiant:relmseEstimate";

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}
double number_or(const Json& json, double otherwise) {
    return json.is_number() ? json.get<double>() : otherwise;
}

Json row_json(const CurveRow& row) {
    return {{"seconds", row.seconds},
            {"seconds_with_setup", row.seconds_with_setup},
            {"spp", row.samples},
            {"relmse", row.error.relmse},
            {"relmse_srgb", row.error.relmse_srgb},
            {"rmse", row.error.rmse},
            {"ciede2000", row.error.ciede2000},
            {"bias", row.error.bias},
            {"bias_stderr", finite_or_null(row.error.bias_stderr)},
            {"estimate", estimate_json(row.estimate)}};
}

CurveRow row_from_json(const Json& json) {
    CurveRow row;
    row.seconds = json.at("seconds").get<double>();
    row.seconds_with_setup = json.at("seconds_with_setup").get<double>();
    row.samples = whole_number<std::uint32_t>(json.at("spp"));
    row.error.relmse = json.at("relmse").get<double>();
    row.error.relmse_srgb = json.at("relmse_srgb").get<double>();
    row.error.rmse = json.at("rmse").get<double>();
    row.error.ciede2000 = json.at("ciede2000").get<double>();
    row.error.bias = json.at("bias").get<double>();
    row.error.bias_stderr =
        number_or(json.at("bias_stderr"), std::numeric_limits<double>::quiet_NaN());
    row.estimate = estimate_from_json(json.at("estimate"));
    return row;
}

/// Reads rows whose seconds and samples grow; none when they do not, as in a file that somebody
/// else wrote.
std::vector<CurveRow> rows_from_json(const Json& json) {
    std::vector<CurveRow> rows;
    CurveRow last;
    for (const Json& one : json) {
        const CurveRow row = row_from_json(one);
        if (row.seconds <= last.seconds || row.samples <= last.samples)
            return {};
        last = rows.emplace_back(row);
    }
    return rows;
}

fs::path method_file(const fs::path& folder, const RenderMethod& method, const char* ending) {
    return folder / "methods" / (method.file_stem() + ending);
}

Json optional_json(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

Json fits_json(const ErrorCurve& curve, const RelmseEstimate& reference) {
    const BiasFloor floor = bias_floor(curve, reference);
    Json json = {{"slope_rmse_over_spp", finite_or_null(slope_over_samples(curve))},
                 {"slope_relmse_over_seconds", finite_or_null(slope_over_seconds(curve))},
                 {"efficiency", finite_or_null(efficiency(curve))},
                 {"seconds_to_relmse_1e-2", optional_json(seconds_to_reach(curve, 1e-2))},
                 {"seconds_to_relmse_1e-3", optional_json(seconds_to_reach(curve, 1e-3))}};
    json["bias_floor"] = {{"relmse", floor.relmse},
                          {"smallest_visible", floor.smallest_visible},
                          {"seconds", optional_json(floor.seconds)}};
    return json;
}

} // namespace

Json estimate_json(const RelmseEstimate& estimate) {
    return {{"relmse", finite_or_null(estimate.value)},
            {"low", estimate.low},
            {"high", finite_or_null(estimate.high)}};
}

RelmseEstimate estimate_from_json(const Json& json) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    return {number_or(json.at("relmse"), infinite), number_or(json.at("low"), 0.0),
            number_or(json.at("high"), infinite)};
}

Json curve_json(const ErrorCurve& curve) {
    Json json = {{"method", curve.method.name},          {"model", model_name(curve.method.model)},
                 {"comb", curve.method.comb_count},      {"hero", curve.method.hero_count},
                 {"adaptive", curve.method.adaptive},    {"setup_seconds", curve.setup_seconds},
                 {"build_seconds", curve.build_seconds}, {"rows", Json::array()}};
    for (const CurveRow& row : curve.rows)
        json["rows"].push_back(row_json(row));
    return json;
}

void keep_method(const fs::path& folder, const std::string& identity, const MethodResult& result) {
    fs::create_directories(folder / "methods");
    write_spectral_exr(method_image(folder, result.curve.method), result.image);
    Json json = {{"identity", identity}};
    json.update(curve_json(result.curve));
    write_json(method_file(folder, result.curve.method, ".json"), json); // last: it says "done"
    std::error_code ignored;
    fs::remove(method_file(folder, result.curve.method, ".rows.json"), ignored);
}

fs::path method_image(const fs::path& folder, const RenderMethod& method) {
    return method_file(folder, method, ".exr");
}

void keep_rows(const fs::path& folder, const std::string& identity, const ErrorCurve& curve) {
    Json json = {{"identity", identity}};
    json.update(curve_json(curve));
    fs::create_directories(folder / "methods");
    write_json(method_file(folder, curve.method, ".rows.json"), json);
}

std::vector<CurveRow> kept_rows(const fs::path& folder, const std::string& identity,
                                const RenderMethod& method) {
    std::ifstream stream = open_regular_file(method_file(folder, method, ".rows.json"));
    const Json json = Json::parse(stream, nullptr, false);
    try {
        if (json.is_object() && json.at("identity") == identity)
            return rows_from_json(json.at("rows"));
    } catch (const Json::exception&) { // none, as below
    }
    return {};
}

std::optional<MethodResult> kept_method(const fs::path& folder, const std::string& identity,
                                        const RenderMethod& method) {
    std::ifstream stream = open_regular_file(method_file(folder, method, ".json"));
    const Json json = Json::parse(stream, nullptr, false);
    try {
        if (!json.is_object() || json.at("identity") != identity)
            return std::nullopt;
        MethodResult result;
        result.resumed = true;
        result.curve.method = method;
        result.curve.setup_seconds = json.at("setup_seconds").get<double>();
        result.curve.build_seconds = json.at("build_seconds").get<double>();
        result.curve.rows = rows_from_json(json.at("rows"));
        if (result.curve.rows.empty())
            return std::nullopt;
        result.image = read_spectral_exr(method_image(folder, method));
        return result;
    } catch (const Json::exception&) {
        return std::nullopt;
    } catch (const Error&) {
        return std::nullopt; // the image is damaged or gone
    }
}

void keep_reference(const fs::path& folder, Reference& reference) {
    fs::create_directories(folder);
    reference.file = folder / "reference.exr";
    reference.image.attributes[identity_attribute] = reference.identity;
    reference.image.attributes[estimate_attribute] = estimate_json(reference.estimate).dump();
    write_spectral_exr(reference.file, reference.image);
}

std::optional<Reference> kept_reference(const fs::path& folder, const std::string& identity) {
    Reference reference;
    reference.file = folder / "reference.exr";
    reference.identity = identity;
    std::error_code ignored;
    if (!fs::exists(reference.file, ignored))
        return std::nullopt;
    try {
        reference.image = read_spectral_exr(reference.file);
        const auto& attributes = reference.image.attributes;
        const auto kept = attributes.find(identity_attribute);
        if (kept == attributes.end() || kept->second != identity)
            return std::nullopt;
        reference.estimate = estimate_from_json(Json::parse(attributes.at(estimate_attribute)));
        return reference;
    } catch (const std::exception&) {
        return std::nullopt; // damaged: it is rendered again
    }
}

void write_curves_csv(const fs::path& file, const ConvergeResult& result) {
    std::string text = "method,seconds,seconds_with_setup,spp,relmse,relmse_srgb,rmse,ciede2000,"
                       "bias,bias_stderr\n";
    for (const MethodResult& method : result.methods)
        for (const CurveRow& row : method.curve.rows)
            text +=
                fmt::format("{},{:.9g},{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n",
                            method.curve.method.name, row.seconds, row.seconds_with_setup,
                            row.samples, row.error.relmse, row.error.relmse_srgb, row.error.rmse,
                            row.error.ciede2000, row.error.bias, row.error.bias_stderr);
    write_text_atomically(file, text);
}

Json converge_json(const ConvergeResult& result, const Scene& scene, const Device& device,
                   double time_seconds) {
    Json json = {{"scene", scene.file.filename().string()},
                 {"scene_hash", scene.hash},
                 {"device", device.info().name},
                 {"seed", result.seed},
                 {"time_seconds", time_seconds},
                 {"reference",
                  {{"file", result.reference.file.filename().string()},
                   {"estimate", estimate_json(result.reference.estimate)}}},
                 {"interrupted", result.interrupted},
                 {"methods", Json::array()}};
    for (const MethodResult& method : result.methods) {
        Json entry = curve_json(method.curve);
        entry.update(fits_json(method.curve, result.reference.estimate));
        json["methods"].push_back(entry);
    }
    return json;
}

} // namespace reradiant
