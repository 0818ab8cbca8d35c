#include "host/check/check.h"

#include "host/base/regular_file.h"
#include "host/report/json_file.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <cmath>

namespace reradiant {

namespace {

constexpr const char* format_name = "reradiant-check-1";

/// JSON has no infinity: what has no budget is null.
nlohmann::ordered_json numbers(const std::vector<float>& values) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const float value : values)
        list.push_back(std::isfinite(value) ? nlohmann::ordered_json(static_cast<double>(value))
                                            : nlohmann::ordered_json());
    return list;
}

std::vector<float> numbers_of(const nlohmann::json& list) {
    std::vector<float> values;
    for (const nlohmann::json& value : list)
        values.push_back(value.is_null() ? std::numeric_limits<float>::infinity()
                                         : value.get<float>());
    return values;
}

nlohmann::json functions_of(const std::filesystem::path& file) {
    std::ifstream stream = open_regular_file(file);
    if (!stream)
        throw_input_error({file.string()}, "cannot be opened",
                          "name a file that `reradiant check --save` wrote");
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
    const auto holds = [&](const char* key) { return json.is_object() && json.contains(key); };
    if (!holds("format") || json.at("format") != format_name || !holds("functions") ||
        !json.at("functions").is_object())
        throw_input_error({file.string()}, "holds no results of `reradiant check`",
                          "name a file that `reradiant check --save` wrote");
    return json.at("functions");
}

/// Largest movement over what both runs may be off; sizes are equal.
double movement(const CheckSample& now, const CheckSample& then) {
    double worst = 0.0;
    for (std::size_t i = 0; i < now.results.size(); ++i) {
        const double budget =
            static_cast<double>(now.budgets[i]) + static_cast<double>(then.budgets[i]);
        const double moved =
            std::fabs(static_cast<double>(now.results[i]) - static_cast<double>(then.results[i]));
        if (moved > 0.0 && !std::isinf(budget))
            worst = std::max(worst, moved / budget);
    }
    return worst;
}

void compare_function(FunctionReport& function, const SavedResults& saved) {
    const std::string file = saved.file.string();
    const auto entry = saved.functions.find(function.name);
    if (entry == saved.functions.end()) {
        function.failures.push_back(fmt::format("{} does not hold it", file));
        return;
    }
    const CheckSample& then = entry->second;
    if (then.results.size() != function.sample.results.size() ||
        then.budgets.size() != function.sample.budgets.size()) {
        function.failures.push_back(
            fmt::format("{} holds other inputs; save it anew with the same --samples", file));
        return;
    }
    const double moved = movement(function.sample, then);
    if (moved > 1.0)
        function.failures.push_back(
            fmt::format("results moved by {:.3g} of their budgets since {}", moved, file));
}

} // namespace

void save_results(const std::filesystem::path& file, const Device& device,
                  const CheckReport& report) {
    nlohmann::ordered_json functions = nlohmann::ordered_json::object();
    for (const FunctionReport& function : report.functions)
        functions[function.name] = {{"results", numbers(function.sample.results)},
                                    {"budgets", numbers(function.sample.budgets)}};
    write_json(file, {{"format", format_name},
                      {"device", device.info().name},
                      {"driver", device.info().driver},
                      {"functions", functions}});
}

SavedResults read_saved_results(const std::filesystem::path& file) {
    SavedResults saved{file, {}};
    const nlohmann::json functions = functions_of(file);
    try {
        for (const auto& [name, entry] : functions.items())
            saved.functions[name] = {numbers_of(entry.at("results")),
                                     numbers_of(entry.at("budgets"))};
    } catch (const nlohmann::json::exception& error) {
        throw_input_error({file.string()}, fmt::format("is damaged: {}", error.what()),
                          "save it anew with `reradiant check --save`");
    }
    return saved;
}

void compare_results(const SavedResults& saved, CheckReport& report) {
    for (FunctionReport& function : report.functions)
        compare_function(function, saved);
}

} // namespace reradiant
