#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "types/geometry/Geometry.hpp"
#include "types/text/Describe.hpp"

namespace insonify::scene {

/** Number of bytes that isPngOrJpeg() examines. */
inline constexpr size_t picture_mark_size = 8;

/** Returns whether a picture is PNG or JPEG by its first bytes. stb_image would read other formats with untested
 *  decoders. */
inline bool isPngOrJpeg(std::string_view begin) {
    return begin.starts_with("\x89PNG\r\n\x1a\n") || begin.starts_with("\xff\xd8\xff");
}

/** The meaning of a surface map's values: decibels, interpolated linearly between two values, or classes. */
struct MapValues {
    static constexpr double max_db = 40;  ///< Max of a map, above the material of its surface [dB].
    static constexpr size_t max_classes = 16;

    std::vector<double> decibels;                ///< Strengths at the two `values` [dB].
    std::vector<double> values{0, 255};          ///< The strength is constant beyond them.
    std::map<std::string, std::string> classes;  ///< Names of sediments, matter or materials by integer value.

    static void describe(auto& self, auto& visit) {
        visit({"decibels", "dB", "of the echo at the two `values`, above that of the surface's own material", -200,
               max_db},
              self.decibels);
        visit({"values", "", "of the map, at which `decibels` are given; beyond them it is as at them", -1e9, 1e9},
              self.values);
        visit({"classes", "",
               "in the place of decibels: by whole values 0 to 254, sediments, matter or materials of the scene"},
              self.classes);
    }
    void check(types::Diagnostics& diagnostics) const;
    /** Returns the factor of the intensity at a value [1]; 1 for NaN. */
    float strengthAt(double value) const;
    /** Returns the max factor of a map with this meaning [1]. */
    float maxStrength() const;
    bool operator==(const MapValues&) const = default;
};

/** Returns a map of `width` x `height` values in rows from the top; NaN means the surface's own material.
 *  @param materials of each class, in the order of MapValues::classes. */
types::SurfaceMap surfaceMap(std::span<const float> values, int width, int height, const MapValues& meaning,
                             std::vector<int> materials);

/** Returns the index of each class's material. A name refers to a material of the geometry, or else to a sediment or
 *  matter, for which a material is added. Any other name is a diagnostic at `path` and the class. */
std::vector<int> getMaterials(const MapValues& meaning, const std::string& path, types::Geometry& geometry,
                              types::Diagnostics& diagnostics);

}  // namespace insonify::scene
