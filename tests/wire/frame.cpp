// Frames: what comes back, how long they are, and that no byte can be wrong unseen.

#include <weave/wire/frame.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <support/random.hpp>
#include <wire/protocol.hpp>

using namespace weave;
using namespace weave::wire;
using weave::testing::for_all;
using weave::testing::from_hex;
using weave::testing::Random;

namespace {

/// The example of PROTOCOL.md.
Frame example() {
    Frame frame;
    frame.head.session = 7;
    frame.head.number = 300;
    frame.head.step = 1200;
    frame.head.residual = 0.015625;
    frame.head.quantum_mm = 0.0078125;
    frame.head.size_mm = {2, 1};
    frame.head.layout = 3;
    frame.head.lost_crossings = 0;
    frame.head.is_flipping = true;
    frame.counts = {3, 1};
    frame.points = {{0, 0.5, 0.125}, {0.5, 0.5, -0.125}, {1, 0.5, 0.1328125}, {-0.0078125, 2, 0}};
    return frame;
}

const std::string example_bytes = from_hex(R"(
    57 56 46 52  01 00  08 00  07 00 00 00 00 00 00 00
    2c 01 00 00 00 00 00 00  b0 04 00 00 00 00 00 00
    00 00 00 00 00 00 90 3f  00 00 00 00 00 00 80 3f
    00 00 00 00 00 00 00 40  00 00 00 00 00 00 f0 3f
    03 00 00 00  00 00 00 00  02 00 00 00  04 00 00 00
    03  00 80 01 20  80 01 00 3f  00 00 82 01
    01  01 80 04 00
)");

double random_number(Random& random, double most) {
    return most * (static_cast<double>(random.between(0, 2'000'000)) / 1e6 - 1);
}

Frame random_frame(Random& random) {
    Frame frame;
    FrameHead& head = frame.head;
    head.session = random.between(1, most_number);
    head.number = random.between(1, most_number);
    head.step = random.between(0, most_number);
    head.residual = std::abs(random_number(random, random.coin() ? 1e-6 : 1e300));
    if (random.coin()) head.lost_crossings = static_cast<std::uint32_t>(random.between(0, 0xfffffffe));
    head.layout = static_cast<std::uint32_t>(random.between(1, 0xffffffff));
    head.size_mm = {std::abs(random_number(random, 100)), std::abs(random_number(random, 1e9))};
    head.quantum_mm = std::pow(10, random_number(random, 6));
    head.at_rest = random.coin(), head.is_last = random.coin();
    head.is_coarse = random.coin(), head.is_flipping = random.coin();
    for (std::size_t yarn = random.between(0, 5); yarn > 0; --yarn) {
        frame.counts.push_back(static_cast<std::uint32_t>(random.between(1, random.coin() ? 3 : 200)));
        const double most = std::min(9e8, head.quantum_mm * std::pow(10, random.between(0, 13)));
        for (std::size_t i = 0; i < frame.counts.back(); ++i)
            frame.points.emplace_back(random_number(random, most), random_number(random, most), random_number(random, most));
    }
    return frame;
}

std::string refusal(std::string bytes) {
    const auto frame = decode_frame(bytes);
    return frame ? "" : frame.error().text();
}

/// The example with these bytes in place of its own from `at` on.
std::string with(std::size_t at, const std::string& hex) {
    std::string bytes = example_bytes;
    const std::string other = from_hex(hex);
    return bytes.replace(at, other.size(), other);
}

}  // namespace

TEST_CASE("the protocol's example is what is written and read") {
    std::string told;
    for (const std::string& line : weave::testing::protocol_block("frame")) told += line + " ";
    REQUIRE(from_hex(told) == example_bytes);
    REQUIRE(encode_frame(example()).value() == example_bytes);
    const Frame frame = decode_frame(example_bytes).value();
    const Frame wanted = example();
    CHECK(frame.head.session == 7);
    CHECK(frame.head.number == 300);
    CHECK(frame.head.step == 1200);
    CHECK(frame.head.residual == 0.015625);
    CHECK(frame.head.layout == 3);
    CHECK(frame.head.lost_crossings == 0U);
    CHECK(frame.head.size_mm == wanted.head.size_mm);
    CHECK(frame.head.is_flipping);
    CHECK_FALSE((frame.head.at_rest || frame.head.is_last || frame.head.is_coarse));
    CHECK(frame.counts == wanted.counts);
    CHECK(frame.points == wanted.points);
}

TEST_CASE("places come back within half a quantum, and all else as it was") {
    for_all([](Random& random) {
        const Frame frame = random_frame(random);
        const std::string bytes = encode_frame(frame).value();
        const Frame again = decode_frame(bytes).value();
        REQUIRE(again.counts == frame.counts);
        REQUIRE(again.points.size() == frame.points.size());
        for (std::size_t i = 0; i < frame.points.size(); ++i) {
            const double off = (again.points[i] - frame.points[i]).cwiseAbs().maxCoeff();
            REQUIRE(off <= 0.51 * frame.head.quantum_mm);
        }
        REQUIRE(again.head.session == frame.head.session);
        REQUIRE(again.head.residual == frame.head.residual);
        REQUIRE(again.head.lost_crossings == frame.head.lost_crossings);
        REQUIRE(encode_frame(again).value() == bytes);
    });
}

TEST_CASE("no place of a frame errs by 1/50 of the smallest radius") {
    for_all([](Random& random) {
        const double radius = std::pow(10, random_number(random, 3));
        Frame frame;
        frame.head.quantum_mm = quantum_for(radius);
        frame.counts = {1};
        frame.points = {{random_number(random, 1e3 * radius), random_number(random, 30 * radius), random_number(random, radius)}};
        const Frame again = decode_frame(encode_frame(frame).value()).value();
        REQUIRE((again.points[0] - frame.points[0]).norm() < radius / 50);
    });
}

TEST_CASE("a straight yarn with even points takes three bytes a point") {
    Frame frame;
    frame.head.quantum_mm = quantum_for(0.2);
    frame.counts = {1000};
    for (int i = 0; i < 1000; ++i) frame.points.emplace_back(0.24 * i, 5, -1);
    REQUIRE(encode_frame(frame).value().size() <= frame_head_bytes + 2 + 3 * 1000 + 8);
}

TEST_CASE("every part of a frame that is wrong is refused, with its place") {
    using Catch::Contains;
    CHECK_THAT(refusal(""), Contains("shorter than its head"));
    CHECK_THAT(refusal(with(0, "58")), Contains("this is no frame"));
    CHECK_THAT(refusal(with(4, "02")), Contains("version: is 2"));
    CHECK_THAT(refusal(with(6, "18")), Contains("flags"));
    CHECK_THAT(refusal(with(7, "01")), Contains("flags"));
    CHECK_THAT(refusal(with(8, "00")), Contains("session"));
    CHECK_THAT(refusal(with(14, "20")), Contains("session"));  // 2^53
    CHECK_THAT(refusal(with(16, "0000")), Contains("number"));
    CHECK_THAT(refusal(with(30, "ff")), Contains("step"));
    CHECK_THAT(refusal(with(38, "f87f")), Contains("residual"));  // no number
    CHECK_THAT(refusal(with(38, "f07f")), Contains("residual"));  // infinite
    CHECK_THAT(refusal(with(32, "00000000000000 80")), Contains("residual"));  // -0
    CHECK_THAT(refusal(with(46, "0000")), Contains("quantum_mm"));
    CHECK_THAT(refusal(with(54, "00c0")), Contains("size_mm[0]"));
    CHECK_THAT(refusal(with(62, "f07f")), Contains("size_mm[1]"));
    CHECK_THAT(refusal(with(64, "00")), Contains("layout"));
    CHECK_THAT(refusal(with(72, "05")), Contains("yarns: are more"));
    CHECK_THAT(refusal(with(72, "03")), Contains("yarns[2]"));
    CHECK_THAT(refusal(with(72, "01")), Contains("points: are fewer"));
    CHECK_THAT(refusal(with(76, "06")), Contains("points: are more"));
    CHECK_THAT(refusal(with(76, "05")), Contains("points: are fewer"));
    CHECK_THAT(refusal(with(76, "03")), Contains("yarns[1]: has 1 points where 0 are left of those in the head, at byte 93"));
    CHECK_THAT(refusal(with(80, "00")), Contains("yarns[0]: has no points"));
    CHECK_THAT(refusal(with(80, "8300")), Contains("yarns[0]: is no number"));  // in two bytes
    CHECK_THAT(refusal(with(97, "80")), Contains("yarns[1].points[0].z: is no number in as few bytes as it needs, at byte 97"));
    CHECK_THAT(refusal(example_bytes + '\0'), Contains("from byte 98"));
}

TEST_CASE("a frame cut anywhere, or with bytes behind it, is refused") {
    for (std::size_t length = 0; length < example_bytes.size(); ++length)
        REQUIRE_FALSE(decode_frame(std::string_view(example_bytes).substr(0, length)));
    REQUIRE_FALSE(decode_frame(example_bytes + example_bytes));
}

TEST_CASE("a frame whose bytes were changed is refused, or is another frame's bytes") {
    for_all([](Random& random) {
        std::string bytes = encode_frame(random_frame(random)).value();
        for (std::size_t k = random.between(1, 4); k > 0; --k)
            bytes[random.between(0, bytes.size() - 1)] = static_cast<char>(random.between(0, 255));
        const auto frame = decode_frame(bytes);
        if (frame) REQUIRE(encode_frame(*frame).value() == bytes);
        else REQUIRE_FALSE(frame.error().where.empty());
    });
}

TEST_CASE("a frame that counts more than it has bytes asks for no memory") {
    std::string bytes = example_bytes;
    for (const std::size_t at : {72, 76}) bytes.replace(at, 4, 4, '\xff');
    REQUIRE_FALSE(decode_frame(bytes));
    bytes = with(72, "01 00 00 00");
    REQUIRE_FALSE(decode_frame(bytes.replace(76, 4, 4, '\x7f')));
}

TEST_CASE("places beyond what a frame can tell are refused in both directions") {
    using Catch::Contains;
    Frame frame = example();
    for (const double bad : {1.1e9, -1.1e9, std::numeric_limits<double>::infinity(), std::nan("")}) {
        frame.points[2].y() = bad;
        REQUIRE_THAT(encode_frame(frame).error().text(), Contains("yarns[0].points[2].y"));
    }
    frame = example();
    frame.head.quantum_mm = 1e-12;
    frame.points[3].x() = 71;  // 2^46 quanta are 70.4 mm
    REQUIRE_THAT(encode_frame(frame).error().text(), Contains("yarns[1].points[0].x"));
    // Seven bytes hold more than the head's unit allows.
    REQUIRE_THAT(refusal(example_bytes.substr(0, 94) + from_hex("ff ff ff ff ff ff 7f 00 00")), Contains("lies too far away, at byte 94"));
}

TEST_CASE("what does not fit together is not written") {
    Frame frame = example();
    frame.counts = {3, 2};
    REQUIRE_FALSE(encode_frame(frame));
    frame.counts = {4, 0};
    REQUIRE_FALSE(encode_frame(frame));
    frame = example();
    frame.head.session = 0;
    REQUIRE_FALSE(encode_frame(frame));
    frame = example();
    frame.head.residual = std::nan("");
    REQUIRE_FALSE(encode_frame(frame));
    frame = example();
    frame.head.lost_crossings = 0xffffffff;
    REQUIRE_FALSE(encode_frame(frame));
}
