#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <vector>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/Objects.hpp"

namespace insonify::gpu {
namespace {

struct ObjectsTest : testing::Test {
    void TearDown() override { EXPECT_NO_THROW(context.check()); }
    EglContext context{"software"};
};

std::vector<uint8_t> toBytes(const Buffer& buffer, size_t count) {
    std::vector<uint8_t> bytes(count);
    buffer.read(bytes.data(), count);
    return bytes;
}

std::vector<uint8_t> counted(size_t count) {
    std::vector<uint8_t> bytes(count);
    std::iota(bytes.begin(), bytes.end(), uint8_t{1});
    return bytes;
}

TEST_F(ObjectsTest, ABufferOfAnySizeContainsItsInitialData) {
    for (size_t size : {1, 4, 15, 16, 17, 1000}) {
        const auto data = counted(size);
        EXPECT_EQ(toBytes(Buffer(size, data.data()), size), data) << size;
    }
}

TEST_F(ObjectsTest, ABufferIsNeverEmptyBecauseShadersMustBindData) {
    EXPECT_EQ(Buffer(0).bytes(), 16u);
    EXPECT_EQ(Buffer::of(std::span<const float>()).bytes(), 16u);
    EXPECT_EQ(Buffer(3).bytes(), 16u);
    EXPECT_EQ(Buffer(100).bytes(), 100u);
}

TEST_F(ObjectsTest, WritesAndReadsMayHaveAnyOffset) {
    const auto data = counted(32);
    Buffer buffer(32, data.data());
    const std::array<uint8_t, 3> three = {200, 201, 202};
    buffer.write(three.data(), three.size(), 7);
    std::array<uint8_t, 5> around{};
    buffer.read(around.data(), around.size(), 6);
    EXPECT_EQ(around, (std::array<uint8_t, 5>{7, 200, 201, 202, 11}));
}

TEST_F(ObjectsTest, ClearingMakesAllBytesZero) {
    for (size_t size : {4, 16, 64}) {
        const auto data = counted(size);
        Buffer buffer(size, data.data());
        buffer.clear();
        EXPECT_EQ(toBytes(buffer, size), std::vector<uint8_t>(size, 0)) << size;
    }
}

TEST_F(ObjectsTest, ANameIsDeletedWithItsLastOwner) {
    GLuint id = 0;
    {
        Buffer first(64);
        id = first.id();
        Buffer second = std::move(first);
        EXPECT_EQ(second.id(), id);
        EXPECT_EQ(first.id(), 0u);
        EXPECT_TRUE(glIsBuffer(id));
    }
    EXPECT_FALSE(glIsBuffer(id));
}

TEST_F(ObjectsTest, MoveAssignmentDeletesTheOldObject) {
    Buffer kept(64);
    const GLuint before = kept.id();
    kept = Buffer(32);
    EXPECT_FALSE(glIsBuffer(before));
    EXPECT_EQ(kept.bytes(), 32u);
}

TEST_F(ObjectsTest, APictureOfIntegersIsClearedAndReadBackAsItIs) {
    const Texture colour(GL_RG32UI, 5, 3), depth(GL_DEPTH_COMPONENT32F, 5, 3);
    const Framebuffer target(colour, depth);
    target.bind();
    const std::array<GLuint, 4> word = {4'000'000'000u, 7, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, word.data());
    std::vector<uint32_t> words(2 * 5 * 3);
    glGetTextureImage(colour.id(), 0, GL_RG_INTEGER, GL_UNSIGNED_INT,
                      static_cast<GLsizei>(words.size() * sizeof(uint32_t)), words.data());
    for (size_t i = 0; i < words.size(); ++i) EXPECT_EQ(words[i], i % 2 ? 7u : 4'000'000'000u) << i;
}

TEST_F(ObjectsTest, ATextureHasAllLevelsOnlyIfMipmapped) {
    const Texture plain(GL_RGBA8, 64, 16), mipmapped(GL_RGBA8, 64, 16, true);
    GLint levels = 0;
    glGetTextureParameteriv(plain.id(), GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
    EXPECT_EQ(levels, 1);
    glGetTextureParameteriv(mipmapped.id(), GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
    EXPECT_EQ(levels, 7) << "64, 32, 16, 8, 4, 2, 1";
}

TEST_F(ObjectsTest, RejectsPicturesThatCannotBeRasterisedInto) {
    const Texture colour(GL_RGB9_E5, 4, 4), depth(GL_DEPTH_COMPONENT32F, 4, 4);  // shared exponents: for reading only
    EXPECT_THROW(Framebuffer(colour, depth), GlError);
}

TEST_F(ObjectsTest, AttributesAreReadPerVertexAndPerInstance) {
    const Buffer positions(96), rows(96), order(16);
    const VertexArray vertices;
    vertices.attribute(0, positions, 3);
    vertices.instanceRows(1, rows, 3);
    vertices.indices(order);
    const auto get = [&](GLuint location, GLenum what) {
        GLint value = -1;
        glGetVertexArrayIndexediv(vertices.id(), location, what, &value);
        return value;
    };
    EXPECT_EQ(get(0, GL_VERTEX_ATTRIB_ARRAY_SIZE), 3);
    EXPECT_EQ(get(0, GL_VERTEX_ATTRIB_ARRAY_DIVISOR), 0);
    for (GLuint row = 1; row <= 3; ++row) {
        EXPECT_EQ(get(row, GL_VERTEX_ATTRIB_ARRAY_ENABLED), GL_TRUE) << row;
        EXPECT_EQ(get(row, GL_VERTEX_ATTRIB_ARRAY_SIZE), 4) << row;
        EXPECT_EQ(get(row, GL_VERTEX_ATTRIB_ARRAY_DIVISOR), 1) << row;
        EXPECT_EQ(get(row, GL_VERTEX_ATTRIB_RELATIVE_OFFSET), 16 * (static_cast<GLint>(row) - 1)) << row;
    }
    GLint bound = 0;
    glGetVertexArrayiv(vertices.id(), GL_ELEMENT_ARRAY_BUFFER_BINDING, &bound);
    EXPECT_EQ(static_cast<GLuint>(bound), order.id());
}

}  // namespace
}  // namespace insonify::gpu
