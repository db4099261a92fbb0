#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "components/console/Action.hpp"
#include "components/dataset/Annotate.hpp"
#include "components/dataset/Collection.hpp"
#include "components/dataset/SampleFiles.hpp"
#include "components/dataset/Samples.hpp"
#include "components/dataset/Sweep.hpp"
#include "components/deployer/Simulation.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::dataset {

/** Returns the parts of a scene that a sweep needs: the nodes to place with their places in the file, the nodes to keep
 *  clear of, and the nodes to place on. Throws types::ConfigError if a node for objects to stand on is absent. */
SceneParts getParts(const Sweep& sweep, const scene::Scene& scene);

/** Returns the names of each object of a scene, and of the nodes above it. */
std::vector<Lineage> lineages(const scene::Scene& scene);

/** Returns the SHA-256 of all triangles, objects' places and materials of a scene. */
std::string computeDigest(const types::Geometry& geometry);

/** Reads the sweep of a data set. Its paths are resolved against its folder. Throws types::ConfigError with all
 *  diagnostics and their places. */
Sweep readSweep(const std::filesystem::path& file);

/** Returns describeOddPoses() of a sweep in one of its scenes, of at most 10,000 poses. What samples vary, such as a
 * range among the settings, is not compared. @param runs the poses of a trajectory, as for Samples */
std::vector<std::string> describePoses(const Sweep& sweep, const SceneChoice& choice,
                                       const std::vector<std::vector<TimedPose>>& runs,
                                       const framework::Deployment& deployment, const scene::Scene& scene);

/** Returns the sweep with files for its scenes that have a recipe. The component library worlds makes a scene once per
 *  recipe, seed and generator. Scenes are kept in insonify/scenes of the user's cache. Throws types::ConfigError for a
 *  wrong recipe, or if the library is absent. */
Sweep withMadeScenes(Sweep sweep);

/** Returns a text that identifies the origin of the scenes with a recipe, for the hash of a data set; empty if there
 *  are none. */
std::string describeOrigins(const Sweep& sweep);

/** Changes of the files by the command line. */
struct Changes {
    std::vector<std::string> set;        ///< "task.property.path=value"; values of the sweep take precedence.
    std::optional<uint64_t> seed;        ///< Replaces the sweep's seed.
    std::optional<uint64_t> count = {};  ///< Number of samples that are drawn from the sweep's; none: all.
};

/** Makes the samples of a data set with a deployment: the work of `insonify dataset`.
 *
 *  Each sample is rendered from a reset state, with noise of its own seed. So its bytes do not depend on the process
 *  that makes it or on other samples. Sonars with automatic visibility use rays where they can, because rasterisation
 *  differs between graphics cards. */
class DatasetRun {
public:
    /** Throws types::ConfigError with the errors of the deployment, of the sweep, or between them. */
    DatasetRun(const std::string& deployment, const std::string& sweep, Format format, Changes changes = {});

    const Sweep& sweep() const { return sweep_; }
    const Samples& samples() const { return *samples_; }
    const Classes& classes() const { return *classes_; }
    const Selection& selection() const { return selection_; }
    Format format() const { return format_; }
    /** Returns the description of the data set; `sweep` is the file as given. */
    Title title(const std::string& sweep) const;

    /** Renders and writes one sample. */
    void make(uint64_t index, SampleFiles& files);
    /** Returns the warnings of tasks and scenes that samples have had since the last call, each once for a run. */
    std::vector<std::string> consumeWarnings() { return std::exchange(warnings_, {}); }

private:
    struct SceneFile {
        std::string name;  ///< File name without folders.
        SceneParts parts;
        std::vector<Lineage> objects;
        std::string digest;
    };
    framework::DeploymentSpec loaded() const;
    void checkAssignments() const;
    void checkDrawn() const;
    void checkAssignment(const std::string& path, const std::string& property, const Written& value) const;
    void refuseBudgets() const;
    /** Warns of odd poses among the runs. */
    void readScenes(const framework::Deployment& deployment, const std::vector<std::vector<TimedPose>>& runs);
    SceneFile readScene(const std::string& file, const scene::Scene& scene) const;
    void computeDigests();
    std::vector<std::string> makeOverrides(const Sample& sample) const;
    std::string getScale(const std::string& task, const Sample& sample) const;
    std::vector<std::string> tasksOfType(const std::string& type) const;
    types::ConfigError placed(types::Diagnostics diagnostics, const Sample& sample) const;
    std::optional<std::map<std::string, std::string>> findChanges(const std::vector<std::string>& after) const;
    bool change(const std::optional<std::map<std::string, std::string>>& changes);
    void simulate(const Sample& sample);
    void collectWarnings();
    std::map<std::string, types::Pose> placeObjects(const Sample& sample) const;
    std::vector<uint32_t> getHiders(size_t scene) const;
    std::vector<int32_t> findHiders(const Sample& sample, const std::string& vehicle, const Run& run);

    const std::string deployment_;
    const Changes changes_;
    const Sweep sweep_;
    const Format format_;
    framework::DeploymentSpec spec_;
    std::vector<Instances> instances_;  ///< One for each scene.
    std::vector<SceneFile> scenes_;
    std::optional<Samples> samples_;
    std::optional<Classes> classes_;
    Selection selection_;
    std::string digest_, origin_;                       ///< As in Title.
    std::unique_ptr<deployer::Simulation> simulation_;  ///< One scene with its settings.
    std::unique_ptr<deployer::Simulation> before_;      ///< The previous one, kept until the next first sample.
    std::unique_ptr<deployer::Simulation> hiding_;      ///< The same without single objects, where shadows are wanted.
    std::vector<std::string> overrides_;                ///< Overrides of the current simulation.
    size_t scene_ = 0;                                  ///< Scene of the current simulation.
    std::vector<std::string> warnings_;                 ///< For consumeWarnings().
    std::set<std::string> warned_;                      ///< All that it has had.
};

/** Adds the command `dataset` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, console::Action& action);

}  // namespace insonify::dataset
