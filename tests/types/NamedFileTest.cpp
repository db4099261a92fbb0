#include <gtest/gtest.h>

#include "tests/support/Draw.hpp"
#include "tests/support/Folder.hpp"
#include "types/NamedFile.hpp"

namespace insonify::types {
namespace {

namespace fs = std::filesystem;

TEST(NamedFileTest, ResolvesDotsAndLinks) {
    const Folder all;
    fs::create_directories(all / "a/b");
    fs::create_directory_symlink("..", all / "a/up");
    fs::create_symlink("loop", all / "a/loop");
    EXPECT_TRUE(isBelow(all / "a", all / "a"));
    EXPECT_TRUE(isBelow(all / "a/b/none/../x", all / "a/")) << "what does not exist";
    EXPECT_TRUE(isBelow(all / "a/up/a/b", all / "a"));
    EXPECT_TRUE(isBelow(all / "a", "/"));
    for (const char* outside : {"", "ab", "a/..", "a/up", "a/up/x", "a/b/../../x", "a/loop/x"})
        EXPECT_FALSE(isBelow(all / outside, all / "a")) << outside;
    EXPECT_FALSE(isBelow("", all / "a"));
}

/** Random trees with links: a name belongs to the file that names it exactly when the place that it leads to is in the
 *  file's folder, by the system's own resolution. */
TEST(NamedFileTest, BelongsByThePlaceThatANameLeadsTo) {
    const test::Seeds seeds(40);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        test::Draw draw(seed);
        const Folder all;
        std::vector<fs::path> folders = {all.path()};
        const auto any = [&] { return folders[static_cast<size_t>(draw.upTo(static_cast<int>(folders.size())))]; };
        for (int i = 0; i < 12; ++i) {
            const fs::path place = any() / std::string(1, static_cast<char>('a' + i));
            draw.once(3) ? fs::create_directory_symlink(any(), place) : void(fs::create_directory(place));
            folders.push_back(place);
            writeBytes(place / "x", {'1'});
        }
        for (int i = 0; i < 60; ++i) {
            const fs::path scene = any() / "scene.gltf";
            fs::path named = scene.parent_path();
            for (int steps = draw.upTo(5); steps > 0; --steps)
                named /= draw.once(2) ? ".." : std::string(1, static_cast<char>('a' + draw.upTo(12)));
            named /= "x";
            std::error_code none;
            const fs::path real = fs::canonical(named, none), folder = fs::canonical(scene.parent_path());
            if (none) continue;
            const bool is_below = real.string().starts_with(folder.string() + "/");
            EXPECT_EQ(belongsTo(named, scene), is_below) << seed << " " << named << " of " << scene;
        }
    }
}

}  // namespace
}  // namespace insonify::types
