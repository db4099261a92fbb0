#include "components/deployer/SimulationBatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "components/framework/Wiring.hpp"

namespace insonify::deployer {

SimulationBatch::SimulationBatch(const std::string& deployment, const SimulationOptions& options, size_t count) {
    if (count == 0) throw std::invalid_argument("a batch has at least one simulation");
    for (size_t i = 0; i < count; ++i) {
        SimulationOptions own = options;
        own.threads = 1;
        own.seed = computeSeed(options.seed, i);
        simulations_.push_back(std::make_unique<Simulation>(deployment, std::move(own)));
    }
}

uint64_t SimulationBatch::computeSeed(uint64_t seed, size_t number) {
    return number == 0 ? seed : framework::computeSeed(seed == 0 ? 1 : seed, fmt::format("simulation {}", number));
}

template <class Work>
void SimulationBatch::forEach(size_t count, const Work& work) {
    std::atomic<size_t> next = 0;
    std::mutex alone;
    size_t first_failed = count;
    std::string failure;
    threads_.share([&](int, int) {
        for (size_t i = next++; i < count; i = next++) try {
                work(i);
            } catch (const std::exception& error) {
                const std::lock_guard lock(alone);
                if (i < first_failed) failure = error.what();
                first_failed = std::min(i, first_failed);
            }
    });
    if (first_failed < count) throw std::runtime_error(failure);
}

std::vector<std::vector<SteppedPing>> SimulationBatch::step(std::vector<std::map<std::string, types::Pose>> at) {
    if (at.size() != size())
        throw std::invalid_argument(fmt::format("there are poses for {} simulations of {}", at.size(), size()));
    std::vector<std::vector<SteppedPing>> made(size());
    forEach(size(), [&](size_t i) {
        try {
            made[i] = simulations_[i]->step(std::move(at[i]), {});
        } catch (const std::exception& error) {
            throw std::runtime_error(fmt::format("simulation {}: {}", i, error.what()));
        }
    });
    return made;
}

void SimulationBatch::set(const std::map<std::string, std::string>& values) {
    for (const auto& simulation : simulations_) simulation->set(values);  // what one refuses, the first refuses
}

std::vector<std::string> SimulationBatch::consumeWarnings() {
    std::vector<std::string> all;
    for (const auto& simulation : simulations_)
        for (std::string& text : simulation->consumeWarnings())
            if (std::ranges::count(all, text) == 0) all.push_back(std::move(text));
    return all;
}

void SimulationBatch::reset(std::span<const size_t> which, std::span<const std::optional<uint64_t>> seeds) {
    for (const size_t number : which)
        if (number >= size()) throw std::out_of_range(fmt::format("there is no simulation {} of {}", number, size()));
    for (size_t i = 0; i < which.size(); ++i)
        if (std::ranges::count(which, which[i]) > 1)
            throw std::invalid_argument(fmt::format("simulation {} is given more than once", which[i]));
    for (const std::optional<uint64_t>& seed : seeds) Simulation::refuseSeed(seed);
    forEach(which.size(), [&](size_t i) { simulations_[which[i]]->reset(seeds[i]); });
}

}  // namespace insonify::deployer
