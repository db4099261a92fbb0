#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/Objects.hpp"

namespace insonify::gpu {
namespace {

std::vector<uint32_t> read(const void* bytes, size_t count) {
    std::vector<uint32_t> values(count);
    std::memcpy(values.data(), bytes, count * sizeof(uint32_t));
    return values;
}

TEST(ReadBackTest, ReturnsTheContentAtTheTimeOfTheRequest) {
    EglContext context("software");
    const std::vector<uint32_t> first = {1, 2, 3}, second = {4, 5, 6};
    Buffer buffer = Buffer::of(std::span(first));
    ReadBack back(3 * sizeof(uint32_t));
    back.ask(buffer);
    buffer.write(second.data(), 3 * sizeof(uint32_t));
    EXPECT_EQ(read(back.wait(), 3), first);
    EXPECT_NO_THROW(context.check());
}

TEST(ReadBackTest, AReadStaysValidWhileOthersArePending) {
    EglContext context("software");
    std::vector<ReadBack> reads;
    for (uint32_t value = 10; value < 13; ++value) {
        reads.emplace_back(sizeof value);
        reads.back().ask(Buffer(sizeof value, &value));
    }
    for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(read(reads[i].wait(), 1)[0], 10 + i);
    const uint32_t again = 20;
    reads[1].ask(Buffer(sizeof again, &again));
    EXPECT_EQ(read(reads[1].wait(), 1)[0], 20u);
    EXPECT_EQ(read(reads[2].wait(), 1)[0], 12u);
    EXPECT_NO_THROW(context.check());
}

TEST(ReadBackTest, APictureIsReadRowByRowFromBelow) {
    EglContext context("software");
    const Texture picture(GL_RG32UI, 3, 2);
    const std::vector<uint32_t> words = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    glTextureSubImage2D(picture.id(), 0, 0, 0, 3, 2, GL_RG_INTEGER, GL_UNSIGNED_INT, words.data());
    ReadBack back(words.size() * sizeof(uint32_t));
    back.ask(picture, GL_RG_INTEGER);
    EXPECT_EQ(read(back.wait(), words.size()), words);
    EXPECT_NO_THROW(context.check());
}

TEST(UploadListTest, ACopyContainsTheItemsWrittenBeforeItsRequest) {
    EglContext context("software");
    UploadList<uint32_t> list(4);
    ReadBack back(3 * sizeof(uint32_t));
    for (uint32_t first : {1u, 10u}) {
        list.clear();
        for (uint32_t i = 0; i < 3; ++i) list.push_back(first + i);
        EXPECT_EQ(list.size(), 3u);
        back.ask(list.buffer());
        EXPECT_EQ(read(back.wait(), 3), (std::vector{first, first + 1, first + 2}));
    }
    EXPECT_EQ(list.room(), 4u);
    EXPECT_NO_THROW(context.check());
}

TEST(FenceTest, AnEmptyFenceDoesNotWait) {
    const Fence none;
    none.wait();
    EglContext context("software");
    Fence::here().wait();
    EXPECT_NO_THROW(context.check());
}

}  // namespace
}  // namespace insonify::gpu
