#include "components/sonar/raster/SurfacePass.hpp"

#include <algorithm>
#include <array>

#include "components/gpu/Objects.hpp"

namespace insonify::sonar {
namespace {

/** Returns the sample in each quarter of a pixel, in the bound framebuffer: left below, right below, above. */
std::array<GLint, 4> samplesOfQuarters() {
    std::array<GLint, 4> samples = {-1, -1, -1, -1};
    for (GLuint i = 0; i < 4; ++i) {
        float at[2];
        glGetMultisamplefv(GL_SAMPLE_POSITION, i, at);
        samples[(at[0] > 0.5f ? 1u : 0u) + (at[1] > 0.5f ? 2u : 0u)] = static_cast<GLint>(i);
    }
    if (std::ranges::count(samples, -1) > 0) throw gpu::GlError("this device has no sample in one quarter of a pixel");
    return samples;
}

bool hasNormalMaps(const SurfacePass::Setup& setup) { return std::ranges::count(setup.defines, "HAVE_NORMAL_MAP") > 0; }

/** Returns the number of contexts that are worth their memory; the device culls for one. Mesa's zink reads the texture
 *  of another context as it was before (22.3, over lavapipe: the picture read last, after pictures are made anew). */
size_t partCount(const gpu::EglContext& context, const SurfacePass::Setup& setup, const ThreadPool& threads) {
    return context.isSoftware() && !context.renderer().starts_with("zink") && !setup.cull_on_device
               ? std::min(setup.frusta.size(), static_cast<size_t>(threads.size()))
               : 1;
}

std::unique_ptr<DrawLists> makeLists(const SurfacePass::Setup& setup, const SurfaceScene& scene, Culler& culler,
                                     gpu::EglContext& context) {
    const DrawLists::Setup lists{setup.geometry, scene, culler, setup.frusta.size()};
    return setup.cull_on_device ? makeDeviceLists(lists, context) : makeProcessorLists(lists);
}

}  // namespace

struct VisibilityBuffer::Multisampled {
    Multisampled(const ViewFrustum& frustum, GLenum format, gpu::EglContext& context)
        : columns(frustum.columns / 2),
          rows(frustum.rows / 2),
          ids(gpu::Texture::multisampled(format, columns, rows, 4)),
          depth(gpu::Texture::multisampled(GL_DEPTH_COMPONENT32F, columns, rows, 4)),
          target(ids, depth),
          resolve(context.programs().raster("resolve.vert.glsl", "resolve.frag.glsl", {})),
          sample_of_quarter(glGetUniformLocation(resolve.id(), "sample_of_quarter")) {
        target.bind();
        order = samplesOfQuarters();
    }

    int columns, rows;
    gpu::Texture ids, depth;
    gpu::Framebuffer target;
    const gpu::Program& resolve;
    GLint sample_of_quarter;
    gpu::VertexArray none;
    std::array<GLint, 4> order;
};

VisibilityBuffer::VisibilityBuffer(const ViewFrustum& frustum, bool with_normal_maps, gpu::EglContext& context)
    : frustum_(frustum),
      channels_(with_normal_maps ? 4 : 2),
      ids_(with_normal_maps ? GL_RGBA32UI : GL_RG32UI, frustum.columns, frustum.rows),
      depth_(GL_DEPTH_COMPONENT32F, frustum.columns, frustum.rows),
      target_(ids_, depth_) {
    if (frustum.samples == 4)
        multisampled_ = std::make_unique<Multisampled>(frustum, with_normal_maps ? GL_RGBA32UI : GL_RG32UI, context);
}

VisibilityBuffer::~VisibilityBuffer() = default;

size_t VisibilityBuffer::bytes() const {
    return sizeof(uint32_t) * static_cast<size_t>(channels_) * static_cast<size_t>(frustum_.columns) *
           static_cast<size_t>(frustum_.rows);
}

void VisibilityBuffer::read(gpu::ReadBack& words) const {
    ids_.bind(0);  // makes another context's writes visible here
    words.ask(ids_, channels_ == 4 ? GL_RGBA_INTEGER : GL_RG_INTEGER);
}

void VisibilityBuffer::clear() const {
    target_.bind();
    glViewport(0, 0, frustum_.columns, frustum_.rows);
    const GLuint miss[4] = {};
    glClearBufferuiv(GL_COLOR, 0, miss);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (!multisampled_) return;
    multisampled_->target.bind();
    glViewport(0, 0, multisampled_->columns, multisampled_->rows);
    glClearBufferuiv(GL_COLOR, 0, miss);
    glClear(GL_DEPTH_BUFFER_BIT);
}

void VisibilityBuffer::resolve() const {
    if (!multisampled_) return;
    target_.bind();
    glViewport(0, 0, frustum_.columns, frustum_.rows);
    glDisable(GL_DEPTH_TEST);
    multisampled_->resolve.use();
    const auto& order = multisampled_->order;
    glUniform4i(multisampled_->sample_of_quarter, order[0], order[1], order[2], order[3]);
    multisampled_->ids.bind(0);
    multisampled_->none.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
}

SurfacePainter::SurfacePainter(const SurfaceScene& scene, const std::vector<std::string>& defines, double near_plane,
                               gpu::EglContext& context)
    : scene_(scene),
      near_plane_(near_plane),
      software_(context.isSoftware()),
      program_(context.programs().raster("surface.vert.glsl", "surface.frag.glsl", defines)) {
    const auto at = [&](const char* name) { return glGetUniformLocation(program_.id(), name); };
    uniforms_ = {at("extent"), at("pixel_size"), at("near_plane"), at("mapped")};
    scene_.describe(vertices_);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glClearDepth(0);
}

void SurfacePainter::draw(const VisibilityBuffer& picture, const Draws& draws) const {
    picture.clear();
    if (draws.groups.empty()) return;
    program_.use();
    setUniforms(picture.frustum());
    vertices_.instanceRows(1, *draws.clips, 3);
    if (scene_.withNormalMaps()) vertices_.instanceRows(7, *draws.normal_transforms, 6);
    vertices_.bind();
    for (const DrawGroup& group : draws.groups) drawGroup(draws, group);
    picture.resolve();
}

void SurfacePainter::setUniforms(const ViewFrustum& frustum) const {
    glUniform2f(uniforms_.extent, static_cast<float>(frustum.extent_u), static_cast<float>(frustum.extent_v));
    const double side = frustum.samples == 4 ? 2 : 1;
    glUniform2f(uniforms_.pixel_size, static_cast<float>(side * frustum.du()), static_cast<float>(side * frustum.dv()));
    glUniform1f(uniforms_.near_plane, static_cast<float>(near_plane_));
}

/** Issues single draws on Mesa's software renderer. It would process indirect commands one by one as well, and search
 *  each in the draws of all contexts: see EglContext::drawing(). */
void SurfacePainter::drawGroup(const Draws& draws, const DrawGroup& group) const {
    const auto offset = [](size_t bytes) { return reinterpret_cast<const void*>(bytes); };
    scene_.bindNormalMap(group.normal_map);
    glUniform1i(uniforms_.mapped, group.normal_map >= 0);
    if (!software_ || draws.known.empty()) {
        draws.indirect->bind(GL_DRAW_INDIRECT_BUFFER);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, offset(group.first * sizeof(DrawCommand)),
                                    static_cast<GLsizei>(group.last - group.first), sizeof(DrawCommand));
        return;
    }
    for (const DrawCommand& draw : draws.known.subspan(group.first, group.last - group.first))
        glDrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLES, static_cast<GLsizei>(draw.count), GL_UNSIGNED_INT,
                                                      offset(draw.first_index * sizeof(uint32_t)), 1,
                                                      static_cast<GLint>(draw.base_vertex), draw.base_instance);
}

SurfacePass::SurfacePass(gpu::EglContext& context, Setup setup, Culler& culler, ThreadPool& threads)
    : setup_(std::move(setup)),
      context_(context),
      culler_(culler),
      threads_(threads),
      scene_(setup_.geometry, setup_.laws, hasNormalMaps(setup_)),
      lists_(makeLists(setup_, scene_, culler, context)),
      parts_(partCount(context, setup_, threads)),
      pictures_(setup_.frusta.size()) {
    gpu::Fence::here().wait();  // the other contexts must find the scene's buffers filled
    try {
        onEachPart([this](size_t part) { makePart(part); });
    } catch (...) {
        release();
        throw;
    }
}

bool SurfacePass::serves(const Setup& other) const {
    return other.frusta.size() == setup_.frusta.size() && other.defines == setup_.defines &&
           other.near_plane == setup_.near_plane && other.empty_too == setup_.empty_too &&
           other.cull_on_device == setup_.cull_on_device;
}

void SurfacePass::updateLaws() {
    scene_.updateLaws(setup_.geometry, setup_.laws);
    if (parts_.size() > 1) gpu::Fence::here().wait();  // the other contexts must find the buffers filled
}

void SurfacePass::resize(const std::vector<ViewFrustum>& frusta) {
    setup_.frusta = frusta;
    onEachPart([this](size_t part) { makePictures(part); });
}

SurfacePass::~SurfacePass() { release(); }

void SurfacePass::release() {
    onEachPart([this](size_t part) {
        for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size()) pictures_[frustum].reset();
        parts_[part].painter.reset();
        parts_[part].own.reset();
    });
}

void SurfacePass::onEachPart(const auto& job) {
    if (parts_.size() == 1) return job(0);
    threads_.run([&](int part, int) {
        if (static_cast<size_t>(part) < parts_.size()) job(static_cast<size_t>(part));
    });
}

void SurfacePass::makePart(size_t part) {
    if (part > 0) parts_[part].own.emplace(gpu::EglContext::Sharing{context_});
    parts_[part].painter.emplace(scene_, setup_.defines, setup_.near_plane, getContext(part));
    makePictures(part);
}

void SurfacePass::makePictures(size_t part) {
    for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size())
        pictures_[frustum] =
            std::make_unique<VisibilityBuffer>(setup_.frusta[frustum], hasNormalMaps(setup_), getContext(part));
}

void SurfacePass::updateShape(uint32_t object) {
    scene_.updateShape(setup_.geometry, setup_.laws, static_cast<size_t>(setup_.geometry.objects[object].mesh));
}

void SurfacePass::uploadShapes(std::span<const uint32_t> objects) {
    const auto alone = context_.transferring();
    for (const uint32_t object : objects) {
        const auto mesh = static_cast<size_t>(setup_.geometry.objects[object].mesh);
        scene_.uploadShape(setup_.geometry.meshes[mesh], mesh);
        lists_->updateShape(object);
    }
    if (parts_.size() > 1) gpu::Fence::here().wait();  // the other contexts must find the buffers filled
}

void SurfacePass::cull() {
    lists_->place();
    onEachPart([&](size_t part) {
        for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size())
            lists_->list(frustum, setup_.frusta[frustum]);
    });
}

void SurfacePass::draw() {
    onEachPart([&](size_t part) {
        // A device that culls does more than rasterising.
        const auto alone = setup_.cull_on_device ? context_.transferring() : std::unique_lock<std::shared_mutex>();
        const auto together = setup_.cull_on_device ? std::shared_lock<std::shared_mutex>() : context_.drawing();
        lists_->prepare(setup_.frusta);
        drawPart(part);
        if (context_.isSoftware()) gpu::Fence::here().wait();  // for other contexts; a card has one queue
        if (parts_[part].own) parts_[part].own->check();
    });
}

void SurfacePass::drawPart(size_t part) {
    for (size_t frustum = part; frustum < pictures_.size(); frustum += parts_.size()) {
        if (!draws(frustum)) continue;
        parts_[part].painter->draw(*pictures_[frustum], lists_->draws(frustum));
    }
}

void SurfacePass::bindResults(size_t frustum) const {
    pictures_[frustum]->bindTexture(0);
    scene_.bindRecords();
    lists_->objects().bindBase(GL_SHADER_STORAGE_BUFFER, OBJECTS_BINDING);
    lists_->draws(frustum).commands->bindBase(GL_SHADER_STORAGE_BUFFER, COMMANDS_BINDING);
}

}  // namespace insonify::sonar
