#pragma once
// The door by which files of scenes come in.
#include "components/scene/Animator.hpp"
#include "components/scene/Scene.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/PosedMesh.hpp"

namespace insonify::fuzz {

/** A file is a sound scene, at rest and at any time of its animations, or an error in our words. */
inline void readScene(const Input& input) try {
    const auto read = std::make_shared<const scene::Scene>(scene::readScene(input.file()));
    scene::expectSound(*read->geometry);
    types::Diagnostics diagnostics;
    scene::Animator animator(read, {}, {}, diagnostics);
    if (animator.isIdle()) return;
    for (const double time : {0.0, 0.3, 1e9}) {
        animator.take(time, {});
        types::Snapshot snapshot;
        snapshot.geometry = read->geometry;
        animator.addMoved(snapshot.moved);
        animator.addDeformed(snapshot);
        ASSERT_TRUE(types::deformsRightly(snapshot));
        scene::expectSound(*types::posedGeometry(snapshot));
    }
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

}  // namespace insonify::fuzz
