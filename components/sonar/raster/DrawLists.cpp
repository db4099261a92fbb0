#include "components/sonar/raster/DrawLists.hpp"

#include <algorithm>
#include <cmath>

#include "components/gpu/Objects.hpp"
#include "components/gpu/Program.hpp"
#include "components/sonar/base/Counters.hpp"

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
    listed.clips.push_back(computeClip(object, view));
    const int map = setup_.scene.withNormalMaps() ? material.normal_map : -1;
    if (setup_.scene.withNormalMaps())
        listed.normal_transforms.push_back(normalTransform(object, view, material.normal_scale));
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

/** Lists whose objects the processor chooses, and whose clusters a compute shader chooses. Every cluster of the scene
 *  has its draw, at a fixed place; it is empty where the cluster is not seen. */
class DeviceLists final : public DrawLists {
public:
    DeviceLists(const Setup& setup, gpu::EglContext& context);
    void list(size_t frustum, const ViewFrustum& view) override;
    bool mayShow(size_t frustum) const override { return views_[frustum].any; }
    void updateShape(uint32_t object) override;
    void prepare(std::span<const ViewFrustum> views) override;
    Draws draws(size_t frustum) const override;
    std::span<const CommandRecord> commands(size_t) const override { return commands_; }
    bool empty() const override;
    Shown shown() const override;

private:
    /** View of all objects by one frustum in one ping. */
    struct View {
        gpu::UploadList<ViewedObject> objects;
        bool any = false;  ///< Whether at least one is in view.
    };
    /** Input for rasterising a frustum, written by the shader: one entry for each cluster. */
    struct Found {
        gpu::Buffer draws, clips, normal_transforms;
    };
    struct Uniforms {
        GLint cluster_count, frustum, frustum_count, outward, range_max;
    };
    void addClusters(std::vector<ClusterRecord>& clusters, uint32_t object) const;
    void addCommands(uint32_t object);
    ViewedObject viewedObject(size_t object, const ViewFrustum& view, uint32_t in_view) const;
    void cull(size_t frustum, const ViewFrustum& view) const;
    void setUniforms(size_t frustum, const ViewFrustum& view) const;
    /** Returns the triangles that each frustum showed, then whether each object was shown; waits for the device. */
    std::span<const uint32_t> counts() const;

    gpu::EglContext& context_;
    const gpu::Program& program_;
    Uniforms uniforms_;
    std::vector<CommandRecord> commands_;  ///< One for each cluster, the same for all pings.
    std::vector<size_t> first_cluster_;    ///< First cluster of each object.
    std::vector<DrawGroup> groups_;
    std::vector<View> views_;   ///< One for each frustum.
    std::vector<Found> found_;  ///< One for each frustum: the device culls and rasterises in order.
    gpu::Buffer clusters_, device_commands_, shown_;
    mutable gpu::ReadBack asked_;
};

std::vector<std::string> defines(const SurfaceScene& scene) {
    return scene.withNormalMaps() ? std::vector<std::string>{"HAVE_NORMAL_MAP"} : std::vector<std::string>{};
}

DeviceLists::DeviceLists(const Setup& setup, gpu::EglContext& context)
    : DrawLists(setup),
      context_(context),
      program_(context.programs().compute("cull.comp.glsl", defines(setup.scene))) {
    const auto at = [this](const char* name) { return glGetUniformLocation(program_.id(), name); };
    uniforms_ = {at("cluster_count"), at("frustum"), at("frustum_count"), at("outward"), at("range_max")};
    std::vector<ClusterRecord> clusters;
    for (uint32_t i = 0; i < setup.geometry.objects.size(); ++i) {
        first_cluster_.push_back(clusters.size());
        addClusters(clusters, i);
        addCommands(i);
    }
    const size_t count = clusters.size(), counts = setup.frusta + setup.geometry.objects.size();
    clusters_ = gpu::Buffer::of(std::span<const ClusterRecord>(clusters));
    device_commands_ = gpu::Buffer::of(std::span<const CommandRecord>(commands_));
    const size_t mapped = setup.scene.withNormalMaps() ? count : 0;
    for (size_t i = 0; i < setup.frusta; ++i)
        found_.push_back({gpu::Buffer(count * sizeof(DrawCommand)), gpu::Buffer(count * sizeof(Clip)),
                          gpu::Buffer(mapped * sizeof(NormalTransform))});
    shown_ = gpu::Buffer(counts * sizeof(uint32_t));
    asked_ = gpu::ReadBack(counts * sizeof(uint32_t));
    for (size_t i = 0; i < setup.frusta; ++i)
        views_.push_back({gpu::UploadList<ViewedObject>(setup.geometry.objects.size())});
}

void DeviceLists::addClusters(std::vector<ClusterRecord>& clusters, uint32_t object) const {
    const int mesh = setup_.geometry.objects[object].mesh;
    const SurfaceScene::MeshPlace& place = setup_.scene.place(mesh);
    for (const types::Cluster& cluster : setup_.geometry.meshes[static_cast<size_t>(mesh)].clusters) {
        const types::Material& material = setup_.geometry.materials[static_cast<size_t>(cluster.material)];
        clusters.push_back({vec4(cluster.centre, material.normal_scale), vec4(cluster.half, 0),
                            vec4(cluster.cone_apex, 0),
                            vec4(cluster.cone_axis, setup_.culler.isSingleSided(cluster) ? cluster.cone_cutoff : 2),
                            object, cluster.index_count, place.first_index + cluster.first_index, place.first_vertex});
    }
}

void DeviceLists::addCommands(uint32_t object) {
    const int mesh = setup_.geometry.objects[object].mesh;
    const SurfaceScene::MeshPlace& place = setup_.scene.place(mesh);
    for (const types::Cluster& cluster : setup_.geometry.meshes[static_cast<size_t>(mesh)].clusters) {
        const types::Material& material = setup_.geometry.materials[static_cast<size_t>(cluster.material)];
        const size_t at = commands_.size();
        commands_.push_back({object, place.first_triangle, static_cast<uint32_t>(cluster.material), 0});
        const int map = setup_.scene.withNormalMaps() ? material.normal_map : -1;
        if (groups_.empty() || groups_.back().normal_map != map) groups_.push_back({at, at, map});
        groups_.back().last = at + 1;
    }
}

void DeviceLists::updateShape(uint32_t object) {
    std::vector<ClusterRecord> clusters;
    addClusters(clusters, object);
    clusters_.write(clusters.data(), clusters.size() * sizeof(ClusterRecord),
                    first_cluster_[object] * sizeof(ClusterRecord));
}

void DeviceLists::list(size_t frustum, const ViewFrustum& frustum_view) {
    View& view = views_[frustum];
    view.objects.clear();
    view.any = false;
    const Culler::View planes = Culler::computeView(frustum_view);
    for (size_t i = 0; i < setup_.geometry.objects.size(); ++i) {
        const uint32_t in_view = setup_.culler.inView(planes, i);
        view.any = view.any || in_view != NOT_IN_VIEW;
        count(Counter::ObjectsCulled, in_view == NOT_IN_VIEW);
        view.objects.push_back(viewedObject(i, frustum_view, in_view));
    }
}

ViewedObject DeviceLists::viewedObject(size_t object, const ViewFrustum& view, uint32_t in_view) const {
    ViewedObject viewed{};
    viewed.in_view = in_view;
    if (in_view == NOT_IN_VIEW) return viewed;
    const ObjectRecord& record = setup_.culler.records()[object];
    const Clip clip = computeClip(record, view);
    viewed.clip_x = clip.x;
    viewed.clip_y = clip.y;
    viewed.clip_w = clip.w;
    if (!setup_.scene.withNormalMaps()) return viewed;
    const NormalTransform rows = normalTransform(record, view, 1);
    viewed.normal_x = rows.normal[0];
    viewed.normal_y = rows.normal[1];
    viewed.normal_z = rows.normal[2];
    viewed.tangent_x = rows.tangent[0];
    viewed.tangent_y = rows.tangent[1];
    viewed.tangent_z = rows.tangent[2];
    return viewed;
}

void DeviceLists::setUniforms(size_t frustum, const ViewFrustum& view) const {
    const Culler::View planes = Culler::computeView(view);
    glUniform1ui(uniforms_.cluster_count, static_cast<GLuint>(commands_.size()));
    glUniform1ui(uniforms_.frustum, static_cast<GLuint>(frustum));
    glUniform1ui(uniforms_.frustum_count, static_cast<GLuint>(setup_.frusta));
    glUniform3fv(uniforms_.outward, static_cast<GLsizei>(planes.size()), &planes[0].x);
    glUniform1f(uniforms_.range_max, setup_.culler.rangeMax());
}

void DeviceLists::cull(size_t frustum, const ViewFrustum& view) const {
    setUniforms(frustum, view);
    const auto bind = [](const gpu::Buffer& buffer, GLuint at) { buffer.bindBase(GL_SHADER_STORAGE_BUFFER, at); };
    bind(objects(), OBJECTS_BINDING);
    bind(clusters_, CLUSTERS_BINDING);
    bind(views_[frustum].objects.buffer(), VIEWED_BINDING);
    bind(found_[frustum].draws, DRAWS_BINDING);
    bind(found_[frustum].clips, CLIPS_BINDING);
    bind(found_[frustum].normal_transforms, NORMAL_TRANSFORMS_BINDING);
    bind(shown_, SHOWN_BINDING);
    glDispatchCompute(static_cast<GLuint>((commands_.size() + 63) / 64), 1, 1);
}

void DeviceLists::prepare(std::span<const ViewFrustum> views) {
    // Before: the last ping's draws read the buffers that are rewritten. After: this ping's draws read them.
    const auto order = [] {
        glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    };
    shown_.clear();
    program_.use();
    order();
    for (size_t i = 0; i < views.size(); ++i)
        if (mayShow(i)) cull(i, views[i]);
    order();
}

Draws DeviceLists::draws(size_t frustum) const {
    const Found& found = found_[frustum];
    const std::span<const DrawGroup> groups = groups_;
    return {&found.clips,
            &found.normal_transforms,
            &device_commands_,
            &found.draws,
            mayShow(frustum) ? groups : groups.first(0),
            {}};
}

std::span<const uint32_t> DeviceLists::counts() const {
    const auto alone = context_.transferring();
    asked_.ask(shown_);
    return {static_cast<const uint32_t*>(asked_.wait()), setup_.frusta + setup_.geometry.objects.size()};
}

bool DeviceLists::empty() const {
    return std::ranges::all_of(counts().first(setup_.frusta), [](uint32_t count) { return count == 0; });
}

Shown DeviceLists::shown() const {
    const std::span<const uint32_t> counts = this->counts(), triangles = counts.first(setup_.frusta);
    Shown shown;
    for (uint32_t of_object : counts.subspan(setup_.frusta)) shown.objects.push_back(of_object > 0);
    for (uint32_t count : triangles) shown.triangles += count;
    shown.empty_frusta = static_cast<size_t>(std::ranges::count(triangles, 0u));
    return shown;
}

}  // namespace

Clip computeClip(const ObjectRecord& object, const ViewFrustum& frustum) {
    const glm::dvec4 x(object.row_x), y(object.row_y), z(object.row_z);
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth);
    return {vec4((cosine * y - sine * x) / frustum.extent_u), vec4(z / frustum.extent_v), vec4(cosine * x + sine * y)};
}

NormalTransform normalTransform(const ObjectRecord& object, const ViewFrustum& frustum, float normal_scale) {
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

std::unique_ptr<DrawLists> makeDeviceLists(const DrawLists::Setup& setup, gpu::EglContext& context) {
    return std::make_unique<DeviceLists>(setup, context);
}

}  // namespace insonify::sonar
