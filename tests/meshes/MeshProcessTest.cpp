// Mesh files that would crash or hang the library that reads them, or exhaust memory: a message, and the program
// continues.
#include <signal.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <random>
#include <thread>

#include "components/meshes/AssimpFile.hpp"
#include "components/meshes/MeshFile.hpp"
#include "components/scene/gltf/Gltf.hpp"
#include "tests/meshes/Dae.hpp"
#include "tests/sdf/SdfFiles.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::meshes {

using namespace scene;
using namespace sdf;
namespace {

struct MeshProcessTest : SdfFiles {
    /** Returns the error of a mesh file; empty if it was read, and then it must be sound. */
    std::string diagnosticOfMesh(const std::filesystem::path& file) const {
        try {
            const types::GeometryPtr geometry = readMeshFile(file, MeshAxes::AsStored);
            for (const types::Mesh& mesh : geometry->meshes) expectSoundMesh(mesh, geometry->materials.size());
            return "";
        } catch (const types::ConfigError& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ": ")) << error.what();
            return error.what();
        }
    }
    std::string findDiagnostic(const Dae& dae) const { return diagnosticOfMesh(write("part.dae", dae.text())); }

    /** Uses a shell script in place of the program that reads. */
    std::string diagnosticWithReader(const std::string& script) const {
        const auto reader = write("reader", "#!/bin/sh\nulimit -c 0\n" + script + "\n");
        std::filesystem::permissions(reader, std::filesystem::perms::owner_all);
        const Variable named("INSONIFY_MESH_READER", reader);
        return findDiagnostic(Dae());
    }
    void expectPart(const std::string& text, const std::string& part) const {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
};

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expectSame(const FileMeshes& apart, const FileMeshes& here) {
    EXPECT_EQ(apart.materials, here.materials);
    ASSERT_EQ(apart.parts.size(), here.parts.size());
    for (size_t i = 0; i < here.parts.size(); ++i) {
        EXPECT_EQ(apart.parts[i].name, here.parts[i].name);
        EXPECT_EQ(apart.parts[i].material, here.parts[i].material);
        EXPECT_TRUE(sameBytes(apart.parts[i].surface.positions, here.parts[i].surface.positions));
        EXPECT_TRUE(sameBytes(apart.parts[i].surface.indices, here.parts[i].surface.indices));
    }
    ASSERT_EQ(apart.placings.size(), here.placings.size());
    for (size_t i = 0; i < here.placings.size(); ++i) {
        EXPECT_EQ(apart.placings[i].name, here.placings[i].name);
        EXPECT_EQ(apart.placings[i].part, here.placings[i].part);
        EXPECT_EQ(apart.placings[i].world_from_part, here.placings[i].world_from_part);
    }
}

TEST_F(MeshProcessTest, ANodeThatInstancesItselfIsRefused) {
    Dae dae;
    dae.nodes = R"(<node id="n" name="n"><instance_geometry url="#g"/><instance_node url="#n"/></node>)";
    const std::string diagnostic = findDiagnostic(dae);
    expectPart(diagnostic, "part.dae");
    expectPart(diagnostic, "best as .glb");
}

TEST_F(MeshProcessTest, InvalidCornersEndInAnErrorOrASoundMesh) {
    for (const char* corners : {"0 0", "0 3", "3 0", "", "3,3", "-3 3", "1 1", "3 800000000", "99999999999 3"})
        for (const char* count : {"2", "0", "-1", "800000000", "99999999999999999999"}) {
            Dae dae;
            dae.triangles = Dae::polygons(count, corners);
            SCOPED_TRACE(dae.triangles);
            findDiagnostic(dae);
        }
}

TEST_F(MeshProcessTest, AStrideBeyondTheArrayEndsInAnErrorOrASoundMesh) {
    for (const char* stride : {"0", "1", "13", "300", "100000000", "4294967295", "-3", "3,0"}) {
        Dae dae;
        dae.accessor = std::string(R"(count="4" stride=")") + stride + "\"";
        SCOPED_TRACE(dae.accessor);
        findDiagnostic(dae);
    }
}

TEST_F(MeshProcessTest, ACommaBetweenIndicesIsRefusedWithinItsMemory) {
    Dae dae;
    dae.triangles = Dae::getTriangles("0,1 2 0 2 3");
    const std::string diagnostic = findDiagnostic(dae);
    expectPart(diagnostic, "part.dae");
    expectPart(diagnostic, "best as .glb");
}

TEST_F(MeshProcessTest, CountsOfThreeGigabytesAreRefused) {
    Dae floats, corners;
    floats.float_count = "800000000";
    corners.triangles = Dae::polygons("800000000", "3 3");
    for (const Dae& dae : {floats, corners}) {
        const std::string diagnostic = findDiagnostic(dae);
        expectPart(diagnostic, "cannot be read: ");
        EXPECT_EQ(diagnostic.find("std::"), std::string::npos) << diagnostic;
    }
}

TEST_F(MeshProcessTest, AFileThatTakesTooLongIsRefused) {
    constexpr int corners = 60'000;  // of one polygon, which takes a time that grows with their square
    std::string obj, face = "f";
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * 3.14159265 * i / corners, radius = 1 + i % 2;
        obj +=
            "v " + std::to_string(radius * std::cos(angle)) + " " + std::to_string(radius * std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    const auto file = write("star.obj", obj + face + "\n");
    ReadLimits limits = ReadLimits::forFile(std::filesystem::file_size(file));
    const auto read = [&] { readMeshesApart(file, MeshAxes::AsStored, limits); };
    limits.processor_s = 1;
    expectPart(test::computeError<types::ConfigError>(read),
               "star.obj: takes more than 1 s to compute; open the model");
    limits.processor_s = 100;
    limits.wall_s = 1;
    expectPart(test::computeError<types::ConfigError>(read), "star.obj: was not read within 1 s; open the model");
}

TEST_F(MeshProcessTest, ReportsEveryEndOfTheReader) {
    expectPart(diagnosticWithReader("kill -SEGV $$"),
               "part.dae: crashes the library that reads it (assimp, SIGSEGV); ");
    expectPart(diagnosticWithReader("kill -ABRT $$"),
               "part.dae: crashes the library that reads it (assimp, SIGABRT); ");
    expectPart(diagnosticWithReader("kill -KILL $$"), "part.dae: was too much to read: its reader was killed");
    expectPart(diagnosticWithReader("kill -XCPU $$"), "part.dae: takes more than 10 s to compute; ");
    expectPart(diagnosticWithReader("kill -ALRM $$"), "part.dae: was not read within 120 s; ");
    expectPart(diagnosticWithReader("kill -XFSZ $$"), "part.dae: holds more than 1024 MB; ");
    expectPart(diagnosticWithReader("exit 7"), "part.dae: cannot be read: its reader ended with 7; ");
    expectPart(diagnosticWithReader("exit 0"), "damaged: the mark is missing");
    expectPart(diagnosticWithReader("echo noise >&3"), "damaged: the mark is missing");
    expectPart(diagnosticWithReader("echo 'insonify meshes 1' >&3"), "damaged: the end is missing");
    expectPart(diagnosticWithReader("echo 'insonify meshes 1' >&3; head -c 7000 /dev/zero | tr '\\0' '\\1' >&3"),
               "damaged");
}

TEST_F(MeshProcessTest, ReportsAMissingReader) {
    const Variable named("INSONIFY_MESH_READER", folder_ / "nowhere");
    expectPart(findDiagnostic(Dae()), "part.dae: cannot be read: " + (folder_ / "nowhere").string() + ": No such file");
}

TEST_F(MeshProcessTest, ReadsFromManyThreadsAndWithIgnoredChildren) {
    const auto file = write("part.dae", Dae().text());
    const auto before = signal(SIGCHLD, SIG_IGN);
    std::vector<std::thread> threads;
    std::atomic<size_t> triangles = 0;
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([&] { triangles += readMeshFile(file, MeshAxes::AsStored)->triangleCount(); });
    for (std::thread& thread : threads) thread.join();
    signal(SIGCHLD, before);
    EXPECT_EQ(triangles, 16u);
}

TEST_F(MeshProcessTest, AMeshThatCannotBeReadIsTriedOnceInAWorld) {
    write("part.dae", "<COLLADA>");
    const auto reader = write("reader", "#!/bin/sh\necho tried >> '" + (folder_ / "tries").string() + "'\nexit 1\n");
    std::filesystem::permissions(reader, std::filesystem::perms::owner_all);
    const Variable named("INSONIFY_MESH_READER", reader);
    const std::string part = "<mesh><uri>part.dae</uri></mesh>";
    const auto geometry = world(model("a", part) + model("b", part) + model("c", box_)).geometry;
    EXPECT_EQ(geometry->objects.size(), 1u);
    EXPECT_TRUE(hasNotice(*geometry, "2 visuals are omitted: part.dae cannot be read"));
    EXPECT_TRUE(hasNotice(*geometry, "(a::hull::skin, b::hull::skin)"));
    EXPECT_EQ(std::filesystem::file_size(folder_ / "tries"), std::string("tried\n").size());
}

TEST_F(MeshProcessTest, ChecksRepliesLikeFiles) {
    MeshReply reply;
    reply.meshes.materials = {"steel"};
    scene::Surface triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.indices = {0, 1, 2};
    reply.meshes.parts = {{"plate", 0, triangle}};
    reply.meshes.placings = {{"node", 0, glm::dmat4(2)}};
    const auto bytesOfReply = [](const MeshReply& written) {
        char* data = nullptr;
        size_t size = 0;
        std::FILE* file = open_memstream(&data, &size);
        EXPECT_TRUE(writeReply(written, file));
        std::fclose(file);
        const auto* begin = reinterpret_cast<const std::byte*>(data);
        const std::vector<std::byte> bytes(begin, begin + size);
        std::free(data);
        return bytes;
    };
    const std::vector<std::byte> whole = bytesOfReply(reply);
    expectSame(parseReply(whole).meshes, reply.meshes);
    for (size_t size = 0; size < whole.size(); ++size)
        EXPECT_THROW(parseReply({whole.data(), size}), std::runtime_error) << size;
    std::minstd_rand random(1);
    for (int round = 0; round < 20'000; ++round) {
        std::vector<std::byte> damaged = whole;
        damaged[random() % damaged.size()] = static_cast<std::byte>(random());
        try {
            const MeshReply read = parseReply(damaged);
            for (const auto& part : read.meshes.parts)
                for (const uint32_t index : part.surface.indices) ASSERT_LT(index, part.surface.positions.size());
            for (const auto& placing : read.meshes.placings) ASSERT_LT(placing.part, read.meshes.parts.size());
        } catch (const std::runtime_error&) {
        }
    }
}

TEST_F(MeshProcessTest, EveryDamageIsAMeshOrAnError) {
    const std::pair<const char*, std::string> files[] = {
        {"part.dae", Dae().text()},
        {"part.obj", "o plate\nv 0 0 1\nv 2 0 1\nv 2 3 1\nv 0 3 1\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n"},
        {"part.stl", std::string(80, ' ') + toBytes<uint32_t>({1}) +
                         toBytes<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + toBytes<uint16_t>({0})}};
    std::minstd_rand random(11);
    for (const auto& [name, whole] : files)
        for (int round = 0; round < 60; ++round) {
            std::string damaged = whole;
            for (unsigned flips = 1 + random() % 3; flips > 0; --flips)
                damaged[random() % damaged.size()] = static_cast<char>(random() % 2 ? random() : '0' + random() % 10);
            SCOPED_TRACE(damaged);
            diagnosticOfMesh(write(name, damaged));
        }
}

TEST_F(MeshProcessTest, ForeignFilesAreReadBitForBitAsWithoutAProcess) {
    const std::filesystem::path shared = test::shared_data;
    if (!std::filesystem::is_directory(shared)) GTEST_SKIP() << "NO FILES AT " << shared << ": NOTHING WAS COMPARED";
    size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(shared)) {
        const std::string extension = getExtension(entry.path());
        if (extension != ".dae" && extension != ".obj" && extension != ".stl" && extension != ".ply") continue;
        SCOPED_TRACE(entry.path());
        const MeshAxes axes = extension == ".dae" ? MeshAxes::ZUp : MeshAxes::AsStored;
        const ReadLimits limits = ReadLimits::forFile(std::filesystem::file_size(entry.path()));
        expectSame(readMeshesApart(entry.path(), axes, limits), readByAssimp(entry.path(), axes));
        ++files;
    }
    EXPECT_GE(files, 12u);
}

}  // namespace
}  // namespace insonify::meshes
