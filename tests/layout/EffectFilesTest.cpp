// An effect is a file: counts the files of the product that name each effect of components/sonar/effects.
#include <gtest/gtest.h>

#include <cctype>
#include <map>
#include <regex>

#include "tests/layout/Sources.hpp"

using namespace insonify::layout;

namespace {

constexpr size_t max_files = 8;

/** Effects that more files name, with the number of those files. The number may fall, and must not rise. */
const std::map<std::string, size_t> known{
    {"absorption", 23},  {"backscatter", 21}, {"beamPatterns", 14}, {"pulse", 19},
    {"speckle", 16},     {"multipath", 10},   {"motionInPing", 12}, {"normalMaps", 33},
    {"pointTargets", 9}, {"surfaceMaps", 20}, {"truth", 70},
};

/** Folders and files in which the word has another meaning. */
const std::multimap<std::string, std::string> other_meanings{
    {"crosstalk", "components/sonar/effects/Imperfections.cpp"},  // Between a device's neighbouring beams.
    {"crosstalk", "components/sonar/config/SonarConfig.hpp"},     // The same.
    {"volume", "components/acoustics/Seabed"},                    // Scattering within a sediment.
    {"volume", "components/command/BackscatterCommand.cpp"},      // The same.
    {"volume", "components/scene/Clusters.cpp"},                  // The inside of a mesh.
    {"volume", "components/scene/gltf/GltfFile.cpp"},             // An extension of glTF.
    {"volume", "components/sonar/rays/Scatterers"},               // The space between the axes of a lattice.
    {"volume", "components/sonar/rays/RayVisibility.cpp"},        // The space between the axes of an object.
    {"volume", "types/geometry/MeshRays.hpp"},                    // The space between a triangle and a ray.
};

/** Code without its comments and includes, in lower case and without underscores: one spelling for all of an effect's
 * names. */
std::string namesIn(const Source& source) {
    static const std::regex line_comment("//.*");
    std::string text;
    for (const std::string& line : source.lines)
        if (!line.starts_with("#include ")) text += std::regex_replace(line, line_comment, "") + "\n";
    for (size_t at = 0; (at = text.find("/*", at)) != std::string::npos;)
        text.erase(at, std::min(text.find("*/", at), text.size()) + 2 - at);
    std::erase(text, '_');
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/** The singular of an effect's name, spelled as namesIn() does. */
std::string spelled(std::string name) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name.ends_with('s')) name.pop_back();
    return name;
}

/** The effects that the list declares, in its order. */
std::vector<std::string> effectNames() {
    static const std::regex declaration(R"(^const Effect& (\w+)\(\);)");
    std::vector<std::string> names;
    for (const std::string& line :
         readSource(std::filesystem::path(insonify::test::source_dir) / "components/sonar/plan/Effects.cpp").lines)
        if (std::smatch found; std::regex_search(line, found, declaration)) names.push_back(found[1]);
    return names;
}

/** Paths of the product's files with their names; studies measure the product, and are not part of it. */
std::map<std::string, std::string> productNames() {
    std::map<std::string, std::string> names;
    for (const char* folder : {"types", "components", "shaders"})
        for (const Source& source : sourcesIn(folder, {".hpp", ".cpp", ".glsl"}))
            if (source.folder() != "study") names[source.path] = namesIn(source);
    return names;
}

bool meansAnother(const std::string& effect, const std::string& path) {
    const auto [first, last] = other_meanings.equal_range(effect);
    return std::any_of(first, last, [&](const auto& other) { return path.starts_with(other.second); });
}

}  // namespace

TEST(EffectFilesTest, FewFilesNameAnEffect) {
    const std::map<std::string, std::string> product = productNames();
    const std::vector<std::string> effects = effectNames();
    ASSERT_GT(effects.size(), 10u);
    for (const std::string& effect : effects) {
        std::vector<std::string> files;
        for (const auto& [path, names] : product)
            if (names.find(spelled(effect)) != std::string::npos && !meansAnother(effect, path)) files.push_back(path);
        const auto more = known.find(effect);
        EXPECT_LE(files.size(), more == known.end() ? max_files : more->second)
            << effect << ": " << testing::PrintToString(files);
        const auto isItsOwn = [](const std::string& path) {
            return path.starts_with("components/sonar/effects/") && !path.ends_with("/Effects.cpp");
        };
        EXPECT_TRUE(std::ranges::any_of(files, isItsOwn)) << effect << " is not named in a file of its own";
    }
}

TEST(EffectFilesTest, ExceptionsStillHold) {
    const std::map<std::string, std::string> product = productNames();
    for (const auto& [effect, number] : known) EXPECT_GT(number, max_files) << effect;
    for (const auto& [effect, prefix] : other_meanings)
        EXPECT_TRUE(std::ranges::any_of(product,
                                        [&](const auto& file) {
                                            return file.first.starts_with(prefix) &&
                                                   file.second.find(spelled(effect)) != std::string::npos;
                                        }))
            << prefix << " does not name " << effect;
}

TEST(EffectFilesTest, CommentsNameNoEffect) {
    const Source source{"x.cpp", {"int own_volume;  // pulse", "/* speckle", "multipath */ double ringDown;"}};
    EXPECT_EQ(namesIn(source), "int ownvolume;  \n double ringdown;\n");
}
