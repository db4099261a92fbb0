#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "components/sonar/rays/TileCells.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** A surface map with coarser levels. Each level is half as large; a texel is the mean over its area. */
class MapLevels {
public:
    static constexpr size_t max_classes = 16;  ///< Of one map [1].
    static constexpr int max_probes = 8;       ///< Texels along a long footprint [1].

    /** What a place of a map shows: factor of the intensity, and shares of the surface's own material and of each
     * class, whose sum is 1 [1]. */
    struct Look {
        float strength = 1;
        std::array<float, max_classes + 1> shares{1};
    };
    /** Where a sample lies in the map, and the two axes of what it covers there, in whole widths and heights [1]. */
    struct Footprint {
        glm::vec2 at, along, across;
    };

    /** Throws std::invalid_argument for a map of other numbers of texels than it says, or of too many classes. */
    explicit MapLevels(const types::SurfaceMap& map);
    /** The mean over a footprint. */
    Look look(const Footprint& footprint) const;
    const std::vector<int>& materials() const { return materials_; }

private:
    /** Channels: the strength, then the shares of the classes. */
    struct Level {
        int width, height;
        std::vector<float> channels;
    };
    Level halved(const Level& finer) const;
    /** Adds what is at a place of a level, bilinear. */
    void addTexels(const Level& level, glm::vec2 at, float* sums) const;

    size_t channels_;
    bool repeat_u_, repeat_v_;
    std::vector<int> materials_;
    std::vector<Level> levels_;
};

/** Maps of a scene's surfaces where rays meet them. */
class SurfaceMapping {
public:
    /** The geometry must outlive it. `commands`: those of its objects, which those of the maps' classes follow. */
    SurfaceMapping(const types::Geometry& geometry, std::span<const CommandRecord> commands);

    bool isEmpty() const { return maps_.empty(); }
    /** All commands: those of objects, and for each one with a map those of its classes. */
    const std::vector<CommandRecord>& commands() const { return commands_; }
    /** Whether a tile meets a surface with a map. */
    bool isMapped(const TileHits& hits) const;
    /** What sample `i` of a tile sees of the map that it meets. Seen from the sonar, whichever way sound took. */
    MapLevels::Look look(const CastView& view, const PlacedScene& scene, const CastTile& tile, int i) const;
    /** The command of a class of a command with a map; the command itself for 0, its own material. */
    uint32_t commandOf(uint32_t command, size_t class_number) const {
        return class_number == 0 ? command : first_class_[command] + static_cast<uint32_t>(class_number) - 1;
    }
    size_t classesOf(uint32_t command) const {
        return of_command_[command] ? of_command_[command]->materials().size() : 0;
    }

private:
    const types::Geometry& geometry_;
    std::vector<CommandRecord> commands_;
    std::vector<std::shared_ptr<const MapLevels>> maps_;
    std::vector<const MapLevels*> of_command_;  ///< Null: it has none.
    std::vector<uint32_t> first_class_;
};

/** Tiles with the materials and factors of surface maps. A sample that covers several materials is in one tile for
 *  each. Keeps its memory from ping to ping. */
class MappedTiles {
public:
    /** Takes some tiles of a scene with maps, which must outlive their use here. `apart`: each sample is of one of its
     * materials, as many samples of each as its share: for fields, to which two materials at one place would not add as
     * energies. */
    void take(const CastView& view, const PlacedScene& scene, std::span<const CastTile> tiles, bool apart);
    /** One for each tile, with all its samples, each of the material that it sees most of. */
    std::span<const CastTile> whole() const { return whole_; }
    /** The other materials of samples that see several. */
    std::span<const CastTile> rest() const { return rest_; }

private:
    static constexpr size_t max_materials = 4;      ///< Others of a sample count as the one it sees most of [1].
    static constexpr float min_share = 1.0f / 256;  ///< Of a material of its own [1].

    /** A tile's samples of one material each. */
    struct Part {
        size_t tile;  ///< Index into `whole_`, or behind these into `rest_`.
        TileHits hits;
        std::array<float, tile_samples> gains;
    };
    void add(const SurfaceMapping& maps, const CastTile& tile, size_t at, const MapLevels::Look* looks, bool apart);

    std::vector<CastTile> whole_, rest_;
    std::vector<Part> parts_;
};

}  // namespace insonify::sonar
