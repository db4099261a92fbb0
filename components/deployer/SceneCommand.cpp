// insonify scene FILE
#include <fmt/core.h>

#include <memory>

#include "components/deployer/Commands.hpp"
#include "components/deployer/Json.hpp"
#include "components/deployer/SceneReport.hpp"

namespace insonify::deployer {
namespace {

std::string text(const Json& vector) {
    return fmt::format("{:.6g}, {:.6g}, {:.6g}", vector[0].get<double>(), vector[1].get<double>(),
                       vector[2].get<double>());
}

void printExtent(const Json& bounds) {
    if (bounds.is_null()) return fmt::print("bounds: none, the scene has no triangles\n");
    fmt::print("bounds: from [{}] to [{}] m, size {} m\n", text(bounds["min"]), text(bounds["max"]),
               text(bounds["size"]));
}

void printMaterial(const Json& material) {
    fmt::print("  {:20} {:7.1f} dB lambert_db, reflection {:.2g}, reflectivity {:.2g}, {} triangles, {:.4g} m2{}{}\n",
               material["name"].get<std::string>(), material["lambert_db"].get<double>(),
               material["reflection"].get<double>(), material["reflectivity"].get<double>(),
               material["triangles"].get<size_t>(), material["area_m2"].get<double>(),
               material["normal_map"].get<bool>() ? ", normal map" : "",
               material["source"] == "default" ? "; no acoustics in the file: medium sand" : "");
}

void printObjects(const Json& objects) {
    constexpr size_t shown = 40;
    fmt::print("objects, {}\n", objects.size());
    for (size_t i = 0; i < objects.size() && i < shown; ++i)
        fmt::print("  {:20} {} triangles, size {} m at [{}]\n", objects[i]["name"].get<std::string>(),
                   objects[i]["triangles"].get<size_t>(), text(objects[i]["bounds"]["size"]),
                   text(objects[i]["bounds"]["centre"]));
    if (objects.size() > shown) fmt::print("  and {} more, which --json names\n", objects.size() - shown);
}

void printScene(const Json& scene) {
    fmt::print("{}: {}\n", scene["file"].get<std::string>(), scene["axes"].get<std::string>());
    printExtent(scene["bounds"]);
    fmt::print("triangles: {}\nmaterials, {}\n", scene["triangles"].get<size_t>(), scene["materials"].size());
    for (const Json& material : scene["materials"]) printMaterial(material);
    printObjects(scene["objects"]);
    for (const Json& line : scene["not_understood"]) fmt::print("left out or mended: {}\n", line.get<std::string>());
    for (const Json& line : scene["warnings"]) fmt::print("warning: {}\n", line.get<std::string>());
}

}  // namespace

int showScene(const std::string& file, bool json) {
    const Json scene = sceneReport(file);
    json ? print(scene) : printScene(scene);
    return 0;
}

void addSceneCommand(CLI::App& app, Action& action) {
    struct Options {
        std::string file;
        bool json = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("scene", "Tells what is in a scene: its box, axes, materials, objects");
    command->add_option("FILE", options->file, "a .gltf, .glb, .world or .sdf file")->required();
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return showScene(options->file, options->json); }; });
}

}  // namespace insonify::deployer
