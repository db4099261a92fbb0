#pragma once
// Scenes at times of their animations.
#include "components/scene/motion/Animator.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::fuzz {

/** Expects that a file which is a scene stays sound while its animations play. */
inline void expectSoundWhilePlayed(const std::filesystem::path& file) {
    const auto scene = std::make_shared<const scene::Scene>(scene::readScene(file));
    types::Diagnostics diagnostics;
    scene::Animator animator(scene, {}, {}, diagnostics);
    if (animator.isIdle()) return;
    for (const double time : {0.0, 0.3, 1e9}) {
        animator.take(time, {});
        types::Snapshot snapshot;
        snapshot.geometry = scene->geometry;
        animator.addMoved(snapshot.moved);
        animator.addDeformed(snapshot);
        ASSERT_TRUE(types::deformsRightly(snapshot));
        scene::expectSound(*types::posedGeometry(snapshot));
    }
}

}  // namespace insonify::fuzz
