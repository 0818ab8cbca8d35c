#include "tests/scene/scratch.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <mutex>

namespace reradiant::testing {

namespace {

class CollectingSink : public spdlog::sinks::base_sink<std::mutex> {
public:
    std::vector<std::string> messages;

protected:
    void sink_it_(const spdlog::details::log_msg& message) override {
        if (message.level == spdlog::level::warn)
            messages.emplace_back(message.payload.begin(), message.payload.end());
    }
    void flush_() override {}
};

} // namespace

const char* const SMALL_SCENE = R"([film]
width = 8
height = 4
[camera]
origin = [0, 0, 5]
target = [0, 0, 0]
[[light]]
type = "environment"
radiance = 1
[[material]]
name = "grey"
[material.substrate]
type = "lambert"
reflectance = 0.5
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "grey"
)";

Caught error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return {true,
                error.exit_code(),
                error.position().line,
                error.position().column,
                error.position().file,
                error.what()};
    }
    ADD_FAILURE() << "no Error was thrown";
    return {};
}

std::vector<std::string> warnings_of(const std::function<void()>& action) {
    const auto sink = std::make_shared<CollectingSink>();
    const auto previous = spdlog::default_logger();
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
    action();
    spdlog::set_default_logger(previous);
    return sink->messages;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos)
        ADD_FAILURE() << "\"" << from << "\" does not occur";
    else
        text.replace(at, from.size(), to);
    return text;
}

} // namespace reradiant::testing
