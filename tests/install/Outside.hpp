#pragma once
// An installed Insonify, and projects outside of it.
#include <gtest/gtest.h>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::deployer {

inline Outcome call(const TestFolder& folder, std::vector<std::string> words) {
    return Process(std::move(words), folder.path()).wait();
}

/** `cmake --install` into a prefix in the folder. */
inline void install(const TestFolder& folder) {
    ASSERT_THAT(call(folder, {INSONIFY_CMAKE, "--install", test::build_dir, "--prefix", folder / "prefix"}),
                succeeds());
}

/** Configures the project in the folder with only the prefix, and builds it in its folder `build`. */
inline Outcome buildOutside(const TestFolder& folder, const std::string& prefix) {
    const Outcome configured =
        call(folder, {INSONIFY_CMAKE, "-S", ".", "-B", "build", "-DCMAKE_PREFIX_PATH=" + prefix});
    if (configured.code != 0) return configured;
    return call(folder, {INSONIFY_CMAKE, "--build", "build"});
}

}  // namespace insonify::deployer
