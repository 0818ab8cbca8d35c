#include "host/fit/solver/solve_journal.h"

#include "host/base/json_numbers.h"
#include "reradiant/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reradiant {

namespace {

using Json = nlohmann::json;

Json vector_json(const Eigen::VectorXd& values) {
    return std::vector<double>(values.begin(), values.end());
}
Eigen::VectorXd vector_from(const Json& json) {
    const auto values = json.get<std::vector<double>>();
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
}

Json state_json(const SolveState& state) {
    const SolveTrace& trace = state.trace;
    return {{"start", vector_json(state.start)},
            {"parameters", vector_json(state.parameters)},
            {"cost", trace.cost},
            {"seconds_at", trace.seconds},
            {"iterations", trace.iterations},
            {"kkt", trace.kkt},
            {"converged", trace.converged},
            {"stop_reason", trace.stop_reason},
            {"damping", state.damping},
            {"damping_growth", state.damping_growth},
            {"seconds", state.seconds},
            {"idle_steps", state.idle_steps},
            {"is_done", state.is_done}};
}

[[noreturn]] void refuse(const std::string& why) {
    throw_input_error({}, "holds no steps to go on from: " + why, "remove it and begin anew");
}

bool all_finite(const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(),
                       [](double value) { return std::isfinite(value); });
}

void check(const SolveState& state) {
    const SolveTrace& trace = state.trace;
    if (state.parameters.size() != state.start.size() || trace.cost.size() != trace.seconds.size())
        refuse("there are more numbers of one kind than of the other");
    if (!state.start.allFinite() || !state.parameters.allFinite() || !all_finite(trace.cost) ||
        !all_finite(trace.seconds) ||
        !all_finite({state.damping, state.damping_growth, state.seconds}))
        refuse("some of their numbers are not finite");
    if (trace.iterations < 0 || trace.cost.size() != static_cast<std::size_t>(trace.iterations))
        refuse("there are more steps than costs, or fewer");
}

SolveState state_from(const Json& json) {
    SolveState state;
    state.start = vector_from(json.at("start"));
    state.parameters = vector_from(json.at("parameters"));
    json.at("cost").get_to(state.trace.cost);
    json.at("seconds_at").get_to(state.trace.seconds);
    state.trace.iterations = whole_number<int>(json.at("iterations"));
    json.at("kkt").get_to(state.trace.kkt);
    json.at("converged").get_to(state.trace.converged);
    json.at("stop_reason").get_to(state.trace.stop_reason);
    json.at("damping").get_to(state.damping);
    json.at("damping_growth").get_to(state.damping_growth);
    json.at("seconds").get_to(state.seconds);
    state.idle_steps = whole_number<int>(json.at("idle_steps"));
    json.at("is_done").get_to(state.is_done);
    check(state);
    return state;
}

} // namespace

SolveJournal::SolveJournal(const Json& json) {
    try {
        *this = SolveJournal(json, shared_);
    } catch (const Json::exception& error) {
        refuse(error.what());
    }
}

SolveJournal::SolveJournal(const Json& json, std::shared_ptr<Shared> shared)
    : shared_(std::move(shared)) {
    for (const Json& one : json.at("solves"))
        solves_.push_back(state_from(one));
    for (const Json& one : json.at("branches"))
        branches_.push_back(std::unique_ptr<SolveJournal>(new SolveJournal(one, shared_)));
}

Json SolveJournal::json() const {
    Json solves = Json::array(), branches = Json::array();
    for (const SolveState& state : solves_)
        solves.push_back(state_json(state));
    for (const auto& branch : branches_)
        branches.push_back(branch->json());
    return {{"solves", solves}, {"branches", branches}};
}

SolveProgress SolveJournal::progress() const {
    SolveProgress sum;
    for (const SolveState& state : solves_) {
        ++sum.minimisations;
        sum.finished += state.is_done ? 1 : 0;
        sum.iterations += state.trace.iterations;
    }
    for (const auto& branch : branches_) {
        const SolveProgress more = branch->progress();
        sum.minimisations += more.minimisations;
        sum.finished += more.finished;
        sum.iterations += more.iterations;
    }
    return sum;
}

SolveState SolveJournal::begin(const Eigen::VectorXd& start) {
    const std::lock_guard lock(shared_->mutex);
    if (begun_ == solves_.size())
        solves_.push_back({start, start, {}, 0.0, 0.0, 0.0, 0, false});
    const SolveState& state = solves_[begun_++];
    if (state.start.size() != start.size() || (state.start.array() != start.array()).any())
        throw_runtime_error("the steps to go on from are those of another fit");
    return state;
}

void SolveJournal::note(SolveState state) {
    const std::lock_guard lock(shared_->mutex);
    solves_[begun_ - 1] = std::move(state);
    if (shared_->after_step)
        shared_->after_step();
}

SolveJournal& SolveJournal::branch() {
    const std::lock_guard lock(shared_->mutex);
    if (branched_ == branches_.size()) {
        branches_.push_back(std::make_unique<SolveJournal>());
        branches_.back()->shared_ = shared_;
    }
    return *branches_[branched_++];
}

void SolveJournal::set_after_step(std::function<void()> after_step) {
    const std::lock_guard lock(shared_->mutex);
    shared_->after_step = std::move(after_step);
}

} // namespace reradiant
