#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "tests/support/Folder.hpp"
#include "types/text/Sha256.hpp"

namespace insonify::types {
namespace {

TEST(Sha256Test, MatchesTheVectorsOfTheStandard) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256Test, PiecesOfAnyLengthGiveTheHashOfTheWhole) {
    std::string bytes;
    for (int i = 0; i < 1000; ++i) bytes.push_back(static_cast<char>(i * 7));
    for (const size_t piece : {1u, 3u, 63u, 64u, 65u, 200u}) {
        Sha256 hash;
        for (size_t at = 0; at < bytes.size(); at += piece) hash.add(std::string_view(bytes).substr(at, piece));
        EXPECT_EQ(hash.hex(), sha256(bytes)) << piece;
    }
}

TEST(Sha256Test, AFileHasTheHashOfItsBytes) {
    const Folder folder;
    const std::vector<char> bytes(3'000'001, 'x');
    writeBytes(folder / "file", bytes);
    EXPECT_EQ(sha256OfFile(folder / "file"), sha256({bytes.data(), bytes.size()}));
    EXPECT_THROW(sha256OfFile(folder / "none"), std::runtime_error);
}

}  // namespace
}  // namespace insonify::types
