#include "components/sonar/rays/MappedCells.hpp"

#include <cmath>

#include "types/VectorMath.hpp"

namespace insonify::sonar {

INSONIFY_VECTOR_CLONES void MappedCells::setCosines(const PlacedScene& scene, int first, int end, Cells& cells) {
    for (int i = first; i < end; ++i) {
        const double x = cells.cos_el[i] * cells.cos_az[i], y = cells.cos_el[i] * cells.sin_az[i], z = cells.sin_el[i];
        const double nx = cells.normal_x[i], ny = cells.normal_y[i], nz = cells.normal_z[i];
        const double facing = std::abs(nx * x + ny * y + nz * z), larger = facing > 1e-6 ? facing : 1e-6;
        const double extent = cells.width[i] > cells.height[i] ? cells.width[i] : cells.height[i];
        x_[i] = static_cast<float>(x);
        y_[i] = static_cast<float>(y);
        z_[i] = static_cast<float>(z);
        extent_[i] = static_cast<float>(std::abs(cells.distance[i]) / larger * extent);
        normal_[i] = static_cast<float>(std::sqrt(nx * nx + ny * ny + nz * nz));
    }
    for (int i = first, next; i < end; i = next) {
        for (next = i + 1; next < end && command_[next] == command_[i];) ++next;
        if (command_[i] == TileHits::nothing) continue;
        const CommandRecord& command = scene.commands[command_[i]];
        const auto material = static_cast<int>(command.material);
        if (!scene.normal_maps.isMapped(material)) continue;
        scene.normal_maps.cosines(
            scene.objects[command.object], command.object, material,
            {next - i, triangle_ + i, u_ + i, v_ + i, x_ + i, y_ + i, z_ + i, extent_ + i, normal_ + i},
            cells.mapped + i);
    }
}

}  // namespace insonify::sonar
