// What a run goes on from: it comes back as it was, and nothing else passes for it.

#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>

#include <catch2/catch.hpp>

#include <limits>
#include <simd/worker/checkpoint.hpp>
#include <string>
#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::simd;

namespace {

Json some_state() {
    return {{"numbers", {0.1, -0.0, 5e-324, std::numeric_limits<double>::max(), 1e-9}},
            {"counts", {0, 1, std::uint64_t{1} << 53, -7}},
            {"text", std::string("é\0\n", 4)},
            {"nothing", Json()},
            {"deep", {{"er", {{"still", Json::array()}}}}}};
}

std::string file_with(std::string_view body) {
    return "weave checkpoint 1\n" + sha256_hex(body) + "\n" + std::string(body);
}

}  // namespace

TEST_CASE("a checkpoint comes back as it was, to the last bit, and the next takes its place") {
    const weave::testing::TemporaryFolder folder;
    const auto none = read_checkpoint(folder.path);
    REQUIRE(none);
    CHECK_FALSE(*none);
    for (const std::uint64_t changes : {12U, 13U}) {
        const Checkpoint written{(std::uint64_t{1} << 53) - 1, changes, some_state()};
        REQUIRE(write_checkpoint(folder.path, written));
        const auto read = read_checkpoint(folder.path);
        REQUIRE(read);
        REQUIRE(*read);
        CHECK((*read)->step == written.step);
        CHECK((*read)->changes == written.changes);
        CHECK((*read)->run.dump() == written.run.dump());
        CHECK(folder.entries() == 1);
    }
}

TEST_CASE("a checkpoint with any bit flipped, any byte cut off or anything behind it is refused") {
    const weave::testing::TemporaryFolder folder;
    REQUIRE(write_checkpoint(folder.path, {1000, 2, some_state()}));
    const std::string whole = read_file(checkpoint_path(folder.path)).value();
    REQUIRE(parse_checkpoint(whole));
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            std::string broken = whole;
            broken[at] = static_cast<char>(static_cast<unsigned char>(broken[at]) ^ (1U << bit));
            INFO("byte " << at << ", bit " << bit);
            CHECK_FALSE(parse_checkpoint(broken));
        }
        CHECK_FALSE(parse_checkpoint(std::string_view(whole).substr(0, at)));
        CHECK_FALSE(parse_checkpoint(std::string_view(whole).substr(whole.size() - at)));
    }
    CHECK_FALSE(parse_checkpoint(whole + '\0'));
    CHECK_FALSE(parse_checkpoint(whole + whole));
    REQUIRE(write_file(checkpoint_path(folder.path), whole.substr(1)));
    const auto refused = read_checkpoint(folder.path);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().where == checkpoint_path(folder.path).string());
}

TEST_CASE("a body that hashes right and says something else is refused") {
    const auto body = [](const Json& json) {
        std::string bytes;
        Json::to_cbor(json, bytes);
        return bytes;
    };
    const Json whole{{"step", 1}, {"changes", 0}, {"run", Json::object()}};
    REQUIRE(parse_checkpoint(file_with(body(whole))));
    for (const char* member : {"step", "changes", "run"}) {
        Json broken = whole;
        broken.erase(member);
        CHECK_FALSE(parse_checkpoint(file_with(body(broken))));
    }
    for (const char* member : {"step", "changes"}) {
        for (const Json& value : {Json("1"), Json(-1), Json(1.5), Json::array(), Json(true), Json(1e300)}) {
            Json broken = whole;
            broken[member] = value;
            INFO(broken.dump());
            CHECK_FALSE(parse_checkpoint(file_with(body(broken))));
        }
    }
    CHECK_FALSE(parse_checkpoint(file_with("")));
    CHECK_FALSE(parse_checkpoint(file_with(body(Json::array()))));
    CHECK_FALSE(parse_checkpoint(file_with(body(whole) + "x")));
    CHECK_FALSE(parse_checkpoint(file_with(std::string(1000, '\x81'))));           // lists in lists
    CHECK_FALSE(parse_checkpoint(file_with("\x9b\x7f\xff\xff\xff\xff\xff\xff\xff")));  // a list of 2^63 things
    CHECK_FALSE(parse_checkpoint(file_with("\x7b\x7f\xff\xff\xff\xff\xff\xff\xff")));  // a text as long
}
