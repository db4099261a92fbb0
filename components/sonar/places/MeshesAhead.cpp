#include "components/sonar/places/MeshesAhead.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace insonify::sonar {

MeshesAhead::~MeshesAhead() {
    {
        const std::lock_guard alone(mutex_);
        quit_ = true;
    }
    asked_.notify_one();
    if (worker_.joinable()) worker_.join();
}

void MeshesAhead::take(const Meshes& meshes, const MaterialLaws& laws) {
    if (meshes == taken_) return;
    taken_ = meshes;
    {
        const std::lock_guard alone(mutex_);
        next_ = meshes ? meshes : std::make_shared<const std::vector<types::MeshPtr>>();
        laws_ = laws;
    }
    if (!worker_.joinable()) worker_ = types::startThread("meshes ahead", [this] { work(); });
    asked_.notify_one();
}

MeshesAhead::Made MeshesAhead::make(const types::MeshPtr& mesh, const MaterialLaws& laws) try {
    Made made{mesh, MeshTree::of(mesh), MeshFacts::of(mesh), {}, {}, {}};
    made.tree->tree();
    made.facts->box();
    made.facts->longestEdge();
    made.facts->triangles();
    made.planes = made.facts->planes();
    made.facets = made.facts->facets(glm::dmat3(1), laws);
    made.curves = made.facts->curves(glm::dmat3(1));
    return made;
} catch (const std::exception&) {
    return {};  // the ping that needs it meets the same error, and reports it
}

void MeshesAhead::work() {
    types::useDefaultScheduling();
    for (std::unique_lock<std::mutex> lock(mutex_);;) {
        asked_.wait(lock, [this] { return quit_ || next_; });
        if (quit_) return;
        const Meshes meshes = std::exchange(next_, nullptr);
        const MaterialLaws laws = laws_;
        std::vector<Made> made;
        for (size_t i = 0; i < meshes->size() && !quit_ && !next_; ++i) {
            lock.unlock();
            made.push_back(make((*meshes)[i], laws));
            lock.lock();
        }
        for (Made& old : made_)
            if (next_ && std::ranges::count(*next_, old.mesh) > 0) made.push_back(std::move(old));
        lock.unlock();
        made_ = std::move(made);  // only now, so that data that is still needed is not made twice
        lock.lock();
    }
}

}  // namespace insonify::sonar
