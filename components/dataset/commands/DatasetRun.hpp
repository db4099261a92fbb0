#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/command/Shard.hpp"
#include "components/dataset/Instances.hpp"
#include "components/dataset/SampleFiles.hpp"
#include "components/dataset/Samples.hpp"
#include "components/deployer/Simulation.hpp"

namespace insonify::dataset {

/** What the command line changes of the files. */
struct Changes {
    std::vector<std::string> set;  ///< "task.property.path=value", under what the sweep sets.
    std::optional<uint64_t> seed;  ///< In place of the sweep's.
};

/** Makes the samples of a data set with a deployment: what `insonify dataset` does.
 *
 *  Each sample is rendered from the start, as if nothing had been before it, with noise of its own seed, so that its
 *  bytes are the same whoever makes it and whatever else is made. Sonars that are free to find triangles by rays or by
 *  drawing take rays where they can, for drawing differs by graphics card. */
class DatasetRun {
public:
    /** Throws types::ConfigError with what is wrong with the deployment, with the sweep, or between them. */
    DatasetRun(const std::string& deployment, const std::string& sweep, Format format, Changes changes = {});

    const Sweep& sweep() const { return sweep_; }
    const Samples& samples() const { return *samples_; }
    const Classes& classes() const { return *classes_; }
    const std::string& digest() const { return digest_; }  ///< Of all that decides what the samples are.
    Format format() const { return format_; }
    const std::string& deployment() const { return deployment_; }

    /** Renders one sample and writes it. */
    void make(uint64_t index, SampleFiles& files);

private:
    struct SceneFile {
        std::string name;  ///< Without folders.
        SceneParts parts;
        std::vector<Lineage> objects;
        std::string digest;
    };
    framework::DeploymentSpec loaded() const;
    void checkAssignments() const;
    void checkDrawn() const;
    void checkAssignment(const std::string& path, const std::string& property, const Written& value) const;
    void refuseBudgets() const;
    void readScenes();
    SceneFile readScene(const std::string& file) const;
    std::string digestOfAll() const;
    std::vector<std::string> overridesOf(const Sample& sample) const;
    std::string scaleOf(const std::string& task, const Sample& sample) const;
    std::vector<std::string> tasksOfType(const std::string& type) const;
    void simulate(const Sample& sample);

    const std::string deployment_;
    const Changes changes_;
    const Sweep sweep_;
    const Format format_;
    framework::DeploymentSpec spec_;
    std::vector<Instances> instances_;  ///< One for each scene.
    std::vector<SceneFile> scenes_;
    std::optional<Samples> samples_;
    std::optional<Classes> classes_;
    std::string digest_;
    std::unique_ptr<deployer::Simulation> simulation_;  ///< One scene with its settings.
    std::unique_ptr<deployer::Simulation> before_;      ///< The one before, until the first sample of the next.
    std::vector<std::string> overrides_;                ///< Overrides of the simulation.
    size_t scene_ = 0;                                  ///< Scene of the simulation.
};

}  // namespace insonify::dataset
