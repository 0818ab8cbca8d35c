#include "host/measure/walk_states.h"

#include "host/base/json_numbers.h"
#include "reradiant/error.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

using Json = nlohmann::json;

Json walk_states_json(const std::vector<WalkState>& states) {
    Json list = Json::array();
    for (const WalkState& state : states)
        list.push_back({state.blocks, state.walks, state.numbers});
    return list;
}

std::vector<WalkState> walk_states_from(const Json& list) {
    std::vector<WalkState> states;
    try {
        for (const Json& state : list)
            states.push_back({whole_number<std::uint64_t>(state.at(0)),
                              whole_number<std::uint64_t>(state.at(1)),
                              state.at(2).get<std::vector<double>>()});
    } catch (const Json::exception& error) {
        throw_input_error({}, std::string("holds no walks to go on from: ") + error.what(),
                          "remove it and begin anew");
    }
    for (const WalkState& state : states)
        if (!std::all_of(state.numbers.begin(), state.numbers.end(),
                         [](double number) { return std::isfinite(number); }))
            throw_input_error({}, "holds sums that are not finite", "remove it and begin anew");
    return states;
}

} // namespace reradiant
