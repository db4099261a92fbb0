#pragma once
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "types/Describe.hpp"
#include "types/Geometry.hpp"

namespace insonify::scene {

/** What the values of a map on a surface mean: decibels, between two values of which it is linear, or classes. */
struct MapValues {
    static constexpr double max_db = 40;  ///< Of a map, above its surface's material [dB].
    static constexpr size_t max_classes = 16;

    std::vector<double> decibels;                ///< At the two `values` [dB].
    std::vector<double> values{0, 255};          ///< Beyond them it is as at them.
    std::map<std::string, std::string> classes;  ///< Names of sediments, matter or materials by whole values.

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"decibels", "dB", "of the echo at the two `values`, above that of the surface's own material", -200,
                    max_db},
              self.decibels);
        visit(Field{"values", "", "of the map, at which `decibels` are given; beyond them it is as at them", -1e9, 1e9},
              self.values);
        visit(Field{"classes", "",
                    "in the place of decibels: by whole values 0 to 254, sediments, matter or materials of the scene"},
              self.classes);
    }
    void check(types::Diagnostics& diagnostics) const;
    /** Factor of the intensity at a value; 1 where that is NaN [1]. */
    float strengthAt(double value) const;
    /** Largest factor that a map of these has [1]. */
    float maxStrength() const;
    bool operator==(const MapValues&) const = default;
};

/** A map of `width` x `height` values, rows from the top; NaN: of the surface's own material. `materials`: of each
 * class, in the order of MapValues::classes. */
types::SurfaceMap surfaceMapOf(std::span<const float> values, int width, int height, const MapValues& meaning,
                               std::vector<int> materials);

/** The material of each class: that of the geometry of this name, or else one that is added, of the sediment or matter.
 *  A name that is none of these is a diagnostic at `path` and the class. */
std::vector<int> materialsOf(const MapValues& meaning, const std::string& path, types::Geometry& geometry,
                             types::Diagnostics& diagnostics);

}  // namespace insonify::scene
