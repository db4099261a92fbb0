#include "components/python/Interface.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "components/deployer/Json.hpp"
#include "components/deployer/SimulationBatch.hpp"
#include "components/framework/config/ConfigReader.hpp"
#include "components/python/Samples.hpp"
#include "components/recordings/RecordingReader.hpp"
#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::python {
namespace {

using console::Json;

Json noticesIn(const deployer::Simulation& simulation) {
    Json all = Json::array();
    for (const types::Notice& notice : simulation.notices())
        all.push_back({{"text", notice.text}, {"is_warning", notice.kind == types::Notice::Kind::Warning}});
    return all;
}

/** Something that steps, with threads, which only the process that made it may use. */
class Stepped : public Handle {
public:
    /** Returns a handle for use in this process; throws in a forked child. */
    template <class Kind>
    static Kind& usable(Handle& handle) {
        auto& stepped = dynamic_cast<Kind&>(handle);
        stepped.process.require("the simulation");
        return stepped;
    }
    types::OwnProcess process;
};

class SimulationHandle final : public Stepped {
public:
    SimulationHandle(const std::string& deployment, deployer::SimulationOptions options)
        : simulation(deployment, std::move(options)) {}
    Json facts() const override {
        return {{"poses", simulation.poses()},
                {"pings", simulation.pings()},
                {"period", simulation.period()},
                {"notices", noticesIn(simulation)}};
    }
    deployer::Simulation simulation;
};

class LogHandle final : public Handle {
public:
    explicit LogHandle(const std::string& file)
        : whole((recordings::refuseRecording(file), log::openWholeLog(file))), samples(whole.log->streams().size()) {
        times_.resize(samples.size());
        for (const log::SampleRef& at : whole.log->samples()) {
            samples[at.stream].push_back(at);
            times_[at.stream].push_back(at.time.seconds());
        }
    }
    Json facts() const override {
        Json streams = Json::array();
        for (const log::Stream& stream : whole.log->streams())
            streams.push_back({{"name", stream.name}, {"type", stream.type}, {"metadata", stream.metadata}});
        Json files = Json::array();
        for (const auto& file : whole.files) files.push_back(file.string());
        return {{"streams", streams}, {"files", files}, {"notice", whole.notice}};
    }
    std::vector<Array> arrays() const override {
        std::vector<Array> arrays;
        for (const auto& times : times_) arrays.push_back({"times", "f8", times.data(), {times.size()}, 1});
        return arrays;
    }

    log::WholeLog whole;
    std::vector<std::vector<log::SampleRef>> samples;  ///< By stream.
    std::mutex reading;  ///< Python's threads may call at the same time; the reader is for one thread.

private:
    std::vector<std::vector<double>> times_;
};

thread_local std::string last_error;

const char* keep(const Json& json) {
    last_error = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return last_error.c_str();
}

void keepError(const char* kind, const std::exception& error, const types::Diagnostics& diagnostics = {}) {
    Json all = Json::array();
    for (const types::Diagnostic& each : diagnostics) all.push_back(deployer::toJson(each));
    keep({{"kind", kind}, {"message", error.what()}, {"diagnostics", all}});
}

/** Returns the errors with the parameter of Python as the origin of what `--set` would have set. */
types::ConfigError namingParameter(types::Diagnostics diagnostics, const char* parameter) {
    for (types::Diagnostic& each : diagnostics)
        if (each.file == framework::set_origin) each.file = parameter;
    return types::ConfigError(std::move(diagnostics));
}

/** Returns the result of `work`; `failed` if it throws. */
template <class Work>
auto guarded(std::invoke_result_t<Work> failed, Work&& work) {
    try {
        return work();
    } catch (const types::ConfigError& error) {
        const types::ConfigError named = namingParameter(error.diagnostics(), "overrides");
        keepError("ConfigError", named, named.diagnostics());
    } catch (const UnreadableType& error) {
        keepError("TypeError", error);
    } catch (const std::invalid_argument& error) {
        keepError("ValueError", error);
    } catch (const std::out_of_range& error) {
        keepError("IndexError", error);
    } catch (const std::bad_alloc& error) {
        keepError("MemoryError", error);
    } catch (const std::exception& error) {
        keepError("RuntimeError", error);
    } catch (...) {
        keepError("RuntimeError", std::runtime_error("an exception without a reason"));
    }
    return failed;
}

/** Returns the value of an enumerator's name. */
template <class Enum>
Enum getValue(const std::string& name, const char* what) {
    const auto& names = types::EnumNames<Enum>::names;
    const auto found = std::ranges::find(names, name);
    if (found != std::end(names)) return static_cast<Enum>(found - std::begin(names));
    std::string known;
    for (const std::string_view each : names) known += (known.empty() ? "" : ", ") + std::string(each);
    throw types::ConfigError("", what, "is " + name + "; it may be " + known);
}

template <class Number>
std::optional<Number> unlessNull(const Number* number) {
    return number ? std::optional(*number) : std::nullopt;
}

types::Pose getPose(const double* numbers) {
    types::Pose pose;
    pose.position = {numbers[0], numbers[1], numbers[2]};
    pose.orientation = glm::dquat(numbers[3], numbers[4], numbers[5], numbers[6]);
    return pose;
}

deployer::SimulationOptions getOptions(uint64_t seed, const char* const* overrides, size_t override_count, int truth,
                                       const double* period) {
    deployer::SimulationOptions options;
    options.seed = seed;
    options.overrides = {overrides, overrides + override_count};
    options.truth = truth != 0;
    options.period = unlessNull(period);
    return options;
}

class BatchHandle final : public Stepped {
public:
    BatchHandle(const std::string& deployment, const deployer::SimulationOptions& options, size_t count)
        : batch(deployment, options, count) {
        for (size_t i = 0; i < count; ++i) seeds_.push_back(deployer::SimulationBatch::computeSeed(options.seed, i));
        const deployer::Simulation& first = batch.front();
        if (first.poses().size() != 1 || first.pings().size() != 1)
            throw types::ConfigError(deployment, "",
                                     "has several vehicles or sonars; a batch steps deployments of one of each");
    }
    Json facts() const override {
        const deployer::Simulation& first = batch.front();
        return {{"poses", first.poses()},
                {"pings", first.pings()},
                {"period", first.period()},
                {"seeds", seeds_},
                {"notices", noticesIn(first)}};
    }
    std::unique_ptr<Handle> step(const double* poses) {
        std::vector<std::map<std::string, types::Pose>> at(batch.size());
        for (size_t i = 0; i < at.size(); ++i) at[i][batch.front().poses().front()] = getPose(poses + 7 * i);
        std::vector<types::SonarPtr> pings;
        std::vector<types::SonarTruthPtr> truths;
        for (const auto& made : batch.step(std::move(at))) {
            if (!made.front().ping) throw std::runtime_error("a simulation made no ping");
            pings.push_back(made.front().ping);
            if (made.front().truth) truths.push_back(made.front().truth);
        }
        return pingsHandle(pings, truths);
    }

    deployer::SimulationBatch batch;

private:
    std::vector<uint64_t> seeds_;
};

}  // namespace

const char* insonify_error() { return last_error.c_str(); }

const char* insonify_version() {
    return guarded(nullptr, [] { return INSONIFY_VERSION; });
}

void insonify_free(Handle* handle) {
    const auto* stepped = dynamic_cast<const Stepped*>(handle);
    if (stepped && stepped->process.isForked()) return;  // to end it would wait for the threads of the parent
    delete handle;
}

const char* insonify_facts(const Handle* handle) {
    return guarded(nullptr, [&] {
        if (const auto* stepped = dynamic_cast<const Stepped*>(handle)) stepped->process.require("the simulation");
        return keep(handle->facts());
    });
}

size_t insonify_arrays(const Handle* handle, Array* arrays, size_t room) {
    return guarded(std::numeric_limits<size_t>::max(), [&] {
        const std::vector<Array> all = handle->arrays();
        std::copy_n(all.begin(), std::min(room, all.size()), arrays);
        return all.size();
    });
}

Handle* insonify_simulation(const char* deployment, uint64_t seed, const char* const* overrides, size_t override_count,
                            int truth, const double* period) {
    return guarded(nullptr, [&]() -> Handle* {
        return new SimulationHandle(deployment, getOptions(seed, overrides, override_count, truth, period));
    });
}

Handle* insonify_batch(const char* deployment, uint64_t seed, const char* const* overrides, size_t override_count,
                       int truth, const double* period, size_t count) {
    return guarded(nullptr, [&]() -> Handle* {
        return new BatchHandle(deployment, getOptions(seed, overrides, override_count, truth, period), count);
    });
}

Handle* insonify_batch_step(Handle* batch, const double* poses) {
    return guarded(nullptr, [&]() -> Handle* { return Stepped::usable<BatchHandle>(*batch).step(poses).release(); });
}

int insonify_batch_reset(Handle* batch, const size_t* which, const uint64_t* seeds, size_t count) {
    return guarded(-1, [&] {
        std::vector<std::optional<uint64_t>> given(count);
        for (size_t i = 0; seeds && i < count; ++i) given[i] = seeds[i];
        Stepped::usable<BatchHandle>(*batch).batch.reset({which, count}, given);
        return 0;
    });
}

int insonify_step(Handle* simulation, const char* const* ports, const double* poses, size_t port_count,
                  const double* time, Handle** pings) {
    return guarded(-1, [&] {
        std::map<std::string, types::Pose> at;
        for (size_t i = 0; i < port_count; ++i) at[ports[i]] = getPose(poses + 7 * i);
        const auto made =
            Stepped::usable<SimulationHandle>(*simulation).simulation.step(std::move(at), unlessNull(time));
        for (const auto& each : made) *pings++ = each.ping ? pingHandle(each.ping, each.truth).release() : nullptr;
        return 0;
    });
}

double insonify_time(const Handle* simulation) {
    return guarded(std::numeric_limits<double>::quiet_NaN(),
                   [&] { return dynamic_cast<const SimulationHandle&>(*simulation).simulation.time(); });
}

int insonify_set(Handle* stepped, const char* const* assignments, size_t count) {
    return guarded(-1, [&]() -> int {
        std::map<std::string, std::string> values;
        for (const std::string assignment : std::span(assignments, count)) {
            const size_t equals = assignment.find('=');
            values[assignment.substr(0, equals)] = assignment.substr(equals + 1);
        }
        try {
            if (dynamic_cast<BatchHandle*>(stepped))
                Stepped::usable<BatchHandle>(*stepped).batch.set(values);
            else
                Stepped::usable<SimulationHandle>(*stepped).simulation.set(values);
        } catch (const types::ConfigError& error) {
            throw namingParameter(error.diagnostics(), "values");
        }
        return 0;
    });
}

const char* insonify_warnings(Handle* stepped) {
    return guarded(nullptr, [&] {
        if (dynamic_cast<BatchHandle*>(stepped))
            return keep(Stepped::usable<BatchHandle>(*stepped).batch.consumeWarnings());
        return keep(Stepped::usable<SimulationHandle>(*stepped).simulation.consumeWarnings());
    });
}

int insonify_reset(Handle* simulation, const uint64_t* seed) {
    return guarded(-1, [&] {
        Stepped::usable<SimulationHandle>(*simulation).simulation.reset(unlessNull(seed));
        return 0;
    });
}

Handle* insonify_fan(const Handle* ping, uint32_t width, double dynamic_range_db, const double* reference_db,
                     const char* colour_map, const char* scale, int code_bits) {
    return guarded(nullptr, [&]() -> Handle* {
        return fanHandle(*ping, {width, dynamic_range_db, unlessNull(reference_db),
                                 getValue<output::ColourMap>(colour_map, "colour_map"),
                                 getValue<output::BinScale>(scale, "scale"), code_bits})
            .release();
    });
}

Handle* insonify_log(const char* file) {
    return guarded(nullptr, [&]() -> Handle* { return new LogHandle(file); });
}

Handle* insonify_sample(Handle* log, size_t stream, size_t index) {
    return guarded(nullptr, [&]() -> Handle* {
        auto& opened = dynamic_cast<LogHandle&>(*log);
        const std::lock_guard alone(opened.reading);
        return sampleHandle(*opened.whole.log, opened.samples.at(stream).at(index)).release();
    });
}

}  // namespace insonify::python
