#pragma once
// Small worlds made inside a test.
#include <glm/gtc/matrix_transform.hpp>

#include "components/scene/Scene.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Variable.hpp"

namespace insonify::sdf {

using namespace scene;

using test::Variable;

struct SdfFiles : SceneFiles {
    std::filesystem::path writeWorld(const std::string& body, const std::string& version = "1.9") const {
        return write("case.world", "<sdf version='" + version + "'><world name='w'>\n" + body + "</world></sdf>");
    }
    Scene world(const std::string& body, const std::string& version = "1.9") const {
        return readScene(writeWorld(body, version));
    }
    std::string diagnosticOfWorld(const std::string& body) const { return findDiagnostic(writeWorld(body)); }

    /** A model of one link with one visual, each named, at its model's origin. */
    static std::string model(const std::string& name, const std::string& geometry, const std::string& more = "") {
        return "<model name='" + name + "'>" + more + "<link name='hull'>" + visual("skin", geometry) +
               "</link></model>";
    }
    static std::string visual(const std::string& name, const std::string& geometry, const std::string& more = "") {
        return "<visual name='" + name + "'>" + more + "<geometry>" + geometry + "</geometry></visual>";
    }
    static std::string pose(const std::string& numbers) { return "<pose>" + numbers + "</pose>"; }
    /** Writes `name`/model.config and model.sdf. */
    void writeModel(const std::string& name, const std::string& sdf) const {
        std::filesystem::create_directories(folder_ / name);
        write(name + "/model.config", "<model><name>" + name + "</name><sdf version='1.9'>model.sdf</sdf></model>");
        write(name + "/model.sdf", "<sdf version='1.9'>" + sdf + "</sdf>");
    }

    const std::string box_ = "<box><size>2 4 6</size></box>";
};

inline void expectBounds(const Bounds& bounds, glm::dvec3 low, glm::dvec3 high, double tolerance = 1e-6) {
    EXPECT_LT(glm::distance(bounds.low, low), tolerance) << bounds.low.x << " " << bounds.low.y << " " << bounds.low.z;
    EXPECT_LT(glm::distance(bounds.high, high), tolerance)
        << bounds.high.x << " " << bounds.high.y << " " << bounds.high.z;
}

/** Volume inside a closed surface whose faces look outward [m^3]. */
inline double computeVolume(const types::Geometry& geometry) {
    const auto corners = worldCorners(geometry);
    double volume = 0;
    for (size_t i = 0; i < corners.size(); i += 3)
        volume += glm::dot(corners[i], glm::cross(corners[i + 1], corners[i + 2])) / 6;
    return volume;
}

}  // namespace insonify::sdf
