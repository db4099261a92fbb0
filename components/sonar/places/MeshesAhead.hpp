#pragma once
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "components/sonar/echo/MaterialLaws.hpp"
#include "components/sonar/places/MeshFacts.hpp"
#include "components/sonar/rays/SceneTrees.hpp"

namespace insonify::sonar {

/** Makes what takes long of meshes that a ping will need later, next to the pings, on a thread of its own from the
 * first mesh on. A ping that needs such a mesh earlier waits for it, so pings are the same whatever is made in time. */
class MeshesAhead {
public:
    using Meshes = std::shared_ptr<const std::vector<types::MeshPtr>>;

    MeshesAhead() = default;
    ~MeshesAhead();
    MeshesAhead(const MeshesAhead&) = delete;
    MeshesAhead& operator=(const MeshesAhead&) = delete;

    /** From now on these meshes are needed later, with these laws; null: none. Waits for nothing. */
    void take(const Meshes& meshes, const MaterialLaws& laws);

private:
    /** What is kept of a mesh until a geometry has it. */
    struct Made {
        std::shared_ptr<MeshTree> tree;
        std::shared_ptr<MeshFacts> facts;
        MeshFacts::Planes planes;
        MeshFacts::Facets facets;
        MeshFacts::Curves curves;
    };
    void work();
    static Made make(const types::MeshPtr& mesh, const MaterialLaws& laws);

    std::thread worker_;
    std::mutex mutex_;
    std::condition_variable asked_;
    Meshes taken_, next_;  ///< Of the last take(); those that the worker does not have yet.
    MaterialLaws laws_;
    bool quit_ = false;
    std::vector<Made> made_;  ///< By the worker, which alone uses it.
};

}  // namespace insonify::sonar
