#include "components/sonar/rays/DeformingTrees.hpp"

#include <utility>

namespace insonify::sonar {

struct DeformingTrees::Tree {
    std::vector<glm::vec3> positions;  ///< About the origin, and one more.
    std::vector<TreePart> parts;
    std::unique_ptr<EmbreeScene> scene;
};

DeformingTrees::DeformingTrees() = default;
DeformingTrees::~DeformingTrees() = default;
DeformingTrees::DeformingTrees(DeformingTrees&&) noexcept = default;

DeformingTrees& DeformingTrees::operator=(DeformingTrees&& other) noexcept {
    top_ = std::move(other.top_);  // before the trees that it is of
    trees_ = std::move(other.trees_);
    objects_ = std::move(other.objects_);
    return *this;
}

DeformingTrees::DeformingTrees(std::vector<Object> objects) : objects_(std::move(objects)) {
    if (objects_.empty()) return;
    trees_.resize(objects_.size());
    for (size_t i = 0; i < objects_.size(); ++i) {
        Tree& tree = trees_[i];
        tree.positions = objects_[i].mesh->deformation->positions;
        tree.positions.emplace_back();  // Embree reads 16 bytes at each position
        tree.scene = std::make_unique<EmbreeScene>(EmbreeScene::Kind::Refitted);
        for (const MaterialRun& run : materialRuns(*objects_[i].mesh)) {
            tree.scene->add(*objects_[i].mesh, run, tree.positions);
            tree.parts.push_back({static_cast<uint32_t>(tree.parts.size()), run.first_index / 3});
        }
        tree.scene->commit();
    }
    top_ = std::make_unique<EmbreeScene>(EmbreeScene::Kind::Refitted);
    for (const Tree& tree : trees_) top_->add(*tree.scene, glm::dmat4(1));
}

void DeformingTrees::fit(size_t i, const glm::dmat4& place) {
    Tree& tree = trees_[i];
    const std::vector<glm::vec3>& from = objects_[i].mesh->positions;
    for (size_t k = 0; k < from.size(); ++k) tree.positions[k] = place * glm::dvec4(from[k], 1);
    tree.scene->recommit();
}

void DeformingTrees::join() {
    if (top_) top_->recommit();
}

RTCScene DeformingTrees::scene(size_t i) const { return trees_[i].scene->scene(); }

TreePart DeformingTrees::meaningIn(size_t i, uint32_t geometry) const {
    const TreePart& part = trees_[i].parts[geometry];
    return {objects_[i].first_command + part.command, part.first_triangle};
}

}  // namespace insonify::sonar
