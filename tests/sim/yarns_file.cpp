#include <weave/sim/yarns_file.hpp>

#include <catch2/catch.hpp>

#include <bit>
#include <limits>
#include <support/demo_yarns.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

std::string written(const Yarns& yarns) {
    auto bytes = write_yarns(yarns);
    if (!bytes) FAIL(bytes.error().text());
    return *bytes;
}

Error refusal(const std::string& bytes) {
    auto read = read_yarns(bytes);
    REQUIRE_FALSE(read);
    CHECK(read.error().code == ErrorCode::bad_input);
    return read.error();
}

/// Two short yarns that cross once, with odd numbers.
Yarns small() {
    Yarns yarns;
    yarns.title = "ripstop \"α\"";
    yarns.design_sha256 = std::string(64, 'a');
    SimulatedYarn weft;
    weft.system = System::weft;
    weft.number = 4;
    weft.radius_mm = 0.1;
    weft.spline.control = {{0, -0.0, 1.0 / 3}, {0, 1e-300, -5e-324}, {0, 2, 123456.789}};
    weft.planned = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}};
    weft.strain = {0.1, -0.2, 0.3};
    weft.contact_N = {0, 1e-17, 2};
    SimulatedYarn warp = weft;
    warp.system = System::warp;
    warp.beam = 7;
    warp.colour = {1, 2, 3};
    warp.spline.is_periodic = true;
    warp.spline.shift = {0.1 + 0.2, 0, 0};
    yarns.yarns = {weft, warp};
    yarns.crossings = {{0, 2, 1, 5, 4, 4, true}};
    yarns.size_mm = {0.1 + 0.2, 2};
    yarns.is_periodic = {true, false};
    yarns.region = {3, 5, 0, 1};
    yarns.cloth_rows = 40;
    yarns.report = {{"residual", 0.1 + 0.2}, {"plan", {"no friction", nullptr, -1}}};
    return yarns;
}

/// The file with one text in its header in place of another of the same length.
std::string with(std::string bytes, const std::string& old, const std::string& wanted) {
    REQUIRE(old.size() == wanted.size());
    const std::size_t at = bytes.find(old);
    REQUIRE(at != std::string::npos);
    return bytes.replace(at, old.size(), wanted);
}

/// The file with another header, whose length is told truly.
std::string with_header(const std::string& bytes, const std::string& header) {
    const std::size_t second = bytes.find('\n') + 1, third = bytes.find('\n', second) + 1;
    const std::size_t length = std::stoul(bytes.substr(second));
    return bytes.substr(0, second) + std::to_string(header.size()) + "\n" + header +
           bytes.substr(third + length);
}

bool same_bits(const Vec3& a, const Vec3& b) {
    for (int axis = 0; axis < 3; ++axis) {
        if (std::bit_cast<std::uint64_t>(a[axis]) != std::bit_cast<std::uint64_t>(b[axis])) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("a .yarns file gives back what was written, to the last bit") {
    const Yarns yarns = small();
    const auto read = read_yarns(written(yarns));
    REQUIRE(read);
    CHECK(read->title == yarns.title);
    CHECK(read->design_sha256 == yarns.design_sha256);
    CHECK(read->scene_sha256.empty());
    CHECK(read->size_mm == yarns.size_mm);
    CHECK(read->is_periodic == yarns.is_periodic);
    CHECK(read->region == yarns.region);
    CHECK(read->cloth_rows == 40);
    CHECK(read->cloth_columns == 0);
    CHECK(read->report == yarns.report);
    REQUIRE(read->yarns.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
        const SimulatedYarn &a = read->yarns[k], &b = yarns.yarns[k];
        CHECK((a.system == b.system && a.number == b.number && a.beam == b.beam));
        CHECK((a.radius_mm == b.radius_mm && a.colour == b.colour));
        CHECK((a.spline.is_periodic == b.spline.is_periodic && a.spline.shift == b.spline.shift));
        CHECK((a.strain == b.strain && a.contact_N == b.contact_N));
        REQUIRE((a.spline.control.size() == 3 && a.planned.size() == 3));
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(same_bits(a.spline.control[i], b.spline.control[i]));
            CHECK(same_bits(a.planned[i], b.planned[i]));
        }
    }
    REQUIRE(read->crossings.size() == 1);
    const Crossing& crossing = read->crossings[0];
    CHECK((crossing.weft == 0 && crossing.weft_key == 2 && crossing.warp == 1 && crossing.warp_key == 5));
    CHECK((crossing.pick == 4 && crossing.end == 4 && crossing.weft_over));
}

TEST_CASE("writing what was read gives the same bytes, with arrays at multiples of 8") {
    for (const Yarns& yarns : {small(), plain_weave(), interlock({1, 2, 3}, {4, 5, 6}), Yarns{}}) {
        const std::string bytes = written(yarns);
        CHECK(written(read_yarns(bytes).value()) == bytes);
        std::size_t points = 0;
        for (const SimulatedYarn& yarn : yarns.yarns) points += yarn.planned.size();
        CHECK((bytes.size() - points * 64 - yarns.crossings.size() * 28) % 8 == 0);
    }
}

TEST_CASE("numbers stand in the file as YARNS.md says") {
    const Yarns yarns = small();
    const std::string bytes = written(yarns);
    const std::size_t arrays = bytes.size() - 6 * 64 - 28;
    // 1/3 is 0x3fd5555555555555; it is the third number of the first control point.
    CHECK(bytes.substr(arrays + 16, 8) == "\x55\x55\x55\x55\x55\x55\xd5\x3f");
    CHECK(bytes.substr(bytes.size() - 8) == std::string("\x04\x00\x00\x00\x01\x00\x00\x00", 8));
}

TEST_CASE("a newer version is refused, and other files are") {
    const std::string bytes = written(small());
    CHECK(refusal(with(bytes, "weave-yarns 1\n", "weave-yarns 2\n")).message.find("newer") !=
          std::string::npos);
    CHECK(refusal("").message.find("not a .yarns file") != std::string::npos);
    CHECK(refusal("{\"format\": \"weave\"}").message.find("not a .yarns file") != std::string::npos);
    CHECK(refusal("weave-yarns 01\n2\n{}").where == "line 1");
    CHECK(refusal("weave-yarns 0\n2\n{}").where == "line 1");
    CHECK(refusal("weave-yarns 1\n-2\n{}").where == "line 2");
    CHECK(refusal("weave-yarns 1\n99999999999\n{}").where == "line 2");
    CHECK(refusal("weave-yarns 1\n3\n{}").where == "line 2");
    CHECK(refusal("weave-yarns 1\n2\n[]").where.starts_with("header"));
}

TEST_CASE("what a header must not say is refused with its place") {
    const std::string bytes = written(small());
    const auto where = [&](const std::string& old, const std::string& wanted) {
        return refusal(with(bytes, old, wanted)).where;
    };
    CHECK(where("\"radius_mm\":0.1", "\"radius_mm\":0.0") == "header: yarns[0].radius_mm");
    CHECK(where("\"radius_mm\":0.1", "\"radiux_mm\":0.1") == "header: yarns[0].radius_mm");
    CHECK(where("\"points\":3", "\"points\":1") == "header: yarns[0].points");
    CHECK(where("\"points\":3", "\"points\":4") == "header: arrays");
    CHECK(where("\"count\":1,", "\"count\":2,") == "arrays");
    CHECK(where("\"count\":1,", "\"count\":-,").starts_with("header"));
    CHECK(where("\"offset\":0", "\"offset\":8") == "header: arrays");
    CHECK(where("aaaa\"", "aaaZ\"") == "header: design_sha256");
    CHECK(where("\"first_row\":3", "\"first_row\":9") == "header: region");
    CHECK(where("\"report\":", "\"repost\":") == "header: report");
    CHECK(where("\"periodic\":[true,", "\"periodic\":[1234,") == "header: periodic");
    CHECK(where("[0.30000000000000004,0.0,0.0]", "[2e9                ,0.0,0.0]") ==
          "header: yarns[1].shift_mm");
}

TEST_CASE("arrays that are too short, too long or hold no numbers are refused") {
    const std::string bytes = written(small());
    CHECK(refusal(bytes.substr(0, bytes.size() - 1)).where == "arrays");
    CHECK(refusal(bytes + "x").where == "arrays");
    const std::size_t arrays = bytes.size() - 6 * 64 - 28;
    const auto where = [&](std::size_t at, std::uint64_t word) {
        std::string broken = bytes;
        for (std::size_t k = 0; k < 8; ++k) broken[at + k] = static_cast<char>(word >> 8 * k & 0xff);
        return refusal(broken).where;
    };
    const auto infinite = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());
    const auto nan = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
    CHECK(where(arrays, infinite) == "yarns[0].control[0]");
    CHECK(where(arrays + 4 * 24, std::bit_cast<std::uint64_t>(2e9)) == "yarns[1].control[1]");
    CHECK(where(arrays + 144, nan) == "yarns[0].planned[0]");
    CHECK(where(arrays + 288 + 8, nan) == "yarns[0].strain[1]");
    CHECK(where(arrays + 336 + 40, nan) == "yarns[1].contact_N[2]");
    CHECK(where(arrays + 384, 1) == "crossings[0]");                // the weft index names the warp
    CHECK(where(arrays + 384 + 8, 0xffffffff) == "crossings[0]");   // no such warp
    CHECK(where(bytes.size() - 8, 0x200000004) == "crossings[0]");  // neither over nor under
}

TEST_CASE("a header that asks for more than the file holds allocates nothing") {
    std::string header =
        "{\"title\":\"\",\"design_sha256\":\"\",\"scene_sha256\":\"\",\"size_mm\":[1,1],"
        "\"periodic\":[true,true],\"region\":{\"first_row\":0,\"last_row\":0,\"first_column\":0,"
        "\"last_column\":0},\"cloth_rows\":1,\"cloth_columns\":1,\"yarns\":[";
    const std::string yarn =
        "{\"system\":\"warp\",\"number\":0,\"beam\":0,\"radius_mm\":1,\"colour\":\"#000000\","
        "\"points\":60000000,\"periodic\":false,\"planned_length_mm\":1,\"length_mm\":1,"
        "\"rest_length_mm\":1}";
    const std::string empty = written(Yarns{});
    CHECK(refusal(with_header(empty, header + yarn + "],\"report\":{},\"arrays\":[]}")).where ==
          "header: arrays");
    CHECK(refusal(with_header(empty, header + yarn + "," + yarn + "],\"report\":{},\"arrays\":[]}")).where ==
          "header: yarns");
}

TEST_CASE("what contradicts itself is refused with the place") {
    const auto refused = [](auto change) {
        Yarns yarns = small();
        change(yarns);
        const auto bytes = write_yarns(yarns);
        REQUIRE_FALSE(bytes);
        CHECK(bytes.error().code == ErrorCode::bad_input);
        return bytes.error();
    };
    const auto where = [&](auto change) { return refused(change).where; };
    const auto again = [](std::size_t yarn) {
        return [yarn](Yarns& yarns) { yarns.yarns.push_back(yarns.yarns[yarn]); };
    };
    CHECK(where(again(1)) == "yarns[2].number");
    CHECK(refused(again(1)).message.find("warp 4 again") != std::string::npos);
    Yarns two_feeders = small();
    again(0)(two_feeders);  // a pick of two feeders has two wefts
    CHECK(write_yarns(two_feeders));
    again(0)(two_feeders);
    CHECK_FALSE(write_yarns(two_feeders));
    CHECK(where([](Yarns& yarns) { yarns.size_mm[0] = 0; }) == "size_mm[0]");
    CHECK(where([](Yarns& yarns) { yarns.crossings[0].end = 5; }) == "crossings[0]");
    CHECK(where([](Yarns& yarns) { yarns.crossings[0].pick = 3; }) == "crossings[0]");
    Yarns open = small();
    open.size_mm[1] = 0;  // it does not repeat there
    CHECK(write_yarns(open));
}

TEST_CASE("a report of what cannot have been is refused with the member; what nobody knows is left alone") {
    const std::pair<const char*, Json> impossible[]{{"residual", -5},
                                                    {"residual", nullptr},
                                                    {"residual", "1e-3"},
                                                    {"converged", "yes"},
                                                    {"order_kept", 1},
                                                    {"max_overlap", -0.1},
                                                    {"points", -1},
                                                    {"iterations", 1.5},
                                                    {"lost_crossings", "none"},
                                                    {"smallest_curvature", 1},
                                                    {"smallest_curvature", "flat"},
                                                    {"strain_deviation", 0.1},
                                                    {"strain_deviation", {{"warp", -0.1}}}};
    for (const auto& [name, value] : impossible) {
        CAPTURE(name, value.dump());
        Yarns yarns = small();
        yarns.report[name] = value;
        const auto bytes = write_yarns(yarns);
        REQUIRE_FALSE(bytes);
        CHECK(bytes.error().where == std::string("report.") + name);
    }
    Yarns yarns = small();
    yarns.report = {{"residual", 0},
                    {"converged", true},
                    {"curves_down", false},
                    {"whatever", nullptr},
                    {"smallest_curvature", "not looked"},
                    {"strain_deviation", {{"warp", 0.1}, {"weft", nullptr}}}};
    CHECK(write_yarns(yarns));
}

TEST_CASE("yarns that no file can hold are refused when writing") {
    const auto where = [](auto change) {
        Yarns yarns = small();
        change(yarns);
        auto bytes = write_yarns(yarns);
        REQUIRE_FALSE(bytes);
        return bytes.error().where;
    };
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK(where([&](Yarns& yarns) { yarns.yarns[1].strain.pop_back(); }) == "yarns[1].strain");
    CHECK(where([&](Yarns& yarns) { yarns.yarns[1].planned.clear(); }) == "yarns[1].planned");
    CHECK(where([&](Yarns& yarns) { yarns.yarns[0].spline.control[1].x() = infinite; }) ==
          "yarns[0].control[1]");
    CHECK(where([&](Yarns& yarns) { yarns.yarns[0].radius_mm = -1; }) == "yarns[0].radius_mm");
    CHECK(where([&](Yarns& yarns) { yarns.yarns[0].length_mm = infinite; }) == "yarns[0].length_mm");
    CHECK(where([&](Yarns& yarns) { yarns.crossings[0].warp = 0; }) == "crossings[0]");
    CHECK(where([&](Yarns& yarns) { yarns.report["residual"] = infinite; }) == "report.residual");
    CHECK(where([&](Yarns& yarns) { yarns.report["other"] = infinite; }) == "report");
    CHECK(where([&](Yarns& yarns) { yarns.report = 3; }) == "report");
    CHECK(where([&](Yarns& yarns) { yarns.title = "\xff"; }).empty());
}

TEST_CASE("no damage to a .yarns file passes as something else, or worse") {
    const std::string bytes = written(small());
    for_all(
        [&](Random& random) {
            std::string broken = bytes;
            for (std::size_t k = random.between(1, 4); k > 0; --k)
                broken[random.between(0, broken.size() - 1)] = static_cast<char>(random.between(0, 255));
            if (random.between(0, 9) == 0) broken.resize(random.between(0, broken.size()));
            const auto read = read_yarns(broken);
            if (read) {
                const auto again = write_yarns(*read);
                REQUIRE(again);
                CHECK(write_yarns(read_yarns(*again).value()).value() == *again);
            } else {
                CHECK_FALSE(read.error().message.empty());
            }
        },
        std::min<std::size_t>(property_cases(), 3000));
}
