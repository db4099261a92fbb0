#include "components/sonar/surfaces/DeformedMeshes.hpp"

#include <algorithm>

#include "types/geometry/PosedMesh.hpp"

namespace insonify::sonar {

DeformedMeshes::DeformedMeshes(const types::Snapshot& snapshot, const std::vector<uint32_t>& others)
    : scene_(snapshot.geometry), objects_(others) {
    for (const types::DeformedObject& one : snapshot.deformed) objects_.push_back(one.object);
    std::ranges::sort(objects_);
    objects_.erase(std::unique(objects_.begin(), objects_.end()), objects_.end());
    auto geometry = std::make_shared<types::Geometry>(*scene_);
    std::vector<size_t> uses(geometry->meshes.size());
    for (const types::Object& object : geometry->objects) ++uses[static_cast<size_t>(object.mesh)];
    for (const uint32_t number : objects_) {
        types::Object& object = geometry->objects[number];
        const auto mesh = static_cast<size_t>(object.mesh);
        Own& own = own_.emplace_back();
        own.rest = scene_->meshes.shared(mesh);
        own.mesh = std::make_shared<types::Mesh>(*own.rest);
        if (uses[mesh] == 1) {
            geometry->meshes.replace(mesh, own.mesh);
        } else {
            --uses[mesh];
            object.mesh = static_cast<int>(geometry->meshes.size());
            geometry->meshes.push_back(types::MeshPtr(own.mesh));
        }
        own.facts = MeshFacts::of(own.mesh);
    }
    geometry_ = std::move(geometry);
}

bool DeformedMeshes::serves(const types::Snapshot& snapshot) const {
    return snapshot.geometry == scene_ && std::ranges::all_of(snapshot.deformed, [&](const auto& one) {
               return std::ranges::binary_search(objects_, one.object);
           });
}

bool DeformedMeshes::changes(const types::Snapshot& snapshot) {
    if (has_taken_ && snapshot.deformed == deformed_ && snapshot.joints == joints_ && snapshot.morphs == morphs_)
        return false;
    has_taken_ = true;
    deformed_ = snapshot.deformed;
    joints_ = snapshot.joints;
    morphs_ = snapshot.morphs;
    return true;
}

void DeformedMeshes::take(const types::Snapshot& snapshot, size_t part, size_t parts) {
    for (size_t i = part; i < objects_.size(); i += parts) {
        Own& own = own_[i];
        const auto deformed =
            std::ranges::lower_bound(snapshot.deformed, objects_[i], {}, &types::DeformedObject::object);
        if (deformed != snapshot.deformed.end() && deformed->object == objects_[i]) {
            types::poseMesh(types::getPose(snapshot, *deformed, *own.mesh->deformation), *own.mesh);
        } else {
            own.mesh->positions = own.rest->positions;
            own.mesh->normals = own.rest->normals;
            own.mesh->tangents = own.rest->tangents;
            types::boundClusters(*own.mesh);
        }
        own.facts->renew();
    }
}

}  // namespace insonify::sonar
