#include "components/sonar/raster/DeviceNeeds.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/raster/DrawLists.hpp"

namespace insonify::sonar {
namespace {

/** Returns the columns or rows of the largest picture. */
int64_t maxSide(const std::vector<ViewFrustum>& frusta) {
    int maximum = 0;
    for (const ViewFrustum& frustum : frusta) maximum = std::max({maximum, frustum.columns, frustum.rows});
    return maximum;
}

int64_t clusterCount(const types::Geometry& geometry) {
    size_t count = 0;
    for (const types::Object& object : geometry.objects)
        count += geometry.meshes[static_cast<size_t>(object.mesh)].clusters.size();
    return static_cast<int64_t>(count);
}

/** Returns the size of the largest storage buffer [bytes]. */
int64_t maxBuffer(const DepositSetup& setup, const types::Geometry& geometry) {
    size_t triangles = 0, shares = 0, starts = 0;
    for (const types::Mesh& mesh : geometry.meshes) triangles += mesh.indices.size() / 3;
    for (const ColumnShares& frustum : setup.shares) {
        shares = std::max(shares, frustum.shares.size());
        starts = std::max(starts, frustum.starts.size());
    }
    const size_t triangle = sizeof(PlaneRecord) + (setup.rules.laws.hasLobes() ? sizeof(FacetRecord) : 0);
    return static_cast<int64_t>(
        std::max({setup.sumCount() * sizeof(uint64_t), triangles * triangle, shares * sizeof(DeviceShare),
                  starts * sizeof(uint32_t), geometry.objects.size() * sizeof(ObjectRecord),
                  static_cast<size_t>(clusterCount(geometry)) * sizeof(NormalTransform)}));
}

}  // namespace

gpu::Limits drawingNeeds(const RenderPlan& plan, const types::Geometry& geometry) {
    gpu::Limits needs;
    needs.draw_parameters = 1;
    needs.texture_size = needs.viewport_size = maxSide(plan.frusta);
    if (plan.features.has(Feature::NormalMap))
        for (const types::NormalMap& map : geometry.normal_maps)
            needs.texture_size = std::max({needs.texture_size, int64_t{map.width}, int64_t{map.height}});
    if (plan.options.samples_per_pixel > 1)
        needs.integer_samples = needs.depth_samples = plan.options.samples_per_pixel;
    return needs;
}

gpu::Limits depositNeeds(const DepositSetup& setup, const types::Geometry& geometry) {
    constexpr int64_t group = 64, side = 8;  // invocations in a work group, and columns and rows of a deposit's
    constexpr int64_t group_bytes = 2 * 4 * 8 * 32, own_bytes = 8;  // deposit.comp.glsl: words of the sums of a channel
    gpu::Limits needs;
    needs.storage_blocks = needs.storage_bindings = SUMS_BINDING + 1;
    needs.storage_bytes = maxBuffer(setup, geometry);
    needs.shared_bytes = group_bytes * static_cast<int64_t>(setup.rules.channels()) + own_bytes;
    needs.group_invocations = needs.group_size = group;
    needs.group_count =
        std::max((maxSide(setup.frusta) + side - 1) / side, (clusterCount(geometry) + group - 1) / group);
    return needs;
}

void requireDrawing(const gpu::Limits& limits, const gpu::Limits& needs, const std::string& renderer) {
    if (const std::string shortfall = limits.shortfall(needs); !shortfall.empty())
        throw gpu::GlError(fmt::format(
            "{} cannot render this sonar's images: {}; set visibility: cpu, or another device", renderer, shortfall));
}

std::string whyOnProcessor(Deposit deposit, const gpu::Limits& limits, const gpu::Limits& needs,
                           const std::string& renderer) {
    const std::string shortfall = limits.shortfall(needs);
    if (shortfall.empty()) return {};
    if (deposit == Deposit::Gpu)
        throw gpu::GlError(
            fmt::format("deposit: gpu is too much for {}: {}; set deposit: cpu, or use fewer triangles or bins",
                        renderer, shortfall));
    return fmt::format("images are summed on the processor, because {} cannot: {}", renderer, shortfall);
}

}  // namespace insonify::sonar
