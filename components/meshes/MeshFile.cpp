#include "components/meshes/MeshFile.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <glm/matrix.hpp>

#include "components/loader/ComponentLibrary.hpp"
#include "components/scene/Clusters.hpp"
#include "components/scene/Surface.hpp"
#include "components/scene/UniqueNames.hpp"
#include "components/scene/gltf/Gltf.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::meshes {

using namespace scene;
namespace {

constexpr const char* remedy = "; open the model in its own program and export it again, best as .glb";

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& message) {
    throw types::ConfigError(file.string(), "", message);
}

[[noreturn]] void refuseForSystem(const std::filesystem::path& file, const char* what, int error) {
    refuse(file, fmt::format("cannot be read: {}: {}", what, std::strerror(error)));
}

std::filesystem::path findReader(const std::filesystem::path& file) {
    if (const char* named = std::getenv("INSONIFY_MESH_READER")) return named;
    for (const std::filesystem::path& folder : loader::folders())
        if (access((folder / mesh_reader).c_str(), X_OK) == 0) return folder / mesh_reader;
    refuse(file, fmt::format("cannot be read: needs {}, with its program {}", loader::absence("meshes"), mesh_reader));
}

/** A file in memory that is deleted with its last user. */
class MemoryFile {
public:
    explicit MemoryFile(const std::filesystem::path& file) : descriptor_(memfd_create("insonify meshes", MFD_CLOEXEC)) {
        if (descriptor_ < 0) refuseForSystem(file, "memfd_create", errno);
    }
    ~MemoryFile() {
        if (mapped_) munmap(mapped_, size_);
        close(descriptor_);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    int descriptor() const { return descriptor_; }
    /** Returns its contents. Call it once. */
    std::span<const std::byte> bytes(const std::filesystem::path& file) {
        struct stat state {};
        if (fstat(descriptor_, &state) != 0) refuseForSystem(file, "fstat", errno);
        if (state.st_size == 0) return {};
        size_ = static_cast<size_t>(state.st_size);
        void* mapped = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
        if (mapped == MAP_FAILED) refuseForSystem(file, "mmap", errno);
        mapped_ = mapped;
        return {static_cast<const std::byte*>(mapped_), size_};
    }

private:
    int descriptor_;
    void* mapped_ = nullptr;
    size_t size_ = 0;
};

/** Settings to start the process. Only the reply stays open in it, no signal is blocked or ignored, and a terminal's
 *  SIGINT does not reach it. */
class SpawnSettings {
public:
    explicit SpawnSettings(int reply) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_adddup2(&actions_, reply, mesh_reply_descriptor);
        posix_spawn_file_actions_addclosefrom_np(&actions_, mesh_reply_descriptor + 1);
        for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
            posix_spawn_file_actions_addopen(&actions_, standard, "/dev/null", O_RDWR, 0);
        posix_spawnattr_init(&attributes_);
        sigset_t signals;
        sigemptyset(&signals);
        posix_spawnattr_setsigmask(&attributes_, &signals);
        sigfillset(&signals);
        posix_spawnattr_setsigdefault(&attributes_, &signals);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    ~SpawnSettings() {
        posix_spawnattr_destroy(&attributes_);
        posix_spawn_file_actions_destroy(&actions_);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;

    int start(std::vector<std::string> words, pid_t& process) const {
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        return posix_spawn(&process, arguments[0], &actions_, &attributes_, arguments.data(), environ);
    }

private:
    posix_spawn_file_actions_t actions_;
    posix_spawnattr_t attributes_;
};

/** Returns why a signal ended the process. */
std::string cause(int signal, const ReadLimits& limits) {
    switch (signal) {
        case SIGXCPU: return fmt::format("takes more than {} s to compute", limits.processor_s);
        case SIGALRM: return fmt::format("was not read within {} s", limits.wall_s);
        case SIGXFSZ: return fmt::format("holds more than {} MB", limits.memory >> 20);
        case SIGKILL: return "was too much to read: its reader was killed, probably out of memory";
        default: return fmt::format("crashes the library that reads it (assimp, SIG{})", sigabbrev_np(signal));
    }
}

/** Waits for the end of the process. If a program ignores SIGCHLD there is no status; then only the reply shows the
 *  outcome. */
void await(pid_t process, const std::filesystem::path& file, const ReadLimits& limits) {
    int status = 0;
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR) return;
    if (WIFSIGNALED(status)) refuse(file, cause(WTERMSIG(status), limits) + remedy);
    if (WEXITSTATUS(status) != 0)
        refuse(file, fmt::format("cannot be read: its reader ended with {}{}", WEXITSTATUS(status), remedy));
}

/** Returns the meshes of a file at the same indices; without triangles if no triangle is usable. */
std::vector<types::Mesh> getMeshes(FileMeshes& from, types::Notices& notices) {
    std::vector<types::Mesh> meshes(from.parts.size());
    DroppedTriangles dropped;
    for (size_t i = 0; i < meshes.size(); ++i) {
        Surface surface = std::move(from.parts[i].surface);
        cleanUp(surface, dropped);
        meshes[i].name = from.parts[i].name;
        if (surface.indices.empty()) continue;
        appendSurface(surface, static_cast<int>(from.parts[i].material), meshes[i]);
        buildClusters(meshes[i]);
    }
    dropped.addTo(notices);
    return meshes;
}

/** Removes the materials of no mesh: assimp makes one for surfaces that name none. */
void dropUnused(types::Geometry& geometry) {
    std::vector<int> numbers(geometry.materials.size(), -1);
    const auto forEach = [&](auto&& visit) {
        for (types::Mesh& mesh : geometry.meshes)
            for (types::Cluster& cluster : mesh.clusters) visit(cluster.material);
    };
    forEach([&](int material) { numbers[static_cast<size_t>(material)] = 0; });
    int used = 0;
    std::vector<types::Material> kept;
    for (size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] == 0) numbers[i] = used++, kept.push_back(std::move(geometry.materials[i]));
    geometry.materials = std::move(kept);
    forEach([&](int& material) { material = numbers[static_cast<size_t>(material)]; });
}

types::GeometryPtr readGltfMesh(const std::filesystem::path& file, MeshAxes axes) {
    const Scene scene = readGltf(file);
    types::Geometry geometry = *scene.geometry;
    for (const types::Omission& omission : scene.omitted)
        geometry.notices.push_back(fmt::format("omitted: {}: {}", omission.name, omission.reason));
    if (axes == MeshAxes::AsStored)
        for (types::Object& object : geometry.objects)
            object.world_from_object = glm::transpose(z_up_from_y_up) * object.world_from_object;
    return std::make_shared<const types::Geometry>(std::move(geometry));
}

types::GeometryPtr readApart(const std::filesystem::path& file, MeshAxes axes) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw types::ConfigError(file.string(), "", "is not a file; give the path of a .dae, .obj, .stl or .ply file");
    const ReadLimits limits = ReadLimits::forFile(std::filesystem::file_size(file, error));
    FileMeshes from = readMeshesApart(file, axes, limits);
    auto geometry = std::make_shared<types::Geometry>();
    for (const std::string& name : from.materials) geometry->materials.emplace_back().name = name;
    geometry->meshes = getMeshes(from, geometry->notices);
    dropUnused(*geometry);
    for (const FileMeshes::Placing& placing : from.placings)
        if (!geometry->meshes[placing.part].indices.empty())
            geometry->objects.push_back({placing.name, static_cast<int>(placing.part), placing.world_from_part});
    if (geometry->objects.empty()) throw types::ConfigError(file.string(), "", "has no triangles");
    return geometry;
}

}  // namespace

ReadLimits ReadLimits::forFile(uintmax_t bytes) {
    ReadLimits limits;
    const auto megabytes = static_cast<unsigned>(std::min<uintmax_t>(bytes >> 20, 1 << 20));
    limits.processor_s += 2 * megabytes;
    limits.wall_s += 20 * megabytes;
    limits.memory += (uint64_t{megabytes} << 20) * 128;
    return limits;
}

FileMeshes readMeshesApart(const std::filesystem::path& file, MeshAxes axes, const ReadLimits& limits) {
    MemoryFile memory(file);
    const SpawnSettings settings(memory.descriptor());
    pid_t process = -1;
    const std::filesystem::path reader = findReader(file);
    const int error = settings.start(
        {reader, std::filesystem::absolute(file), axes == MeshAxes::ZUp ? "z" : "s", std::to_string(limits.processor_s),
         std::to_string(limits.wall_s), std::to_string(limits.memory)},
        process);
    if (error != 0) refuseForSystem(file, reader.c_str(), error);
    await(process, file, limits);
    MeshReply reply;
    try {
        reply = parseReply(memory.bytes(file));
    } catch (const std::runtime_error& failure) {
        refuse(file, fmt::format("cannot be read: the answer of {} is damaged: {}", mesh_reader, failure.what()));
    }
    if (!reply.refusal.empty()) refuse(file, fmt::format("cannot be read: {}{}", reply.refusal, remedy));
    return std::move(reply.meshes);
}

types::GeometryPtr readMeshFile(const std::filesystem::path& file, MeshAxes axes) {
    const std::string extension = getExtension(file);
    if (isGltf(file)) return readGltfMesh(file, axes);
    if (extension == ".dae") return readApart(file, axes);
    if (extension == ".obj" || extension == ".stl" || extension == ".ply") return readApart(file, MeshAxes::AsStored);
    throw types::ConfigError(
        file.string(), "",
        fmt::format("has extension \"{}\"; may be .dae, .obj, .stl, .ply, .gltf or .glb", extension));
}

Scene readMeshScene(const std::filesystem::path& file) {
    const types::GeometryPtr read = readMeshFile(file, MeshAxes::ZUp);
    types::Geometry geometry = *read;
    Scene scene;
    if (getExtension(file) == ".dae")  // its turn is what both readings differ by
        scene.z_up_from_file = geometry.objects.front().world_from_object *
                               glm::inverse(readMeshFile(file, MeshAxes::AsStored)->objects.front().world_from_object);
    const std::string name = file.stem().string();
    for (types::Material& material : geometry.materials)
        if (material.name.empty() || material.name == "DefaultMaterial") material.name = name;
    UniqueNames names, object_names;
    scene.nodes.push_back({names.add(name), -1, scene.z_up_from_file, glm::dvec3(1)});
    for (types::Object& object : geometry.objects) {
        const std::string own = object.name.empty() ? name : object.name;
        scene.object_nodes.push_back(static_cast<int>(scene.nodes.size()));
        scene.nodes.push_back({names.add(own), 0, glm::inverse(scene.z_up_from_file) * object.world_from_object});
        scene.node_from_object.emplace_back(1);
        object.name = object_names.add(own);
    }
    scene.geometry = std::make_shared<const types::Geometry>(std::move(geometry));
    return scene;
}

}  // namespace insonify::meshes
