#pragma once
#include <condition_variable>
#include <memory>
#include <vector>

#include "components/sonar/echo/MaterialLaws.hpp"
#include "components/sonar/places/MeshFacts.hpp"
#include "components/sonar/rays/SceneTrees.hpp"
#include "types/Thread.hpp"

namespace insonify::sonar {

/** Prepares the expensive data of meshes that a later ping will need, on its own thread, which starts with the first
 *  mesh, without a realtime priority. A ping that needs a mesh earlier waits for it, and lends its priority meanwhile,
 *  so the pings do not depend on the progress of the thread. */
class MeshesAhead {
public:
    using Meshes = std::shared_ptr<const std::vector<types::MeshPtr>>;

    MeshesAhead() = default;
    ~MeshesAhead();
    MeshesAhead(const MeshesAhead&) = delete;
    MeshesAhead& operator=(const MeshesAhead&) = delete;

    /** Sets the meshes that will be needed, with these laws; null: none. Does not wait. */
    void take(const Meshes& meshes, const MaterialLaws& laws);

private:
    /** Data of a mesh that is kept until a geometry has the mesh. */
    struct Made {
        types::MeshPtr mesh;
        std::shared_ptr<MeshTree> tree;
        std::shared_ptr<MeshFacts> facts;
        MeshFacts::Planes planes;
        MeshFacts::Facets facets;
        MeshFacts::Curves curves;
    };
    void work();
    static Made make(const types::MeshPtr& mesh, const MaterialLaws& laws);

    std::thread worker_;
    types::PriorityMutex mutex_;
    std::condition_variable asked_;
    Meshes taken_, next_;  ///< Argument of the last take(); meshes that the worker has not received yet.
    MaterialLaws laws_;
    bool quit_ = false;
    std::vector<Made> made_;  ///< Used by the worker thread only.
};

}  // namespace insonify::sonar
