#include "components/sonar/raster/DrawLists.hpp"

#include <cmath>

namespace insonify::sonar {
namespace {

class ProcessorLists final : public DrawLists {
public:
    explicit ProcessorLists(const Setup& setup);
    void list(size_t frustum, const ViewFrustum& view) override;
    bool mayShow(size_t frustum) const override { return !listed_[frustum].ranges.empty(); }
    Draws draws(size_t frustum) const override;
    std::span<const CommandRecord> commands(size_t frustum) const override { return listed_[frustum].commands; }
    bool empty() const override;
    Shown shown() const override;

private:
    /** Draws of one frustum in one ping: one entry for each draw. */
    struct Listed {
        Listed(size_t limit, bool with_normal_maps);

        std::vector<Culler::DrawRange> ranges;
        std::vector<CommandRecord> commands;
        std::vector<DrawCommand> draws;
        std::vector<DrawGroup> groups;
        gpu::UploadList<Clip> clips;
        gpu::UploadList<NormalTransform> normal_transforms;
        gpu::UploadList<CommandRecord> device_commands;
        gpu::UploadList<DrawCommand> device_draws;
    };
    void add(Listed& listed, const Culler::DrawRange& range, const ViewFrustum& view) const;

    std::vector<Listed> listed_;  ///< One for each frustum.
};

ProcessorLists::Listed::Listed(size_t limit, bool with_normal_maps)
    : clips(limit), normal_transforms(with_normal_maps ? limit : 0), device_commands(limit), device_draws(limit) {
    ranges.reserve(limit);
    commands.reserve(limit);
    draws.reserve(limit);
    groups.reserve(limit);
}

ProcessorLists::ProcessorLists(const Setup& setup) : DrawLists(setup) {
    for (size_t i = 0; i < setup.frusta; ++i)
        listed_.emplace_back(setup.culler.drawRangeLimit(), setup.scene.withNormalMaps());
}

void ProcessorLists::list(size_t frustum, const ViewFrustum& view) {
    Listed& listed = listed_[frustum];
    listed.commands.clear();
    listed.draws.clear();
    listed.groups.clear();
    listed.clips.clear();
    listed.normal_transforms.clear();
    listed.device_commands.clear();
    listed.device_draws.clear();
    setup_.culler.visible(view, listed.ranges);
    for (const Culler::DrawRange& range : listed.ranges) add(listed, range, view);
}

void ProcessorLists::add(Listed& listed, const Culler::DrawRange& range, const ViewFrustum& view) const {
    const SurfaceScene::MeshPlace& place = setup_.scene.place(setup_.geometry.objects[range.object].mesh);
    const types::Material& material = setup_.geometry.materials[static_cast<size_t>(range.material)];
    const ObjectRecord& object = setup_.culler.records()[range.object];
    const size_t at = listed.draws.size();
    listed.draws.push_back(
        {range.index_count, 1, place.first_index + range.first_index, place.first_vertex, static_cast<uint32_t>(at)});
    listed.device_draws.push_back(listed.draws.back());
    listed.commands.push_back({range.object, place.first_triangle, static_cast<uint32_t>(range.material), 0});
    listed.device_commands.push_back(listed.commands.back());
    listed.clips.push_back(clipOf(object, view));
    const int map = setup_.scene.withNormalMaps() ? material.normal_map : -1;
    if (setup_.scene.withNormalMaps())
        listed.normal_transforms.push_back(normalTransformOf(object, view, material.normal_scale));
    if (listed.groups.empty() || listed.groups.back().normal_map != map) listed.groups.push_back({at, at, map});
    listed.groups.back().last = at + 1;
}

Draws ProcessorLists::draws(size_t frustum) const {
    const Listed& all = listed_[frustum];
    return {&all.clips.buffer(),
            &all.normal_transforms.buffer(),
            &all.device_commands.buffer(),
            &all.device_draws.buffer(),
            all.groups,
            all.draws};
}

bool ProcessorLists::empty() const {
    for (size_t i = 0; i < setup_.frusta; ++i)
        if (mayShow(i)) return false;
    return true;
}

Shown ProcessorLists::shown() const {
    Shown shown;
    shown.objects.resize(setup_.geometry.objects.size());
    for (size_t i = 0; i < setup_.frusta; ++i) {
        const auto& ranges = listed_[i].ranges;
        shown.empty_frusta += ranges.empty();
        for (const Culler::DrawRange& range : ranges) {
            shown.objects[range.object] = true;
            shown.triangles += range.index_count / 3;
        }
    }
    return shown;
}

}  // namespace

Clip clipOf(const ObjectRecord& object, const ViewFrustum& frustum) {
    const glm::dvec4 x(object.row_x), y(object.row_y), z(object.row_z);
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth);
    return {vec4((cosine * y - sine * x) / frustum.extent_u), vec4(z / frustum.extent_v), vec4(cosine * x + sine * y)};
}

NormalTransform normalTransformOf(const ObjectRecord& object, const ViewFrustum& frustum, float normal_scale) {
    const auto cosine = static_cast<float>(std::cos(frustum.azimuth)),
               sine = static_cast<float>(std::sin(frustum.azimuth));
    NormalTransform rows{
        {cosine * object.normal_x + sine * object.normal_y, cosine * object.normal_y - sine * object.normal_x,
         object.normal_z},
        {cosine * object.row_x + sine * object.row_y, cosine * object.row_y - sine * object.row_x, object.row_z}};
    rows.normal[0].w = normal_scale;
    return rows;
}

DrawLists::DrawLists(const Setup& setup) : setup_(setup), objects_(setup.geometry.objects.size()) {}

void DrawLists::place() {
    objects_.clear();
    for (const ObjectRecord& record : setup_.culler.records()) objects_.push_back(record);
}

std::unique_ptr<DrawLists> makeProcessorLists(const DrawLists::Setup& setup) {
    return std::make_unique<ProcessorLists>(setup);
}

}  // namespace insonify::sonar
