#include "components/dds/LifecycleServer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "types/text/ConfigError.hpp"

namespace insonify::dds {

/** A transition between two states, by ROS's numbers. */
struct LifecycleServer::Edge {
    uint8_t id;
    const char* label;
    uint8_t start, goal;
};

namespace {

/** lifecycle_msgs/msg/State. */
struct StateId {
    static constexpr uint8_t unknown = 0, unconfigured = 1, inactive = 2, active = 3, finalized = 4, configuring = 10,
                             cleaning_up = 11, shutting_down = 12, activating = 13, deactivating = 14,
                             error_processing = 15;
};
/** lifecycle_msgs/msg/Transition. */
struct TransitionId {
    static constexpr uint8_t configure = 1, cleanup = 2, activate = 3, deactivate = 4, unconfigured_shutdown = 5,
                             inactive_shutdown = 6, active_shutdown = 7, error_success = 60;
};

constexpr std::array<std::pair<uint8_t, const char*>, 11> lifecycle_states{
    {{StateId::unknown, "unknown"},
     {StateId::unconfigured, "unconfigured"},
     {StateId::inactive, "inactive"},
     {StateId::active, "active"},
     {StateId::finalized, "finalized"},
     {StateId::configuring, "configuring"},
     {StateId::cleaning_up, "cleaningup"},
     {StateId::shutting_down, "shuttingdown"},
     {StateId::activating, "activating"},
     {StateId::deactivating, "deactivating"},
     {StateId::error_processing, "errorprocessing"}}};

ros::State getState(uint8_t id) {
    const auto found = std::ranges::find(lifecycle_states, id, &std::pair<uint8_t, const char*>::first);
    return {id, found == lifecycle_states.end() ? "" : found->second};
}

/** The labels of what a transition ends with. */
struct Ending {
    static constexpr const char *success = "transition_success", *failure = "transition_failure",
                                *error = "transition_error";
};

}  // namespace

/** The state machine of rcl_lifecycle (default_state_machine.c), in its order. */
std::span<const LifecycleServer::Edge> LifecycleServer::graph() {
    static constexpr Edge edges[] = {
        {TransitionId::configure, "configure", StateId::unconfigured, StateId::configuring},
        {10, Ending::success, StateId::configuring, StateId::inactive},
        {11, Ending::failure, StateId::configuring, StateId::unconfigured},
        {12, Ending::error, StateId::configuring, StateId::error_processing},
        {TransitionId::cleanup, "cleanup", StateId::inactive, StateId::cleaning_up},
        {20, Ending::success, StateId::cleaning_up, StateId::unconfigured},
        {21, Ending::failure, StateId::cleaning_up, StateId::inactive},
        {22, Ending::error, StateId::cleaning_up, StateId::error_processing},
        {TransitionId::activate, "activate", StateId::inactive, StateId::activating},
        {30, Ending::success, StateId::activating, StateId::active},
        {31, Ending::failure, StateId::activating, StateId::inactive},
        {32, Ending::error, StateId::activating, StateId::error_processing},
        {TransitionId::deactivate, "deactivate", StateId::active, StateId::deactivating},
        {40, Ending::success, StateId::deactivating, StateId::inactive},
        {41, Ending::failure, StateId::deactivating, StateId::active},
        {42, Ending::error, StateId::deactivating, StateId::error_processing},
        {TransitionId::unconfigured_shutdown, "shutdown", StateId::unconfigured, StateId::shutting_down},
        {TransitionId::inactive_shutdown, "shutdown", StateId::inactive, StateId::shutting_down},
        {TransitionId::active_shutdown, "shutdown", StateId::active, StateId::shutting_down},
        {50, Ending::success, StateId::shutting_down, StateId::finalized},
        {51, Ending::failure, StateId::shutting_down, StateId::finalized},
        {52, Ending::error, StateId::shutting_down, StateId::error_processing},
        {TransitionId::error_success, Ending::success, StateId::error_processing, StateId::unconfigured},
        {61, Ending::failure, StateId::error_processing, StateId::finalized},
        {62, Ending::error, StateId::error_processing, StateId::finalized}};
    return edges;
}

ros::TransitionDescription LifecycleServer::described(const Edge& edge) {
    return {{edge.id, edge.label}, getState(edge.start), getState(edge.goal)};
}

const LifecycleServer::Edge* LifecycleServer::find(uint8_t state, uint8_t id, const std::string& label) {
    for (const Edge& edge : graph())
        if (edge.start == state && (label.empty() ? edge.id == id : edge.label == label)) return &edge;
    return nullptr;
}

LifecycleServer::LifecycleServer(NodeServer& server, std::string task, types::DeploymentControl& deployment,
                                 std::function<void(const std::string&)> report)
    : server_(server),
      task_(std::move(task)),
      deployment_(deployment),
      report_(std::move(report)),
      events_(server.node(), server.named("~/transition_event"), {.reliability = Reliability::Reliable, .depth = 10}),
      announced_(state()) {
    server_.serve(ros::change_state,
                  {[this](const auto& request, auto& response) { response.field = change(request.field); }});
    server_.serve(ros::get_state, {[this](const auto&, auto& response) { response.field = getState(state()); }});
    server_.serve(ros::get_available_states, {[](const auto&, auto& response) {
                      for (const auto& [id, label] : lifecycle_states) response.field.push_back({id, label});
                  }});
    server_.serve(ros::get_available_transitions, {[this](const auto&, auto& response) {
                      const uint8_t now = state();
                      for (const Edge& edge : graph())
                          if (edge.start == now) response.field.push_back(described(edge));
                  }});
    server_.serve(ros::get_transition_graph, {[](const auto&, auto& response) {
                      for (const Edge& edge : graph()) response.field.push_back(described(edge));
                  }});
    constexpr auto seldom = std::chrono::milliseconds(200);
    server_.every(seldom, [this] { watch(); });
}

uint8_t LifecycleServer::state() {
    static const std::map<std::string, uint8_t> of_tasks{{"PreOperational", StateId::unconfigured},
                                                         {"Stopped", StateId::inactive},
                                                         {"Running", StateId::active},
                                                         {"RunTimeError", StateId::active},
                                                         {"Exception", StateId::error_processing},
                                                         {"FatalError", StateId::finalized}};
    const auto tasks = deployment_.status().tasks;
    const auto task =
        std::ranges::find_if(tasks, [this](const types::TaskStatus& each) { return each.record.name == task_; });
    const auto found = task == tasks.end() ? of_tasks.end() : of_tasks.find(task->state);
    const uint8_t now = found == of_tasks.end() ? StateId::unknown : found->second;
    is_shut_down_ = is_shut_down_ && (now == StateId::unconfigured || now == StateId::error_processing);
    return is_shut_down_ ? StateId::finalized : now;
}

void LifecycleServer::make(uint8_t transition) {
    const auto call = [this](const char* operation) { deployment_.call(task_ + "." + operation, {}); };
    if (transition == TransitionId::active_shutdown) call("stop");
    if (transition == TransitionId::cleanup || transition == TransitionId::inactive_shutdown ||
        transition == TransitionId::active_shutdown)
        call("cleanup");
    if (transition == TransitionId::configure) call("configure");
    if (transition == TransitionId::activate) call("start");
    if (transition == TransitionId::deactivate) call("stop");
    if (transition == TransitionId::error_success) call("recover");
}

bool LifecycleServer::change(const ros::Transition& wanted) {
    const uint8_t before = state();
    const Edge* const edge = find(before, wanted.id, wanted.label);
    if (!edge) {
        const std::string named = wanted.label.empty() ? std::to_string(wanted.id) : wanted.label;
        report_(fmt::format("there is no transition {} from the state {} of {}", named, getState(before).label, task_));
        return false;
    }
    const bool has_two_steps = edge->goal >= StateId::configuring;
    if (has_two_steps) announce(*edge);
    const char* outcome = Ending::success;
    try {
        make(edge->id);
        is_shut_down_ = edge->goal == StateId::shutting_down || edge->goal == StateId::finalized;
    } catch (const std::exception& refused) {
        report_(fmt::format("{} of {}: {}", edge->label, task_, types::getReason(refused)));
        const uint8_t now = state();
        outcome = now == StateId::error_processing || now == StateId::finalized ? Ending::error : Ending::failure;
    }
    if (const Edge* const end = has_two_steps ? find(edge->goal, 0, outcome) : edge;
        has_two_steps || outcome == Ending::success)
        announce(*end);
    return outcome == Ending::success;
}

void LifecycleServer::announce(const Edge& edge) {
    const ros::TransitionDescription made = described(edge);
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    const auto stamp = std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count();
    events_.send({static_cast<uint64_t>(stamp), made.transition, made.start_state, made.goal_state});
    announced_ = edge.goal;
}

void LifecycleServer::watch() {
    const uint8_t now = state();
    if (now != announced_) announce({0, "", announced_, now});
}

}  // namespace insonify::dds
