// insonify scene FILE, insonify scene make RECIPE
#include "components/command/SceneCommand.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "components/acoustics/Plate.hpp"
#include "components/command/CommandLine.hpp"
#include "components/command/RunCommand.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "components/scene/Acoustics.hpp"
#include "components/scene/Drawings.hpp"
#include "components/scene/Scene.hpp"
#include "types/geometry/Extent.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

Json makeJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json makeJson(const types::Extent& extent) {
    if (extent.isEmpty()) return nullptr;
    return {{"min", makeJson(extent.low)},
            {"max", makeJson(extent.high)},
            {"size", makeJson(extent.size())},
            {"centre", makeJson((extent.low + extent.high) / 2.0)}};
}

/** The surface area of each material. */
struct Surfaces {
    std::vector<size_t> triangles;
    std::vector<double> areas;  ///< [m2]

    explicit Surfaces(const types::Geometry& geometry)
        : triangles(geometry.materials.size()), areas(geometry.materials.size()) {
        for (const types::Object& object : geometry.objects)
            add(geometry.meshes[static_cast<size_t>(object.mesh)], object);
    }

private:
    void add(const types::Mesh& mesh, const types::Object& object) {
        const auto corner = [&](size_t k) {
            return glm::dvec3(object.world_from_object * glm::dvec4(mesh.positions[mesh.indices[k]], 1));
        };
        for (const types::Cluster& cluster : mesh.clusters) {
            const auto material = static_cast<size_t>(cluster.material);
            triangles[material] += cluster.index_count / 3;
            for (size_t k = cluster.first_index; k < size_t{cluster.first_index} + cluster.index_count; k += 3)
                areas[material] += glm::length(glm::cross(corner(k + 1) - corner(k), corner(k + 2) - corner(k))) / 2;
        }
    }
};

const char* source(const types::Material& material) {
    if (material.is_named) return "name";
    return material.has_acoustics ? "file" : "default";
}

/** Returns a thin wall: {thickness_m, density [kg/m^3], sound_speed [m/s], behind: "water", "air" or {density,
 *  sound_speed}, half_wave_khz, and with a frequency [kHz] reflected_db and passed_db}, or null. */
Json makeJson(const std::optional<types::Shell>& shell, std::optional<double> frequency_khz) {
    if (!shell) return {};
    Json behind = shell->has_air ? "air" : "water";
    if (shell->fill_density > 0) behind = {{"density", shell->fill_density}, {"sound_speed", shell->fill_speed}};
    const acoustics::Plate plate = acoustics::makePlate(*shell);
    Json wall = {{"thickness_m", shell->thickness},
                 {"density", shell->density},
                 {"sound_speed", shell->sound_speed},
                 {"behind", behind},
                 {"half_wave_khz", plate.sound_speed / (2000 * plate.thickness)}};
    if (!frequency_khz) return wall;
    constexpr acoustics::Fluid water{1025, 1500};
    const acoustics::PlateShares shares =
        acoustics::computeShares(plate, water, acoustics::getFluidBehind(*shell, water), 1000 * *frequency_khz, 1);
    wall["frequency_khz"] = *frequency_khz;
    wall["reflected_db"] = 10 * std::log10(std::max(shares.reflected, 1e-30));
    wall["passed_db"] = 10 * std::log10(std::max(shares.passed, 1e-30));
    return wall;
}

Json makeJson(const types::Material& material, size_t triangles, double area, std::optional<double> frequency_khz) {
    return {{"name", material.name},
            {"source", source(material)},
            {"matter", material.matter.empty() ? Json() : Json(material.matter)},
            {"lambert_db", material.lambert_db},
            {"reflection", material.reflection},
            {"roughness_slope", material.roughness_slope ? Json(*material.roughness_slope) : Json()},
            {"sediment", material.seabed.empty() ? Json() : Json(material.seabed)},
            {"measured_angles", material.measured.size()},
            {"reflectivity", material.reflectivity},
            {"normal_map", material.normal_map >= 0},
            {"surface_map", material.max_map_strength > 0},
            {"shell", makeJson(material.shell, frequency_khz)},
            {"mirror", material.mirror},
            {"triangles", triangles},
            {"area_m2", area}};
}

Json getObjects(const types::Geometry& geometry) {
    Json objects = Json::array();
    for (const types::Object& object : geometry.objects) {
        const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(object.mesh)];
        Json materials = Json::array();
        for (const types::Cluster& cluster : mesh.clusters) {
            const std::string& name = geometry.materials[static_cast<size_t>(cluster.material)].name;
            if (std::ranges::find(materials, Json(name)) == materials.end()) materials.push_back(name);
        }
        objects.push_back({{"name", object.name},
                           {"materials", materials},
                           {"triangles", mesh.indices.size() / 3},
                           {"bounds", makeJson(types::getExtent(mesh, object.world_from_object))}});
    }
    return objects;
}

Json findWarnings(const std::string& file, const types::Geometry& geometry, const types::Extent& extent,
                  const Json& materials, const scene::Placement& placement) {
    Json warnings = Json::array();
    if (const auto unit = scene::askUnit(
            file, extent.size(), "set placement.scale: 0.001 (--scale 0.001 shows it), else placement.scale: 1");
        unit && !placement.scale)
        warnings.push_back(unit->text);
    if (const std::string side = scene::sideWarning(geometry, file); !side.empty()) warnings.push_back(side);
    if (const glm::dvec3 size = extent.size(); std::max({size.x, size.y, size.z}) > 1e5)
        warnings.push_back("the scene is more than 100 km wide; glTF and SDF are in metres");
    const auto plain = std::ranges::count_if(materials, [](const Json& m) { return m["source"] == "default"; });
    if (plain > 0)
        warnings.push_back(
            fmt::format("{} of {} materials have no acoustics and sound like medium sand; "
                        "`insonify describe materials` lists names for extras.acoustics, and "
                        "scene::SceneTask's property materials gives them from outside",
                        plain, materials.size()));
    return warnings;
}

std::string getAxes(const std::string& file, const scene::Scene& scene, const scene::Placement& placement) {
    const scene::SceneFormat& format = *scene::findSceneFormat(file);
    std::string placed = format.component == "meshes" ? ", unless placement.up and scale say otherwise" : "";
    if (placement.up || placement.scale)
        placed = placement.scale ? fmt::format(", scaled by {}", *placement.scale) : "";
    return fmt::format("{}{}: {}", format.name, placed, scene::describeLay(scene, placement, types::WorldFrame::AsIs));
}

/** Returns the animations of a scene: [{name, duration_s, channels}]. */
Json describeAnimations(const scene::Scene& scene) {
    Json all = Json::array();
    if (!scene.animations) return all;
    for (const scene::Animation& animation : scene.animations->all)
        all.push_back(
            {{"name", animation.name}, {"duration_s", animation.duration}, {"channels", animation.channels.size()}});
    return all;
}

/** Returns a scene file in the world's axes, as a sonar uses it: {file, axes, bounds: {min, max, size, centre} [m] or
 *  null, triangles, materials: [{name, source: file, name or default, matter or null, lambert_db [dB], reflection,
 *  roughness_slope or null, sediment or null, measured_angles, reflectivity, normal_map, surface_map, shell as above,
 *  mirror, triangles, area_m2}], objects: [{name, materials: [names], triangles, bounds}], nodes: [names that a
 *  connection may move], animations: [{name, duration_s, channels}], deforming: objects with a skin or morph targets,
 *  omitted: [{name, reason}] of what is omitted, not_understood: [], warnings: []}. Throws types::ConfigError for a
 * file that cannot be read. */
Json sceneReport(const std::string& file, const scene::OmitRules& rules, std::optional<double> frequency_khz,
                 const scene::Placement& placement) {
    const scene::Scene scene = scene::withoutOmitted(scene::placed(scene::readScene(file), placement), rules);
    const types::GeometryPtr named = scene::applyMaterialNames(scene.geometry);
    const types::Geometry& geometry = *named;
    const types::Extent extent = types::getExtent(geometry);
    const Surfaces surfaces(geometry);
    Json materials = Json::array(), nodes = Json::array();
    for (size_t i = 0; i < geometry.materials.size(); ++i)
        if (surfaces.triangles[i] > 0)
            materials.push_back(
                makeJson(geometry.materials[i], surfaces.triangles[i], surfaces.areas[i], frequency_khz));
    for (const scene::Node& node : scene.nodes) nodes.push_back(node.name);
    Json omitted = Json::array(), warnings = findWarnings(file, geometry, extent, materials, placement);
    for (const types::Omission& omission : scene.omitted)
        omitted.push_back({{"name", omission.name}, {"reason", omission.reason}});
    for (const std::string& warning : scene.warnings) warnings.push_back(warning);
    return {{"file", file},
            {"axes", getAxes(file, scene, placement)},
            {"bounds", makeJson(extent)},
            {"triangles", geometry.triangleCount()},
            {"materials", materials},
            {"objects", getObjects(geometry)},
            {"nodes", nodes},
            {"animations", describeAnimations(scene)},
            {"deforming", scene.animations ? scene.animations->objects.size() : 0},
            {"omitted", omitted},
            {"not_understood", types::lines(geometry.notices)},
            {"warnings", warnings}};
}

/** Returns three lengths [m], to six digits and at least to the millimetre. */
std::string text(const Json& vector) {
    const auto number = [&](size_t i) {
        const double value = vector[i].get<double>();
        return std::abs(value) < 1000 ? fmt::format("{:.6g}", value)
                                      : fmt::format("{:.12g}", std::round(value * 1e3) / 1e3);
    };
    return fmt::format("{}, {}, {}", number(0), number(1), number(2));
}

void printExtent(const Json& bounds) {
    if (bounds.is_null()) return console::printResult("bounds: none, the scene has no triangles\n");
    console::printResult("bounds: from [{}] to [{}] m, size {} m\n", text(bounds["min"]), text(bounds["max"]),
                         text(bounds["size"]));
}

/** Returns a material's law and its source, where the numbers do not show them. */
std::string lawText(const Json& material) {
    if (material["source"] == "default") return "; no acoustics in the file: medium sand";
    std::string text;
    if (!material["matter"].is_null())
        text = fmt::format("; {} at the sonar's frequency", material["matter"].get<std::string>());
    if (!material["sediment"].is_null())
        text = fmt::format("; {} at the sonar's frequency", material["sediment"].get<std::string>());
    if (const auto angles = material["measured_angles"].get<size_t>(); angles > 0)
        text = fmt::format("; measured: a table of {} angles", angles);
    return text + (material["source"] == "name" ? ", by its name" : "");
}

/** Returns ", wall of 3 mm, 2230 kg/m3 and 5640 m/s, before air", with what it reflects and passes, or nothing without
 *  a wall. */
std::string shellText(const Json& shell) {
    if (shell.is_null()) return "";
    const Json& behind = shell["behind"];
    std::string shares;
    if (shell.contains("frequency_khz"))
        shares = fmt::format(", at {:g} kHz it reflects {:.1f} dB and passes {:.1f} dB",
                             shell["frequency_khz"].get<double>(), shell["reflected_db"].get<double>(),
                             shell["passed_db"].get<double>());
    else if (behind != "air")
        shares = fmt::format(", passes most sound near multiples of {:.4g} kHz", shell["half_wave_khz"].get<double>());
    return fmt::format(", wall of {:.4g} mm, {:.4g} kg/m3 and {:.4g} m/s, before {}{}",
                       1e3 * shell["thickness_m"].get<double>(), shell["density"].get<double>(),
                       shell["sound_speed"].get<double>(),
                       behind.is_string() ? behind.get<std::string>()
                                          : fmt::format("{:.4g} kg/m3 and {:.4g} m/s", behind["density"].get<double>(),
                                                        behind["sound_speed"].get<double>()),
                       shares);
}

void printMaterial(const Json& material) {
    console::printResult(
        "  {:22} {:5.1f} dB lambert_db, reflection {:.2g}, roughness_slope {}, reflectivity {:.2g}, {} "
        "triangles, {:.4g} m2{}{}{}{}{}\n",
        material["name"].get<std::string>(), material["lambert_db"].get<double>(), material["reflection"].get<double>(),
        material["roughness_slope"].is_null() ? "none"
                                              : fmt::format("{:.2g}", material["roughness_slope"].get<double>()),
        material["reflectivity"].get<double>(), material["triangles"].get<size_t>(), material["area_m2"].get<double>(),
        material["normal_map"].get<bool>() ? ", normal map" : "",
        material["surface_map"].get<bool>() ? ", surface map" : "", material["mirror"].get<bool>() ? ", mirror" : "",
        shellText(material["shell"]), lawText(material));
}

void printObjects(const Json& objects) {
    constexpr size_t shown = 40;
    console::printResult("objects, {}\n", objects.size());
    for (size_t i = 0; i < objects.size() && i < shown; ++i)
        console::printResult("  {:22} {}, {} triangles, size {} m at [{}]\n", objects[i]["name"].get<std::string>(),
                             fmt::join(objects[i]["materials"].get<std::vector<std::string>>(), " and "),
                             objects[i]["triangles"].get<size_t>(), text(objects[i]["bounds"]["size"]),
                             text(objects[i]["bounds"]["centre"]));
    if (objects.size() > shown) console::printResult("  and {} more, which --json names\n", objects.size() - shown);
}

void printAnimations(const Json& scene) {
    constexpr size_t shown = 20;
    const Json& animations = scene["animations"];
    if (const auto count = scene["deforming"].get<size_t>(); count > 0)
        console::printResult("objects with a skin or morph targets, {}\n", count);
    if (animations.empty()) return;
    console::printResult("animations, {}\n", animations.size());
    for (size_t i = 0; i < animations.size() && i < shown; ++i)
        console::printResult("  {:20} {:.4g} s, {} channels\n", animations[i]["name"].get<std::string>(),
                             animations[i]["duration_s"].get<double>(), animations[i]["channels"].get<size_t>());
    if (animations.size() > shown)
        console::printResult("  and {} more, which --json names\n", animations.size() - shown);
}

/** Prints what is omitted and why: names with the same reason share a row. */
void printOmitted(const Json& scene) {
    constexpr size_t named = 3;
    std::vector<std::pair<std::string, std::vector<std::string>>> rows;  // names by reason, in the file's order
    for (const Json& each : scene["omitted"]) {
        const auto reason = each["reason"].get<std::string>();
        auto row = std::ranges::find(rows, reason, &decltype(rows)::value_type::first);
        if (row == rows.end()) row = rows.insert(rows.end(), {reason, {}});
        row->second.push_back(each["name"].get<std::string>());
    }
    if (!rows.empty()) console::printResult("omitted, {}\n", scene["omitted"].size());
    for (const auto& [reason, names] : rows) {
        const size_t shown = std::min(names.size(), named);
        const std::string more = names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "";
        console::printResult(
            "  {:40} {}\n",
            fmt::format("{}{}", fmt::join(names.begin(), names.begin() + static_cast<ptrdiff_t>(shown), ", "), more),
            reason);
    }
    const Json& notices = scene["not_understood"];
    if (!notices.empty()) console::printResult("omitted or repaired in the file, {}\n", notices.size());
    for (const Json& line : notices) console::printResult("  {}\n", line.get<std::string>());
}

void printScene(const Json& scene) {
    console::printResult("{}: {}\n", scene["file"].get<std::string>(), scene["axes"].get<std::string>());
    printExtent(scene["bounds"]);
    console::printResult("nodes: {}\ntriangles: {}\nmaterials, {}\n", scene["nodes"].size(),
                         scene["triangles"].get<size_t>(), scene["materials"].size());
    for (const Json& material : scene["materials"]) printMaterial(material);
    printObjects(scene["objects"]);
    printAnimations(scene);
    printOmitted(scene);
    for (const Json& line : scene["warnings"]) console::printResult("warning: {}\n", line.get<std::string>());
}

}  // namespace

int showScene(const std::string& file, bool json, const scene::OmitRules& rules, std::optional<double> frequency_khz,
              const scene::Placement& placement) {
    const auto require = [](const char* option, const std::optional<double>& value, double min, double max) {
        if (value && !(*value >= min && *value <= max))
            throw types::ConfigError("", option, fmt::format("is {:g}; must be from {} to {}", *value, min, max));
    };
    require("--frequency-khz", frequency_khz, 0.001, 1e5);
    require("--water-surface", rules.water_surface, -1e5, 1e5);
    require("--scale", placement.scale, 1e-6, 1e6);
    const Json scene = sceneReport(file, rules, frequency_khz, placement);
    json ? print(scene) : printScene(scene);
    return 0;
}

namespace {

struct MakeOptions {
    std::string recipe, thing, out, seed;
    std::vector<std::string> set;
    bool list = false, json = false, quiet = false;
};

/** Returns what is wrong with the combination of options; empty: nothing. */
std::string getRefusal(const MakeOptions& options) {
    if (options.list) return options.recipe.empty() ? "" : "--list needs no RECIPE";
    if (options.recipe.empty() == options.thing.empty()) return "give a RECIPE, or a --thing, or --list";
    if (!options.set.empty() && options.thing.empty()) return "--set is for a --thing; a recipe has its own values";
    if (scene::getExtension(options.out) != ".glb")
        return fmt::format("--out is {}; must be a file that ends in .glb",
                           options.out.empty() ? "missing" : options.out);
    return "";
}

/** Hands the options to the component library worlds. */
int makeScene(const MakeOptions& options) {
    if (const std::string refusal = getRefusal(options); !refusal.empty())
        throw types::ConfigError("", "scene make", refusal);
    if (!loader::isPresent("worlds")) throw types::ConfigError("", "scene make", "is in " + loader::absence("worlds"));
    std::vector<std::string> words;
    const auto add = [&](const char* name, const std::string& value) {
        if (!value.empty()) words.push_back(fmt::format("--{}={}", name, value));
    };
    add("recipe", options.recipe), add("thing", options.thing), add("seed", options.seed), add("out", options.out);
    for (const std::string& assignment : options.set) add("set", assignment);
    for (const auto& [flag, is_set] :
         {std::pair("--list", options.list), std::pair("--json", options.json), std::pair("--quiet", options.quiet)})
        if (is_set) words.emplace_back(flag);
    loader::load("worlds").entry<void(const std::vector<std::string>&)>("insonify_make_scene")(words);
    return 0;
}

void addMakeCommand(CLI::App& scene, Action& action) {
    const auto options = std::make_shared<MakeOptions>();
    CLI::App* command = scene.add_subcommand("make", "Makes a sea floor with things on it, by a recipe and a seed");
    command->add_option("RECIPE", options->recipe, "a YAML file with floor and things");
    command->add_option("--seed", options->seed, "seed of the recipe's random choices (1)")
        ->type_name("N")
        ->check(console::refuseUnlessWhole);
    command->add_option("--out", options->out, "the scene to write, a .glb file");
    command->add_option("--thing", options->thing, "makes this thing alone, without a recipe");
    command->add_option("--set", options->set, "parameter=value of the thing; may be repeated")
        ->allow_extra_args(false);
    command->add_flag("--list", options->list, "lists things with their parameters, defaults and bounds");
    command->add_flag("--json", options->json, "for machines");
    command->add_flag("--quiet", options->quiet, "no summary");
    command->callback([options, &action] { action = [options] { return makeScene(*options); }; });
}

}  // namespace

void addSceneCommand(CLI::App& app, Action& action) {
    struct Options {
        std::string file;
        bool json = false;
        scene::OmitRules rules;
        std::optional<double> frequency_khz;
        scene::Placement placement;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("scene", "Prints what a scene contains: its box, axes, materials, objects; or makes one");
    command->add_option("FILE", options->file, "a " + scene::sceneEndings() + " file");
    command->add_flag("--json", options->json, "for machines");
    command
        ->add_option("--omit", options->rules.names,
                     "as `omit` of scene::SceneTask: a name that is omitted, * is any text; may be repeated")
        ->type_name("NAME")
        ->allow_extra_args(false);
    command->add_option("--water-surface", options->rules.water_surface, "as `water_surface` of scene::SceneTask [m]")
        ->type_name("Z");
    command->add_option("--frequency-khz", options->frequency_khz, "at which thin walls reflect and pass sound [kHz]")
        ->type_name("F");
    command
        ->add_option_function<std::string>(
            "--up",
            [options](const std::string& axis) { options->placement.up = static_cast<scene::UpAxis>(axis[0] - 'x'); },
            "as `placement.up` of scene::SceneTask: the axis of the file that points up")
        ->check(CLI::IsMember({"x", "y", "z"}));
    command
        ->add_option("--scale", options->placement.scale,
                     "as `placement.scale` of scene::SceneTask: factor of all lengths, 0.001 for a file in millimetres")
        ->type_name("F");
    addMakeCommand(*command, action);
    command->callback([options, command, &action] {
        if (!command->get_subcommands().empty()) return;
        if (options->file.empty()) throw CLI::RequiredError("FILE");
        action = [options] {
            return showScene(exampleAt(options->file), options->json, options->rules, options->frequency_khz,
                             options->placement);
        };
    });
}

}  // namespace insonify::command
