#include "components/framework/execution/Executor.hpp"

#include <algorithm>
#include <stdexcept>

namespace insonify::framework {

Executor::Executor(const Graph& graph, Environment& environment, types::Time start)
    : graph_(graph), environment_(environment), start_(start), wall_start_(Clock::now()) {
    environment_.start_time = [this] { return start_; };
}

void Executor::begin() { wall_start_ = Clock::now(); }

bool Executor::advance() { throw std::logic_error("only schedule: lockstep can advance instant by instant"); }

Progress Executor::progress() const {
    const uint64_t counted = graph_.countedSamples(), rehearsed = std::min(counted, first_);
    uint64_t most = counted;
    for (const OutputPortBase* port : graph_.counted()) most = std::max<uint64_t>(most, port->written());
    return {counted - rehearsed, rehearsed, environment_.elapsed().seconds(),
            std::chrono::duration<double>(Clock::now() - wall_start_).count(), most - rehearsed};
}

bool Executor::isOver(const RunLimits& limits) const {
    return graph_.hasFailed() || (limits.samples > 0 && graph_.countedSamples() >= limits.samples);
}

}  // namespace insonify::framework
