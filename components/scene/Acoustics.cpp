#include "components/scene/Acoustics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "components/acoustics/Backscatter.hpp"
#include "components/acoustics/Seabed.hpp"
#include "types/NamedFile.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

/** A synonym of a matter or a sediment. */
struct Synonym {
    std::string_view word, name;
};
constexpr Synonym synonyms[] = {
    {"aluminum", "aluminium"},
    {"alu", "aluminium"},
    {"metal", "steel"},
    {"stainless_steel", "steel"},
    {"iron", "cast_iron"},
    {"brass", "bronze"},
    {"rusty_steel", "carbon_steel"},
    {"rusted_steel", "carbon_steel"},
    {"corroded_steel", "carbon_steel"},
    {"stone", "rock"},
    {"boulder", "rock"},
    {"cement", "concrete"},
    {"plexiglass", "acrylic"},
    {"plexiglas", "acrylic"},
    {"perspex", "acrylic"},
    {"polyethylene", "hdpe"},
    {"fiberglass", "fibreglass"},
    {"grp", "fibreglass"},
    {"gfk", "fibreglass"},
    {"wooden", "wood"},
    {"timber", "wood"},
    {"netting", "net"},
    {"fishing_net", "net"},
    {"biofouling", "fouling"},
    {"barnacles", "fouling"},
    {"marine_growth", "fouling"},
    {"carton", "paper"},
    {"cardboard", "paper"},
    {"polyethylene_terephthalate", "pet"},
    {"painted_steel", "painted_metal"},
    {"human", "human_body"},
    {"person", "human_body"},
    {"swimmer", "human_body"},
    {"sand", "medium_sand"},
    {"gravel", "sandy_gravel"},
    {"mud", "clay"},
    {"silt", "medium_silt"},
};

/** Returns the matter or else the sediment of that name: "rock" is matter, "sand" is the sediment. */
std::string_view getName(std::string_view words) {
    const auto* synonym = std::ranges::find(synonyms, words, &Synonym::word);
    if (synonym != std::end(synonyms)) return synonym->name;
    if (const auto matter = acoustics::matterNamed(words)) return acoustics::getName(*matter);
    const auto& sediments = types::EnumNames<Sediment>::names;
    const auto* sediment = std::ranges::find(sediments, words);
    return sediment != std::end(sediments) && words != "mackenzie" ? *sediment : std::string_view();
}

Acoustics getAcoustics(std::string_view name) {
    Acoustics acoustics;
    acoustics.material = acoustics::matterNamed(name);
    const auto& sediments = types::EnumNames<Sediment>::names;
    if (!acoustics.material)
        acoustics.sediment = static_cast<Sediment>(std::ranges::find(sediments, name) - std::begin(sediments));
    return acoustics;
}

/** Joins texts up to a max number, because a notice is one line. */
std::string listed(const std::vector<std::string>& texts) {
    constexpr size_t max_shown = 20;
    const size_t shown = std::min(texts.size(), max_shown);
    const auto last = texts.begin() + static_cast<std::ptrdiff_t>(shown);
    return fmt::format("{}{}", fmt::join(texts.begin(), last, ", "),
                       shown < texts.size() ? fmt::format(" and {} more", texts.size() - shown) : "");
}

std::string makeNotice(const std::vector<std::string>& taken, const std::vector<std::string>& unclear) {
    std::string text;
    if (!taken.empty()) text = "materials without acoustic values are taken by their names: " + listed(taken);
    if (!unclear.empty())
        text +=
            (text.empty() ? "" : "; ") + ("materials whose names contain several stay medium sand: " + listed(unclear));
    return text + "; `materials` of the scene's task gives others, `materials_by_name: false` takes none";
}

/** A seabed of ACOUSTICS.md 3.2. */
struct SeabedRow {
    Sediment sediment;
    double lambert_db;  ///< Lambert parameter, 10 log10(mu) [dB].
};
constexpr SeabedRow seabeds[] = {
    // Fitted to APL-UW TR 9407 at 100 kHz, except for both rocks, which are kept below 1/pi.
    {Sediment::RoughRock, -5.0},
    {Sediment::Rock, -5.0},
    {Sediment::Cobble, -8.1},
    {Sediment::SandyGravel, -11.7},
    {Sediment::CoarseSand, -14.2},
    {Sediment::MediumSand, -16.7},
    {Sediment::FineSand, -19.3},
    {Sediment::MuddySand, -20.0},
    {Sediment::VeryFineSand, -20.0},
    {Sediment::CoarseSilt, -20.2},
    {Sediment::SandySilt, -20.4},
    {Sediment::MediumSilt, -23.7},
    {Sediment::FineSilt, -23.7},
    {Sediment::VeryFineSilt, -23.7},
    {Sediment::Clay, -23.7},
    // Measured in deep water at 530 and 1030 Hz: Mackenzie 1961.
    {Sediment::Mackenzie, -27.0},
};

/** Checks that there is a row for each name of an enum, in its order. */
template <class E, class Rows>
constexpr bool isInOrder(const Rows& rows, E std::remove_extent_t<Rows>::*key) {
    size_t next = 0;
    for (const auto& row : rows)
        if (row.*key != static_cast<E>(next++)) return false;
    return next == std::size(types::EnumNames<E>::names);
}
static_assert(isInOrder(seabeds, &SeabedRow::sediment));

/** Returns the fluid of that name; none for water and air. */
std::optional<acoustics::MatterProperties> getFluid(Fill fill) {
    if (fill == Fill::Sand) return acoustics::getProperties(Matter::Sand);
    if (fill == Fill::Mud) return acoustics::getProperties(Matter::Mud);
    if (fill != Fill::Oil) return {};
    // Light crude oil without gas at 15.6 deg C and atmospheric pressure: Batzle and Wang 1992, equation 20a, which has
    // no loss.
    acoustics::MatterProperties oil{};
    oil.density = 825;
    oil.sound_speed = 1371;
    return oil;
}

/** Lambert parameter that gives a rigid sphere of radius a its target strength of a^2 / 4: 3 / (8 pi) [dB]. */
constexpr double convex_body_db = -9.23;

/** Fills a described struct from values by key, and collects errors. */
class ValueReader {
public:
    ValueReader(const AcousticValues& values, types::Diagnostics& diagnostics)
        : values_(values), diagnostics_(diagnostics) {}

    template <class T>
    void operator()(const types::Field& field, std::optional<T>& value) {
        const std::string key = block_ + std::string(field.name);
        known_.push_back(key);
        types::Field keyed = field;
        keyed.name = key.c_str();
        if (const auto found = values_.find(key); found != values_.end()) read(keyed, found->second, value);
    }
    void operator()(const types::Field& field, std::optional<ShellAcoustics>& value) {
        block_ = std::string(field.name) + ".";
        ShellAcoustics block;
        ShellAcoustics::describe(block, *this);
        if (std::ranges::any_of(values_, [&](const auto& given) { return given.first.starts_with(block_); }))
            value = block;
        else if (values_.contains(std::string(field.name)))
            diagnostics_.push_back(
                {std::string(field.name), "must be a block such as {thickness_mm: 2, material: pvc}"});
        known_.emplace_back(field.name);
        block_.clear();
    }
    /** @param others keys that are read elsewhere */
    void refuseUnknown(const std::vector<std::string>& others) {
        known_.insert(known_.end(), others.begin(), others.end());
        for (const auto& [key, value] : values_)
            if (std::ranges::count(known_, key) == 0)
                diagnostics_.push_back({key, fmt::format("is not known; {}may be {}", types::didYouMean(key, known_),
                                                         fmt::join(known_, ", "))});
    }

private:
    void read(const types::Field& field, const AcousticValue& from, std::optional<double>& value) {
        const auto* number = std::get_if<double>(&from);
        if (number && *number >= field.min && *number <= field.max)
            value = *number;
        else
            diagnostics_.push_back(
                {field.name, fmt::format("is {}; must be a number from {} to {}", text(from), field.min, field.max)});
    }
    void read(const types::Field& field, const AcousticValue& from, std::optional<std::string>& value) {
        if (const auto* file = std::get_if<std::string>(&from); file && !file->empty())
            value = *file;
        else
            diagnostics_.push_back({field.name, fmt::format("is {}; must be the path of a file", text(from))});
    }
    void read(const types::Field& field, const AcousticValue& from, std::optional<bool>& value) {
        if (const auto* given = std::get_if<bool>(&from))
            value = *given;
        else
            diagnostics_.push_back({field.name, fmt::format("is {}; must be true or false", text(from))});
    }
    template <types::NamedEnum E>
    void read(const types::Field& field, const AcousticValue& from, std::optional<E>& value) {
        const auto& names = types::EnumNames<E>::names;
        const auto* name = std::get_if<std::string>(&from);
        const auto* found = name ? std::ranges::find(names, *name) : std::end(names);
        if (found != std::end(names))
            value = static_cast<E>(found - names);
        else
            diagnostics_.push_back(
                {field.name, fmt::format("is {}; {}may be {}", text(from), near(name, names), fmt::join(names, ", "))});
    }
    static std::string near(const std::string* name, const auto& names) {
        return name ? types::didYouMean(*name, {std::begin(names), std::end(names)}) : "";
    }
    static std::string text(const AcousticValue& value) {
        if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
        if (const auto* given = std::get_if<bool>(&value)) return *given ? "true" : "false";
        const auto* name = std::get_if<std::string>(&value);
        return name ? fmt::format("\"{}\"", *name) : "no number and no text";
    }

    const AcousticValues& values_;
    types::Diagnostics& diagnostics_;
    std::string block_;  ///< "shell." in that block.
    std::vector<std::string> known_;
};

/** Replaces values of the material of that name. Returns whether there is one. */
bool overrideMaterial(types::Geometry& geometry, const std::string& name, const Acoustics& acoustics) {
    bool found = false;
    for (types::Material& material : geometry.materials)
        if (material.name == name) {
            acoustics.applyTo(material);
            found = true;
        }
    return found;
}

/** Gives an object its own mesh with its own materials, and replaces their values. */
void overrideObject(types::Geometry& geometry, types::Object& object, const Acoustics& acoustics) {
    types::Mesh mesh = std::as_const(geometry.meshes)[static_cast<size_t>(object.mesh)];
    std::map<int, int> own;
    for (types::Cluster& cluster : mesh.clusters) {
        const auto [known, is_new] = own.try_emplace(cluster.material, static_cast<int>(geometry.materials.size()));
        if (is_new) {
            types::Material material = geometry.materials[static_cast<size_t>(cluster.material)];
            acoustics.applyTo(material);
            geometry.materials.push_back(std::move(material));
        }
        cluster.material = known->second;
    }
    object.mesh = static_cast<int>(geometry.meshes.size());
    geometry.meshes.push_back(std::move(mesh));
}

types::Diagnostic unknown(const Scene& scene, const std::string& name) {
    std::set<std::string> names;
    for (const types::Material& material : scene.geometry->materials) names.insert(material.name);
    for (const Node& node : scene.nodes) names.insert(node.name);
    constexpr size_t shown = 50;
    const auto last = names.size() <= shown ? names.end() : std::next(names.begin(), shown);
    const std::string near = types::didYouMean(name, {names.begin(), names.end()});
    return {"materials." + name, fmt::format("is neither a material nor a model of the scene; {}may be {}{}", near,
                                             fmt::join(names.begin(), last, ", "), last == names.end() ? "" : ", ...")};
}

}  // namespace

std::vector<std::string> splitWords(const std::string& name) {
    std::vector<std::string> words(1);
    for (size_t i = 0; i < name.size(); ++i) {
        const bool begins = i > 0 && types::isUpperLetter(name[i]) && types::isLowerLetter(name[i - 1]);
        if ((begins || !types::isLetter(name[i])) && !words.back().empty()) words.emplace_back();
        if (types::isLetter(name[i])) words.back() += types::lowered(name[i]);
    }
    return words;
}

std::vector<std::string_view> matterIn(const std::string& name) {
    constexpr size_t max_words = 3;
    const std::vector<std::string> words = splitWords(name);
    std::vector<std::string_view> found;
    for (size_t i = 0; i < words.size();) {
        size_t taken = 1;
        for (size_t count = std::min(max_words, words.size() - i); count > 0; --count) {
            const auto first = words.begin() + static_cast<std::ptrdiff_t>(i);
            const std::string joined =
                fmt::format("{}", fmt::join(first, first + static_cast<std::ptrdiff_t>(count), "_"));
            const std::string_view matter = getName(joined);
            if (matter.empty()) continue;
            if (std::ranges::find(found, matter) == found.end()) found.push_back(matter);
            taken = count;
            break;
        }
        i += taken;
    }
    return found;
}

types::GeometryPtr applyMaterialNames(const types::GeometryPtr& geometry) {
    std::vector<std::string> taken, unclear;
    std::shared_ptr<types::Geometry> named;
    for (size_t i = 0; i < geometry->materials.size(); ++i) {
        const std::string name = geometry->materials[i].name;
        if (geometry->materials[i].has_acoustics) continue;
        const std::vector<std::string_view> found = matterIn(name);
        if (found.empty()) continue;
        std::string text = fmt::format("\"{}\" as {}", name, fmt::join(found, " or "));
        std::vector<std::string>& list = found.size() == 1 ? taken : unclear;
        if (std::ranges::find(list, text) == list.end()) list.push_back(std::move(text));
        if (!named) named = std::make_shared<types::Geometry>(*geometry);
        if (found.size() > 1) continue;
        getAcoustics(found.front()).applyTo(named->materials[i]);
        named->materials[i].is_named = true;
    }
    if (!named) return geometry;
    named->notices.push_back(makeNotice(taken, unclear));
    return named;
}

double lambertDb(Sediment sediment) { return seabeds[static_cast<size_t>(sediment)].lambert_db; }

double reflection(Matter matter) { return acoustics::getProperties(matter).reflection; }

double lambertDb(Matter matter) { return convex_body_db + 20 * std::log10(std::abs(reflection(matter))); }

void Acoustics::readTable(const std::filesystem::path& folder, types::Diagnostics& diagnostics) {
    if (!table) return;
    try {
        const acoustics::Curve curve = acoustics::readBackscatter((folder / *table).string());
        for (size_t i = 0; i < curve.x.size(); ++i) measured.emplace_back(curve.x[i], curve.y[i]);
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics())
            diagnostics.push_back({"table", diagnostic.text()});
    }
}

namespace {

/** Removes the laws that given values replace. */
void clearLaws(const Acoustics& given, types::Material& target) {
    const bool has_scattering = given.sediment || given.material || given.lambert_db || given.table || given.shell;
    if (has_scattering) {
        target.shell.reset();
        target.seabed.clear();
        target.measured = given.measured;
    }
    if (has_scattering || given.reflection || given.roughness_slope) target.matter.clear();
}

void applyNames(const Acoustics& given, types::Material& target) {
    if (given.sediment) {
        const std::string name(types::EnumNames<Sediment>::names[static_cast<size_t>(*given.sediment)]);
        if (!given.lambert_db && acoustics::seabedNamed(name)) target.seabed = name;
        target.lambert_db = static_cast<float>(lambertDb(*given.sediment));
    }
    if (given.material) {
        target.lambert_db = static_cast<float>(lambertDb(*given.material));
        target.reflection = static_cast<float>(scene::reflection(*given.material));
        const bool has_law = acoustics::getProperties(*given.material).hasRoughness();
        if (has_law && !given.lambert_db && !given.reflection && !given.roughness_slope && !given.table)
            target.matter = acoustics::getName(*given.material);
    }
}

}  // namespace

void Acoustics::applyTo(types::Material& target) const {
    clearLaws(*this, target);
    applyNames(*this, target);
    if (shell) {
        target.shell = shell->shell();
        target.lambert_db = static_cast<float>(convex_body_db);
        target.reflection = 1;
    }
    if (lambert_db) target.lambert_db = static_cast<float>(*lambert_db);
    if (reflection) target.reflection = static_cast<float>(*reflection);
    if (roughness_slope) target.roughness_slope = static_cast<float>(*roughness_slope);
    if (mirror) target.mirror = *mirror;
    if (reflectivity) target.reflectivity = static_cast<float>(*reflectivity);
    target.has_acoustics = true;
}

void ShellAcoustics::check(types::Diagnostics& diagnostics) const {
    if (!thickness_mm) diagnostics.push_back({"thickness_mm", "is missing"});
    const bool is_wall = material && acoustics::getProperties(*material).is_wall;
    if (material && !is_wall) {
        std::vector<std::string_view> names;
        for (size_t i = 0; i < acoustics::matterCount(); ++i)
            if (const auto matter = static_cast<Matter>(i); acoustics::getProperties(matter).is_wall)
                names.push_back(acoustics::getName(matter));
        diagnostics.push_back({"material", fmt::format("is no matter of walls; give density and sound_speed, or one of "
                                                       "{}",
                                                       fmt::join(names, ", "))});
    }
    if (!material && !(density && sound_speed))
        diagnostics.push_back({"material", "is missing; or give density and sound_speed"});
    const double speed = sound_speed.value_or(is_wall ? acoustics::getProperties(*material).sound_speed : INFINITY);
    checkFill(diagnostics);
    if (shear_speed && !(*shear_speed < 0.87 * speed))  // or its compressibility is negative
        diagnostics.push_back(
            {"shear_speed", fmt::format("is {}; must be below 0.87 times the sound_speed of {}", *shear_speed, speed)});
}

void ShellAcoustics::checkFill(types::Diagnostics& diagnostics) const {
    const bool has_fluid = fill_density || fill_sound_speed || fill_loss;
    if (has_fluid && fill == Fill::Air)
        diagnostics.push_back({"fill",
                               "is air, which no sound passes into; omit fill_density, fill_sound_speed and "
                               "fill_loss"});
    else if (has_fluid && !(fill && getFluid(*fill)) && !(fill_density && fill_sound_speed))
        diagnostics.push_back({"fill_density",
                               "needs a fill of oil, sand or mud, or both fill_density and "
                               "fill_sound_speed"});
}

types::Shell ShellAcoustics::shell() const {
    const acoustics::MatterProperties wall =
        material ? acoustics::getProperties(*material) : acoustics::MatterProperties{};
    const acoustics::MatterProperties fluid =
        getFluid(fill.value_or(Fill::Water)).value_or(acoustics::MatterProperties{});
    return {.thickness = thickness_mm.value_or(0) / 1000,
            .density = density.value_or(wall.density),
            .sound_speed = sound_speed.value_or(wall.sound_speed),
            .shear_speed = shear_speed.value_or(wall.shear_speed),
            .loss = loss.value_or(wall.loss),
            .has_air = fill == Fill::Air,
            .fill_density = fill_density.value_or(fluid.density),
            .fill_speed = fill_sound_speed.value_or(fluid.sound_speed),
            .fill_loss = fill_loss.value_or(fluid.loss)};
}

void Acoustics::check(types::Diagnostics& diagnostics) const {
    if (shell && (sediment || material || table))
        diagnostics.push_back({"shell", "is given with `sediment`, `material` or `table`; give one of them"});
    if (sediment && material) diagnostics.push_back({"material", "is given with `sediment`; give one of the two"});
    if (table && (sediment || lambert_db))
        diagnostics.push_back({"table", "is given with `sediment` or `lambert_db`; give one of them"});
}

Acoustics readAcoustics(const AcousticValues& values, const std::filesystem::path& folder,
                        types::Diagnostics& diagnostics, const std::vector<std::string>& others) {
    Acoustics acoustics;
    ValueReader reader(values, diagnostics);
    Acoustics::describe(acoustics, reader);
    reader.refuseUnknown(others);
    acoustics.check(diagnostics);
    const bool is_read = std::ranges::none_of(
        diagnostics, [](const types::Diagnostic& each) { return each.path.starts_with("shell."); });
    if (acoustics.shell && is_read) {
        types::Diagnostics of_shell;
        acoustics.shell->check(of_shell);
        for (const types::Diagnostic& diagnostic : of_shell)
            diagnostics.push_back({"shell." + diagnostic.path, diagnostic.message});
    }
    const std::filesystem::path own = folder.empty() ? "." : folder;
    if (acoustics.table && !types::belongsTo(own / *acoustics.table, own / "scene")) {
        diagnostics.push_back({"table", fmt::format("is {}, which {}", *acoustics.table, types::not_its_own)});
        acoustics.table.reset();
    }
    acoustics.readTable(folder, diagnostics);
    return acoustics;
}

types::GeometryPtr overrideMaterials(const Scene& scene, const std::map<std::string, Acoustics>& materials,
                                     types::Diagnostics& diagnostics) {
    if (materials.empty()) return scene.geometry;
    auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
    std::set<std::string> used;
    for (const auto& [name, acoustics] : materials)
        if (overrideMaterial(*geometry, name, acoustics)) used.insert(name);
    for (const auto& [name, acoustics] : materials) {
        const int node = findNode(scene, name);
        if (node < 0 && !used.contains(name)) diagnostics.push_back(unknown(scene, name));
        if (node >= 0)
            for (const Part& part : getParts(scene, node))
                overrideObject(*geometry, geometry->objects[part.object], acoustics);
    }
    return geometry;
}

}  // namespace insonify::scene
