#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/deployer/Simulation.hpp"
#include "components/sonar/base/ThreadPool.hpp"

namespace insonify::deployer {

/** Several simulations of one deployment that share its scene and step in parallel, on the machine's cores. Their pings
 *  are those of single simulations, bit for bit. Used by one thread at a time. */
class SimulationBatch {
public:
    /** Simulation i has the seed computeSeed(options.seed, i). Throws as Simulation does, and std::invalid_argument for
     * a count of 0. */
    SimulationBatch(const std::string& deployment, const SimulationOptions& options, size_t count);

    size_t size() const { return simulations_.size(); }
    const Simulation& front() const { return *simulations_.front(); }
    /** Returns the seed of a simulation: the batch's own for the first, different seeds for the others. */
    static uint64_t computeSeed(uint64_t seed, size_t number);

    /** Steps each simulation to its own next time, with its own poses. When some fail, steps all others and throws
     *  std::runtime_error with the number of the first that failed. */
    std::vector<std::vector<SteppedPing>> step(std::vector<std::map<std::string, types::Pose>> at);
    /** Changes properties of all simulations, as Simulation::set(). */
    void set(const std::map<std::string, std::string>& values);
    /** Returns Simulation::consumeWarnings() of all simulations, each text once. */
    std::vector<std::string> consumeWarnings();
    /** Resets these simulations, each with a seed, not 0; none: the same seed. */
    void reset(std::span<const size_t> which, std::span<const std::optional<uint64_t>> seeds);

private:
    /** Calls `work(i)` for the numbers below `count`, on all threads. */
    template <class Work>
    void forEach(size_t count, const Work& work);

    std::vector<std::unique_ptr<Simulation>> simulations_;
    sonar::ThreadPool threads_{0};
};

}  // namespace insonify::deployer
