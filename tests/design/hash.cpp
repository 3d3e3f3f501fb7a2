#include <weave/design/document.hpp>

#include <catch2/catch.hpp>

#include <design/random_design.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// The same value with the members of its objects in another order.
Json shuffled(Random& random, const Json& value) {
    if (value.is_array()) {
        Json list = Json::array();
        for (const Json& item : value) list.push_back(shuffled(random, item));
        return list;
    }
    if (!value.is_object()) return value;
    std::vector<std::string> keys;
    for (auto it = value.begin(); it != value.end(); ++it) keys.push_back(it.key());
    random.shuffle(keys);
    Json object = Json::object();
    for (const std::string& key : keys) object[key] = shuffled(random, value[key]);
    return object;
}

}  // namespace

TEST_CASE("hashes do not depend on the order of members nor on spaces") {
    for_all(
        [](Random& random) {
            Design design = random_design(random);
            design.view = Json::object();  // its order is the program's own and is kept
            const Json document = parse_json(write_document(design)).value();
            const Result<Design> other =
                read_document(shuffled(random, document).dump(static_cast<int>(random.between(0, 4)) - 1));
            if (!other) FAIL(other.error().text());
            REQUIRE(design_sha256(*other) == design_sha256(design));
            REQUIRE(scene_sha256(*other) == scene_sha256(design));
            REQUIRE(write_document(*other) == write_document(design));
        },
        property_cases() / 10);
}

TEST_CASE("scene and view leave the design's hash alone; anything else changes it") {
    for_all(
        [](Random& random) {
            const Design design = random_design(random);
            const std::string hash = design_sha256(design), scene_hash = scene_sha256(design);
            const auto changed = [&](auto&& change) {
                Design other = design;
                change(other);
                CHECK(scene_sha256(other) == scene_hash);
                return design_sha256(other) != hash;
            };
            Design other = design;
            other.view = {{"camera", 3}};
            CHECK(design_sha256(other) == hash);
            CHECK(scene_sha256(other) == scene_hash);
            other.scene.friction = design.scene.friction == 1 ? 2 : 1;
            CHECK(design_sha256(other) == hash);
            CHECK(scene_sha256(other) != scene_hash);

            CHECK(changed([](Design& d) { d.title += "x"; }));
            CHECK(changed([](Design& d) { d.notes += "x"; }));
            CHECK(changed([](Design& d) { d.blocks["new"] = plain(); }));
            CHECK(changed([](Design& d) { d.blocks["new"] = plain(), d.root = "new"; }));
            CHECK(changed([](Design& d) {
                Node flipped = *d.blocks.at(d.root);
                flipped.flips.push_back({0, 0, true});
                d.blocks[d.root] = std::make_shared<const Node>(flipped);
            }));
            CHECK(changed(
                [](Design& d) { d.warp.yarns[0].radius_mm = d.warp.yarns[0].radius_mm == 1 ? 2 : 1; }));
            CHECK(changed([](Design& d) { d.warp.order.once.push_back(0); }));
            CHECK(changed([](Design& d) { d.warp.beams.push_back({"more"}); }));
            CHECK(changed([](Design& d) { ++d.warp.ends_per_dent; }));
            CHECK(changed([](Design& d) { d.weft.feeder_order.push_back({}); }));
            CHECK(changed([](Design& d) { d.weft.directions.push_back(Direction::left_to_right); }));
            CHECK(changed([](Design& d) { d.weft.take_up.push_back(true); }));
            CHECK(changed([](Design& d) { d.weft.yarns[0].colour.green ^= 1; }));
            CHECK(changed([](Design& d) { d.weft.feeders[0].name += "x"; }));
        },
        property_cases() / 10);
}
