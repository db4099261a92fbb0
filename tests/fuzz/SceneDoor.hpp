#pragma once
// The door for scene files.
#include "components/scene/Scene.hpp"
#include "tests/fuzz/PlayedScene.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {

/** Expects that a file is a sound scene, or an error in our words. */
inline void readScene(const Input& input) try {
    scene::expectSound(*scene::loadScene(input.file()));
    expectSoundWhilePlayed(input.file());
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

}  // namespace insonify::fuzz
