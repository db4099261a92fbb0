#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/ReadBack.hpp"

namespace insonify::gpu {
namespace {

std::vector<uint32_t> read(const void* bytes, size_t count) {
    std::vector<uint32_t> values(count);
    std::memcpy(values.data(), bytes, count * sizeof(uint32_t));
    return values;
}

TEST(ReadBackTest, WhatComesBackIsWhatTheBufferHeldWhenItWasAskedFor) {
    EglContext context("software");
    const std::vector<uint32_t> first = {1, 2, 3}, second = {4, 5, 6};
    Buffer buffer = Buffer::of(std::span(first));
    ReadBack back(3 * sizeof(uint32_t));
    back.ask(buffer);
    buffer.write(second.data(), 3 * sizeof(uint32_t));
    EXPECT_EQ(read(back.wait(), 3), first);
    EXPECT_NO_THROW(context.check());
}

TEST(ReadBackTest, AReadStaysWhileTheNextIsOnItsWay) {
    EglContext context("software");
    ReadBack back(sizeof(uint32_t));
    std::vector<const void*> places;
    for (uint32_t value = 10; value < 20; ++value) {
        back.ask(Buffer(sizeof value, &value));
        places.push_back(back.wait());
        EXPECT_EQ(read(places.back(), 1)[0], value);
    }
    EXPECT_EQ(read(places[8], 1)[0], 18u);
    EXPECT_EQ(places[0], places[2]) << "two places take turns";
    EXPECT_NO_THROW(context.check());
}

TEST(FenceTest, NobodyWaitsForAFenceOfNothing) {
    const Fence none;
    none.wait();
    EglContext context("software");
    Fence::here().wait();
    EXPECT_NO_THROW(context.check());
}

}  // namespace
}  // namespace insonify::gpu
