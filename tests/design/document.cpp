#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>

#include <catch2/catch.hpp>

#include <design/random_design.hpp>
#include <filesystem>
#include <fstream>

using namespace weave;
using namespace weave::testing;

namespace {

/// A document that uses every kind of block and every section.
const char* const whole = R"json({
"format": "weave", "version": 1, "title": "shoe", "notes": "", "root": "cloth",
"blocks": {
  "toe": {"kind": "stacks", "stacks": [["T0 P0", "P1 T0"], ["P0 T1", "T1 P1"]]},
  "card": {"kind": "card", "ends": 4, "t": [1], "p": [1], "card": ["a0", "50"]},
  "family": {"kind": "preset", "family": "plain", "options": {}},
  "cut": {"kind": "slice", "dots": "weft", "positions": ["T0 P0 (T1)", "P0 T0 -"]},
  "tiled": {"kind": "tile", "of": "toe", "x": 2, "y": 2, "z": 1, "flips": [{"pick": 0, "end": 1, "weft": "under"}]},
  "joined": {"kind": "attach", "of": "toe", "other": "tiled", "face": "+z"},
  "cloth": {"kind": "stencil", "of": ["toe", "tiled"], "map": ["0*2 1*2", "1 0 0 1"]},
  "moved": {"kind": "renumber", "of": "toe", "row": 0, "order": [0]}
},
"warp": {"yarns": [{"name": "cotton", "colour": "#d98a2b", "radius_mm": 0.15}], "beams": [{"name": "one"}],
         "colours": ["#000000"], "colour_order": "0 1", "order": "0*4", "beam_order": "0",
         "density_ends_per_cm": 20, "ends_per_dent": 2},
"weft": {"yarns": [{"name": "wool"}], "feeders": [{"name": "a", "yarn": 0}, {"name": "b"}],
         "feeder_order": "0 1 0+1 -*2", "directions": "0 1", "take_up": "1 0", "density_picks_per_cm": 20},
"scene": {"version": 1, "dx_mm": 0.5, "boundary_x": "frozen", "pins": [{"system": "pick", "number": 3}],
          "warp": {"strain": 1.1}, "fields": [{"centre_mm": [0, 1, 2], "radius_mm": 1, "strength_N_per_mm": 2}],
          "friction": 0.2, "gravity": true},
"view": {"zoom": 2}})json";

Json whole_json() {
    return parse_json(whole).value();
}

struct Damage {
    std::string place;    ///< JSON pointer to the member to change
    std::string value;    ///< JSON text of its new value; empty: take it away
    std::string where;    ///< place that the error must name
    std::string message;  ///< words that the error must contain
};

/// Takes a member away or gives it another value.
std::string damaged(const Damage& damage) {
    Json document = whole_json();
    const Json::json_pointer pointer(damage.place);
    if (damage.value.empty()) {
        Json& parent = document[pointer.parent_pointer()];
        if (parent.is_array()) {
            parent.erase(static_cast<std::size_t>(std::stoul(pointer.back())));
        } else {
            parent.erase(pointer.back());
        }
    } else {
        document[pointer] = Json::parse(damage.value);
    }
    return document.dump();
}

void refuses(const Damage& damage) {
    INFO(damage.place << " = " << damage.value);
    const Result<Design> design = read_document(damaged(damage));
    REQUIRE_FALSE(design);
    CHECK(design.error().code == ErrorCode::bad_input);
    CHECK(design.error().where == damage.where);
    CHECK_THAT(design.error().message, Catch::Contains(damage.message));
}

}  // namespace

TEST_CASE("a document with every kind of block is read, and evaluates where it makes sense") {
    const Result<Design> design = read_document(whole);
    if (!design) FAIL(design.error().text());
    CHECK(design->title == "shoe");
    CHECK(design->blocks.size() == 8);
    CHECK(design->weft.feeder_order == std::vector<FeederSet>{{0}, {1}, {0, 1}, {}, {}});
    CHECK(design->weft.directions ==
          std::vector<Direction>{Direction::left_to_right, Direction::right_to_left});
    CHECK(design->weft.take_up == std::vector<bool>{true, false});
    CHECK(design->weft.feeders[1].yarn == 0);
    CHECK(design->scene.boundary_x == Boundary::frozen);
    CHECK(design->scene.boundary_y == Boundary::periodic);
    CHECK(design->scene.warp.strain == 1.1);
    CHECK(design->scene.pins == std::vector<Pin>{{true, 3}});
    CHECK(design->view["zoom"] == 2);
    const Result<Evaluation> cloth = evaluate(*design);
    REQUIRE(cloth);
    CHECK(cloth->block->rows() == 2);
    CHECK(cloth->block->columns() == 4);
}

TEST_CASE("reading what was written gives an equal design, and writing it again the same bytes") {
    for_all(
        [](Random& random) {
            const Design design = random_design(random);
            if (const Status sound = check(design); !sound) FAIL(sound.error().text());
            const std::string text = write_document(design);
            const Result<Design> back = read_document(text);
            if (!back) FAIL(back.error().text() << "\n" << text);
            if (!(*back == design)) FAIL("reads back otherwise:\n" << text);
            REQUIRE(write_document(*back) == text);
            REQUIRE(design_sha256(*back) == design_sha256(design));
            REQUIRE(scene_sha256(*back) == scene_sha256(design));
        },
        property_cases() / 10);
}

TEST_CASE("only the format's own documents of known versions are read") {
    refuses({"/version", "2", "version", "is 2, newer than this program, which reads versions up to 1"});
    refuses({"/version", "18446744073709551615", "version", "newer"});
    refuses({"/version", "0", "version", "whole number from 1"});
    refuses({"/version", "-9223372036854775808", "version", "whole number from 1"});
    refuses({"/version", "1.0", "version", "whole number from 1"});
    refuses({"/version", "", "version", "whole number from 1"});
    refuses({"/format", "\"wif\"", "", "is not a .weave document"});
    refuses({"/format", "", "", "is not a .weave document: it has no \"format\": \"weave\""});
    refuses({"/scene/version", "2", "scene.version", "newer"});
    for (const char* other : {"[]", "3", "null", "\"weave\""})
        CHECK_THAT(read_document(other).error().message, Catch::Contains("is not a .weave document"));
}

TEST_CASE("what is not JSON is refused with line and column, or with what is odd about it") {
    const auto message = [](std::string text) { return read_document(text).error().text(); };
    CHECK_THAT(message("{\n \"format\" \"weave\"}"), Catch::Contains("line 2"));
    CHECK_THAT(message(""), Catch::Contains("is not JSON"));
    CHECK_THAT(message("{\"format\": \"weave\", \"format\": \"weave\"}"),
               Catch::Contains("repeats the member 'format'"));
    CHECK_THAT(message(std::string(100000, '[')), Catch::Contains("nests deeper than 64 levels"));
    CHECK_THAT(message("{\"title\": \"\xff\"}"), Catch::Contains("is not JSON"));
    CHECK_THAT(message("\x89PNG\r\n"), Catch::StartsWith("is no design, which would begin with {"));
    CHECK(message("weave-yarns 1\n") == "holds relaxed yarns, no design");
    CHECK_THAT(message(R"({"format": "weave", "version": 1, "blocks": {"a": {}, "a": {}}})"),
               Catch::Contains("repeats the member 'a'"));
}

TEST_CASE("unknown members are refused wherever they stand") {
    const std::string known = "is not known here";
    refuses({"/colour", "1", "colour", known});
    refuses({"/blocks/toe/t", "[1,1]", "blocks.toe.t", known});
    refuses({"/blocks/card/stacks", "[]", "blocks.card.stacks", known});
    refuses({"/blocks/family/x", "1", "blocks.family.x", known});
    refuses({"/blocks/cut/of", "\"toe\"", "blocks.cut.of", known});
    refuses({"/blocks/tiled/map", "[]", "blocks.tiled.map", known});
    refuses({"/blocks/tiled/flips/0/row", "1", "blocks.tiled.flips[0].row", known});
    refuses({"/blocks/joined/x", "1", "blocks.joined.x", known});
    refuses({"/blocks/cloth/face", "1", "blocks.cloth.face", known});
    refuses({"/blocks/moved/x", "1", "blocks.moved.x", known});
    refuses({"/warp/feeders", "[]", "warp.feeders", known});
    refuses({"/warp/yarns/0/radius", "1", "warp.yarns[0].radius", known});
    refuses({"/warp/beams/0/yarn", "1", "warp.beams[0].yarn", known});
    refuses({"/weft/ends_per_dent", "1", "weft.ends_per_dent", known});
    refuses({"/weft/feeders/1/colour", "1", "weft.feeders[1].colour", known});
    refuses({"/scene/wind", "1", "scene.wind", known});
    refuses({"/scene/warp/radius_mm", "1", "scene.warp.radius_mm", known});
    refuses({"/scene/pins/0/end", "1", "scene.pins[0].end", known});
    refuses({"/scene/fields/0/x", "1", "scene.fields[0].x", known});
}

TEST_CASE("missing members are named with their place") {
    for (const char* place :
         {"root", "blocks", "blocks/toe/kind", "blocks/card/ends", "blocks/family/family", "blocks/cut/dots",
          "blocks/tiled/of", "blocks/joined/other", "blocks/joined/face", "blocks/moved/order",
          "blocks/tiled/flips/0/weft", "scene/pins/0/number", "scene/fields/0/radius_mm"}) {
        std::string where = place;
        std::replace(where.begin(), where.end(), '/', '.');
        if (const auto at = where.find(".0."); at != std::string::npos) where.replace(at, 3, "[0].");
        const bool choice = where.ends_with("weft");
        refuses({"/" + std::string(place), "", where, choice ? "is missing" : "missing"});
    }
    refuses({"/blocks/toe/stacks", "", "blocks.toe.stacks", "must be a list of rows"});
    refuses({"/blocks/card/card", "", "blocks.card.card", "must be a list of rows"});
    refuses({"/blocks/cut/positions", "", "blocks.cut.positions", "must be a list"});
    refuses({"/blocks/cloth/of", "", "blocks.cloth.of", "must be a list of 1 to 65535 block names"});
    refuses({"/blocks/cloth/map", "", "blocks.cloth.map", "must be a list of rows"});
    refuses({"/blocks/moved/row", "", "blocks.moved", "needs either a row or a column"});
    refuses({"/blocks/moved/column", "0", "blocks.moved", "needs either a row or a column"});
}

TEST_CASE("wrong types are refused wherever they stand") {
    refuses({"/title", "3", "title", "must be a text"});
    refuses({"/notes", "[]", "notes", "must be a text"});
    refuses({"/blocks", "[]", "blocks", "must be an object"});
    refuses({"/blocks/toe", "[]", "blocks.toe", "must be an object"});
    refuses({"/warp", "[]", "warp", "must be an object"});
    refuses({"/scene", "null", "scene", "must be an object"});
    refuses({"/view", "1", "view", "must be an object"});
    refuses({"/blocks/toe/kind", "\"leaf\"", "blocks.toe.kind", "must be one of stacks, card"});
    refuses({"/blocks/toe/kind", "7", "blocks.toe.kind", "must be one of"});
    refuses({"/blocks/toe/height", "-1", "blocks.toe.height", "whole number from 0"});
    refuses({"/blocks/toe/stacks/1", "\"T1\"", "blocks.toe.stacks[1]", "must be a list of stacks"});
    refuses({"/blocks/toe/stacks/1/0", "3", "blocks.toe.stacks[1][0]", "must be a text such as"});
    refuses({"/blocks/card/t", "[1.5]", "blocks.card.t[0]", "whole number"});
    refuses({"/blocks/card/p", "[]", "blocks.card.p", "needs at least one number"});
    refuses({"/blocks/card/card/1", "0", "blocks.card.card[1]", "hexadecimal"});
    refuses({"/blocks/family/options/up", "1.5", "blocks.family.options.up", "whole number"});
    refuses({"/blocks/cut/positions/1", "1", "blocks.cut.positions[1]", "must be a text"});
    refuses({"/blocks/cloth/of/1", "1", "blocks.cloth.of[1]", "must be a block name"});
    refuses({"/blocks/cloth/map/1", "[0]", "blocks.cloth.map[1]", "must be a text"});
    refuses({"/blocks/tiled/flips/0", "3", "blocks.tiled.flips[0]", "must be an object"});
    refuses({"/blocks/moved/order/0", "\"0\"", "blocks.moved.order[0]", "whole number"});
    refuses({"/warp/colours", "\"#000000\"", "warp.colours", "must be a list of colours"});
    refuses({"/warp/colours/0", "3", "warp.colours[0]", "is not a colour"});
    refuses({"/weft/feeders", "{}", "weft.feeders", "must be a list"});
    refuses({"/weft/feeder_order", "[0]", "weft.feeder_order", "must be a text"});
    refuses({"/scene/gravity", "1", "scene.gravity", "must be true or false"});
    refuses({"/scene/fields/0/centre_mm", "[0,1]", "scene.fields[0].centre_mm", "must be three numbers"});
    refuses({"/scene/fields/0/centre_mm/1", "\"x\"", "scene.fields[0].centre_mm", "must be three numbers"});
}

TEST_CASE("values out of range are refused wherever they stand") {
    refuses({"/warp/yarns/0/radius_mm", "0", "warp.yarns[0].radius_mm", "a number from 0.0001 to 100"});
    refuses(
        {"/warp/yarns/0/radius_mm", "\"thick\"", "warp.yarns[0].radius_mm", "a number from 0.0001 to 100"});
    refuses({"/warp/yarns", "[]", "warp.yarns", "needs at least one yarn"});
    refuses({"/warp/yarns/0/colour", "\"orange\"", "warp.yarns[0].colour", "'orange' is not a colour"});
    refuses({"/warp/order", "\"0 1\"", "warp.order", "names number 1, but there are only 1, counted from 0"});
    refuses({"/warp/order", "\"\"", "warp.order", "is empty"});
    refuses({"/warp/beam_order", "\"2*3\"", "warp.beam_order", "names number 2"});
    refuses({"/warp/beams", "[]", "warp.beams", "needs at least one beam"});
    refuses({"/warp/colour_order", "\"2\"", "warp.colour_order", "names number 2"});
    refuses({"/warp/density_ends_per_cm", "0", "warp.density_ends_per_cm", "from 0.01 to 10000"});
    refuses({"/warp/ends_per_dent", "0", "warp.ends_per_dent", "from 1 to 1000"});
    refuses({"/weft/feeders/0/yarn", "1", "weft.feeders[0].yarn", "whole number from 0 to 0"});
    refuses({"/weft/feeders", "[]", "weft.feeders", "needs 1 to 64 feeders"});
    refuses({"/weft/feeder_order", "\"2\"", "weft.feeder_order", "names feeder 2"});
    refuses({"/weft/feeder_order", "\"0+0\"", "weft.feeder_order", "the same feeder twice"});
    refuses({"/weft/feeder_order", "\"\"", "weft.feeder_order", "is empty"});
    refuses({"/weft/directions", "\"2\"", "weft.directions", "names number 2"});
    refuses({"/weft/take_up", "\"0 2\"", "weft.take_up", "names number 2"});
    refuses({"/scene/friction", "-0.1", "scene.friction", "a number from 0 to 100"});
    refuses({"/scene/warp/strain", "0.9", "scene.warp.strain", "a number from 1 to 2"});
    refuses({"/scene/boundary_x", "\"open\"", "scene.boundary_x", "must be one of periodic, frozen, free"});
    refuses({"/scene/insertion", "\"hand\"", "scene.insertion", "shuttle, rapier, air-jet"});
    refuses({"/scene/pins/0/number", "-1", "scene.pins[0].number", "whole number"});
    refuses({"/scene/fields/0/centre_mm/0", "1e300", "scene.fields[0].centre_mm", "from -1e9 to 1e9"});
    refuses({"/blocks/tiled/x", "0", "blocks.tiled.x", "whole number from 1"});
    refuses({"/blocks/joined/face", "\"top\"", "blocks.joined.face", "must be one of +x"});
    refuses({"/title", "\"" + std::string(1001, 'x') + "\"", "title", "longer than 1000 bytes"});
    refuses(
        {"/warp/beams/0/name", "\"" + std::string(201, 'x') + "\"", "warp.beams[0].name", "longer than 200"});
}

TEST_CASE("a wrong stack is named by row and column") {
    Json rows = Json::array();
    for (int i = 0; i < 5; ++i) {
        Json row = Json::array();
        for (int j = 0; j < 5; ++j) row.push_back("T" + std::to_string(i) + " P" + std::to_string(j));
        rows.push_back(row);
    }
    const auto with = [&](std::size_t i, std::size_t j, const std::string& stack) {
        Json document = whole_json();
        document["blocks"]["toe"] = {{"kind", "stacks"}, {"stacks", rows}};
        document["blocks"]["toe"]["stacks"][i][j] = stack;
        document["blocks"]["moved"]["of"] = "card";
        return read_document(document.dump());
    };
    const auto error = [&](const std::string& stack) {
        const Result<Design> design = with(3, 4, stack);
        REQUIRE_FALSE(design);
        CHECK(design.error().where == "blocks.toe.stacks[3][4]");
        return design.error().message;
    };
    CHECK(with(3, 4, "T3 P4"));
    CHECK_THAT(error("T3 P4 P4"), Catch::Contains("holds 2 ends, but column 4 has 1"));
    CHECK_THAT(error("T3"), Catch::Contains("holds 0 ends"));
    CHECK_THAT(error("T4 P4"), Catch::Contains("T"));
    CHECK_THAT(error("T2 P4"), Catch::Contains("holds T2, which belongs to an earlier row"));
    CHECK_THAT(error("T3 P3"), Catch::Contains("holds P3, which belongs to an earlier column"));
    CHECK_THAT(error("T3 Q4"), Catch::Contains("'Q4' is not a yarn such as"));
    CHECK_THAT(error("T3 P99999999999999999999"), Catch::Contains("is not a yarn"));
    CHECK_THAT(error("T3 P4~~"), Catch::Contains("is not a yarn"));
    refuses({"/blocks/toe/stacks/1/1", "", "blocks.toe.stacks[1]", "has 1 stacks, but row 0 has 2"});
    refuses({"/blocks/toe/stacks", "[]", "blocks.toe.stacks", "must be a list of rows"});
    refuses({"/blocks/toe/stacks", "[[\"-\"]]", "blocks.toe", "needs at least one pick and one end"});
}

TEST_CASE("a wrong card, map or slice is named by its row") {
    refuses(
        {"/blocks/card/card/1", "\"5\"", "blocks.card.card[1]", "must be 2 lower-case hexadecimal digits"});
    refuses(
        {"/blocks/card/card/0", "\"5\"", "blocks.card.card[0]", "two hexadecimal digits for each 8 ends"});
    refuses({"/blocks/card/card/1", "\"A0\"", "blocks.card.card[1]", "lower-case"});
    refuses({"/blocks/card/card/1", "\"a8\"", "blocks.card.card[1]", "the padding 0"});
    refuses({"/blocks/card/ends", "16777216", "blocks.card.card[0]", "hexadecimal digits"});
    refuses({"/blocks/card/ends", "0", "blocks.card.ends", "whole number from 1"});
    refuses({"/blocks/cloth/map/1", "\"0 1\"", "blocks.cloth.map[1]", "has 2 stacks, but row 0 has 4"});
    refuses(
        {"/blocks/cloth/map/1", "\"0*3 2\"", "blocks.cloth.map[1]", "names number 2, but there are only 2"});
    refuses({"/blocks/cloth/map/0", "\"0*99999999\"", "blocks.cloth.map[0]", "is longer than 4194304"});
    refuses({"/blocks/cut/positions/1", "\"P0 X\"", "blocks.cut.positions[1]", "'X' is not a yarn"});
}

TEST_CASE("names, roots and children are checked when a document is read") {
    refuses({"/blocks/a b", "{\"kind\": \"tile\", \"of\": \"toe\"}", "blocks", "'a b' is not a block name"});
    refuses({"/blocks/a\\nb", "{\"kind\": 3}", "blocks", "is not a block name"});
    refuses({"/root", "\"sole\"", "root", "'sole' is not a block of this design"});
    refuses({"/blocks/tiled/of", "\"sole\"", "blocks.tiled", "is made from 'sole', which is not a block"});
    refuses({"/blocks/joined/other", "\"joined\"", "blocks.joined", "in a circle: joined > joined"});
}

TEST_CASE("a circle of blocks is named as a chain") {
    Json document = whole_json();
    document["blocks"]["toe"] = {{"kind", "tile"}, {"of", "heel"}};
    document["blocks"]["heel"] = {{"kind", "attach"}, {"of", "card"}, {"other", "sole"}, {"face", "+x"}};
    document["blocks"]["sole"] = {{"kind", "tile"}, {"of", "toe"}};
    const Result<Design> design = read_document(document.dump());
    REQUIRE_FALSE(design);
    CHECK_THAT(design.error().message, Catch::Contains("in a circle: toe > heel > sole > toe") ||
                                           Catch::Contains("in a circle: heel > sole > toe > heel") ||
                                           Catch::Contains("in a circle: sole > toe > heel > sole"));
    CHECK_THAT(design.error().where, Catch::StartsWith("blocks."));
}

TEST_CASE("deep trees neither overflow nor tire the reader") {
    Design design;
    design.blocks["b0"] = plain();
    for (std::size_t k = 1; k < most_blocks; ++k) {
        const std::string below = "b" + std::to_string(k - 1);
        design.blocks["b" + std::to_string(k)] = node(RenumberOperation{below, System::weft, 0, {0}});
    }
    design.root = "b" + std::to_string(most_blocks - 1);
    const Result<Design> back = read_document(write_document(design));
    REQUIRE(back);
    CHECK(*back == design);
    Design larger = design;
    larger.blocks["one-more"] = plain();
    REQUIRE_FALSE(check(larger));
    CHECK_THAT(check(larger).error().text(), Catch::Contains("more than 4096 blocks"));
}

TEST_CASE("a hand-written leaf may leave out what follows from it, and keeps empty slots on top as height") {
    const Result<Design> design =
        read_document(R"({"format": "weave", "version": 1, "root": "a", "blocks": {"a":
        {"kind": "stacks", "stacks": [["T0 P1 P0 -", "  P2   T0 E E -"]]}}})");
    if (!design) FAIL(design.error().text());
    const Block& block = *evaluate(*design)->block;
    CHECK(block.t() == std::vector<std::uint32_t>{1});
    CHECK(block.p() == std::vector<std::uint32_t>{2, 1});
    CHECK(block.height() == 5);
    CHECK(block.stack(0, 0) == parse_stack("T0 P1 P0").value());
    CHECK(design->warp == default_warp());
    CHECK(design->weft == default_weft());
    CHECK(design->scene == Scene{});
    const Result<Design> again = read_document(write_document(*design));
    REQUIRE(again);
    CHECK(*again == *design);
}

TEST_CASE("check finds what an editor could do wrong, so that every sound design can be written and read") {
    const Design sound = read_document(whole).value();
    const auto refused = [&](auto&& damage, const std::string& where) {
        Design design = sound;
        damage(design);
        const Status status = check(design);
        REQUIRE_FALSE(status);
        CHECK(status.error().where == where);
    };
    const double nan = std::nan("");
    refused([&](Design& d) { d.scene.dx_mm = nan; }, "scene.dx_mm");
    refused([&](Design& d) { d.scene.weft.radius_scale = 0.0; }, "scene.weft.radius_scale");
    refused([&](Design& d) { d.scene.pins[0].number = std::size_t{1} << 40; }, "scene.pins[0].number");
    refused([&](Design& d) { d.scene.fields[0].centre_mm[2] = nan; }, "scene.fields[0].centre_mm");
    refused([&](Design& d) { d.scene.fields[0].radius_mm = 0; }, "scene.fields[0].radius_mm");
    refused([&](Design& d) { d.scene.friction = nan; }, "scene.friction");
    refused([&](Design& d) { d.warp.density_ends_per_cm = nan; }, "warp.density_ends_per_cm");
    refused([&](Design& d) { d.warp.ends_per_dent = 0; }, "warp.ends_per_dent");
    refused([&](Design& d) { d.warp.yarns[0].radius_mm = nan; }, "warp.yarns[0]");
    refused([&](Design& d) { d.warp.yarns.clear(); }, "warp.yarns");
    refused([&](Design& d) { d.warp.order.once.clear(); }, "warp.order");
    refused([&](Design& d) { d.warp.beams.clear(); }, "warp.beams");
    refused([&](Design& d) { d.weft.feeders.resize(65); }, "weft.feeders");
    refused([&](Design& d) { d.weft.feeders[1].yarn = 9; }, "weft.feeders[1]");
    refused([&](Design& d) { d.weft.feeder_order = {{0, 1, 0}}; }, "weft.feeder_order");
    refused([&](Design& d) { d.weft.density_picks_per_cm = 0; }, "weft.density_picks_per_cm");
    refused([&](Design& d) { d.title.assign(1001, 'x'); }, "title");
    refused([&](Design& d) { d.notes.assign(65537, 'x'); }, "notes");
    refused([&](Design& d) { d.root = "none"; }, "root");
    refused([&](Design& d) { d.blocks["-a"] = plain(); }, "blocks");
    refused([&](Design& d) { d.blocks["toe"] = nullptr; }, "blocks.toe");
    refused([&](Design& d) { d.title = "caf\xe9"; }, "title");
    refused([&](Design& d) { d.warp.beams[0].name = "\xed\xa0\x80"; }, "warp.beams[0].name");
    refused([&](Design& d) { d.view = 3; }, "view");
}

TEST_CASE("check finds what is wrong with a single block, with its place") {
    constexpr std::size_t far = std::size_t{1} << 40;
    const auto refused = [](NodeSource source, const std::string& where, std::vector<Flip> flips = {}) {
        Design design = design_of({{"a", plain()}, {"toe", node(std::move(source), std::move(flips))}}, "a");
        const Status status = check(design);
        INFO(where);
        REQUIRE_FALSE(status);
        CHECK(status.error().code == ErrorCode::bad_input);
        CHECK(status.error().where == "blocks.toe." + where);
        CHECK_FALSE(status.error().message.empty());
    };
    const auto card = std::make_shared<const CardImage>(2, 3);
    const auto map = [](std::size_t rows, std::size_t columns, std::vector<std::uint16_t> numbers) {
        return std::make_shared<const StencilMap>(StencilMap{rows, columns, std::move(numbers)});
    };
    refused(StacksLeaf{}, "stacks");
    refused(CardLeaf{}, "card");
    refused(CardLeaf{std::make_shared<const CardImage>(), {1}, {1}}, "card");
    refused(CardLeaf{card, {}, {1}}, "t");
    refused(CardLeaf{card, {1}, {1, 1U << 28}}, "p[1]");
    refused(PresetLeaf{{std::string(101, 'x'), {}}}, "family");
    refused(PresetLeaf{{"\xff", {}}}, "family");
    refused(PresetLeaf{{"twill", {{"up", std::int64_t{1} << 41}}}}, "options.up");
    refused(PresetLeaf{{"twill", {{"up", -(std::int64_t{1} << 41)}}}}, "options.up");
    refused(PresetLeaf{{"twill", {{"\xff", 1}}}}, "options");
    refused(TileOperation{"a", 0, 1, 1}, "x");
    refused(TileOperation{"a", 1, far, 1}, "y");
    refused(TileOperation{"a", 1, 1, far}, "z");
    refused(AttachOperation{"a", "a", static_cast<Face>(6)}, "face");
    refused(StencilOperation{{}, map(1, 1, {0})}, "of");
    refused(StencilOperation{{"a"}, nullptr}, "map");
    refused(StencilOperation{{"a"}, map(0, 0, {})}, "map");
    refused(StencilOperation{{"a"}, map(2, 2, {0, 0, 0})}, "map");
    refused(StencilOperation{{"a"}, map(2, 2, {0, 0, 0, 1})}, "map[1]");
    refused(StencilOperation{{"a"}, map(1, longest_sequence + 1, {})}, "map");
    refused(RenumberOperation{"a", System::weft, far, {0}}, "row");
    refused(RenumberOperation{"a", System::warp, far, {0}}, "column");
    refused(RenumberOperation{"a", System::weft, 0, {0, far}}, "order[1]");
    refused(TileOperation{"a", 1, 1, 1}, "flips[1]", {{0, 0, true}, {0, far, true}});
}

TEST_CASE("block names are plain words") {
    for (const char* name : {"a", "Z9", "7-up", "a.b_c-d"}) CHECK(check_block_name(name));
    CHECK(check_block_name(std::string(64, 'n')));
    for (const char* name : {"", "-a", ".a", "_a", "a b", "a/b", "é", "a\n"})
        CHECK_FALSE(check_block_name(name));
    CHECK_FALSE(check_block_name(std::string(65, 'n')));
}

TEST_CASE("files: errors name the file, and saving replaces it whole") {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("weave-document-" + std::to_string(run_seed()));
    std::filesystem::create_directories(folder);
    const auto file = folder / "shoe.weave";
    const Design design = read_document(whole).value();
    REQUIRE(save_design(design, file));
    CHECK(load_design(file).value() == design);
    std::ofstream(file) << damaged({"/warp/yarns/0/radius_mm", "0", "", ""});
    CHECK_THAT(load_design(file).error().text(),
               Catch::StartsWith(file.string() + ": warp.yarns[0].radius_mm: must be"));
    REQUIRE(save_design(design, file));
    CHECK(load_design(file).value() == design);
    const auto other = [&](const std::string& content) {
        std::ofstream(folder / "other") << content;
        return load_design(folder / "other").error().message;
    };
    CHECK(other("weave-yarns 1\n") == "holds relaxed yarns, no design");
    CHECK_THAT(other("\x89PNG\r\n"), Catch::Contains("have to be imported first"));
    CHECK_THAT(other(" {\"format\""), Catch::Contains("is not JSON: line 1"));
    std::filesystem::remove(folder / "other");
    CHECK(load_design(folder / "none.weave").error().where == (folder / "none.weave").string());
    CHECK_FALSE(save_design(design, folder / "none" / "shoe.weave"));
    CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 1);
    std::filesystem::remove_all(folder);
}

TEST_CASE("a stack that is wrong names its yarns as the document writes them") {
    const auto error = [](const std::string& stacks) {
        return read_document(
                   R"({"format": "weave", "version": 1, "root": "a", "blocks": {"a": {"kind": "stacks", "stacks": )" +
                   stacks + "}}}")
            .error()
            .text();
    };
    CHECK(error(R"([["T0 P0", "T0 P1 P1"]])") == "blocks.a.stacks[0][1]: holds P1 twice");
    CHECK(error(R"([["T0 P0"], ["T2 P0"]])") ==
          "blocks.a.stacks[1][0]: holds T2, but the only pick of this stack is T1");
}
