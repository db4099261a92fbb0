// Invalid files: a ConfigError that names the file, or a scene; never a crash.
#include <gmock/gmock.h>

#include <random>

#include "tests/scene/SceneFiles.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

struct BadInputTest : SceneFiles {
    void expectDiagnostic(const std::filesystem::path& file, const std::string& part) const {
        const std::string diagnostic = findDiagnostic(file);
        EXPECT_NE(diagnostic.find(file.string()), std::string::npos) << diagnostic;
        EXPECT_NE(diagnostic.find(part), std::string::npos) << diagnostic;
    }
    void expectGltfDiagnostic(const std::string& rest, const std::string& part) const {
        expectDiagnostic(write("case.gltf", gltf(rest)), part);
    }
    /** A triangle with the given accessors and bufferViews. */
    static std::string triangle(const std::string& accessors, const std::string& views) {
        return R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[)" +
               accessors + R"(],"bufferViews":[)" + views + "]," + buffers(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}));
    }
};

const char* const good_accessor = R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":3})";
const char* const good_view = R"({"buffer":0,"byteLength":36})";

std::string glb(const std::string& json, const std::string& binary) {
    const auto chunk = [](const std::string& type, std::string bytes, char pad) {
        while (bytes.size() % 4 != 0) bytes += pad;
        return toBytes<uint32_t>({static_cast<uint32_t>(bytes.size())}) + type + bytes;
    };
    const std::string chunks = chunk("JSON", json, ' ') + chunk(std::string("BIN\0", 4), binary, '\0');
    return "glTF" + toBytes<uint32_t>({2, static_cast<uint32_t>(12 + chunks.size())}) + chunks;
}

TEST_F(BadInputTest, ReportsMissingEmptyAndForeignFilesAndFolders) {
    std::filesystem::create_directory(folder_ / "folder.glb");
    expectDiagnostic(folder_ / "missing.glb", "must be a scene, which may be " + sceneEndings());
    expectDiagnostic(folder_ / "folder.glb", "is not a file");
    expectDiagnostic(write("empty.glb", ""), "is empty");
    expectDiagnostic(write("cube.fbx", "v 0 0 0"), "has extension \".fbx\"; may be " + sceneEndings());
    expectDiagnostic(write("noise.glb", "this is no model at all"), "cannot be read as glTF 2.0");
}

TEST_F(BadInputTest, EndingsInAnyCaseOfLettersBelongToTheSameReader) {
    std::mt19937 random(7);
    const auto respelled = [&](std::string text) {
        for (char& c : text)
            if (random() % 2) c = types::raised(c);
        return text;
    };
    for (const SceneFormat& format : sceneFormats()) {
        const std::string ending(format.ending), lower = "x" + ending;
        const std::string expected = findDiagnostic(write(lower, "neither JSON nor XML"));
        EXPECT_THAT(expected, testing::Not(testing::HasSubstr("has extension"))) << ending;
        EXPECT_THAT(sceneEndings(), testing::HasSubstr(ending));
        for (int i = 0; i < 10; ++i) {
            const std::string name = "x" + respelled(ending);
            SCOPED_TRACE(name);
            ASSERT_EQ(findSceneFormat(name), &format);
            EXPECT_EQ(isGltf(name), isGltf(lower));
            std::string diagnostic = findDiagnostic(write(name, "neither JSON nor XML"));
            for (size_t at; name != lower && (at = diagnostic.find(name)) != std::string::npos;)
                diagnostic.replace(at, name.size(), lower);
            EXPECT_EQ(diagnostic, expected);
            EXPECT_THAT(findDiagnostic(folder_ / ("y" + respelled(ending))), testing::HasSubstr("did you mean "));
        }
    }
    for (const char* other : {"x", "x.", "x.glb2", "x.gl", ".glb", "x.sdf.bak", "glb"}) {
        EXPECT_EQ(findSceneFormat(other), nullptr) << other;
        expectDiagnostic(write(other, "x"), "may be " + sceneEndings());
    }
}

TEST_F(BadInputTest, DoesNotReadImagesThatExhaustMemory) {
    expectDiagnostic(write("416.gltf", R"({"images":[{"uri":"%!QAAAQAAA5"}],"asset":{"version":""}})"),
                     "asset.version");
    expectDiagnostic(write("cut.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"%!QAAAQA)"),
                     "cannot be read as glTF 2.0");
    EXPECT_EQ(diagnosticOfGltf(R"("images":[{"uri":"."},{"uri":""},{"uri":"/"},{"uri":"/dev/zero"}])"), "");
}

/** A buffer is read as vertices: a model of somebody else must not show any file of the machine in this way. */
TEST_F(BadInputTest, NamesThatLeaveTheFolderAreRefusedInEverySpelling) {
    const std::string corners = toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    write("secret.bin", corners);
    write("scenes/own.bin", corners);
    write("scenes/sub/own.bin", corners);
    std::filesystem::create_symlink("../secret.bin", folder_ / "scenes/link.bin");
    std::filesystem::create_symlink("own.bin", folder_ / "scenes/near.bin");
    std::filesystem::create_directory_symlink("..", folder_ / "scenes/up");
    const auto named = [&](const std::string& scene, const std::string& name) {
        const std::string views = triangle(good_accessor, good_view);
        return findDiagnostic(write(scene, gltf(views.substr(0, views.find("\"buffers\"")) +
                                                R"("buffers":[{"byteLength":36,"uri":")" + name + R"("}])")));
    };
    for (const char* name : {"own.bin", "./own.bin", "sub/own.bin", "sub/../own.bin", "sub%2f..%2Fown.bin", "near.bin"})
        EXPECT_EQ(named("scenes/case.gltf", name), "") << name;
    for (const char* name : {"../secret.bin", "%2e%2e/secret.bin", "%2E%2E%2Fsecret.bin", "..%2fsecret.bin",
                             "sub/../../secret.bin", "./../secret.bin", "link.bin", "up/secret.bin", "../none.bin"})
        EXPECT_THAT(named("scenes/case.gltf", name), testing::HasSubstr(", which is outside of its folder")) << name;
    EXPECT_NE(named("scenes/case.gltf", (folder_ / "secret.bin").string()), "");
    EXPECT_NE(named("scenes/case.gltf", "file://" + (folder_ / "secret.bin").string()), "");
    // The folders of a model belong to it.
    EXPECT_THAT(named("scenes/sub/case.gltf", "../own.bin"), testing::HasSubstr("outside of its folder"));
    write("scenes/model.config", "");
    EXPECT_EQ(named("scenes/sub/case.gltf", "../own.bin"), "");
    EXPECT_THAT(named("scenes/sub/case.gltf", "../../secret.bin"), testing::HasSubstr("outside of its folder"));
    // As an installed package of links to its sources, file by file.
    named("scenes/case.gltf", "own.bin");
    std::filesystem::create_directory(folder_ / "install");
    for (const char* file : {"case.gltf", "own.bin"})
        std::filesystem::create_symlink(folder_ / "scenes" / file, folder_ / "install" / file);
    EXPECT_EQ(findDiagnostic(folder_ / "install/case.gltf"), "");
}

TEST_F(BadInputTest, AnImageOutsideOfTheFolderIsAWarning) {
    write("secret.png", "x");
    const auto geometry =
        loadScene(write("scenes/case.gltf", gltf(R"("images":[{"uri":"../secret.png"}],)" + scene::triangle() +
                                                 R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
                                                   "nodes":[{"mesh":0}])")));
    ASSERT_EQ(geometry->notices.size(), 1u);
    EXPECT_THAT(geometry->notices[0].text, testing::HasSubstr("names ../secret.png, which is outside of its folder"));
}

TEST_F(BadInputTest, OtherVersionsAreRefused) {
    expectDiagnostic(write("one.gltf", R"({"asset":{"version":"1.0"}})"), "asset.version: is \"1.0\"; must be 2.0");
}

TEST_F(BadInputTest, JsonNestedTooDeeplyIsRefusedBeforeItIsParsed) {
    const std::string deep(100'000, '[');
    expectDiagnostic(write("deep.gltf", R"({"asset":{"version":"2.0","extras":)" + deep),
                     "nests JSON 100002 levels deep; may be up to 200");
    expectDiagnostic(write("deep.glb", glb(R"({"asset":{"version":"2.0","extras":)" + deep, "")), "levels deep");
    EXPECT_EQ(diagnosticOfGltf(R"("extras":")" + deep + "\""), "");  // brackets in a text do not nest
}

TEST_F(BadInputTest, GigabytesDeclaredInAKilobyteAreRefusedWithoutBeingAllocated) {
    expectGltfDiagnostic(R"("buffers":[{"byteLength":4294967295,"uri":"data:application/octet-stream;base64,AAAA"}])",
                         "");
    expectGltfDiagnostic(
        triangle(R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":4294967295})", good_view),
        "accessors[0]: 4294967295 elements of 12 bytes from byteOffset 0 run over the bufferView's 36 bytes");
    expectGltfDiagnostic(triangle(R"({"componentType":5126,"type":"VEC3","count":4294967295})", good_view),
                         "accessors[0].count");
    expectGltfDiagnostic(
        triangle(R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":18446744073709551615})", good_view),
        "run over");
    expectDiagnostic(write("4g.glb", "glTF" + toBytes<uint32_t>({2, 0xffffffff, 0xfffffff0}) + "JSON{}"), "truncated");
}

TEST_F(BadInputTest, LimitsPrimitivesThatRepeatTheSameData) {
    std::string primitives;
    for (int i = 0; i < 30; ++i) primitives += R"({"attributes":{"POSITION":0}},)";
    primitives += R"({"attributes":{"POSITION":0}})";
    expectGltfDiagnostic(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[)" + primitives +
                             R"(]}],"accessors":[{"componentType":5126,"type":"VEC3","count":10000000}])",
                         "brings the file over 200000000 vertices and indices");
}

TEST_F(BadInputTest, EveryBoundOfAnAccessorIsChecked) {
    const auto accessor = [](const std::string& fields) { return triangle("{" + fields + "}", good_view); };
    const auto view = [](const std::string& fields) { return triangle(good_accessor, "{" + fields + "}"); };
    EXPECT_EQ(diagnosticOfGltf(triangle(good_accessor, good_view)), "");
    expectGltfDiagnostic(accessor(R"("bufferView":3,"componentType":5126,"type":"VEC3","count":3)"),
                         "accessors[0].bufferView: is 3; the file has 1");
    expectGltfDiagnostic(accessor(R"("bufferView":0,"byteOffset":1,"componentType":5126,"type":"VEC3","count":3)"),
                         "run over");
    expectGltfDiagnostic(
        accessor(R"("bufferView":0,"byteOffset":18446744073709551615,"componentType":5126,"type":"VEC3","count":3)"),
        "run over");
    expectGltfDiagnostic(accessor(R"("bufferView":0,"componentType":5124,"type":"VEC3","count":3)"),
                         "componentType: is 5124");
    expectGltfDiagnostic(accessor(R"("bufferView":0,"componentType":5126,"type":"VEC2","count":3)"), "must be VEC3");
    expectGltfDiagnostic(view(R"("buffer":0,"byteLength":37)"),
                         "bufferViews[0]: byteOffset 0 + byteLength 37 run over the buffer's 36 bytes");
    expectGltfDiagnostic(view(R"("buffer":0,"byteOffset":18446744073709551615,"byteLength":36)"),
                         "run over the buffer's");
    expectGltfDiagnostic(view(R"("buffer":1,"byteLength":36)"), "bufferViews[0].buffer: is 1; the file has 1");
    expectGltfDiagnostic(view(R"("buffer":-1,"byteLength":36)"), "bufferViews[0].buffer: is -1");
    expectGltfDiagnostic(view(R"("buffer":0,"byteLength":36,"byteStride":8)"),
                         "byteStride is 8; its elements have 12 bytes");
    expectGltfDiagnostic(view(R"("buffer":0,"byteLength":36,"byteStride":16)"), "run over");
    expectGltfDiagnostic(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":9}}]}])",
                         "accessors[9]: does not exist");
    expectGltfDiagnostic(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":-2}}]}])",
                         "accessors[-2]: does not exist");
}

TEST_F(BadInputTest, SparseIndicesAreChecked) {
    const auto sparse = [](const std::string& fields) {
        return triangle(R"({"componentType":5126,"type":"VEC3","count":2,"sparse":{)" + fields + "}}", good_view);
    };
    expectGltfDiagnostic(
        sparse(
            R"("count":1,"indices":{"bufferView":0,"componentType":5125,"byteOffset":12},"values":{"bufferView":0})"),
        "sparse.indices: hold 1065353216; the accessor has 2 elements");
    expectGltfDiagnostic(
        sparse(R"("count":-1,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0})"), "negative");
    expectGltfDiagnostic(
        sparse(R"("count":99,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0})"), "run over");
    expectGltfDiagnostic(
        sparse(R"("count":1,"indices":{"bufferView":0,"componentType":5126},"values":{"bufferView":0})"),
        "may be 5121");
    expectGltfDiagnostic(
        sparse(R"("count":1,"indices":{"bufferView":7,"componentType":5121},"values":{"bufferView":0})"),
        "bufferView: is 7");
}

TEST_F(BadInputTest, IndicesOfTrianglesAndAttributesOfOtherLengthsAreRefused) {
    const auto indexed = [](const std::string& primitive) {
        return R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}, )" + primitive + R"(}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
                         {"bufferView":1,"componentType":5121,"type":"SCALAR","count":3}],
            "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],)" +
               buffers(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + toBytes<uint8_t>({0, 1, 3}));
    };
    expectGltfDiagnostic(indexed(R"("indices":1)"),
                         "meshes[0].primitives[0].indices: hold 3; the primitive has 3 vertices");
    expectGltfDiagnostic(indexed(R"("indices":0)"), "accessors[0]: holds indices but");
    expectGltfDiagnostic(indexed(R"("mode":9)"), "mode: is 9; may be 0 to 6");
    expectGltfDiagnostic(indexed(R"("material":4)"), "material: is 4; the file has 0");
}

TEST_F(BadInputTest, ReportsUnsupportedExtensionsWithARemedy) {
    const auto require = [this](const std::string& name, const std::string& part) {
        expectGltfDiagnostic(R"("extensionsUsed":[")" + name + R"("],"extensionsRequired":[")" + name + "\"]",
                             name + " cannot be read; " + part);
    };
    require("KHR_draco_mesh_compression", "decompress it: `gltf-transform copy");
    require("EXT_meshopt_compression", "decompress it");
    require("EXT_texture_webp", "convert its images to PNG");
    require("KHR_texture_basisu", "convert its images to PNG");
    require("VENDOR_curves", "export the model without it");
    EXPECT_TRUE(hasNotice(*load(R"("extensionsUsed":["EXT_texture_webp"])"), "EXT_texture_webp is not read"));
}

TEST_F(BadInputTest, AFileCutOffAnywhereIsAnErrorOrAScene) {
    const std::string whole = glb(
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})",
        toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}));
    EXPECT_EQ(loadScene(write("whole.glb", whole))->triangleCount(), 1u);
    for (size_t size = 0; size < whole.size(); ++size)
        EXPECT_THROW(loadScene(write("cut.glb", whole.substr(0, size))), types::ConfigError) << size;
}

TEST_F(BadInputTest, DamagedBytesGiveAnErrorOrASoundScene) {
    const std::string texts[] = {
        gltf(triangle(good_accessor, good_view)),
        glb(R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0,"scale":[1,2,3],"children":[1]},{"mesh":0,"rotation":[0,0,0,1]}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":0,"mode":5}]}],
            "materials":[{"extras":{"acoustics":{"sediment":"clay"}},"normalTexture":{"index":0}}],"textures":[{"source":0}],
            "images":[{"bufferView":0,"mimeType":"image/png"}],
            "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
                         {"bufferView":1,"componentType":5121,"type":"SCALAR","count":3},
                         {"componentType":5126,"type":"VEC2","count":3,
                          "sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}}}],
            "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],"buffers":[{"byteLength":40}]})",
            toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + toBytes<uint8_t>({0, 1, 2, 0}))};
    std::mt19937 random(7);
    size_t scenes = 0;
    const size_t rounds = std::getenv("INSONIFY_FUZZ") ? std::stoul(std::getenv("INSONIFY_FUZZ")) : 250;
    for (const std::string& text : texts)
        for (size_t round = 0; round < rounds; ++round) {
            std::string damaged = text;
            for (unsigned flips = 1 + random() % 4; flips > 0; --flips)
                damaged[random() % damaged.size()] =
                    random() % 2 ? static_cast<char>(random()) : static_cast<char>('0' + random() % 10);
            try {
                expectSound(*loadScene(write(text.starts_with("glTF") ? "fuzz.glb" : "fuzz.gltf", damaged)));
                ++scenes;
            } catch (const types::ConfigError& error) {
                EXPECT_NE(std::string(error.what()), "");
                for (const char* raw : {"std::", "stoi", "_M_", "basic_string", "json.exception"})
                    EXPECT_EQ(std::string(error.what()).find(raw), std::string::npos) << error.what();
            }
        }
    EXPECT_GT(scenes, 0u);  // not every byte matters
}

}  // namespace
}  // namespace insonify::scene
