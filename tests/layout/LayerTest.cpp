// The layers of components/sonar, and the sizes of the source tree: a table that `scripts/check` prints.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <map>
#include <set>

#include "tests/layout/Sources.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::layout;

namespace {

namespace fs = std::filesystem;
using Graph = std::map<std::string, std::set<std::string>>;

/** From below to above: a folder includes itself and the folders before it. */
const std::vector<std::string> layers{"base", "config",    "beams",  "surfaces", "plan",     "bins",
                                      "rays", "multipath", "raster", "effects",  "renderer", "tasks"};
const std::string sonar = "components/sonar/";

std::string getFolder(const std::string& path) { return path.substr(0, path.find_last_of('/')); }
std::string findUnit(const std::string& path) { return path.substr(0, path.find_last_of('.')); }

std::vector<Source> product(const std::string& folder = "components") {
    std::vector<Source> all = sourcesIn(folder, {".hpp", ".cpp"});
    if (folder == "components")
        for (Source& source : sourcesIn("types", {".hpp", ".cpp"})) all.push_back(std::move(source));
    return all;
}

/** Which folder includes files of which other. */
Graph folders(const std::vector<Source>& sources) {
    Graph graph;
    for (const Source& source : sources)
        for (const Include& include : includes(source))
            if (include.ours && getFolder(include.target) != getFolder(source.path))
                graph[getFolder(source.path)].insert(getFolder(include.target));
    return graph;
}

/** The nodes that can be reached from a node. */
std::set<std::string> reached(const Graph& graph, const std::string& from) {
    std::set<std::string> seen;
    const std::function<void(const std::string&)> visit = [&](const std::string& node) {
        const auto found = graph.find(node);
        if (found == graph.end()) return;
        for (const std::string& next : found->second)
            if (seen.insert(next).second) visit(next);
    };
    visit(from);
    return seen;
}

std::vector<std::string> inCircles(const Graph& graph) {
    std::vector<std::string> all;
    for (const auto& [node, targets] : graph)
        if (reached(graph, node).contains(node)) all.push_back(node);
    return all;
}

// What has been reached. Lower these numbers when the tree gets smaller; a commit that adds a function for users may
// raise them, and states which. Last: fixes of satellites from DDS, links of joints in Gazebo, walls of `backscatter`,
// shadows as what an object hides, pictures for `fit`, drawn numbers in the running sonar, parts of packages and of
// --version, trials of graphics cards, errors with and without gain, threads for azimuths, labels that never touch,
// headers of all folders by a script, lists of what packages consist of, sets of a device for sim_to_real,
// numbers of SDF that would be cut, tables with columns in any order, vehicles of MAVLink that send no pose.
constexpr size_t max_units = 475, max_small_files = 71, max_folder = 25, max_lines = 138'620;

/** Number of lines of the product, without pages. */
size_t productLines() {
    const std::set<std::string> binary{".glb", ".jpg", ".png", ".pyc"};
    size_t lines = 0;
    for (const char* folder : {"components", "types", "shaders", "ros2", "scripts"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(insonify::test::source_dir) / folder)) {
            const std::string end = entry.path().extension();
            if (!entry.is_regular_file() || end == ".md" || binary.contains(end)) continue;
            lines += readSource(entry.path()).lines.size();
        }
    return lines;
}

/** A figure of the source tree, and the bound that it must not exceed. */
struct Figure {
    std::string name;
    size_t value, bound;
};

std::vector<Figure> figuresOfTheTree() {
    const std::vector<Source> sources = product();
    std::set<std::string> units;
    std::map<std::string, size_t> files;
    size_t small_files = 0;
    for (const Source& source : sources) {
        units.insert(findUnit(source.path));
        ++files[getFolder(source.path)];
        small_files += source.lines.size() <= 40;
    }
    const auto largest = std::ranges::max_element(files, {}, [](const auto& folder) { return folder.second; });
    return {{"folders of components/sonar in a circle of includes",
             inCircles(folders(product("components/sonar"))).size(), 0},
            {"units (a header with its source) of components and types", units.size(), max_units},
            {"files of at most 40 lines", small_files, max_small_files},
            {"files in the largest folder, " + largest->first, largest->second, max_folder},
            {"lines of the product, without pages", productLines(), max_lines}};
}

}  // namespace

TEST(LayerTest, TheSonarIncludesDownwards) {
    const auto rank = [](const std::string& path) {
        const std::string layer = path.substr(sonar.size(), path.find('/', sonar.size()) - sonar.size());
        return std::ranges::find(layers, layer) - layers.begin();
    };
    size_t checked = 0;
    for (const Source& source : product("components/sonar")) {
        ASSERT_LT(rank(source.path), std::ssize(layers)) << source.path << " is in no layer";
        for (const Include& include : includes(source))
            if (include.target.starts_with(sonar)) {
                EXPECT_LE(rank(include.target), rank(source.path)) << source.path << " includes " << include.target;
                ++checked;
            }
    }
    EXPECT_GT(checked, 300u);
}

TEST(LayerTest, ACircleIsFound) {
    const std::vector<Source> sources{{"a/A.hpp", {"#include \"b/B.hpp\""}},
                                      {"b/B.hpp", {"#include \"c/C.hpp\"", "#include <vector>"}},
                                      {"c/C.cpp", {"#include \"b/B.hpp\"", "#include \"c/C.hpp\""}}};
    EXPECT_EQ(inCircles(folders(sources)), (std::vector<std::string>{"b", "c"}));
}

/** Code of a header would differ between targets with and without checks. */
TEST(LayerTest, ChecksAreInSourceFiles) {
    size_t checks = 0;
    for (const Source& source : product())
        for (size_t line = 0; line < source.lines.size(); ++line) {
            if (source.path == "types/Check.hpp" || source.lines[line].find("INSONIFY_CHECK(") == std::string::npos)
                continue;
            EXPECT_FALSE(source.path.ends_with(".hpp")) << source.path << ":" << line + 1;
            ++checks;
        }
    EXPECT_GT(checks, 40u);
}

/** A text says no kind, so that no code decides by a text. */
TEST(LayerTest, OnlyTheKindOfANoticeMakesItAWarning) {
    for (const Source& source : product())
        for (size_t line = 0; line < source.lines.size() && source.path != "types/text/Notice.hpp"; ++line)
            EXPECT_EQ(source.lines[line].find("\"Warning: "), std::string::npos) << source.path << ":" << line + 1;
}

TEST(LayerTest, TheTreeIsNoLargerThanItWas) {
    for (const Figure& figure : figuresOfTheTree()) {
        std::printf("%7zu of at most %7zu  %s\n", figure.value, figure.bound, figure.name.c_str());
        EXPECT_LE(figure.value, figure.bound) << figure.name;
    }
}
