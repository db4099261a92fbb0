#include "components/sonar/places/MeshesAhead.hpp"

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
    if (!worker_.joinable()) worker_ = std::thread([this] { work(); });
    asked_.notify_one();
}

MeshesAhead::Made MeshesAhead::make(const types::MeshPtr& mesh, const MaterialLaws& laws) try {
    Made made{MeshTree::of(mesh), MeshFacts::of(mesh), {}, {}, {}};
    made.tree->tree();
    made.facts->box();
    made.facts->longestEdge();
    made.planes = made.facts->planes();
    made.facets = made.facts->facets(glm::dmat3(1), laws);
    made.curves = made.facts->curves(glm::dmat3(1));
    return made;
} catch (const std::exception&) {
    return {};  // the ping that needs it meets the same error, and reports it
}

void MeshesAhead::work() {
    for (std::unique_lock lock(mutex_);;) {
        asked_.wait(lock, [this] { return quit_ || next_; });
        if (quit_) return;
        const Meshes meshes = std::exchange(next_, nullptr);
        const MaterialLaws laws = laws_;
        lock.unlock();
        std::vector<Made> made;
        for (const types::MeshPtr& mesh : *meshes) made.push_back(make(mesh, laws));
        made_ = std::move(made);  // only now, so that data that is still needed is not made twice
        lock.lock();
    }
}

}  // namespace insonify::sonar
