#include "reradiant/adding.h"

#include "host/layers/angular/angular_system.h"
#include "host/layers/angular/angular_transport.h"
#include "host/layers/smooth/smooth_transport.h"
#include "host/layers/stack/stack_check.h"
#include "reradiant/error.h"

#include <deque>
#include <mutex>

namespace reradiant {

namespace {

/// The last transports of stacks that scatter: a grey material asks for the same one at every
/// wavelength.
class RecentTransports {
public:
    std::shared_ptr<const AddingTransport> find(const StackValues& stack) {
        const std::scoped_lock lock(mutex_);
        for (const auto& [known, transport] : recent_)
            if (known == stack)
                return transport;
        return nullptr;
    }
    void remember(const StackValues& stack, std::shared_ptr<const AddingTransport> transport) {
        const std::scoped_lock lock(mutex_);
        recent_.emplace_front(stack, std::move(transport));
        if (recent_.size() > 64)
            recent_.pop_back();
    }

private:
    std::mutex mutex_;
    std::deque<std::pair<StackValues, std::shared_ptr<const AddingTransport>>> recent_;
};

constexpr const char* flakes_reason = "adding does not know flakes";
constexpr const char* film_reason = "adding does not know films on rough interfaces";

bool has_rough_film(const StackValues& stack, std::size_t index) {
    return stack[index].film.thickness_nm > 0.0 && is_rough_interface(stack, index);
}

} // namespace

std::optional<std::string> adding_refusal(const LayerStack& stack) {
    for (const Layer& layer : stack.layers) {
        if (layer.flakes && layer.flakes->coverage > 0.0)
            return flakes_reason;
        if (layer.film && layer.film->thickness_nm > 0.0 && layer.alpha > 0.0)
            return film_reason;
    }
    return std::nullopt;
}

std::shared_ptr<const AddingTransport> adding_transport(const StackValues& stack) {
    check_stack(stack);
    bool scatters = false;
    for (std::size_t k = 0; k < stack.size(); ++k) {
        if (stack[k].flake_coverage > 0.0 || has_rough_film(stack, k)) {
            throw_input_error({}, stack[k].flake_coverage > 0.0 ? flakes_reason : film_reason,
                              "use the model walk or weidlich-wilkie");
        }
        scatters = scatters || is_rough_interface(stack, k) || stack[k].tau_scattering > 0.0;
    }
    if (!scatters)
        return smooth_transport(stack);
    static RecentTransports recent;
    if (auto known = recent.find(stack))
        return known;
    auto transport = angular_transport(stack);
    recent.remember(stack, transport);
    return transport;
}

} // namespace reradiant
