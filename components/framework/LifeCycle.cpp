#include "components/framework/LifeCycle.hpp"

#include "components/framework/Operation.hpp"

namespace insonify::framework {

std::vector<std::unique_ptr<OperationBase>> lifeCycleOperations(TaskContext& task) {
    struct Transition {
        const char *name, *doc;
        Outcome (TaskContext::*make)();
    };
    static constexpr Transition transitions[] = {
        {"configure", "PreOperational or Stopped -> Stopped", &TaskContext::configure},
        {"start", "Stopped -> Running", &TaskContext::start},
        {"stop", "Running or RunTimeError -> Stopped", &TaskContext::stop},
        {"cleanup", "Stopped -> PreOperational", &TaskContext::cleanup},
        {"recover", "RunTimeError -> Running; Exception -> PreOperational", &TaskContext::recover}};
    std::vector<std::unique_ptr<OperationBase>> operations;
    for (const Transition& transition : transitions)
        operations.push_back(std::make_unique<Operation<void()>>(
            &task, transition.name, transition.doc, [&task, make = transition.make] {
                if (const Outcome outcome = (task.*make)(); !outcome) throw std::runtime_error(outcome.reason);
            }));
    return operations;
}

}  // namespace insonify::framework
