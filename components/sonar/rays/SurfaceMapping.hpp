#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "components/sonar/rays/TileCells.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

/** A surface map with coarser levels. Each level is half as large; a texel is the mean over its area. */
class MapLevels {
public:
    static constexpr size_t max_classes = 16;  ///< Max classes of one map [1].
    static constexpr int max_probes = 8;       ///< Max texels along a long footprint [1].

    /** Contents of a place of a map: factor of the intensity, and shares of the surface's own material and of each
     *  class, whose sum is 1 [1]. */
    struct Look {
        float strength = 1;
        std::array<float, max_classes + 1> shares{1};
    };
    /** Place of a sample in the map, and the two axes of the area that it covers there, in whole widths and heights
     *  [1]. */
    struct Footprint {
        glm::vec2 at, along, across;
    };

    /** Throws std::invalid_argument for a map with a wrong number of texels for its size, or too many classes. */
    explicit MapLevels(const types::SurfaceMap& map);
    /** Returns the mean over a footprint. */
    Look look(const Footprint& footprint) const;
    const std::vector<int>& materials() const { return materials_; }

private:
    /** Channels: the strength, then the shares of the classes. */
    struct Level {
        int width, height;
        std::vector<float> channels;
    };
    Level halved(const Level& finer) const;
    /** Adds the channels at a place of a level, interpolated bilinearly. */
    void addTexels(const Level& level, glm::vec2 at, float* sums) const;

    size_t channels_;
    bool repeat_u_, repeat_v_;
    std::vector<int> materials_;
    std::vector<Level> levels_;
};

/** Surface maps of a scene at the hits of rays. */
class SurfaceMapping {
public:
    /** The geometry must outlive it. `commands`: commands of its objects, followed by those of the maps' classes. */
    SurfaceMapping(const types::Geometry& geometry, std::span<const CommandRecord> commands);

    bool isEmpty() const { return maps_.empty(); }
    /** Returns all commands: those of objects, then for each command with a map those of its classes. */
    const std::vector<CommandRecord>& commands() const { return commands_; }
    /** Returns whether a tile hits a surface with a map. */
    bool isMapped(const TileHits& hits) const;
    /** Returns the contents of the map that sample `i` of a tile hits. The footprint is as seen from the sonar,
     *  whichever path sound took. */
    MapLevels::Look look(const TracedView& view, const PlacedScene& scene, const TracedTile& tile, int i) const;
    /** Returns the command of a class of a command with a map; the command itself for 0, its own material. */
    uint32_t getCommand(uint32_t command, size_t class_number) const {
        return class_number == 0 ? command : first_class_[command] + static_cast<uint32_t>(class_number) - 1;
    }
    size_t getClasses(uint32_t command) const {
        return of_command_[command] ? of_command_[command]->materials().size() : 0;
    }

private:
    const types::Geometry& geometry_;
    std::vector<CommandRecord> commands_;
    std::vector<std::shared_ptr<const MapLevels>> maps_;
    std::vector<const MapLevels*> of_command_;  ///< Map of each command; null: none.
    std::vector<uint32_t> first_class_;
};

/** Tiles with the materials and factors of surface maps. A sample that covers several materials is in one tile for
 *  each. Keeps its memory from ping to ping. */
class MappedTiles {
public:
    /** Takes some tiles of a scene with maps, which must outlive their use here. `apart`: each sample gets one of its
     *  materials, in proportion to their shares. It is for fields, in which two materials at one place would not add as
     *  energies do. */
    void take(const TracedView& view, const PlacedScene& scene, std::span<const TracedTile> tiles, bool apart);
    /** Returns one tile for each tile, with all its samples, each with the material of its largest share. */
    std::span<const TracedTile> whole() const { return whole_; }
    /** Returns the other materials of samples with several. */
    std::span<const TracedTile> rest() const { return rest_; }

private:
    static constexpr size_t max_materials = 4;      ///< Further materials of a sample count as its largest [1].
    static constexpr float min_share = 1.0f / 256;  ///< Min share of a separate material [1].

    /** A tile's samples of one material each. */
    struct Part {
        size_t tile;  ///< Index into `whole_`, or behind these into `rest_`.
        TileHits hits;
        std::array<float, tile_samples> gains;
    };
    void add(const SurfaceMapping& maps, const TracedTile& tile, size_t at, const MapLevels::Look* looks, bool apart);

    std::vector<TracedTile> whole_, rest_;
    std::vector<Part> parts_;
};

}  // namespace insonify::sonar
